"""What an array reaches, as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.report.airframe import array_words
from nullpose.report.frames import frame_rows
from nullpose.report.geometry import distance_m
from nullpose.report.quantity import bound_words, value_words
from nullpose.report.requirements import requirement_words
from nullpose.report.tables import binding_nodes, degrees_text, fixed, new_table, status_words
from nullpose.scenario import Array
from nullpose.solve import ArraySolution

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["array_view"]


def array_view(solution: ArraySolution) -> RenderableType:
    """Return where an array hovers and how it is turned, what nodes get, and the phases of a shared beam.

    Args:
        solution: what was found.
    """
    from rich.console import Group
    from rich.text import Text

    scenario = solution.scenario
    head = Text.assemble(
        (scenario.name or "scenario", "bold"), "\n", (_begun(solution.label), "bold blue"), ": "
    )
    head.append(value_words(solution.objective), style="bold")
    stats = solution.stats
    agreeing = (
        f"{stats.agreeing} of {stats.searches} searches ended at this value" if stats.searches > 1 else ""
    )
    lines = (
        bound_words(solution.objective),
        status_words(solution),
        agreeing,
        requirement_words(solution),
    )
    head.append("".join(f"\n{line}" for line in lines if line))
    parts: list[RenderableType] = [head, Text(), _pose_table(solution), _links_table(solution)]
    if solution.combining == "analogue":
        parts.append(_phases_table(solution))
    return Group(*parts)


def _begun(label: str) -> str:
    return label[0].upper() + label[1:]


def _pose_table(solution: ArraySolution) -> Table:
    from rich.table import Table

    array = Array(
        elements=solution.elements, layout=solution.layout, spacing_wavelengths=solution.spacing_wavelengths
    )
    x, y, z = (fixed(float(component), 4) for component in solution.position_m)
    table = Table.grid(padding=(0, 2))
    table.add_row("position", f"x {x} m, y {y} m, z {z} m")
    table.add_row("attitude", f"level, yaw {degrees_text(solution.yaw_rad, 3)} deg")
    table.add_row("array", array_words(array))
    for name, words in frame_rows(solution):
        table.add_row(name, words)
    return table


def _links_table(solution: ArraySolution) -> Table:
    from rich.markup import escape

    scenario, quantity = solution.scenario, solution.objective.quantity
    margins = quantity.noun != quantity.ratio
    columns = (*(["margin (dB)"] if margins else []), "SINR (dB)", "SINR", "distance (m)")
    table = new_table("Links", columns, first="node")
    table.add_column("")
    binding = binding_nodes(solution)
    for link, point in zip(solution.links, scenario.node_positions_m, strict=True):
        cells = [f"{quantity.in_unit(quantity.at(link)):.4f}"] if margins else []
        cells += [f"{link.sinr_db:.4f}", f"{link.sinr:.5g}", f"{distance_m(solution.pose, point):.2f}"]
        binds = link.node in binding
        table.add_row(escape(link.node), *cells, "binding" if binds else "", style="bold" if binds else "")
    return table


def _phases_table(solution: ArraySolution) -> Table:
    """Return the phase of each element of a shared beam, the first being zero."""
    table = new_table("Phase shifters", ("phase (deg)",), first="element")
    phases_rad = solution.phases_rad - solution.phases_rad[0]
    for index, phase_rad in enumerate(phases_rad, start=1):
        table.add_row(str(index), degrees_text(float(phase_rad), 1))
    return table
