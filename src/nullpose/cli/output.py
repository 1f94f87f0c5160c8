"""What every verb does with what it finds: results to standard output, notices to standard error, files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeVar

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.printing import say
from nullpose.errors import SolveError, require, require_usage

if TYPE_CHECKING:
    from nullpose.cli.options import SceneOptions
    from nullpose.files import PlainTable
    from nullpose.report.document import View


class Plain(Protocol):
    """What can be printed as JSON."""

    def to_dict(self) -> PlainTable:
        """Return plain data."""


Found = TypeVar("Found", bound=Plain)
_COMPILING = (
    "Compiling kernels for this machine, once for dipoles, patterns, arrays and robust poses each ..."
)


def tell(
    found: Found,
    view: Callable[[Found], View],
    json_output: bool,
    *,
    files: Sequence[Path] = (),
    fault: str = "",
    broken: bool = False,
    **more: object,
) -> None:
    """Print a result as JSON or as tables; end with the code of interrupts if an interrupt ended the work.

    Args:
        found: what the verb found.
        view: turns it into tables, or a text.
        json_output: whether JSON is printed in place of these.
        files: the files that were written, to be named.
        fault: what is wrong with the result; empty for nothing.
        broken: whether the lines of a text may be broken between words on a terminal.
        more: further keys of the JSON object.

    Raises:
        SolveError: there is a fault.
    """
    if json_output:
        show_json(found.to_dict() | more | ({"files": [str(path) for path in files]} if files else {}))
    else:
        shown = view(found)
        show(shown, broken=broken)
        for path in files:
            say(f"Wrote {path}", err=isinstance(shown, str))  # a text may go to a file of its own
    require(SolveError, not fault, fault)
    if getattr(found, "interrupted", False):
        raise typer.Exit(INTERRUPTED)


def show(view: View, *, broken: bool = False) -> None:
    """Print a text or tables on standard output; the lines of a text stay whole unless they may be broken."""
    if isinstance(view, str):
        say(view, broken=broken)
        return
    from rich.console import Console

    class PlainConsole(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    PlainConsole(highlight=False, emoji=False).print(view, crop=False)


def show_json(value: object) -> None:
    """Print plain data as one JSON object on standard output."""
    from nullpose.files import json_text

    say(json_text(value), broken=False)


@contextmanager
def compiling_announced(time_limit: float | None = None) -> Iterator[None]:
    """Let Python run kernels until other processes have compiled them; say so where that is waited for.

    Args:
        time_limit: what the command line states, which counts the time of compiling; None for nothing.
    """
    from nullpose.solver.background_compiler import BackgroundCompiler
    from nullpose.solver.compiling import announce_compiling

    announce = cache(partial(say, _COMPILING, err=True))
    with BackgroundCompiler(announce, counts=time_limit is not None).in_use(), announce_compiling(announce):
        yield


def prepare_outputs(
    scene: SceneOptions,
    *,
    figure: Sequence[Path],
    width: str | None = None,
    export: Sequence[Path] = (),
    **others: Path | None,
) -> None:
    """Make sure, before any work, that a figure and other outputs, by their options, can be written.

    Raises:
        UsageError: a width without a figure; or the figure's name ends in none of .png, .svg and .pdf.
        OutputError: an output is an input or another output too, or it or its folder cannot be written.
    """
    require_usage(
        width is None or len(figure) > 0,
        "--width: given without --figure; add --figure FILE, or leave out --width",
    )
    if figure:
        from nullpose.report.figures.style import prepare_figure_file

        for path in figure:
            prepare_figure_file(path)
    files = [*(("export", path) for path in export), *(("figure", path) for path in figure)]
    scene.check_outputs((f"--{name}", path) for name, path in (*others.items(), *files))
