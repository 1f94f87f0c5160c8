"""A solution as tables for a terminal, and what several tables share."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from nullpose.physics import Pose, antenna_gain, eavesdropper_snr, received_power_w, to_db
from nullpose.report.airframe import airframe_words
from nullpose.report.frames import frame_rows
from nullpose.report.geometry import azimuth_rad, distance_m, null_angle_rad, tilt_rad
from nullpose.report.quantity import bound_words, value_words
from nullpose.report.requirements import requirement_words
from nullpose.solve import ArraySolution, Scheme, Solution

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = [
    "BINDING_RTOL",
    "azimuth_text",
    "binding_nodes",
    "count_words",
    "degrees_text",
    "fixed",
    "new_table",
    "not_applicable_lines",
    "solution_view",
    "status_words",
]

BINDING_RTOL = 1e-6
"""Nodes whose number is within this of the smallest all bind, as they do on a kink of the max-min."""

_UPRIGHT_RAD = 1e-9  # an axis closer to the vertical than this has no azimuth worth telling


def binding_nodes(solution: Solution | ArraySolution) -> frozenset[str]:
    """Return the names of the nodes that have the smallest SINR, margin or rate, within ``BINDING_RTOL``.

    Args:
        solution: what was found.
    """
    quantity = solution.objective.quantity
    smallest = min(map(quantity.at, solution.links))
    return frozenset(
        link.node for link in solution.links if quantity.at(link) <= smallest * (1.0 + BINDING_RTOL)
    )


def status_words(solution: Solution | ArraySolution) -> str:
    """Return how sure the answer is, in words, and the work behind it.

    Args:
        solution: what was found.
    """
    reason = f": {solution.reason}" if solution.reason else ""
    effort = [count_words(solution.stats.starts, "start")]
    if solution.stats.boxes:
        effort.append(count_words(solution.stats.boxes, "box", "boxes"))
    rigour = f"\n{solution.objective.rigour.message}" if solution.objective.upper_bound is not None else ""
    return f"{solution.status.message}{reason}{rigour}\n{', '.join(effort)}, {solution.stats.wall_s:.2g} s"


def count_words(number: int, noun: str, nouns: str = "") -> str:
    """Return a number of things in words, as in ``2 boxes``.

    Args:
        number: how many.
        noun: the word for one.
        nouns: the word for several, if it is not formed with an s.
    """
    return f"{number} {noun if number == 1 else nouns or noun + 's'}"


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


def new_table(title: str, columns: Iterable[str], *, first: str = "") -> Table:
    """Return an empty table of numbers in the house's look.

    Args:
        title: stands above it; may be empty.
        columns: their headings, after the first.
        first: heading of the first column, which names the rows.
    """
    from rich import box
    from rich.table import Table

    table = Table(
        title=title or None, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold", pad_edge=False
    )
    table.add_column(first)
    for column in columns:
        table.add_column(column, justify="right")
    return table


def fixed(value: float, digits: int) -> str:
    """Return a number with so many decimals, without the sign of a zero.

    Args:
        value: any number.
        digits: how many decimals.
    """
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def degrees_text(angle_rad: float, digits: int = 2) -> str:
    """Return an angle in degrees.

    Args:
        angle_rad: the angle, radians.
        digits: how many decimals.
    """
    return fixed(math.degrees(angle_rad), digits)


def azimuth_text(pose: Pose) -> str:
    """Return the azimuth of the antenna's axis in degrees, a dash for an upright one.

    Args:
        pose: how the drone is turned.
    """
    return "-" if tilt_rad(pose) < _UPRIGHT_RAD else degrees_text(azimuth_rad(pose))


def solution_view(solution: Solution) -> RenderableType:
    """Return one solution as tables: value, pose, links, jammers and eavesdroppers.

    Args:
        solution: what was found.
    """
    from rich.console import Group
    from rich.text import Text

    scenario, objective = solution.scenario, solution.objective
    head = Text.assemble(
        (scenario.name or "scenario", "bold"), "\n", (solution.scheme.label, "bold blue"), ": "
    )
    head.append(value_words(objective), style="bold")
    lines = (bound_words(objective), status_words(solution), requirement_words(solution), solution.note)
    head.append("".join(f"\n{line}" for line in lines if line))
    parts: list[RenderableType] = [head, Text(), _pose_table(solution), _links_table(solution)]
    if scenario.jammers and not objective.quantity.is_rate:
        parts.append(_jammers_table(solution))
    if scenario.eavesdroppers:
        parts.append(_eavesdroppers_table(solution))
    if scenario.jammers and objective.quantity.is_rate:
        parts.append(Text("Jamming does not depend on the pose; it is counted in the noise of the nodes."))
    return Group(*parts)


def _pose_table(solution: Solution) -> Table:
    from rich.table import Table

    pose = solution.pose
    x, y, z = (fixed(float(component), 4) for component in pose.position_m)
    roll, pitch, yaw = (degrees_text(angle, 3) for angle in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad))
    tilt = f"{degrees_text(tilt_rad(pose), 3)} deg from vertical"
    upright = tilt_rad(pose) < _UPRIGHT_RAD
    azimuth = "" if upright else f", azimuth {azimuth_text(pose)} deg (0 east, 90 north)"
    table = Table.grid(padding=(0, 2))
    table.add_row("position", f"x {x} m, y {y} m, z {z} m")
    table.add_row("attitude", f"roll {roll} deg, pitch {pitch} deg, yaw {yaw} deg")
    airframe = solution.scenario.airframe
    if airframe is not None:
        table.add_row("airframe", airframe_words(airframe, pose.tilt_rad))
    table.add_row("antenna axis", f"{tilt}{azimuth}")
    table.add_row("", f"({', '.join(fixed(float(x), 6) for x in pose.antenna_axis)})")
    for name, words in frame_rows(solution):
        table.add_row(name, words)
    return table


def _links_table(solution: Solution) -> Table:
    from rich.markup import escape

    scenario, pose = solution.scenario, solution.pose
    quantity = solution.objective.quantity
    gains_db = to_db(antenna_gain(pose.position_m, pose.antenna_axis, scenario.node_positions_m))
    binding = binding_nodes(solution)
    own = _own_columns(solution)
    columns = (
        *own,
        f"{quantity.ratio} (dB)",
        *([quantity.ratio] if quantity.noun == quantity.ratio else []),
        "distance (m)",
        "antenna gain (dB)",
    )
    table = new_table("Links", columns, first="node")
    table.add_column("")
    for i, link in enumerate(solution.links):
        numbers = [
            *(cells[i] for cells in own.values()),
            f"{link.sinr_db:.4f}",
            *([f"{link.sinr:.5g}"] if quantity.noun == quantity.ratio else []),
            f"{distance_m(pose, scenario.node_positions_m[i]):.2f}",
            fixed(gains_db[i], 2),
        ]
        binds = link.node in binding
        table.add_row(escape(link.node), *numbers, "binding" if binds else "", style="bold" if binds else "")
    return table


def _own_columns(solution: Solution) -> dict[str, list[str]]:
    """Return the columns that only an objective other than the SINR has: heading and cells."""
    scenario, links = solution.scenario, solution.links
    if solution.objective.quantity.is_rate:
        columns = {"secrecy rate (bits/s/Hz)": [f"{link.secrecy_rate_bps_hz or 0.0:.6g}" for link in links]}
        if scenario.jammers or len(set(scenario.node_noise_w)) > 1:
            columns["noise (dBm)"] = [
                f"{30.0 + float(to_db(noise_w)):.2f}" for noise_w in scenario.node_noise_w
            ]
        return columns
    if not scenario.has_margins:
        return {}
    columns = {
        "margin (dB)": [f"{link.sinr_db if link.margin_db is None else link.margin_db:.4f}" for link in links]
    }
    required = [node.min_sinr_db for node in scenario.nodes]
    if any(needs is not None for needs in required):
        columns["required SINR (dB)"] = ["-" if needs is None else f"{needs:g}" for needs in required]
    weights = [node.weight for node in scenario.nodes]
    if any(weight is not None for weight in weights):
        columns["weight"] = ["-" if weight is None else f"{weight:g}" for weight in weights]
    return columns


def _jammers_table(solution: Solution) -> Table:
    from rich.markup import escape

    scenario, pose = solution.scenario, solution.pose
    received_w = received_power_w(
        pose.position_m,
        pose.antenna_axis,
        scenario.jammer_positions_m,
        scenario.jammer_powers_w,
        scenario.receiver.reference_gain,
    )
    ratios_db = to_db(received_w / scenario.receiver.noise_power_w)
    columns = ("axis to jammer (deg)", "distance (m)", "jamming to noise (dB)")
    table = new_table("Jammers", columns, first="jammer")
    for name, point, ratio_db in zip(
        scenario.jammer_names, scenario.jammer_positions_m, ratios_db, strict=True
    ):
        angle, distance = degrees_text(null_angle_rad(pose, point), 4), f"{distance_m(pose, point):.2f}"
        table.add_row(escape(name), angle, distance, _level(float(ratio_db)))
    return table


def _eavesdroppers_table(solution: Solution) -> Table:
    from rich.markup import escape

    scenario, pose = solution.scenario, solution.pose
    ratios_db = to_db(eavesdropper_snr(scenario, pose.position_m, pose.antenna_axis))
    columns = ("axis to eavesdropper (deg)", "distance (m)", "SNR (dB)")
    table = new_table("Eavesdroppers", columns, first="eavesdropper")
    for name, point, ratio_db in zip(
        scenario.eavesdropper_names, scenario.eavesdropper_positions_m, ratios_db, strict=True
    ):
        angle, distance = degrees_text(null_angle_rad(pose, point), 4), f"{distance_m(pose, point):.2f}"
        table.add_row(escape(name), angle, distance, _level(float(ratio_db)))
    return table


def _level(ratio_db: float) -> str:
    return "nulled" if ratio_db < -150.0 else f"{ratio_db:.2f}"  # below it is rounding of the angle
