"""The verb ``compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullpose.cli.options import (
    AllowOutside,
    Fast,
    FigureFile,
    FigureWidth,
    Gap,
    JsonOutput,
    NodeLimit,
    Overrides,
    ScenarioFile,
    Seed,
    TimeLimit,
    Width,
    read_scenario,
    solve_options,
)
from nullpose.cli.output import compiling_announced, prepare_outputs, tell
from nullpose.cli.progress import Ticker

if TYPE_CHECKING:
    from nullpose.scenario import Scenario


def compare(
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    airframes: Annotated[
        bool,
        typer.Option(
            "--airframes",
            help="Compare vehicles instead: level, tilting, omnidirectional, and level with an array.",
        ),
    ] = False,
    figure: FigureFile = None,
    width: Width = None,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    json_output: JsonOutput = False,
) -> None:
    """Solve under the paper's four schemes, or with several vehicles."""
    scenario = read_scenario(file, overrides, allow_outside)
    prepare_outputs(file, overrides, figure=figure, width=width)
    options = solve_options(gap, time_limit, node_limit, fast, seed)
    if airframes:
        _compare_airframes(scenario, options, figure, width, json_output)
        return
    from nullpose.report.comparison import compare_all, comparison_view

    with compiling_announced(), Ticker("solving") as ticker:
        comparison = compare_all(scenario, on_progress=ticker, **options)
    if figure is not None:
        from nullpose.report.figures.bars import draw_comparison
        from nullpose.report.figures.style import write_figure_file

        write_figure_file(draw_comparison(comparison, width), figure)
    tell(comparison, comparison_view, json_output, files=[] if figure is None else [figure])


def _compare_airframes(
    scenario: Scenario,
    options: dict[str, Any],
    figure: Path | None,
    width: FigureWidth | None,
    json_output: bool,
) -> None:
    """Print what was found of each vehicle, and draw it if that was asked for."""
    from nullpose.report.airframes import airframes_view, answer_lines
    from nullpose.study import compare_airframes

    with compiling_announced(), Ticker("comparing vehicles") as ticker:
        vehicles = compare_airframes(scenario, on_progress=ticker, **options)
    if figure is not None:
        from nullpose.report.figures.bars import draw_airframes
        from nullpose.report.figures.style import write_figure_file

        write_figure_file(draw_airframes(vehicles, width), figure)
    files = [] if figure is None else [figure]
    tell(vehicles, airframes_view, json_output, files=files, answer=answer_lines(vehicles))
