"""Where a verb's words go: results to standard output, everything else to standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["compiling_announced", "show", "show_json"]


def show(view: RenderableType) -> None:
    """Print a table, or several, on standard output.

    Args:
        view: anything that rich can draw.
    """
    from rich.console import Console

    class PlainConsole(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    PlainConsole(highlight=False).print(view)


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
        lambda: typer.echo("Compiling kernels for this machine (once, about a minute) ...", err=True)
    ):
        yield
