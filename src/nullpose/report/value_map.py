"""A map written to files, and what it says in a terminal."""

from __future__ import annotations

from pathlib import Path

from nullpose.report.document import View
from nullpose.report.figures.plan import draw_value_map
from nullpose.report.figures.style import write_figure
from nullpose.report.results import result_head
from nullpose.solver import Result
from nullpose.study import Field


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
