"""Cases in scenes as rows: one by one, or those of many scenes together in one compiled loop."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from nullpose.errors import NullposeError
from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate, interferer_gains, objective_of_links
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import (
    NODE_LIMIT,
    ManySolutions,
    SolveKeywords,
    Status,
    solve,
    solve_many,
)
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.robust import RobustDetails
from nullpose.solver.trajectory import GAP_DB, solve_trajectory
from nullpose.study.case import Case
from nullpose.study.evaluation import pose_faults
from nullpose.study.least_tilt import tilt_search
from nullpose.study.monte_carlo.rows import FAILED, Row, row_of
from nullpose.study.monte_carlo.spec import StudySpec

At = tuple[int, int]  # a scene's number and that of a combination of swept values

_PLACE = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad")


def solved_row(spec: StudySpec, scene: Scenario, index: int, point: int, case: Case) -> Row:
    """Solve a case in a scene; a failure is a row with a reason.

    Args:
        spec: the study.
        scene: the scene at the combination of swept values.
        index: the scene's number.
        point: the combination's number.
        case: one of the spec's cases.

    Raises:
        KeyboardInterrupt: Ctrl-C ended a proof.
    """
    began = time.perf_counter()
    try:
        columns = _solved(case, case.drawn(scene), _options_of(spec, case))
    except Exception as error:  # whatever goes wrong in one scene is no reason to lose the others
        columns = {"status": FAILED, "reason": reason_of(error)}
    if columns["reason"] == INTERRUPT:
        raise KeyboardInterrupt
    return row_of(index, point, case.name, seconds=time.perf_counter() - began, **columns)


def reason_of(error: Exception) -> str:
    """Return an error as the reason of a row, on one line.

    Args:
        error: what was raised.
    """
    words = "; ".join(line.strip() for line in str(error).splitlines() if line.strip())
    return words if isinstance(error, NullposeError) else f"{type(error).__name__}: {words}"


def _options_of(spec: StudySpec, case: Case) -> SolveKeywords:
    """Collect the options of a solve of a case.

    Args:
        spec: the study.
        case: one of its cases.
    """
    return {
        "gap": spec.gap if case.gap is None else case.gap,
        "time_limit_s": spec.time_limit_s if case.time_limit_s is None else case.time_limit_s,
        "node_limit": NODE_LIMIT if spec.node_limit is None else spec.node_limit,
        "threads": 1,  # a worker has one, and equal rows everywhere need it
        "certify": case.certify is not False,
    }


def _null_gain(scene: Scenario, pose: Pose) -> float | None:
    """Return the smallest of the gains towards interferers; None of an array, or without interferers."""
    place = pose.position_m, pose.orientation(scene.antenna_record)
    gains = np.empty(0) if scene.array is not None else interferer_gains(scene, *place)
    return float(np.min(gains)) if len(gains) else None


def _found(
    scene: Scenario, status: Status, pose: Pose, value: float, bound: float | None, gap: float | None
) -> PlainTable:
    """Return the columns of a pose with what is proved of it; a bound or gap that is not finite is none.

    Args:
        scene: with jammers or eavesdroppers.
        status: how the solve ended.
        pose: position and attitude.
        value: a power ratio, or bits/s/Hz.
        bound: no pose exceeds it; None if nothing is proved.
        gap: relative, between the two.
    """
    proved = {"bound": bound, "gap": gap}
    place = (*pose.position_m, pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    return {
        "status": status.value,
        "value": float(value),
        **{name: float(x) if x is not None and math.isfinite(x) else None for name, x in proved.items()},
        **dict(zip(_PLACE, map(float, place), strict=True)),
        "null_gain": _null_gain(scene, pose),
    }


def _solved(case: Case, scene: Scenario, options: SolveKeywords) -> PlainTable:
    if case.pose is not None:
        pose = case.pose.on(scene)
        faults = "; ".join(f"not allowed: {fault}" for fault in pose_faults(scene, pose))
        return _evaluated(scene, pose, Status.POSE_GIVEN) | {"reason": faults}
    if case.flight == "trajectory":
        return _flown(scene, options)
    tilts: PlainTable = {}
    if case.reach is not None and scene.airframe is not None:
        search = tilt_search(scene, case.reach, options | {"gap": case.gap})
        mount = search.sides(scene.airframe.mount_deg)
        result = search.result_of(mount)
        tilts = {"least_tilt_deg": mount.suffices_deg, "too_little_deg": mount.fails_deg}
    else:
        result = solve(
            scene,
            case.scheme or Scheme.OPTIMUM,
            robust=bool(case.robust),
            hover=case.flight == "hover",
            **options,
        )
    objective, pose, details = result.objective, result.pose, result.details
    columns = _found(
        result.scenario, result.status, pose, objective.value, objective.upper_bound, objective.relative_gap
    )
    node = details.robust.binding_node if isinstance(details, RobustDetails) else result.binding_node
    return columns | tilts | {"reason": result.reason, "binding_node": node, "boxes": result.stats.boxes}


def _evaluated(
    scene: Scenario, pose: Pose, status: Status, bound: float | None = None, gap: float | None = None
) -> PlainTable:
    links, quantity = evaluate(scene, pose), Quantity.of(scene)
    node = None if quantity.whole else min(links, key=quantity.at).node
    columns = _found(scene, status, pose, objective_of_links(scene, links), bound, gap)
    return columns | {"binding_node": node}


def _flown(scene: Scenario, options: SolveKeywords) -> PlainTable:
    """Return the columns of the best flight: value and pose of its worst instant, the bound of all flights.

    A relative gap of a power ratio counts in dB, of a rate in bits/s/Hz.
    """
    gap, quantity = options["gap"], Quantity.of(scene)
    gap_db = GAP_DB if gap is None else gap if quantity.is_rate else quantity.in_unit(1.0 + gap)
    found = solve_trajectory(scene, gap_db=max(gap_db, 1e-6), time_limit_s=options["time_limit_s"])
    worst, bound = int(np.argmin(found.values)), found.upper_bound
    value = float(found.values[worst])
    bound = max(value, bound if quantity.is_rate else 10.0 ** (bound / 10.0))
    proved = bound, quantity.gap(value, bound)
    still = scene.at(float(found.times_s[worst]))
    return _evaluated(still, found.poses[worst], found.status, *proved) | {"reason": found.reason}


def solved_together(spec: StudySpec, scenes: Mapping[At, Scenario]) -> dict[tuple[int, int, str], Row]:
    """Return the rows of those cases that can be solved together, by scene, combination and case.

    A row is the same whatever is solved beside it. What cannot be solved so is left out.

    Args:
        spec: the study.
        scenes: by number and combination.
    """
    alike: dict[str, list[Case]] = defaultdict(list)  # by target and limits
    for case in spec.cases:
        if case.is_free and not case.robust:
            alike[repr(_options_of(spec, case))].append(case)
    vehicles: dict[Airframe | None, dict[At, Scenario]] = defaultdict(dict)  # by the scene's own
    for at, scene in ((at, scene.still()) for at, scene in scenes.items()):
        if not (Quantity.of(scene).is_rate or Quantity.of(scene).whole):
            vehicles[scene.airframe][at] = scene.without_array
    rows = (
        row
        for cases in alike.values()
        for airframe, scenes_alike in vehicles.items()
        for row in _rows(spec, cases, airframe, scenes_alike)
    )
    return {(row["scene"], row["point"], row["case"]): row for row in rows}


def _rows(
    spec: StudySpec, cases: Sequence[Case], airframe: Airframe | None, scenes: Mapping[At, Scenario]
) -> Iterator[Row]:
    """Yield the rows of cases with the same target and limits in scenes with the same vehicle."""
    began, places = time.perf_counter(), list(scenes.items())
    try:
        many = solve_many(
            list(scenes.values()),
            airframes=[case.airframe or airframe for case in cases],
            **_options_of(spec, cases[0]),
        )
    except Exception:  # one of them is at fault: the others are not lost, nor solved in another way
        middle = len(places) // 2
        for half in (places[:middle], places[middle:]) if middle else ():
            yield from _rows(spec, cases, airframe, dict(half))
        return
    seconds = (time.perf_counter() - began) / (len(scenes) * len(cases))
    for number, (at, scene) in enumerate(places):
        for column, case in enumerate(cases):
            columns = _columns_of(many, (number, column), scene, case.airframe or airframe)
            yield row_of(*at, case.name, seconds=seconds, **columns)


def _columns_of(
    many: ManySolutions, at: tuple[int, int], scene: Scenario, airframe: Airframe | None
) -> PlainTable:
    status, reason = many.status[at], str(many.reason[at])
    if status is None:
        return {"status": FAILED, "reason": reason}
    mount_rad = 0.0 if airframe is None else airframe.mount_rad
    pose = Pose(many.position_m[at], many.roll_rad[at], many.pitch_rad[at], many.yaw_rad[at], mount_rad)
    columns = _found(scene, status, pose, many.value[at], many.upper_bound[at], many.relative_gap[at])
    node = scene.terminal_names[int(many.binding_node[at])]
    return columns | {"reason": reason, "binding_node": node, "boxes": int(many.boxes[at])}
