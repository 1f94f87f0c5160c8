"""What every verb does with what it finds: results to standard output, notices to standard error, files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.errors import SolveError

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["compiling_announced", "prepare_outputs", "show", "show_json", "tell", "write_figure"]


def tell(
    found: Any,
    view: Callable[[Any], RenderableType],
    json_output: bool,
    *,
    fault: str = "",
    **more: object,
) -> None:
    """Print what was found, as JSON or as tables; end with the code of interrupts if one ended the work.

    Args:
        found: by the verb; has a ``to_dict``.
        view: returns its tables.
        json_output: whether JSON is wanted.
        fault: what is wrong with it all the same; empty for nothing.
        more: what else the JSON object holds.

    Raises:
        SolveError: there is a fault.
    """
    if json_output:
        show_json(found.to_dict() | more)
    else:
        show(view(found))
    if fault:
        raise SolveError(fault)
    if getattr(found, "interrupted", False):
        raise typer.Exit(INTERRUPTED)


def show(view: RenderableType) -> None:
    """Print a table, or several, on standard output.

    Args:
        view: anything that rich can draw.
    """
    from rich.console import Console

    class PlainConsole(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    PlainConsole(highlight=False, emoji=False).print(view)


def show_json(value: object) -> None:
    """Print one JSON object on standard output.

    Args:
        value: plain data.
    """
    from nullpose.report.plain import json_text

    typer.echo(json_text(value))


@contextmanager
def compiling_announced() -> Iterator[None]:
    """Say so on standard error if the kernels have to be compiled in the block."""
    from nullpose.solve.compiling import announce_compiling

    with announce_compiling(
        lambda: typer.echo("Compiling kernels for this machine (once, about half a minute) ...", err=True)
    ):
        yield


def prepare_outputs(file: Path, *, figure: Path | None, **others: Path | None) -> None:
    """Make sure, before any work, that what was asked for can be written, and takes no other file's place.

    Args:
        file: the scenario's.
        figure: where to, or None if no figure was asked for.
        others: further outputs by the names of their options.

    Raises:
        UsageError: the figure's name ends in neither .png nor .svg.
        OutputError: an output is an input or another output too, or it or its folder cannot be written.
    """
    from nullpose.files import check_outputs
    from nullpose.scenario.loading import files_of

    if figure is not None:
        from nullpose.report.figures.style import prepare_figure_file

        prepare_figure_file(figure)
    check_outputs(files_of(file), {f"--{name}": path for name, path in {**others, "figure": figure}.items()})


def write_figure(path: Path | None, drawing: str, found: object) -> None:
    """Draw and write a figure if one was asked for.

    Args:
        path: where to, or None.
        drawing: the function of ``nullpose.report.figures`` that draws it.
        found: what to draw.

    Raises:
        OutputError: the file cannot be written.
    """
    if path is not None:
        from nullpose.report import figures
        from nullpose.report.figures.style import write_figure_file

        write_figure_file(getattr(figures, drawing)(found), path)
