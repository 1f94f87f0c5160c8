"""What was found for a scenario, as tables: with one dipole, with an array, or under errors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from nullpose.physics import (
    FramePose,
    Pose,
    antenna_gain,
    eavesdropper_snr,
    link_gain,
    pose_frames,
    received_power_w,
    to_db,
)
from nullpose.report.document import View, beside, document, head, pairs, rows, table
from nullpose.report.geometry import azimuth_rad, distance_m, null_angle_rad, tilt_rad
from nullpose.report.numbers import (
    begun,
    bound_text,
    bound_words,
    count_of,
    degrees_text,
    fixed,
    stated,
    value_words,
    with_unit,
)
from nullpose.report.sensitivity import sensitivity_view
from nullpose.report.words import airframe_words, array_words, error_words, place_words, requirement_words
from nullpose.scenario import Scenario
from nullpose.solver import Objective, Result, Rigour
from nullpose.solver.array import ArrayDetails
from nullpose.solver.robust import GuardedPose, RobustDetails
from nullpose.study.evaluation import GivenDetails

BINDING_RTOL = 1e-6
"""Nodes whose number is within this of the smallest all bind, as they do on a kink of the max-min."""

_UPRIGHT_RAD = 1e-9  # an axis closer to the vertical than this has no azimuth worth telling
_NULLED_DB = -150.0  # what is below it is rounding of the angle


def binding_nodes(solution: Result) -> frozenset[str]:
    """Return the names of the nodes that have the smallest SINR, margin or rate, within ``BINDING_RTOL``.

    Args:
        solution: what was found.
    """
    quantity = solution.objective.quantity
    most = quantity.least(solution.links) * (1.0 + BINDING_RTOL)
    return frozenset(link.node for link in solution.links if quantity.at(link) <= most)


def work_words(starts: int, boxes: int) -> str:
    """Return how many searches and boxes there were, in words.

    Args:
        starts: of searches.
        boxes: of a proof; 0 for no proof.
    """
    proof = f"; proof: {count_of(boxes, 'box', 'boxes')} examined" if boxes else ""
    return f"search: {count_of(starts, 'start')}{proof}"


def azimuth_text(pose: Pose) -> str:
    """Return the azimuth of the antenna's axis in degrees, a dash for an upright one.

    Args:
        pose: of the drone.
    """
    return "-" if tilt_rad(pose) < _UPRIGHT_RAD else degrees_text(azimuth_rad(pose))


def _head(result: Result, label: str, *more: str) -> View:
    """Return what stands above any result: value, bound, how sure it is, the work behind it, and more."""
    objective = result.objective
    stats = result.stats
    lines: tuple[str, ...] = (
        bound_words(objective),
        f"{_status_words(result)}{result.reason and f': {result.reason}'}",
        "" if objective.upper_bound is None else objective.rigour.message,
        f"{work_words(stats.starts, stats.boxes)}; {stats.wall_s:.2g} s",
        *more,
    )
    if isinstance(result.details, GivenDetails) and objective.upper_bound is not None:
        bound = f"{bound_text(result.details.best.objective)} {objective.quantity.unit}"
        lines = (f"upper bound of every pose {bound}", objective.rigour.message, *more)
    value = f"{objective.quantity.smallest} {value_words(objective)}"
    return head(result.scenario.name, label, value, lines)


def _status_words(result: Result) -> str:
    """Return how near value and bound are; *certified* is said where there can be a certificate."""
    message = result.status.message
    return message.removeprefix("certified ") if result.rigour is Rigour.FLOATING_POINT else message


def solution_view(solution: Result) -> View:
    """Return one solution as tables: value, pose, links, jammers and eavesdroppers.

    Args:
        solution: what was found.
    """
    scenario, objective, pose = solution.scenario, solution.objective, solution.pose
    rate = objective.quantity.is_rate
    at = (pose.position_m, pose.orientation(scenario.antenna_record), scenario.node_positions_m)
    gains, gain_dbi = antenna_gain(*at, scenario.antenna_record), scenario.antenna_gain_dbi
    columns = {"antenna gain (dB)": [fixed(gain_db, 2) for gain_db in gain_dbi + to_db(gains)]}
    if scenario.node_antennas is not None:
        both = link_gain(*at, scenario.antenna_record, scenario.node_antennas)
        columns["with the ground's (dB)"] = [fixed(gain_db, 2) for gain_db in gain_dbi + to_db(both)]
    leaning = f"azimuth {azimuth_text(pose)} deg (0 east, 90 north)"
    airframe = scenario.airframe
    own = [
        ("airframe", None if airframe is None else airframe_words(airframe, pose.tilt_rad)),
        ("antenna axis", f"{degrees_text(tilt_rad(pose), 3)} deg from vertical, {leaning}"),
        ("", _in_brackets(pose.antenna_axis)),
    ]
    note = "Jamming does not depend on the pose. It is part of the nodes' noise."
    return document(
        _head(solution, solution.label, requirement_words(solution), solution.note),
        pairs("", _pose_rows(scenario, pose, own)),
        _links_table(solution, columns),
        _nulls_table(scenario, pose),
        note if scenario.jammers and rate else None,
        sensitivity_view(solution),
    )


def result_view(result: Result) -> View:
    """Return what was found, as tables: with one dipole, with an array, or under errors.

    Args:
        result: of any kind.
    """
    views = {RobustDetails: robust_view, ArrayDetails: array_view}
    return views.get(type(result.details), solution_view)(result)


def array_view(solution: Result) -> View:
    """Return where an array hovers, its attitude, and what nodes get.

    Args:
        solution: what was found.
    """
    stats = solution.stats
    searches = count_of(stats.searches or 0, "local search", "local searches")
    agreeing = f"{stats.agreeing} of {searches} ended at this value" if (stats.searches or 0) > 1 else ""
    return document(
        _head(solution, begun(solution.label), requirement_words(solution), agreeing),
        pairs("", _pose_rows(solution.scenario, solution.pose, [("array", array_words(solution.details))])),
        _links_table(solution, {}),
        sensitivity_view(solution),
    )


def robust_view(solution: Result) -> View:
    """Return a robust solution as tables: the guarantee, its bound, and both poses side by side.

    Args:
        solution: what was found.
    """
    robust, nominal = solution.robust, solution.nominal
    objective, quantity = solution.objective, solution.objective.quantity
    cells = {"robust pose": robust, "best pose without errors": nominal}
    gain = quantity.in_unit(robust.guaranteed) - quantity.in_unit(nominal.guaranteed)
    combinations = f"upper bound from {count_of(solution.cases, 'combination')} of errors"
    bound = "no upper bound on the guaranteed value" if solution.upper_bound is None else combinations
    errors = f"errors: {error_words(solution.scenario)}; {bound}"
    return document(
        _head(solution, "Robust, guaranteed", errors, solution.note),
        table(
            "",
            beside({name: _guarded_cells(objective, one) for name, one in cells.items()}),
            bold=[f"guaranteed ({quantity.unit})"],
        ),
        *(f"worst for the {name}: {one.worst_case}" for name, one in cells.items()),
        "Guaranteed: holds for all errors within the stated limits. "
        "Lowest found: over the errors that were tried.",
        *(
            pairs(begun(name), frame_rows(solution.scenario, one.pose))
            for name, one in cells.items()
            if solution.scenario.origin is not None
        ),
        f"\nThe robust pose guarantees {with_unit(gain, quantity)} more than the best pose without errors.",
        sensitivity_view(solution),
    )


def _guarded_cells(objective: Objective, one: GuardedPose) -> dict[str, str]:
    """Return what a pose guarantees, what it gives without errors, and where it is."""
    pose, quantity = one.pose, objective.quantity
    values = {"guaranteed": one.guaranteed, "lowest found": one.worst, "without errors": one.nominal}
    return {
        **{f"{name} ({quantity.unit})": f"{quantity.in_unit(value):.4f}" for name, value in values.items()},
        "position (m)": ", ".join(fixed(float(x), 3) for x in pose.position_m),
        "roll, pitch, yaw (deg)": ", ".join(map(degrees_text, (pose.roll_rad, pose.pitch_rad, pose.yaw_rad))),
        "axis azimuth (deg)": azimuth_text(pose),
        "worst node": one.binding_node,
    }


def _pose_rows(
    scenario: Scenario, pose: Pose, own: Iterable[tuple[str, str | None]]
) -> list[tuple[str, str | None]]:
    """Return where the drone is and its attitude: names and words, between them what the antenna has."""
    place = ", ".join(
        f"{axis} {fixed(float(at), 4)} m" for axis, at in zip("xyz", pose.position_m, strict=True)
    )
    return [("position", place), ("attitude", _attitude_words(pose)), *own, *frame_rows(scenario, pose)]


def _attitude_words(pose: Pose | FramePose) -> str:
    angles = {"roll": pose.roll_rad, "pitch": pose.pitch_rad, "yaw": pose.yaw_rad}
    return ", ".join(f"{name} {degrees_text(angle_rad, 3)} deg" for name, angle_rad in angles.items())


def _in_brackets(numbers: Iterable[float]) -> str:
    return f"({', '.join(fixed(float(number), 6) for number in numbers)})"


def frame_rows(scenario: Scenario, pose: Pose) -> list[tuple[str, str]]:
    """Return a pose on the Earth, in NED and as quaternions: a name and words for each.

    Args:
        scenario: without an origin there is nothing to tell.
        pose: of the drone.
    """
    frames = pose_frames(scenario, pose)
    if frames.geodetic is None:
        return []
    north, east, down = (f"{component:z.4f}" for component in frames.ned.position_m)
    return [
        ("on the Earth", place_words(frames.geodetic)),
        ("NED, body FRD", f"north {north} m, east {east} m, down {down} m"),
        ("", _attitude_words(frames.ned)),
        ("quaternion wxyz", f"{_in_brackets(frames.enu.quaternion_wxyz)} in ENU, body FLU"),
        ("", f"{_in_brackets(frames.ned.quaternion_wxyz)} in NED, body FRD"),
    ]


def _links_table(solution: Result, more: Mapping[str, Sequence[str]]) -> View | None:
    """Return a row for each node: what counts of it, its ratio and its distance, more, whether it binds."""
    scenario, quantity, links = solution.scenario, solution.objective.quantity, solution.links
    binding = binding_nodes(solution)
    own: dict[str, Sequence[str | None]] = {}
    if quantity.noun != quantity.ratio:
        numbers = [quantity.in_unit(quantity.at(link)) for link in links]
        own[f"{quantity.noun} ({quantity.unit})"] = [f"{number:.6g}" for number in numbers]
        own[f"required {quantity.ratio} (dB)"] = [stated(node.min_sinr_db, ".6g") for node in scenario.nodes]
        own["weight"] = [stated(node.weight, ".6g") for node in scenario.nodes]
    if quantity.is_rate:
        own["noise (dBm)"] = [f"{30.0 + noise_db:.2f}" for noise_db in to_db(scenario.node_noise_w)]
    distances_m = [distance_m(solution.pose, point_m) for point_m in scenario.node_positions_m]
    columns: dict[str, Sequence[str | None]] = {
        "node": [link.node for link in links],
        **own,
        f"{quantity.ratio} (dB)": [f"{link.sinr_db:.4f}" for link in links],
        quantity.ratio: [None if own else f"{link.sinr:.5g}" for link in links],
        "distance (m)": [f"{distance:.2f}" for distance in distances_m],
        **more,
        "": ["worst" if link.node in binding else "" for link in links],
    }
    return table("Links", rows(columns), bold=binding, left=[""])


def _nulls_table(scenario: Scenario, pose: Pose) -> View | None:
    """Return how far the null is off each eavesdropper or jammer, and how strong the link with it is."""
    noun, heading, points = "eavesdropper", "SNR (dB)", scenario.eavesdropper_positions_m
    names = scenario.eavesdropper_names
    if scenario.eavesdroppers:
        ratios = eavesdropper_snr(scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    else:
        noun, heading, points = "jammer", "jamming to noise (dB)", scenario.jammer_positions_m
        names, powers_w, receiver = scenario.jammer_names, scenario.jammer_powers_w, scenario.receiver
        orientation = pose.orientation(scenario.antenna_record)
        link = (pose.position_m, orientation, points, powers_w, scenario.reference_gain)
        antennas = (scenario.antenna_record, scenario.jammer_antennas)
        ratios = received_power_w(*link, *antennas) / receiver.noise_power_w
    columns = {
        noun: names,
        f"axis to {noun} (deg)": [degrees_text(null_angle_rad(pose, point_m), 4) for point_m in points],
        "distance (m)": [f"{distance_m(pose, point_m):.2f}" for point_m in points],
        heading: ["nulled" if db < _NULLED_DB else f"{db:.2f}" for db in to_db(ratios)],
    }
    return table(f"{noun.capitalize()}s", rows(columns))
