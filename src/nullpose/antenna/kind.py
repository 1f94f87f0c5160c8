"""What a kind of antenna states of itself, antennas whose gain is a quadratic form, and the ground's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna.harmonics import FloatArray
from nullpose.antenna.pattern import PatternAntenna
from nullpose.files import PlainTable

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


@dataclass(frozen=True, slots=True, kw_only=True)
class QuadraticAntenna:
    """An antenna of gain ``g = (1 - e) sin^2(gamma) + e``: 1 broadside, and e along its axis.

    Its link to a point at r, gain over squared distance, is ``u^T M(r) u`` for a unit axis u, with
    ``M(r) = (1 - e) T(r) + e I / |r|^2`` and ``T(r) = (|r|^2 I - r r^T) / |r|^4``. Solver and certificate
    need no more than e of it. It is polarised as a short dipole is.

    Args:
        name: as in a scenario file.
        label: in sentences and tables.
        leak: e, the gain along the axis, a power ratio from 0 to 1; 0 is a perfect null.
    """

    is_quadratic: ClassVar[Literal[True]] = True
    is_axisymmetric: ClassVar[bool] = True
    is_even: ClassVar[bool] = True
    has_polarisation: ClassVar[bool] = True
    peak: ClassVar[float] = 1.0

    name: str
    label: str
    leak: float

    @property
    def mean(self) -> float:
        """Mean gain over the sphere."""
        return (2.0 + self.leak) / 3.0

    def gain(self, sine_squared: FloatArray) -> FloatArray:
        """Evaluate the power gain at an angle from the axis, 1 broadside.

        Args:
            sine_squared: ``sin^2(gamma)``, of any shape.
        """
        return self.leak + (1.0 - self.leak) * sine_squared


AnyAntenna: TypeAlias = QuadraticAntenna | PatternAntenna
"""An antenna of the drone."""


class AntennaKind(NamedTuple):
    """A kind of antenna, as ``kind`` in the table ``[antenna]`` names it.

    Args:
        summary: what it is, for the schema of scenario files.
        make: from the values of ``keys``, by name, to the antenna.
        keys: of the table ``[antenna]`` that have a meaning for it, beside ``kind`` and ``gain_dbi``.
        read: from the path of its file and the table to the keys that the file fills in, and notes on how it
            is read; None where the kind has no file.
    """

    summary: str
    make: Callable[..., AnyAntenna]
    keys: tuple[str, ...] = ()
    read: Callable[[Path, PlainTable], tuple[PlainTable, tuple[str, ...]]] | None = None
