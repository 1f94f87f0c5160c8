"""Antennas on the ground: how much of what the drone sends or receives they take part in."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

GROUND_ANTENNAS = {"isotropic": 1.0, "circular": 0.5, "dipole": 1.0, "profile": 1.0}
"""By the kind in a scenario file: the largest share of the power that it takes.

An isotropic antenna takes part with all of the power whatever the polarisation (paper eq. 2.1), a circular
one, either way round, with half of it. A short dipole takes what its pattern and its polarisation let
through. A profile is an isotropic antenna times a gain by elevation, which is part of the link's channel
(:mod:`nullpose.channel.profile`).
"""


class GroundAntennas(NamedTuple):
    """The antennas of some ground points.

    A dipole of leak f counts as ``1 - f`` of the same dipole with a perfect null and f of an isotropic
    antenna at the same place: what leaks through its null has no known direction and polarisation.

    Args:
        axes: (m, 3) unit axis of a point's short dipole; zero where the point has none.
        shares: (m,) the largest gain of a link that each allows: its own, times its share of the power.
        leaks: (m,) f, the gain of each dipole along its axis, 1 being that across it; 1 without a dipole.
    """

    axes: NDArray[np.float64]
    shares: NDArray[np.float64]
    leaks: NDArray[np.float64]


def unit_axis(axis: tuple[float, float, float] | None) -> NDArray[np.float64]:
    """Return a dipole's axis at unit length, not a rounding error longer; the vertical one if none is given.

    What bounds a link by its distance holds for it to the last bit then.

    Args:
        axis: of any length but zero.
    """
    if axis is None:
        return np.array([0.0, 0.0, 1.0])
    scaled = np.array(axis) / np.max(np.abs(axis))  # or squares may overflow
    unit = scaled / np.linalg.norm(scaled)
    while sum(Fraction(x) ** 2 for x in unit.tolist()) > 1:
        unit = np.nextafter(unit, 0.0)
    return np.asarray(unit)
