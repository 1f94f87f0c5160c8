"""Results as tables for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from nullpose.physics import Pose, antenna_gain, received_power_w, to_db
from nullpose.report.comparison import Comparison
from nullpose.report.frames import frame_rows
from nullpose.report.geometry import azimuth_rad, distance_m, null_angle_rad, tilt_rad
from nullpose.scenario import Scenario
from nullpose.solve import Objective, Solution, Status

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["BINDING_RTOL", "binding_nodes", "bound_words", "comparison_view", "solution_view", "status_words"]

BINDING_RTOL = 1e-6
"""Nodes whose SINR is within this of the smallest all bind, as they do on a kink of the max-min."""

_UPRIGHT_RAD = 1e-9  # an axis closer to the vertical than this has no azimuth worth telling


def binding_nodes(solution: Solution) -> frozenset[str]:
    """Return the names of the nodes that have the smallest SINR, within ``BINDING_RTOL``.

    Args:
        solution: what was found.
    """
    smallest = min(link.sinr for link in solution.links)
    return frozenset(link.node for link in solution.links if link.sinr <= smallest * (1.0 + BINDING_RTOL))


def status_words(solution: Solution) -> str:
    """Return how sure the answer is, in words, and the work behind it.

    Args:
        solution: what was found.
    """
    reason = f": {solution.reason}" if solution.reason else ""
    effort = [_count(solution.stats.starts, "start")]
    if solution.stats.boxes:
        effort.append(_count(solution.stats.boxes, "box", "boxes"))
    return f"{solution.status.message}{reason}\n{', '.join(effort)}, {solution.stats.wall_s:.2g} s"


def bound_words(objective: Objective) -> str:
    """Return the bound and the gap in words, empty if nothing is proved.

    Args:
        objective: value and bound.
    """
    if objective.upper_bound is None or objective.relative_gap is None:
        return ""
    return f"at most {bound_db_text(objective)} dB (relative gap {objective.relative_gap:.1e})"


def bound_db_text(objective: Objective, digits: int = 0) -> str:
    """Return the bound in dB, rounded up, with the decimals that tell it from the value, or so many.

    Args:
        objective: value and bound.
        digits: decimals; 0 to choose.
    """
    assert objective.upper_bound is not None
    bound_db = float(to_db(objective.upper_bound))
    if not digits:
        apart = max(bound_db - objective.value_db, 1e-12)
        digits = min(12, max(2, math.ceil(-math.log10(apart)) + 1))
    return f"{math.ceil(bound_db * 10**digits) / 10**digits:.{digits}f}"


def _count(number: int, noun: str, nouns: str = "") -> str:
    return f"{number} {noun if number == 1 else nouns or noun + 's'}"


def _table(title: str, columns: Iterable[str], *, first: str = "") -> Table:
    from rich import box
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold", pad_edge=False)
    table.add_column(first)
    for column in columns:
        table.add_column(column, justify="right")
    return table


def _fixed(value: float, digits: int) -> str:
    """Return a number with so many decimals, without the sign of a zero."""
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def _degrees(angle_rad: float, digits: int = 2) -> str:
    return _fixed(math.degrees(angle_rad), digits)


def _azimuth(pose: Pose) -> str:
    return "-" if tilt_rad(pose) < _UPRIGHT_RAD else _degrees(azimuth_rad(pose))


def solution_view(solution: Solution) -> RenderableType:
    """Return one solution as tables: value, pose, links and jammers.

    Args:
        solution: what was found.
    """
    from rich.console import Group
    from rich.text import Text

    title = solution.scenario.name or "scenario"
    head = Text.assemble((title, "bold"), "\n", (solution.scheme.label, "bold blue"), ": ")
    objective = solution.objective
    head.append(f"smallest SINR {objective.value_db:.7g} dB ({objective.value:.7g})", style="bold")
    if objective.upper_bound is not None:
        head.append(f"\n{bound_words(objective)}")
    head.append(f"\n{status_words(solution)}")
    if solution.note:
        head.append(f"\n{solution.note}")
    parts: list[RenderableType] = [head, Text(), _pose_table(solution), _links_table(solution)]
    if solution.scenario.jammers:
        parts.append(_jammers_table(solution))
    return Group(*parts)


def _pose_table(solution: Solution) -> Table:
    from rich.table import Table

    pose = solution.pose
    x, y, z = (_fixed(float(component), 4) for component in pose.position_m)
    roll, pitch, yaw = (_degrees(angle, 3) for angle in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad))
    tilt = f"{_degrees(tilt_rad(pose), 3)} deg from vertical"
    upright = tilt_rad(pose) < _UPRIGHT_RAD
    azimuth = "" if upright else f", azimuth {_azimuth(pose)} deg (0 east, 90 north)"
    table = Table.grid(padding=(0, 2))
    table.add_row("position", f"x {x} m, y {y} m, z {z} m")
    table.add_row("attitude", f"roll {roll} deg, pitch {pitch} deg, yaw {yaw} deg")
    table.add_row("antenna axis", f"{tilt}{azimuth}")
    table.add_row("", f"({', '.join(_fixed(float(x), 6) for x in pose.antenna_axis)})")
    for name, words in frame_rows(solution):
        table.add_row(name, words)
    return table


def _links_table(solution: Solution) -> Table:
    from rich.markup import escape

    scenario, pose = solution.scenario, solution.pose
    gains_db = to_db(antenna_gain(pose.position_m, pose.antenna_axis, scenario.node_positions_m))
    binding = binding_nodes(solution)
    table = _table("Links", ("SINR (dB)", "SINR", "distance (m)", "antenna gain (dB)"), first="node")
    table.add_column("")
    for link, gain_db, point in zip(solution.links, gains_db, scenario.node_positions_m, strict=True):
        numbers = [
            f"{link.sinr_db:.4f}",
            f"{link.sinr:.5g}",
            f"{distance_m(pose, point):.2f}",
            f"{gain_db:.2f}",
        ]
        binds = link.node in binding
        table.add_row(escape(link.node), *numbers, "binding" if binds else "", style="bold" if binds else "")
    return table


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
    table = _table("Jammers", columns, first="jammer")
    for name, point, ratio_db in zip(
        scenario.jammer_names, scenario.jammer_positions_m, ratios_db, strict=True
    ):
        angle, distance = _degrees(null_angle_rad(pose, point), 4), f"{distance_m(pose, point):.2f}"
        table.add_row(escape(name), angle, distance, _interference(float(ratio_db)))
    return table


def _interference(ratio_db: float) -> str:
    return "nulled" if ratio_db < -150.0 else f"{ratio_db:.2f}"  # below it is rounding of the angle


def comparison_view(comparison: Comparison) -> RenderableType:
    """Return several schemes' solutions side by side, one column each.

    Args:
        comparison: what each scheme makes of a scenario.
    """
    from rich.console import Group
    from rich.text import Text

    scenario, solutions = comparison.scenario, comparison.solutions
    absent = [scheme.label for scheme, _ in comparison.left_out]
    table = _table(scenario.name or "scenario", [*(s.scheme.label for s in solutions), *absent])
    for section in _comparison_rows(scenario, solutions):
        for label, cells in section:
            table.add_row(label, *cells, *("-" for _ in absent))
        table.add_section()
    lines = [f"{solution.scheme.label}: {solution.note}" for solution in solutions if solution.note]
    lines += [f"{scheme.label} does not apply: {reason}" for scheme, reason in comparison.left_out]
    if solutions:
        starts = sum(solution.stats.starts for solution in solutions)
        boxes = sum(solution.stats.boxes for solution in solutions)
        for status in Status:
            labels = [s.scheme.label for s in solutions if s.status is status]
            if labels:
                who = "All" if len(labels) == len(solutions) else ", ".join(labels)
                lines.append(f"{who}: {status.message}.")
        lines += [f"{s.scheme.label}: {s.reason}" for s in solutions if s.reason]
        work = _count(starts, "start") + (f", {_count(boxes, 'box', 'boxes')}" if boxes else "")
        lines.append(f"{work} in all")
    lines.append("* binding: the smallest SINR is at this node")
    return Group(table, Text("\n".join(lines)))


def _bound_cell(objective: Objective) -> str:
    return "-" if objective.upper_bound is None else bound_db_text(objective, 7)


_Rows = list[tuple[str, list[str]]]


def _comparison_rows(scenario: Scenario, solutions: Sequence[Solution]) -> list[_Rows]:
    from rich.markup import escape

    best_db = max((solution.objective.value_db for solution in solutions), default=math.nan)
    value: _Rows = [
        ("smallest SINR (dB)", [f"[bold]{s.objective.value_db:.7f}[/]" for s in solutions]),
        ("at most (dB)", [_bound_cell(s.objective) for s in solutions]),
        ("smallest SINR", [f"{s.objective.value:.7g}" for s in solutions]),
        ("gap to the best (dB)", [_fixed(best_db - s.objective.value_db, 4) for s in solutions]),
    ]
    poses = [solution.pose for solution in solutions]
    pose: _Rows = [
        (f"{name} (m)", [_fixed(float(p.position_m[i]), 3) for p in poses]) for i, name in enumerate("xyz")
    ]
    attitude: _Rows = [
        ("roll (deg)", [_degrees(p.roll_rad) for p in poses]),
        ("pitch (deg)", [_degrees(p.pitch_rad) for p in poses]),
        ("axis tilt (deg)", [_degrees(tilt_rad(p)) for p in poses]),
        ("axis azimuth (deg)", [_azimuth(p) for p in poses]),
    ]
    attitude += [
        (f"axis to {escape(name)} (deg)", [_degrees(null_angle_rad(p, point)) for p in poses])
        for name, point in zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True)
    ]
    marks = [binding_nodes(solution) for solution in solutions]
    links: _Rows = [
        (
            f"SINR {escape(name)} (dB)",
            [
                f"{solution.links[i].sinr_db:.4f}{'*' if name in mark else ' '}"
                for solution, mark in zip(solutions, marks, strict=True)
            ],
        )
        for i, name in enumerate(scenario.node_names)
    ]
    return [value, pose, attitude, links]
