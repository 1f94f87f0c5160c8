"""What an array reaches, as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.report.airframe import array_words
from nullpose.report.document import document, head, pairs, table
from nullpose.report.frames import frame_rows
from nullpose.report.numbers import begun, degrees_text
from nullpose.report.quantity import bound_words, value_words
from nullpose.report.requirements import requirement_words
from nullpose.report.tables import links_table, position_words, status_words
from nullpose.scenario import Array
from nullpose.solve import ArraySolution

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["array_view"]


def array_view(solution: ArraySolution) -> RenderableType:
    """Return where an array hovers and how it is turned, what nodes get, and the phases of a shared beam.

    Args:
        solution: what was found.
    """
    objective, stats = solution.objective, solution.stats
    agreeing = f"{stats.agreeing} of {stats.searches} searches ended at this value"
    lines = (
        bound_words(objective),
        status_words(solution),
        agreeing if (stats.searches or 1) > 1 else "",
        requirement_words(solution),
    )
    array = Array(
        elements=solution.elements, layout=solution.layout, spacing_wavelengths=solution.spacing_wavelengths
    )
    rows = [
        ("position", position_words(solution.position_m)),
        ("attitude", f"level, yaw {degrees_text(solution.yaw_rad, 3)} deg"),
        ("array", array_words(array)),
        *frame_rows(solution),
    ]
    quantity, own = objective.quantity, {}
    if quantity.noun != quantity.ratio:
        own["margin (dB)"] = [f"{quantity.in_unit(quantity.at(link)):.4f}" for link in solution.links]
    phases = None
    if solution.combining == "analogue":
        turned_rad = solution.phases_rad - solution.phases_rad[0]  # the first element's is zero
        cells = [degrees_text(float(phase_rad), 1) for phase_rad in turned_rad]
        phases = [{"element": str(i), "phase (deg)": phase} for i, phase in enumerate(cells, start=1)]
    return document(
        head(solution.scenario.name, begun(solution.label), value_words(objective), lines),
        pairs("", rows),
        links_table(solution, own),
        table("Phase shifters", phases or []),
    )
