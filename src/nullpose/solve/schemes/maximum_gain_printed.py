"""Maximum gain as printed (paper eq. 3.5 with its unnormalised cross product), for comparison only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nullpose.family import build_family
from nullpose.physics import maximum_gain_sinr_as_printed
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.found import Found
from nullpose.solve.position_search import search_positions
from nullpose.solve.settle import Settled

__all__ = ["find"]

_NO_POSE = "eq. 3.5 as printed is no antenna's, and nothing is proved of it"


def find(scenario: Scenario, effort: Effort) -> Settled:
    """Return the best position found for eq. 3.5 to the letter.

    Args:
        scenario: what to solve; exactly two nodes.
        effort: what it may cost; nothing is proved of this scheme.
    """

    def objective(position: NDArray[np.float64]) -> float:
        with np.errstate(divide="ignore", invalid="ignore"):  # nothing is received from a node on the axis
            value = float(np.log(np.min(maximum_gain_sinr_as_printed(scenario, position))))
        return value if np.isfinite(value) else -np.inf

    position_m, log_value, starts, evaluations = search_positions(
        objective, build_family(scenario), seed=effort.seed
    )
    first_m, second_m = scenario.node_positions_m - position_m
    axis = np.cross(first_m, second_m)
    if not np.linalg.norm(axis) > 1e-9 * np.linalg.norm(first_m) * np.linalg.norm(second_m):
        # in line with both nodes eq. 3.4 names no axis: any across the line is broadside to both
        axis = np.cross(first_m, np.eye(3)[np.argmin(np.abs(first_m))])
    found = Found(
        position_m=position_m,
        axis=axis,
        log_value=log_value,
        multipliers=np.full(2, 0.5),
        starts=starts,
        evaluations=evaluations,
        note="the value is that of eq. 3.5 as printed, whose axis is not a unit vector: "
        "no antenna receives it",
    )
    return Settled(found=found, reason=_NO_POSE)
