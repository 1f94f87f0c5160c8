"""A sweep or a map, written to files and shown in a terminal."""

from __future__ import annotations

from pathlib import Path

from nullpose.problem.schemes import Scheme
from nullpose.report.answer import certainty_lines, rigour_lines
from nullpose.report.document import View, document, grouped, table
from nullpose.report.figures.plan import draw_value_map
from nullpose.report.figures.style import curve_of, write_figure
from nullpose.report.figures.sweep import draw_sweep, value_label
from nullpose.report.numbers import bound_text, capitalised
from nullpose.report.results import result_head
from nullpose.solver import Result, Status
from nullpose.study import Field, ResultRow, ResultTable

_SHARED = "{} of {} points reuse another's valid bound. Solved alone, each has a certificate."
_SHOWN = 40  # rows of a longer sweep are thinned out on the screen, not in the file


def write_sweep(
    sweep: ResultTable, folder: Path, *, log: bool = False, width: str | None = None, bounds: bool = False
) -> tuple[Path, ...]:
    """Write a sweep as CSV, PNG, SVG and PDF to an existing folder; return the paths.

    Raises:
        OutputError: a file cannot be written.
    """
    return (
        sweep.write_csv(folder / "sweep.csv"),
        *write_figure(
            draw_sweep(sweep, log=log, width=width, bounds=bounds),
            *(folder / f"sweep.{kind}" for kind in ("png", "svg", "pdf")),
        ),
    )


def sweep_view(sweep: ResultTable) -> View:
    """Set a sweep as a table of the objective, a column for each scheme, and how certain it is."""
    step = -(-len(sweep.values) // _SHOWN)
    labelled = [(row.label, row) for row in sweep.rows]
    is_shared = [
        row.objective.upper_bound is not None and not row.stats.boxes and row.tilt is None
        for row in sweep.rows
    ]
    apart = [pair for pair, shared in zip(labelled, is_shared, strict=True) if not shared]
    absent = [(Scheme(name).label, f"not applicable: {reason}") for name, reason in sweep.left_out.items()]
    instants = {row.scenario.at_s for row in sweep.rows} - {None}
    lines = [
        *(f"The scene in motion at {at_s:g} s." for at_s in instants),
        *grouped([*absent, *((label, "") for label, _ in labelled)]),
        *([f"One row in {step} is shown."] if step > 1 else []),
        *(f"{line}." for line in certainty_lines(sweep)),
        *map(capitalised, rigour_lines((label, row.objective.rigour) for label, row in apart)),
        *([_SHARED.format(sum(is_shared), len(is_shared))] if any(is_shared) else []),
        *grouped((label, row.reason) for label, row in labelled),
    ]
    return document(table(value_label(sweep), _rows(sweep, sweep.path)[::step]), "\n".join(lines))


def _rows(sweep: ResultTable, heading: str) -> list[dict[str, str]]:
    """Set a row for each value of a sweep."""
    rows = {value: {heading: f"{value:.6g}"} for value in sweep.values}
    for row in sweep.rows:
        rows[row.value][row.label if row.tilt else curve_of(row.scheme).label] = _cell(row)
    return list(rows.values())


def _cell(row: ResultRow) -> str:
    if row.tilt is not None:
        enough_deg, little_deg = row.tilt.suffices_deg, row.tilt.fails_deg
        return "\ntoo little: ".join("-" if deg is None else f"{deg:.1f}" for deg in (enough_deg, little_deg))
    bound = f"\nupper bound {bound_text(row.objective, 2)}" if row.status == Status.GAP_NOT_REACHED else ""
    return f"{row.objective.quantity.in_unit(row.objective.value):.4f}{bound}"


def write_map(result: Result, field: Field, folder: Path, width: str | None = None) -> tuple[Path, ...]:
    """Write the map of a result as CSV, PNG and PDF to an existing folder; return the paths.

    Raises:
        OutputError: a file cannot be written.
    """
    return (
        field.write_csv(folder / "map.csv"),
        *write_figure(draw_value_map(result, field, width), folder / "map.png", folder / "map.pdf"),
    )


def map_view(result: Result, field: Field) -> View:
    """Write the best value of a result's map, where it is, and what is proved of the best pose."""
    value, position_m = field.best
    place = ", ".join(f"{x:z.3f}" for x in position_m)
    rows, columns = field.values.shape
    return result_head(
        result,
        f"map: {rows * columns:,} places {field.altitude_m:.4g} m up, "
        f"{field.east_m[1] - field.east_m[0]:.3g} m apart; best {value:.7g} {field.unit} at ({place}) m",
    )
