"""A radiation pattern as a table: what every reader returns, whatever the file's format."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PatternTable:
    """Power gain over the whole sphere on a grid of directions, body axes x forward, y left, z up.

    Args:
        theta_deg: (t,) polar angles from z, rising from 0 to 180.
        phi_deg: (p,) azimuths from x towards y, rising, from 0, below 360.
        gain: (t, p) power gain over an isotropic antenna, linear, both polarisations together.
        field: (t, p, 2) complex parts along theta and phi, whose squares sum to the gain; None for a file
            that has no phases.
        frequency_hz: of the table; None where the file does not say.
        quantity: what the file tells: "gain", "realised gain" or "directivity".
        source: the file and the format, for messages.
        notes: what a user should know of how it was read, a sentence each.
        caveat: why it is an estimate and not a pattern; empty if it is one.
        lines: (t, p) where in the file; None where rows have no line of their own.
    """

    theta_deg: NDArray[np.float64]
    phi_deg: NDArray[np.float64]
    gain: NDArray[np.float64]
    field: NDArray[np.complex128] | None = None
    frequency_hz: float | None = None
    quantity: str = "gain"
    source: str = ""
    notes: tuple[str, ...] = ()
    caveat: str = ""
    lines: NDArray[np.int64] | None = None


def solid_angles(table: PatternTable) -> NDArray[np.float64]:
    """Return each direction's share of the sphere, (t, p), for polynomials of the cosine exactly.

    Source: Clenshaw and Curtis, 1960: weights for equal steps of the polar angle.

    Args:
        table: any.
    """
    steps = len(table.theta_deg) - 1
    k = np.arange(1, steps // 2 + 1)
    parts = np.where(2 * k == steps, 1.0, 2.0) / (4.0 * k**2 - 1.0)
    bands = 1.0 - np.cos(2.0 * np.radians(np.outer(table.theta_deg, k))) @ parts
    bands[[0, -1]] *= 0.5
    return np.outer(bands / steps, np.full(len(table.phi_deg), 1.0 / len(table.phi_deg)))


def mean_gain(table: PatternTable) -> float:
    """Return a table's mean gain over the sphere: what is radiated of the power that is fed.

    Args:
        table: any.
    """
    return float(np.sum(solid_angles(table) * table.gain))
