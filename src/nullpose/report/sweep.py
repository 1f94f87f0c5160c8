"""A sweep written to files, and shown in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.report.certainty import certainty_lines, rigour_lines
from nullpose.report.document import document
from nullpose.report.document import table as rows_table
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
    quantity = quantity_of(table)
    columns = {CURVES[scheme].label: table.of(scheme) for scheme in table.schemes}
    step = -(-len(table.values) // _SHOWN)
    rows = [
        {table.path: f"{table.values[index]:.6g}"} | {name: _cell(of[index]) for name, of in columns.items()}
        for index in range(0, len(table.values), step)
    ]
    lines = not_applicable_lines((Scheme(scheme), reason) for scheme, reason in table.left_out.items())
    lines += [f"One row in {step} is shown."] if step > 1 else []
    lines += [f"{line}." for line in certainty_lines(table)]
    lines += rigour_lines((Scheme(row.scheme).label, row.objective.rigour) for row in table.rows)
    reasons = dict.fromkeys((row.scheme, row.reason) for row in table.rows if row.reason)  # each once
    lines += [f"{Scheme(scheme).label}: {reason}" for scheme, reason in reasons]
    lines += [f"Wrote {path}" for path in files]
    title = f"S{quantity.smallest[1:]} over the nodes ({quantity.unit})"
    return document(rows_table(title, rows), "\n".join(lines))


def _cell(row: SweepRow) -> str:
    value = f"{row.objective.quantity.in_unit(row.objective.value):.4f}"
    if row.status != Status.GAP_NOT_REACHED or row.upper_bound is None:
        return value
    return f"{value}\nat most {bound_text(row.objective, 2)}"
