"""A sweep written to files, and shown in a terminal."""

from __future__ import annotations

from pathlib import Path

from nullpose.report.certainty import certainty_lines, rigour_lines
from nullpose.report.document import View, document, grouped, table
from nullpose.report.figures.style import write_figure
from nullpose.report.figures.sweep import draw_sweep, quantity_of
from nullpose.report.numbers import begun, bound_text
from nullpose.schemes import Scheme
from nullpose.solve import Status
from nullpose.study import SweepRow, SweepTable

_SHOWN = 40  # rows of a longer sweep are thinned out on the screen, not in the file


def write_sweep(sweep: SweepTable, folder: Path, *, log: bool = False) -> tuple[Path, ...]:
    """Return the paths of a sweep's CSV, PNG and SVG files after writing them.

    Args:
        sweep: what was found.
        folder: an existing folder.
        log: draw the swept setting on a logarithmic axis.

    Raises:
        OutputError: a file cannot be written.
    """
    figure = draw_sweep(sweep, log=log)
    return (sweep.write_csv(folder / "sweep.csv"), *write_figure(figure, folder, "sweep"))


def sweep_view(sweep: SweepTable) -> View:
    """Return a sweep as a table of the objective, one column per scheme, and what is proved of it.

    Args:
        sweep: what was found.
    """
    quantity = quantity_of(sweep)
    step = -(-len(sweep.values) // _SHOWN)
    rows: dict[float, dict[str, str]] = {
        value: {sweep.path: f"{value:.6g}"} for value in sweep.values[::step]
    }
    for row in sweep.rows:
        if row.value in rows:
            rows[row.value][Scheme(row.scheme).record.curve.label] = _cell(row)
    labelled = [(Scheme(row.scheme).label, row) for row in sweep.rows]
    absent = [(Scheme(name).label, f"not applicable: {reason}") for name, reason in sweep.left_out.items()]
    lines = [
        *grouped([*absent, *((label, "") for label, _ in labelled)]),
        *([f"One row in {step} is shown."] if step > 1 else []),
        *(f"{line}." for line in certainty_lines(sweep)),
        *rigour_lines((label, row.objective.rigour) for label, row in labelled),
        *grouped((label, row.reason) for label, row in labelled),
    ]
    title = f"{begun(quantity.smallest)} over the nodes ({quantity.unit})"
    return document(table(title, list(rows.values())), "\n".join(lines))


def _cell(row: SweepRow) -> str:
    value = f"{row.objective.quantity.in_unit(row.objective.value):.4f}"
    if row.status != Status.GAP_NOT_REACHED:
        return value
    return f"{value}\nupper bound {bound_text(row.objective, 2)}"
