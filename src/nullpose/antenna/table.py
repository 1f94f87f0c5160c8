"""A radiation pattern as a table: what every reader returns, whatever the file's format."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PatternTable:
    """Power gain over the whole sphere on a grid of polar angles, body axes x forward, y left, z up.

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
    """

    theta_deg: NDArray[np.float64]
    phi_deg: NDArray[np.float64]
    gain: NDArray[np.float64]
    field: NDArray[np.complex128] | None = None
    frequency_hz: float | None = None
    quantity: str = "gain"
    source: str = ""
    notes: tuple[str, ...] = ()
