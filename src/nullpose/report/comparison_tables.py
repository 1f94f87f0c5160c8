"""Several cases of one scenario side by side, as a table for a terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from nullpose.objectives import Quantity
from nullpose.report.certainty import rigour_lines
from nullpose.report.comparison import Comparison
from nullpose.report.document import beside, document, head, table
from nullpose.report.geometry import null_angle_rad, tilt_rad
from nullpose.report.numbers import begun, degrees_text, fixed
from nullpose.report.quantity import bound_text
from nullpose.report.requirements import requirement_words
from nullpose.report.tables import azimuth_text, binding_nodes, not_applicable_lines, work_words
from nullpose.solve import Solution, Status

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["comparison_view"]


def comparison_view(comparison: Comparison) -> RenderableType:
    """Return several schemes' solutions side by side, one column each.

    Args:
        comparison: what each scheme makes of a scenario.
    """
    scenario, solutions = comparison.scenario, comparison.solutions
    quantity = Quantity.of(scenario)
    best = max((quantity.in_unit(each.objective.value) for each in solutions), default=math.nan)
    labels = [each.label for each in solutions]
    sections = ([_values(each, best) for each in solutions], map(_pose, solutions), map(_links, solutions))
    rows: list[Mapping[str, str]] = []
    for cells in sections:
        rows += [*beside(dict(zip(labels, cells, strict=True))), {}]
    smallest = f"smallest {quantity.short} ({quantity.unit})"
    lines = [f"{each.label}: {each.note}" for each in solutions if each.note]
    lines += [f"{each.label}: {words}" for each in solutions if (words := requirement_words(each))]
    lines += not_applicable_lines(comparison.left_out)
    lines += _certainty(solutions)
    lines.append(f"* binding: the {quantity.smallest} is at this node")
    if scenario.array is not None:
        lines.append("These cases have one dipole. For the file's array: solve, or compare --airframes")
    elif scenario.airframe is not None:
        lines.append("Other vehicles in this scene: compare --airframes")
    return document(head(scenario.name), table("", rows, bold=[smallest]), "\n".join(lines))


def _certainty(solutions: Sequence[Solution]) -> list[str]:
    if not solutions:
        return []
    lines = []
    for status in Status:
        labels = [solution.label for solution in solutions if solution.status is status]
        who = "All" if len(labels) == len(solutions) else ", ".join(labels)
        if len(solutions) == len(labels) == 1:
            lines.append(f"{begun(status.message)}.")
        elif labels:
            lines.append(f"{who}: {status.message}.")
    lines += rigour_lines((solution.label, solution.rigour) for solution in solutions)
    lines += [f"{solution.label}: {solution.reason}" for solution in solutions if solution.reason]
    starts = sum(solution.stats.starts for solution in solutions)
    return [*lines, f"{work_words(starts, sum(each.stats.boxes for each in solutions))} in all"]


def _values(solution: Solution, best: float) -> dict[str, str]:
    objective, quantity = solution.objective, solution.objective.quantity
    value, smallest = quantity.in_unit(objective.value), f"smallest {quantity.short}"
    return {
        f"{smallest} ({quantity.unit})": f"{value:.7f}",
        f"at most ({quantity.unit})": "-" if objective.upper_bound is None else bound_text(objective, 7),
        **({} if quantity.is_rate else {smallest: f"{objective.value:.7g}"}),
        f"gap to the best ({quantity.unit})": fixed(best - value, 4),
    }


def _pose(solution: Solution) -> dict[str, str]:
    """Return place and attitude, and how far the null is off what it is for."""
    scenario, pose = solution.scenario, solution.pose
    cells = {f"{axis} (m)": fixed(float(at), 3) for axis, at in zip("xyz", pose.position_m, strict=True)}
    cells |= {"roll (deg)": degrees_text(pose.roll_rad), "pitch (deg)": degrees_text(pose.pitch_rad)}
    if scenario.airframe is not None:
        cells["yaw (deg)"] = degrees_text(pose.yaw_rad)
        cells["vehicle's tilt (deg)"] = degrees_text(pose.tilt_rad)
    cells |= {"axis tilt (deg)": degrees_text(tilt_rad(pose)), "axis azimuth (deg)": azimuth_text(pose)}
    points = list(zip(scenario.eavesdropper_names, scenario.eavesdropper_positions_m, strict=True))
    if scenario.objective != "secrecy-rate":
        points += zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True)
    return cells | {f"axis to {n} (deg)": degrees_text(null_angle_rad(pose, point)) for n, point in points}


def _links(solution: Solution) -> dict[str, str]:
    """Return each node's margin or rate, and its ratio; a mark where the node binds."""
    quantity, links, binding = solution.objective.quantity, solution.links, binding_nodes(solution)
    marks = {link.node: "*" if link.node in binding else " " for link in links}
    cells = {
        f"{quantity.short} {link.node} ({quantity.unit})": (
            f"{quantity.in_unit(quantity.at(link)):.4f}{marks[link.node]}"
        )
        for link in links
    }
    ratios = {f"{quantity.ratio} {link.node} (dB)": f"{link.sinr_db:.4f} " for link in links}
    return cells if quantity.noun == quantity.ratio else cells | ratios
