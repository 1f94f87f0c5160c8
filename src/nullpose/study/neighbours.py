"""What the points of a sweep say of each other, where the value can only fall along the setting."""

from __future__ import annotations

import re
import time
from collections.abc import Sequence
from dataclasses import replace

from nullpose.objectives import Quantity
from nullpose.physics import evaluate
from nullpose.scenario import Scenario
from nullpose.solver import Result, Rigour, SolveOptions, Status
from nullpose.solver.objective import objective_of, status_of
from nullpose.solver.result import Stats

_FREER = {
    r"airframe\.tilt_max_(deg|rad)": 1.0,
    r"jammers(\.\w+|\[\d+\])\.power_(w|dbm)": -1.0,
    r"receiver\.noise_(w|dbm)": -1.0,
}
"""Settings, and in which direction no pose gets worse and none is lost."""


def freedom(path: str, scenario: Scenario) -> float:
    """Return 1 if the best value can only grow with a setting, -1 if it can only fall, 0 if neither is known.

    Where tilt limits grow, the attitudes of the smaller one are among those of the larger. Less jamming and
    less noise raise every SINR, but also an eavesdropper's.

    Args:
        path: the setting, as in ``jammers.M.power_w``.
        scenario: what is swept.
    """
    sign = next((sign for pattern, sign in _FREER.items() if re.fullmatch(pattern, path)), 0.0)
    at_every_pose = path.startswith("airframe") or not Quantity.of(scenario).is_rate
    return sign if at_every_pose and scenario.array is None else 0.0


def from_freer(scenario: Scenario, freer: Sequence[Result], options: SolveOptions) -> Result | None:
    """Return the certified result that results of freer points imply, or None.

    Their least upper bound holds here, too; if one of their poses is allowed here and comes near to that
    bound, nothing is left to solve. The bound has no certificate of its own.

    Args:
        scenario: the point.
        freer: results of one scheme at points where every pose is as good or better.
        options: with the gap that is asked for.
    """
    began, solve_options = time.perf_counter(), options.of(scenario)
    bounds = [(result.objective.upper_bound, result) for result in freer]
    proved = [(bound, result) for bound, result in bounds if bound is not None]
    if not proved:
        return None
    bound, best = min(proved, key=lambda pair: pair[0])
    airframe = scenario.airframe
    if airframe is not None and best.pose.tilt_rad > airframe.tilt_max_rad:
        return None
    links = tuple(evaluate(scenario, best.pose))
    quantity = Quantity.of(scenario)
    value = quantity.least(links)
    ratio_bound = 2.0**bound if quantity.is_rate else bound
    objective = objective_of(scenario, value, ratio_bound, Rigour.FLOATING_POINT)
    status, _ = status_of(objective, solve_options.target, "not solved by itself")
    if status is not Status.CERTIFIED:
        return None
    return replace(
        best,
        scenario=scenario,
        status=status,
        reason="",
        objective=objective,
        links=links,
        proofs=(),
        stats=Stats(wall_s=time.perf_counter() - began, starts=0, evaluations=1, boxes=0),
    )
