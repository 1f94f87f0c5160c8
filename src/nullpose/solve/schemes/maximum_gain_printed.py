"""Maximum gain as printed (paper eq. 3.5 with its unnormalised cross product), for comparison only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nullpose.family import build_family
from nullpose.physics import maximum_gain_axis, maximum_gain_sinr_as_printed
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.position_search import search_positions

__all__ = ["find"]


def find(scenario: Scenario, *, seed: int) -> Found:
    """Return the best position found for eq. 3.5 to the letter.

    Args:
        scenario: what to solve; exactly two nodes.
        seed: seed of the multistart.
    """

    def objective(position: NDArray[np.float64]) -> float:
        return float(np.log(np.min(maximum_gain_sinr_as_printed(scenario, position))))

    position_m, log_value, starts, evaluations = search_positions(
        objective, build_family(scenario), seed=seed
    )
    return Found(
        position_m=position_m,
        axis=maximum_gain_axis(scenario, position_m),
        log_value=log_value,
        multipliers=np.full(2, 0.5),
        starts=starts,
        evaluations=evaluations,
        note="the value is that of eq. 3.5 as printed, whose axis is not a unit vector: "
        "no antenna receives it",
    )
