"""Several cases of one scenario side by side, as a table for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from nullpose.physics.quantity import Quantity
from nullpose.report.certainty import rigour_lines
from nullpose.report.comparison import Comparison
from nullpose.report.geometry import null_angle_rad, tilt_rad
from nullpose.report.quantity import bound_text
from nullpose.report.requirements import requirement_words
from nullpose.report.tables import (
    azimuth_text,
    binding_nodes,
    count_words,
    degrees_text,
    fixed,
    new_table,
    not_applicable_lines,
)
from nullpose.scenario import Scenario
from nullpose.solve import Objective, Solution, Status

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["comparison_view"]

_Rows = list[tuple[str, list[str]]]


def comparison_view(comparison: Comparison) -> RenderableType:
    """Return several schemes' solutions side by side, one column each.

    Args:
        comparison: what each scheme makes of a scenario.
    """
    from rich.console import Group
    from rich.text import Text

    scenario, solutions = comparison.scenario, comparison.solutions
    quantity = Quantity.of(scenario)
    table = new_table("", (solution.scheme.label for solution in solutions))
    for section in _sections(scenario, quantity, solutions):
        for label, cells in section:
            table.add_row(label, *cells)
        table.add_section()
    lines = [f"{solution.scheme.label}: {solution.note}" for solution in solutions if solution.note]
    requirements = [(solution.scheme.label, requirement_words(solution)) for solution in solutions]
    lines += [f"{label}: {words}" for label, words in requirements if words]
    lines += not_applicable_lines(comparison.left_out)
    lines += _certainty(solutions)
    lines.append(f"* binding: the {quantity.smallest} is at this node")
    if scenario.array is not None:
        lines.append("These cases have one dipole. For the file's array: solve, or compare --airframes")
    elif scenario.airframe is not None:
        lines.append("Other vehicles in this scene: compare --airframes")
    return Group(Text(scenario.name or "scenario", style="bold"), table, Text("\n".join(lines)))


def _certainty(solutions: Sequence[Solution]) -> list[str]:
    if not solutions:
        return []
    lines = []
    for status in Status:
        labels = [solution.scheme.label for solution in solutions if solution.status is status]
        if labels:
            alone = len(solutions) == 1
            who = "All" if len(labels) == len(solutions) > 1 else ", ".join(labels)
            lines.append(
                f"{status.message[0].upper()}{status.message[1:]}." if alone else f"{who}: {status.message}."
            )
    lines += rigour_lines((solution.scheme.label, solution.rigour) for solution in solutions)
    lines += [f"{solution.scheme.label}: {solution.reason}" for solution in solutions if solution.reason]
    work = [count_words(sum(solution.stats.starts for solution in solutions), "start")]
    boxes = sum(solution.stats.boxes for solution in solutions)
    if boxes:
        work.append(count_words(boxes, "box", "boxes"))
    return [*lines, f"{', '.join(work)} in all"]


def _sections(scenario: Scenario, quantity: Quantity, solutions: Sequence[Solution]) -> list[_Rows]:
    return [
        _values(quantity, solutions),
        _places(solutions),
        _attitudes(scenario, solutions),
        *([] if quantity.noun == quantity.ratio else [_own(scenario, quantity, solutions)]),
        _ratios(scenario, quantity, solutions),
    ]


def _values(quantity: Quantity, solutions: Sequence[Solution]) -> _Rows:
    shown = [quantity.in_unit(solution.objective.value) for solution in solutions]
    best = max(shown, default=math.nan)
    smallest = f"smallest {quantity.short}"
    rows = [
        (f"{smallest} ({quantity.unit})", [f"[bold]{value:.7f}[/]" for value in shown]),
        (f"at most ({quantity.unit})", [_bound(solution.objective) for solution in solutions]),
    ]
    if not quantity.is_rate:
        rows.append((smallest, [f"{solution.objective.value:.7g}" for solution in solutions]))
    return [*rows, (f"gap to the best ({quantity.unit})", [fixed(best - value, 4) for value in shown])]


def _bound(objective: Objective) -> str:
    return "-" if objective.upper_bound is None else bound_text(objective, 7)


def _places(solutions: Sequence[Solution]) -> _Rows:
    places_m = [solution.pose.position_m for solution in solutions]
    return [(f"{name} (m)", [fixed(float(p[i]), 3) for p in places_m]) for i, name in enumerate("xyz")]


def _attitudes(scenario: Scenario, solutions: Sequence[Solution]) -> _Rows:
    from rich.markup import escape

    poses = [solution.pose for solution in solutions]
    rows = [
        ("roll (deg)", [degrees_text(pose.roll_rad) for pose in poses]),
        ("pitch (deg)", [degrees_text(pose.pitch_rad) for pose in poses]),
    ]
    if scenario.airframe is not None:
        rows.append(("yaw (deg)", [degrees_text(pose.yaw_rad) for pose in poses]))
        rows.append(("vehicle's tilt (deg)", [degrees_text(pose.tilt_rad) for pose in poses]))
    rows.append(("axis tilt (deg)", [degrees_text(tilt_rad(pose)) for pose in poses]))
    rows.append(("axis azimuth (deg)", [azimuth_text(pose) for pose in poses]))
    points = list(zip(scenario.eavesdropper_names, scenario.eavesdropper_positions_m, strict=True))
    if scenario.objective != "secrecy-rate":
        points += zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True)
    for name, point_m in points:
        rows.append(
            (f"axis to {escape(name)} (deg)", [degrees_text(null_angle_rad(p, point_m)) for p in poses])
        )
    return rows


def _own(scenario: Scenario, quantity: Quantity, solutions: Sequence[Solution]) -> _Rows:
    """Return each node's margin or rate."""
    from rich.markup import escape

    return [
        (
            f"{quantity.short} {escape(name)} ({quantity.unit})",
            [
                f"{quantity.in_unit(quantity.at(solution.links[i])):.4f}{_mark(solution, name)}"
                for solution in solutions
            ],
        )
        for i, name in enumerate(scenario.node_names)
    ]


def _ratios(scenario: Scenario, quantity: Quantity, solutions: Sequence[Solution]) -> _Rows:
    """Return each node's SINR, marked where it binds."""
    from rich.markup import escape

    own = quantity.noun == quantity.ratio
    return [
        (
            f"{quantity.ratio} {escape(name)} (dB)",
            [f"{s.links[i].sinr_db:.4f}{_mark(s, name) if own else ' '}" for s in solutions],
        )
        for i, name in enumerate(scenario.node_names)
    ]


def _mark(solution: Solution, node: str) -> str:
    return "*" if node in binding_nodes(solution) else " "
