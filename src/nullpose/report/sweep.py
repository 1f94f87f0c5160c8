"""A sweep written to files, and shown in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.report.certainty import certainty_lines, rigour_lines
from nullpose.report.figures.style import CURVES, write_figure
from nullpose.report.figures.sweep import draw_sweep, quantity_of
from nullpose.report.quantity import bound_text
from nullpose.report.tables import not_applicable_lines
from nullpose.solve import Scheme, Status
from nullpose.study import SweepRow, SweepTable

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["sweep_view", "write_sweep"]

_SHOWN = 40  # rows of a longer sweep are thinned out on the screen, not in the file


def write_sweep(table: SweepTable, folder: Path, *, log: bool = False) -> tuple[Path, ...]:
    """Return the paths of a sweep's CSV, PNG and SVG files after writing them.

    Args:
        table: what the sweep found.
        folder: an existing folder.
        log: draw the swept setting on a logarithmic axis.

    Raises:
        OutputError: a file cannot be written.
    """
    figure = draw_sweep(table, log=log)
    return (table.write_csv(folder / "sweep.csv"), *write_figure(figure, folder, "sweep"))


def sweep_view(table: SweepTable, files: Sequence[Path]) -> RenderableType:
    """Return a sweep as a table of the objective, one column per scheme, and what is proved of it.

    Args:
        table: what the sweep found.
        files: what was written.
    """
    from rich import box
    from rich.console import Group
    from rich.markup import escape
    from rich.table import Table
    from rich.text import Text

    quantity = quantity_of(table)
    title = f"S{quantity.smallest[1:]} over the nodes ({quantity.unit})"
    view = Table(title=title, box=box.SIMPLE_HEAD, pad_edge=False)
    view.title_justify, view.title_style = "left", "bold"
    view.add_column(escape(table.path), justify="right", overflow="fold")
    for scheme in table.schemes:
        view.add_column(CURVES[scheme].label, justify="right")
    columns = [table.of(scheme) for scheme in table.schemes]
    step = -(-len(table.values) // _SHOWN)
    for index in range(0, len(table.values), step):
        cells = [_cell(column[index]) for column in columns]
        view.add_row(f"{table.values[index]:.6g}", *cells)
    lines = not_applicable_lines((Scheme(scheme), reason) for scheme, reason in table.left_out.items())
    lines += [f"One row in {step} is shown."] if step > 1 else []
    lines += [f"{line}." for line in certainty_lines(table)]
    lines += rigour_lines((Scheme(row.scheme).label, row.objective.rigour) for row in table.rows)
    lines += _reasons(table)
    lines += [f"Wrote {path}" for path in files]
    return Group(view, Text("\n".join(lines)))


def _cell(row: SweepRow) -> str:
    value = f"{row.objective.quantity.in_unit(row.objective.value):.4f}"
    if row.status != Status.GAP_NOT_REACHED or row.upper_bound is None:
        return value
    return f"{value}\nat most {bound_text(row.objective, 2)}"


def _reasons(table: SweepTable) -> list[str]:
    """Return what kept rows from being certified, each reason once with its scheme."""
    reasons = dict.fromkeys((row.scheme, row.reason) for row in table.rows if row.reason)
    return [f"{Scheme(scheme).label}: {reason}" for scheme, reason in reasons]
