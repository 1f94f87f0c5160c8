"""The verb ``compare``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import typer

from nullpose.cli.options import Fast, FigureFiles, JsonOutput, ProofOptions, SceneOptions, Width, expanded
from nullpose.cli.output import compiling_announced, prepare_outputs, tell
from nullpose.cli.progress import Ticker


@expanded
def compare(
    *,
    scene: SceneOptions,
    airframes: Annotated[
        bool,
        typer.Option(
            "--airframes",
            help="Compare vehicles instead: tilts up to 0, 10, 20, 30 degrees and any, and arrays.",
        ),
    ] = False,
    figure: FigureFiles = None,
    width: Width = None,
    proof: ProofOptions,
    fast: Fast = False,
    json_output: JsonOutput = False,
) -> None:
    """Solve under the paper's four schemes, or with several vehicles."""
    scenario = scene.read()
    prepare_outputs(scene, figure=figure or [], width=width)
    from nullpose.files import PlainTable
    from nullpose.report.answer import answer_lines
    from nullpose.report.comparison import airframes_view, comparison_view
    from nullpose.study import ResultTable
    from nullpose.study.vehicles import compare_airframes, compare_schemes, verdicts

    solver: Callable[..., ResultTable] = compare_airframes if airframes else compare_schemes
    with (
        compiling_announced(proof.time_limit),
        Ticker("comparing vehicles" if airframes else "solving") as ticker,
    ):
        found = solver(scenario, on_progress=ticker, **proof.keywords(fast))
    if figure:
        from nullpose.report.figures.dots import draw_comparison
        from nullpose.report.figures.style import write_figure

        write_figure(draw_comparison(found, width), *figure)
    view = airframes_view if airframes else comparison_view
    answer: PlainTable = {"answer": answer_lines(found), **verdicts(found)} if airframes else {}
    tell(found, view, json_output, files=figure or [], **answer)
