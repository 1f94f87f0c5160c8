"""The verbs ``antenna ...``: what a pattern file holds, and what antennas do to a pose."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from nullpose.cli.options import Fast, FigureFiles, JsonOutput, ProofOptions, SceneOptions, expanded
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.progress import Ticker


class _FileOrVerb(TyperGroup):
    """Verbs, of which ``show`` may be left out before its file."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments after putting a verb first."""
        args = ["show", *args] if args and args[0] not in {*self.commands, *ctx.help_option_names} else args
        return super().parse_args(ctx, args)


antenna = typer.Typer(
    name="antenna",
    cls=_FileOrVerb,
    help="Read a pattern file (antenna FILE), or compare antennas.",
    subcommand_metavar="FILE | compare FILE",
    no_args_is_help=True,
)


@antenna.command()
def show(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File of a radiation pattern.", show_default=False)
    ],
    format_name: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="nec, ffd, ffs, cst, msi or csv.",
            show_default="the file tells it",
        ),
    ] = None,
    frequency_hz: Annotated[
        float | None,
        typer.Option("--frequency", metavar="HZ", help="Which of several frequencies.", show_default=False),
    ] = None,
    figure: FigureFiles = None,
    json_output: JsonOutput = False,
) -> None:
    """Show what a pattern file contains.

    The word show may be left out: nullpose antenna FILE.
    """
    from nullpose.antenna.files import read_pattern
    from nullpose.antenna.summary import summary_of
    from nullpose.files import check_outputs
    from nullpose.report.figures.style import prepare_figure_file, write_figure
    from nullpose.report.pattern import pattern_view

    figures = figure or []
    for path in figures:
        prepare_figure_file(path)
    check_outputs({"the pattern": file}, [("--figure", path) for path in figures])
    table = read_pattern(file, format_name, frequency_hz, estimate=True)
    if figures:
        from nullpose.report.figures.pattern import draw_pattern

        write_figure(draw_pattern(table), *figures)
    tell(summary_of(table), pattern_view, json_output, files=figures)


@antenna.command()
@expanded
def compare(
    scene: SceneOptions, proof: ProofOptions, fast: Fast = False, json_output: JsonOutput = False
) -> None:
    """Compare ideal antennas (the paper's) with those of a scenario.

    It evaluates the best pose for ideal antennas with the antennas that the scenario states, and finds the
    best pose for the stated antennas. Ideal: a short dipole, and isotropic antennas on the ground.
    """
    scenario = scene.read()
    from nullpose.report.answer import antennas_answer
    from nullpose.report.comparison import antennas_view
    from nullpose.study import compare_antennas

    with compiling_announced(proof.time_limit), Ticker("comparing antennas") as ticker:
        found = compare_antennas(scenario, on_progress=ticker, **proof.keywords(fast))
    tell(found, antennas_view, json_output, answer=antennas_answer(found))
