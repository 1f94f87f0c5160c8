"""A solution as tables for a terminal, and what several tables share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from nullpose.physics import Pose, antenna_gain, eavesdropper_snr, received_power_w, to_db
from nullpose.physics.types import FloatArray
from nullpose.report.airframe import airframe_words
from nullpose.report.document import document, head, pairs, table
from nullpose.report.frames import frame_rows
from nullpose.report.geometry import azimuth_rad, distance_m, null_angle_rad, tilt_rad
from nullpose.report.numbers import count_words, degrees_text, fixed
from nullpose.report.quantity import bound_words, value_words
from nullpose.report.requirements import requirement_words
from nullpose.scenario import Scenario
from nullpose.solve import ArrayDetails, ArraySolution, Scheme, Solution

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = [
    "BINDING_RTOL",
    "azimuth_text",
    "binding_nodes",
    "links_table",
    "not_applicable_lines",
    "position_words",
    "solution_view",
    "stated_cells",
    "status_words",
    "work_words",
]

BINDING_RTOL = 1e-6
"""Nodes whose number is within this of the smallest all bind, as they do on a kink of the max-min."""

_UPRIGHT_RAD = 1e-9  # an axis closer to the vertical than this has no azimuth worth telling

_NULLED_DB = -150.0  # below it is rounding of the angle


def binding_nodes(solution: Solution | ArraySolution) -> frozenset[str]:
    """Return the names of the nodes that have the smallest SINR, margin or rate, within ``BINDING_RTOL``.

    Args:
        solution: what was found.
    """
    quantity = solution.objective.quantity
    most = quantity.least(solution.links) * (1.0 + BINDING_RTOL)
    return frozenset(link.node for link in solution.links if quantity.at(link) <= most)


def status_words(solution: Solution | ArraySolution) -> str:
    """Return how sure the answer is, in words, and the work behind it.

    Args:
        solution: what was found.
    """
    reason = f": {solution.reason}" if solution.reason else ""
    rigour = f"\n{solution.objective.rigour.message}" if solution.objective.upper_bound is not None else ""
    work = work_words(solution.stats.starts, solution.stats.boxes)
    return f"{solution.status.message}{reason}{rigour}\n{work}, {solution.stats.wall_s:.2g} s"


def work_words(starts: int, boxes: int) -> str:
    """Return how many searches and boxes there were, in words.

    Args:
        starts: of searches.
        boxes: of a proof; 0 for no proof.
    """
    return count_words(starts, "start") + (f", {count_words(boxes, 'box', 'boxes')}" if boxes else "")


def not_applicable_lines(left_out: Iterable[tuple[Scheme, str]]) -> list[str]:
    """Return why schemes are missing, a sentence for each reason.

    Args:
        left_out: the schemes, each with its reason.
    """
    reasons: dict[str, list[str]] = {}
    for scheme, reason in left_out:
        reasons.setdefault(reason, []).append(scheme.label)
    return [
        f"{' and '.join(labels)} {'do' if len(labels) > 1 else 'does'} not apply: {reason}"
        for reason, labels in reasons.items()
    ]


def azimuth_text(pose: Pose) -> str:
    """Return the azimuth of the antenna's axis in degrees, a dash for an upright one.

    Args:
        pose: how the drone is turned.
    """
    return "-" if tilt_rad(pose) < _UPRIGHT_RAD else degrees_text(azimuth_rad(pose))


def position_words(position_m: FloatArray) -> str:
    """Return a position, as in ``x 1.0000 m, y 2.0000 m, z 8.0000 m``.

    Args:
        position_m: shape ``(3,)``, metres.
    """
    return ", ".join(f"{axis} {fixed(float(at), 4)} m" for axis, at in zip("xyz", position_m, strict=True))


def solution_view(solution: Solution) -> RenderableType:
    """Return one solution as tables: value, pose, links, jammers and eavesdroppers.

    Args:
        solution: what was found.
    """
    scenario, objective = solution.scenario, solution.objective
    lines = (bound_words(objective), status_words(solution), requirement_words(solution), solution.note)
    note = "Jamming does not depend on the pose; it is counted in the noise of the nodes."
    rate = objective.quantity.is_rate
    return document(
        head(scenario.name, solution.label, value_words(objective), lines),
        pairs("", _pose_rows(solution)),
        links_table(solution, _own_cells(solution), _gain_cells(solution)),
        _jammers_table(scenario, solution.pose) if scenario.jammers and not rate else None,
        _eavesdroppers_table(scenario, solution.pose) if scenario.eavesdroppers else None,
        note if scenario.jammers and rate else None,
    )


def _jammers_table(scenario: Scenario, pose: Pose) -> RenderableType | None:
    received_w = received_power_w(
        pose.position_m,
        pose.antenna_axis,
        scenario.jammer_positions_m,
        scenario.jammer_powers_w,
        scenario.receiver.reference_gain,
    )
    ratios_db = to_db(received_w / scenario.receiver.noise_power_w)
    points = zip(scenario.jammer_names, scenario.jammer_positions_m, ratios_db, strict=True)
    return _levels_table(pose, "jammer", "jamming to noise (dB)", points)


def _eavesdroppers_table(scenario: Scenario, pose: Pose) -> RenderableType | None:
    ratios_db = to_db(eavesdropper_snr(scenario, pose.position_m, pose.antenna_axis))
    points = zip(scenario.eavesdropper_names, scenario.eavesdropper_positions_m, ratios_db, strict=True)
    return _levels_table(pose, "eavesdropper", "SNR (dB)", points)


def _pose_rows(solution: Solution) -> list[tuple[str, str]]:
    pose, airframe = solution.pose, solution.scenario.airframe
    roll, pitch, yaw = (degrees_text(angle, 3) for angle in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad))
    azimuth = azimuth_text(pose)
    leaning = "" if azimuth == "-" else f", azimuth {azimuth} deg (0 east, 90 north)"
    return [
        ("position", position_words(pose.position_m)),
        ("attitude", f"roll {roll} deg, pitch {pitch} deg, yaw {yaw} deg"),
        *([] if airframe is None else [("airframe", airframe_words(airframe, pose.tilt_rad))]),
        ("antenna axis", f"{degrees_text(tilt_rad(pose), 3)} deg from vertical{leaning}"),
        ("", f"({', '.join(fixed(float(x), 6) for x in pose.antenna_axis)})"),
        *frame_rows(solution),
    ]


def links_table(
    solution: Solution | ArraySolution,
    own: Mapping[str, Sequence[str]],
    gains: Mapping[str, Sequence[str]] | None = None,
) -> RenderableType | None:
    """Return a row for each node: its ratio and its distance, and whether it binds.

    Args:
        solution: what was found.
        own: more columns before these, cells by heading.
        gains: more columns behind these.
    """
    quantity, links = solution.objective.quantity, solution.links
    binding = binding_nodes(solution)
    points_m = solution.scenario.node_positions_m
    columns = {"node": [link.node for link in links], **own}
    columns[f"{quantity.ratio} (dB)"] = [f"{link.sinr_db:.4f}" for link in links]
    if quantity.noun == quantity.ratio or isinstance(solution.details, ArrayDetails):
        columns[quantity.ratio] = [f"{link.sinr:.5g}" for link in links]
    columns["distance (m)"] = [f"{distance_m(solution.pose, point):.2f}" for point in points_m]
    columns |= gains or {}
    columns[""] = ["binding" if link.node in binding else "" for link in links]
    rows = [dict(zip(columns, cells, strict=True)) for cells in zip(*columns.values(), strict=True)]
    return table("Links", rows, bold=binding, left=[""])


def _gain_cells(solution: Solution) -> dict[str, list[str]]:
    pose = solution.pose
    gains = antenna_gain(pose.position_m, pose.antenna_axis, solution.scenario.node_positions_m)
    return {"antenna gain (dB)": [fixed(gain_db, 2) for gain_db in to_db(gains)]}


def _own_cells(solution: Solution) -> dict[str, list[str]]:
    """Return the columns that only an objective other than the SINR has: heading and cells."""
    scenario, links = solution.scenario, solution.links
    if solution.objective.quantity.is_rate:
        columns = {"secrecy rate (bits/s/Hz)": [f"{link.secrecy_rate_bps_hz or 0.0:.6g}" for link in links]}
        if scenario.jammers or len(set(scenario.node_noise_w)) > 1:
            columns["noise (dBm)"] = [f"{30.0 + float(to_db(watts)):.2f}" for watts in scenario.node_noise_w]
        return columns
    if not scenario.has_margins:
        return {}
    margins_db = [link.sinr_db if link.margin_db is None else link.margin_db for link in links]
    return {
        "margin (dB)": [f"{margin_db:.4f}" for margin_db in margins_db],
        **stated_cells("required SINR (dB)", [node.min_sinr_db for node in scenario.nodes]),
        **stated_cells("weight", [node.weight for node in scenario.nodes]),
    }


def stated_cells(heading: str, numbers: Sequence[float | None]) -> dict[str, list[str]]:
    """Return a column of numbers that a file may state, a dash where it does not; nothing if it never does.

    Args:
        heading: of the column.
        numbers: a number or None for each row.
    """
    if all(number is None for number in numbers):
        return {}
    return {heading: ["-" if number is None else f"{number:.6g}" for number in numbers]}


def _levels_table(
    pose: Pose, noun: str, heading: str, points: Iterable[tuple[str, FloatArray, float]]
) -> RenderableType | None:
    """Return how far the null is off each jammer or eavesdropper, and how strong the link with it is."""
    rows = [
        {
            noun: name,
            f"axis to {noun} (deg)": degrees_text(null_angle_rad(pose, point_m), 4),
            "distance (m)": f"{distance_m(pose, point_m):.2f}",
            heading: "nulled"
            if ratio_db < -150.0
            else f"{ratio_db:.2f}",  # below it is rounding of the angle
        }
        for name, point_m, ratio_db in points
    ]
    return table(f"{noun.capitalize()}s", rows)
