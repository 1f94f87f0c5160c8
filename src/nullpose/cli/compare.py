"""The verb ``compare``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.figure import prepare_outputs, write_figure
from nullpose.cli.options import (
    AllowOutside,
    Fast,
    Gap,
    JsonOutput,
    NodeLimit,
    Overrides,
    ScenarioFile,
    Seed,
    TimeLimit,
)
from nullpose.cli.output import Ticker, compiling_announced, show, show_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from nullpose.study import AirframeComparison

__all__ = ["compare"]


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
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="FILE",
            help="Draw the vehicles of --airframes as bars, into a file named .png or .svg.",
            show_default=False,
        ),
    ] = None,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    json_output: JsonOutput = False,
) -> None:
    """Solve a scenario under all four schemes, or with several vehicles, side by side."""
    from nullpose.errors import UsageError
    from nullpose.scenario import apply_overrides, load

    if figure is not None and not airframes:
        raise UsageError("--figure: given without --airframes, which it draws; add it, or leave out --figure")
    scenario = apply_overrides(load(file, allow_outside=allow_outside), overrides or [])
    if airframes:
        from nullpose.study import compare_airframes

        prepare_outputs(file, figure=figure)
        with compiling_announced(), Ticker("comparing vehicles") as ticker:
            vehicles = compare_airframes(
                scenario,
                gap=gap,
                time_limit_s=time_limit,
                node_limit=node_limit,
                certify=not fast,
                seed=seed,
                on_progress=ticker,
            )
        _show_airframes(vehicles, figure, json_output)
        interrupted = vehicles.interrupted
    else:
        from nullpose.report.comparison import compare_all

        with compiling_announced(), Ticker("solving") as ticker:
            comparison = compare_all(
                scenario,
                gap=gap,
                time_limit_s=time_limit,
                node_limit=node_limit,
                certify=not fast,
                seed=seed,
                on_progress=ticker,
            )
        if json_output:
            show_json(comparison.to_dict())
        else:
            from nullpose.report.comparison import comparison_view

            show(comparison_view(comparison))
        interrupted = any(solution.interrupted for solution in comparison.solutions)
    if interrupted:
        raise typer.Exit(INTERRUPTED)


def _drawn(vehicles: AirframeComparison) -> Figure:
    from nullpose.report.figures import draw_airframes

    return draw_airframes(vehicles)


def _show_airframes(vehicles: AirframeComparison, figure: Path | None, json_output: bool) -> None:
    """Print what was found of each vehicle, and draw it if that was asked for."""
    from nullpose.report.airframes import airframes_view, answer_lines

    write_figure(figure, partial(_drawn, vehicles))
    if json_output:
        drawn = {} if figure is None else {"files": [str(figure)]}
        show_json({**vehicles.to_dict(), "answer": answer_lines(vehicles), **drawn})
        return
    show(airframes_view(vehicles))
    if figure is not None:
        typer.echo(f"Wrote {figure}")
