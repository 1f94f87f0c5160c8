"""What was found for a scenario, as tables: with one dipole, with an array, or under errors."""

from __future__ import annotations

import math
from collections.abc import Iterable

from nullpose.physics import (
    FramePose,
    Pose,
    pose_frames,
)
from nullpose.report.document import View, beside, cell, document, head, pairs, rows, table
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.report.links import gain_columns, hop_words, links_table, nulls_table
from nullpose.report.numbers import (
    COMPONENTS,
    DEGREES,
    METRES,
    bound_text,
    bound_words,
    capitalised,
    more_decimals,
    value_words,
    with_unit,
)
from nullpose.report.sensitivity import sensitivity_view
from nullpose.report.words import airframe_words, array_words, error_words, place_words, requirement_words
from nullpose.scenario import Scenario
from nullpose.solver import Objective, Result, Rigour
from nullpose.solver.robust import GuardedPose, RobustDetails
from nullpose.study import Evaluation
from nullpose.study.evaluation import GivenDetails

_UPRIGHT_RAD = 1e-9  # an axis closer to the vertical than this has no azimuth worth a number
_SHOWN = 40  # rows of a longer list are thinned out on the screen


def work_words(starts: int, boxes: int) -> str:
    """Say how many searches there were, and how many boxes of a proof, if there was one."""
    return f"search: {starts:,} starts{f'; proof: {boxes:,} boxes examined' if boxes else ''}"


def azimuth_text(pose: Pose, more: int, is_even: bool = True) -> str:
    """Write the azimuth of the antenna's axis in degrees, a dash for an upright one."""
    return "-" if tilt_rad(pose) < _UPRIGHT_RAD else _degrees(azimuth_rad(pose, is_even), more)


def pose_cells(scenario: Scenario, pose: Pose) -> dict[str, str]:
    """Write position, attitude and axis of a pose as cells of a column."""
    is_even, more = scenario.antenna_record.is_even, more_decimals(scenario, pose)
    tilts = {"vehicle's tilt": pose.tilt_rad, "axis tilt": tilt_rad(pose, is_even)}
    return {
        **{f"{axis} (m)": x for axis, x in zip("xyz", _metres(pose.position_m, more), strict=True)},
        **{f"{name} (deg)": _degrees(each, more) for name, each in (_angles_rad(pose) | tilts).items()},
        "axis azimuth (deg)": azimuth_text(pose, more, is_even),
    }


def _angles_rad(pose: Pose | FramePose) -> dict[str, float]:
    return {"roll": pose.roll_rad, "pitch": pose.pitch_rad, "yaw": pose.yaw_rad}


def _metres(position_m: Iterable[float], more: int) -> list[str]:
    return [f"{x:z.{METRES + more}f}" for x in position_m]


def _degrees(angle_rad: float, more: int) -> str:
    return f"{math.degrees(angle_rad):z.{DEGREES + more}f}"


def result_view(result: Result) -> View:
    """Set a result of any kind as tables: value, pose, links, and what the antenna's null is for."""
    if isinstance(result.details, RobustDetails):
        return _robust_view(result, result.details)
    scenario, pose = result.scenario, result.pose
    array = scenario.array
    more = more_decimals(scenario, pose)
    antenna = _antenna_rows(scenario, pose, more) if array is None else [("array", array_words(array))]
    who = "the nodes'" if scenario.objective_record.transmits else "the destination's"
    note = f"Jamming on the ground does not depend on the pose. It is part of {who} noise."
    searches, place = result.stats.searches or 0, zip("xyz", _metres(pose.position_m, more), strict=True)
    agreement = f"{result.stats.agreeing} of {searches} local searches ended at this value"
    lines = (hop_words(result), requirement_words(result), result.note, agreement if searches > 1 else "")
    at = [
        ("position", ", ".join(f"{axis} {x} m" for axis, x in place)),
        ("attitude", _attitude_words(pose, more)),
    ]
    return document(
        result_head(result, *lines),
        pairs("", [*at, *antenna, *frame_rows(scenario, pose, more)]),
        links_table(result, gain_columns(scenario, pose) if array is None else {}),
        nulls_table(scenario, pose) if array is None else None,
        note if scenario.jammers and scenario.transmitter is not None else None,
        sensitivity_view(result),
    )


def evaluation_view(evaluation: Evaluation) -> View:
    """Set the values of poses that were given: of one in full, of several in a row each."""
    results, best = evaluation.results, evaluation.best
    if len(results) == 1:
        return result_view(results[0])
    quantity = best.objective.quantity
    step = -(-len(results) // _SHOWN)
    details = [result.details for result in results if isinstance(result.details, GivenDetails)]
    shown, poses = results[::step], [result.pose for result in results[::step]]
    columns: dict[str, list[str | None]] = {
        "pose": [str(index) for index in range(1, len(results) + 1, step)],
        "position (m)": [" ".join(f"{x:z.2f}" for x in pose.position_m) for pose in poses],
        "attitude (deg)": [" ".join(_degrees(x, -2) for x in _angles_rad(pose).values()) for pose in poses],
        f"{quantity.smallest_short} ({quantity.unit})": [
            f"{quantity.in_unit(result.objective.value):.4f}" for result in shown
        ],
        "worst node": [result.binding_node for result in shown],
        f"to bound ({quantity.unit})": [
            "not allowed" if pose.not_allowed else cell(pose.below_bound, ".4f") for pose in details[::step]
        ],
    }
    value = with_unit(quantity.in_unit(best.objective.value), quantity)
    lines = (bound_words(best.objective), best.objective.rigour.message, f"{len(results)} poses given")
    return document(
        head(best.scenario.name, "Best pose", f"{quantity.smallest} {value}", lines),
        table("", rows(columns), left=["worst node"]),
        f"One row in {step} is shown." if step > 1 else None,
        "Not allowed: --pose and --json tell why." if any(pose.not_allowed for pose in details) else None,
    )


def result_head(result: Result, *more: str) -> View:
    """Write what stands above any result: value, bound, how sure it is, the work behind it, and more."""
    objective, stats = result.objective, result.stats
    sure = "" if objective.upper_bound is None else objective.rigour.message
    uncertified = "certified " if result.rigour is Rigour.FLOATING_POINT else ""  # no certificate can be
    status = result.status.message.removeprefix(uncertified)
    lines: tuple[str, ...] = (
        bound_words(objective),
        f"{status}{result.reason and f': {result.reason}'}",
        sure,
        f"{work_words(stats.starts, stats.boxes)}; {stats.wall_s:.2g} s",
        *more,
    )
    if isinstance(result.details, GivenDetails):
        bound = f"{bound_text(result.details.best.objective)} {objective.quantity.unit}"
        lines = (sure and f"upper bound of every pose {bound}", sure, *more)
    guaranteed = ", guaranteed" if isinstance(result.details, RobustDetails) else ""
    value = f"{objective.quantity.smallest} {value_words(objective)}"
    return head(result.scenario.name, f"{capitalised(result.label)}{guaranteed}", value, lines)


def _robust_view(result: Result, details: RobustDetails) -> View:
    """Set a robust pose as tables: the guarantee, its bound, and the best pose without errors beside it."""
    robust, nominal, scenario = details.robust, details.nominal, result.scenario
    objective, quantity = result.objective, result.objective.quantity
    poses = {"robust pose": robust, "best pose without errors": nominal}
    gain = quantity.in_unit(robust.guaranteed) - quantity.in_unit(nominal.guaranteed)
    more = f"The robust pose guarantees {with_unit(gain, quantity)} more than the best pose without errors."
    bound = (
        "no upper bound on the guaranteed value"
        if objective.upper_bound is None
        else f"upper bound from {details.cases} combinations of errors"
    )
    errors = f"errors: {error_words(scenario)}; {bound}"
    decimals = {name: more_decimals(scenario, guarded.pose) for name, guarded in poses.items()}
    cells = {name: _guarded_cells(objective, pose, decimals[name]) for name, pose in poses.items()}
    return document(
        result_head(result, errors, result.note),
        table("", beside(cells), bold=[f"guaranteed ({quantity.unit})"]),
        "Guaranteed: under all errors within the limits. Lowest found: by a search.",
        f"{more if math.isfinite(gain) else 'The best pose without errors guarantees nothing.'}\n",
        f"worst for the robust pose: {robust.worst_case}\n",
        *(pairs(capitalised(n), frame_rows(scenario, poses[n].pose, more)) for n, more in decimals.items()),
        sensitivity_view(result),
    )


def _guarded_cells(objective: Objective, guarded: GuardedPose, more: int) -> dict[str, str]:
    """Write what a pose guarantees, what it gives without errors, and where it is."""
    pose, quantity = guarded.pose, objective.quantity
    return {
        **{
            f"{name} ({quantity.unit})": f"{quantity.in_unit(value):.4f}"
            for name, value in {
                "guaranteed": guarded.guaranteed,
                "lowest found": guarded.worst,
                "without errors": guarded.nominal,
            }.items()
        },
        "position (m)": ", ".join(_metres(pose.position_m, more)),
        "roll, pitch, yaw (deg)": ", ".join(_degrees(x, more) for x in _angles_rad(pose).values()),
        "axis azimuth (deg)": azimuth_text(pose, more),
        "worst node": guarded.binding_node,
    }


def _antenna_rows(scenario: Scenario, pose: Pose, more: int) -> list[tuple[str, str | None]]:
    is_even = scenario.antenna_record.is_even
    tilt = f"{_degrees(tilt_rad(pose, is_even), more)} deg from vertical"
    airframe, azimuth = scenario.airframe, azimuth_text(pose, more, is_even)
    leans = "" if azimuth == "-" else f", azimuth {azimuth} deg (0 east, 90 north)"
    return [
        ("airframe", None if airframe is None else airframe_words(airframe, pose.tilt_rad)),
        ("antenna axis", f"{tilt}{leans}"),
        ("", _in_brackets(pose.antenna_axis, more)),
    ]


def _attitude_words(pose: Pose | FramePose, more: int) -> str:
    return ", ".join(
        f"{name} {_degrees(angle_rad, more)} deg" for name, angle_rad in _angles_rad(pose).items()
    )


def _in_brackets(numbers: Iterable[float], more: int) -> str:
    return f"({', '.join(f'{number:z.{COMPONENTS + more}f}' for number in numbers)})"


def frame_rows(scenario: Scenario, pose: Pose, more: int) -> list[tuple[str, str | None]]:
    """Write a pose on the Earth, in NED and as quaternions; nothing without an origin."""
    if (frames := pose_frames(scenario, pose)).geodetic is None:
        return []
    north, east, down = _metres(frames.ned.position_m, more)
    return [
        ("on the Earth", place_words(frames.geodetic, more + 2)),
        ("NED, body FRD", f"north {north} m, east {east} m, down {down} m"),
        ("", _attitude_words(frames.ned, more)),
        ("quaternion wxyz", f"{_in_brackets(frames.enu.quaternion_wxyz, more)} in ENU, body FLU"),
        ("", f"{_in_brackets(frames.ned.quaternion_wxyz, more)} in NED, body FRD"),
    ]
