"""The ``nullpose`` command. Nothing heavy is imported before a verb runs, so that help comes at once."""

from __future__ import annotations

import gc
import os
from typing import Annotated

import typer

from nullpose.cli.antenna import antenna
from nullpose.cli.check import check, schema
from nullpose.cli.compare import compare
from nullpose.cli.evaluate import evaluate
from nullpose.cli.faults import FaultReportingGroup, streams_checked
from nullpose.cli.map import best_map
from nullpose.cli.printing import replace_lacking_letters, say
from nullpose.cli.reproduce import reproduce
from nullpose.cli.solve import solve
from nullpose.cli.studio import studio
from nullpose.cli.study import study
from nullpose.cli.sweep import sweep
from nullpose.cli.trajectory import trajectory
from nullpose.cli.vehicle import vehicle
from nullpose.cli.verify import verify

_NARROWEST = 20  # columns that are set at least

app = typer.Typer(
    name="nullpose",
    cls=FaultReportingGroup,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from nullpose import __version__

        say(f"nullpose {__version__}")
        raise typer.Exit


@app.callback()
def nullpose(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit."),
    ] = False,
) -> None:
    """Find the best pose for a drone's antenna under jamming.

    A scenario file (TOML) states nodes, jammers, receiver and airspace. A first
    example: nullpose compare examples/paper.toml

    Exit codes: 0 success, 2 bad input or usage, 1 another failure (such as a
    rejected certificate), 130 interrupted.
    """


for _verb in (solve, trajectory, compare, vehicle, sweep, evaluate, verify, reproduce, studio, check, schema):
    app.command()(_verb)
app.command("map")(best_map)
app.add_typer(study)
app.add_typer(antenna)


def main() -> None:
    """Run the command line and exit with its code."""
    # the kernels run no faster for LLVM's costlier passes, and compile a fifth longer
    os.environ.setdefault("NUMBA_OPT", "1")
    # pydantic would look for plugins through all that is installed
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")
    # loading the libraries makes much that stays: to look through it for garbage takes a tenth of the start
    gc.set_threshold(100_000)
    if (columns := os.environ.get("COLUMNS", "")).isdecimal() and int(columns) < _NARROWEST:
        os.environ["COLUMNS"] = str(_NARROWEST)
    with streams_checked():
        replace_lacking_letters()
        app(prog_name="nullpose")
