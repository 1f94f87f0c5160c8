"""One case in one scene, as a row."""

from __future__ import annotations

import math
import time
from typing import Any

from nullpose.errors import NullposeError
from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate
from nullpose.scenario import Scenario
from nullpose.schemes import Scheme
from nullpose.solve import NODE_LIMIT, Status, solve, solve_array
from nullpose.solve.proof import INTERRUPT
from nullpose.solve.robust import solve_robust
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.rows import FAILED, Row
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["GIVEN_POSE", "limits_of", "reason_of", "solved_row"]

GIVEN_POSE = "a pose that was given: nothing is searched or proved"
"""The reason of a row whose case states a pose."""


def solved_row(spec: StudySpec, scene: Scenario, index: int, point: int, place: int) -> Row:
    """Return what a case gives in a scene; a failure is a row with a reason.

    Args:
        spec: the study.
        scene: the scene at the combination of swept values.
        index: the scene's number.
        point: the combination's number.
        place: the case's place in the spec.

    Raises:
        KeyboardInterrupt: Ctrl-C ended a proof.
    """
    case = spec.cases[place]
    began = time.perf_counter()
    try:
        values = _solved(spec, case, case.on(scene))
    except Exception as error:  # whatever goes wrong in one scene is no reason to lose the others
        values = {"status": FAILED, "reason": reason_of(error)}
    if values["reason"] == INTERRUPT:
        raise KeyboardInterrupt
    values["seconds"] = time.perf_counter() - began
    return Row(scene=index, point=point, case=place, **values)


def reason_of(error: Exception) -> str:
    """Return an error as the reason of a row, on one line.

    Args:
        error: what was raised.
    """
    words = "; ".join(line.strip() for line in str(error).splitlines() if line.strip())
    return words if isinstance(error, NullposeError) else f"{type(error).__name__}: {words}"


def _solved(spec: StudySpec, case: StudyCase, scene: Scenario) -> dict[str, Any]:
    if case.pose is not None:
        pose = case.pose.on(scene)
        links = evaluate(scene, pose)
        value = Quantity.of(scene).least(links)
        deciding = min(links, key=lambda link: _deciding(link.sinr, link.margin, link.secrecy_rate_bps_hz))
        return _row(Status.BEST_FOUND, GIVEN_POSE, value, None, None, pose, deciding.node, 0)
    if case.robust:
        limits = limits_of(spec, case)
        del limits["threads"]
        robust = solve_robust(scene, **limits)
        best = robust.robust
        return _row(
            robust.status,
            robust.reason,
            best.guaranteed,
            robust.upper_bound,
            robust.relative_gap,
            best.pose,
            best.binding_node,
            robust.stats.boxes,
        )
    found: Any
    if case.array is not None:
        gap = limits_of(spec, case).get("gap")
        found = solve_array(scene, case.array.combining, gap=gap, certify=case.certify is not False)
    else:
        found = solve(scene, case.scheme or Scheme.OPTIMUM, **limits_of(spec, case))
    return _row(
        found.status,
        found.reason,
        found.objective.value,
        found.objective.upper_bound,
        found.objective.relative_gap,
        found.pose,
        found.binding_node,
        found.stats.boxes,
    )


def _deciding(sinr: float, margin: float | None, rate: float | None) -> float:
    return rate if rate is not None else sinr if margin is None else margin


def limits_of(spec: StudySpec, case: StudyCase) -> dict[str, Any]:
    """Return the target and the limits of a solve, as its keywords.

    Args:
        spec: the study.
        case: one of its cases.
    """
    gap = spec.gap if case.gap is None else case.gap
    return {
        **({} if gap is None else {"gap": gap}),
        "time_limit_s": spec.time_limit_s if case.time_limit_s is None else case.time_limit_s,
        "node_limit": NODE_LIMIT if spec.node_limit is None else spec.node_limit,
        "threads": 1,  # a worker has one, and equal rows everywhere need it
        "certify": case.certify is not False,
    }


def _row(
    status: Status,
    reason: str,
    value: float,
    bound: float | None,
    gap: float | None,
    pose: Pose,
    node: str,
    boxes: int,
) -> dict[str, Any]:
    x_m, y_m, z_m = (float(each) for each in pose.position_m)
    return {
        "status": status.value,
        "reason": reason,
        "value": float(value),
        "bound": bound if bound is None or math.isfinite(bound) else None,
        "gap": gap if gap is None or math.isfinite(gap) else None,
        "position_m": (x_m, y_m, z_m),
        "attitude_rad": (float(pose.roll_rad), float(pose.pitch_rad), float(pose.yaw_rad)),
        "binding_node": node,
        "boxes": boxes,
    }
