"""What a scheme hands back before it is evaluated and reported."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Incumbent:
    """A pose found by a scheme's search.

    Args:
        position_m: (3,) metres.
        axis: (3,) antenna axis, of any length.
        log_value: the logarithm of the smallest ratio there, as the search saw it.
        multipliers: (r,) multipliers of the ratios at the optimum, summing to one; equal where not known.
        starts: local searches run.
        evaluations: poses evaluated.
    """

    position_m: NDArray[np.float64]
    axis: NDArray[np.float64]
    log_value: float
    multipliers: NDArray[np.float64]
    starts: int
    evaluations: int
