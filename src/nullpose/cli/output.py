"""Where a verb's words go: results to standard output, everything else to standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Self

import typer

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.progress import Progress, TaskID

__all__ = ["Ticker", "compiling_announced", "show", "show_json"]

_QUIET_S = 1.0  # work shorter than this shows no progress
_LOG_EVERY_S = 10.0


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


class Ticker:
    """Progress on standard error: a bar on a terminal, a line now and then in a log, nothing for short work.

    Args:
        what: what is going on, in a word or two.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._began = time.monotonic()
        self._logged = self._began
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, done: int, total: int) -> None:
        """Take note of how many of how many steps are done."""
        now = time.monotonic()
        if now - self._began < _QUIET_S:
            return
        if self._bar is not None or sys.stderr.isatty():  # a drawn bar stands in for it, and may deny that
            self._draw(done, total)
        elif now - self._logged >= _LOG_EVERY_S:
            self._logged = now
            typer.echo(f"{self._what}: {done} of {total} ({100 * done // total} %)", err=True)

    def _draw(self, done: int, total: int) -> None:
        if self._bar is None or self._task is None:
            from rich.console import Console
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

            columns = (
                TextColumn("{task.description}"),
                BarColumn(),
                MofNCompleteColumn(),
                TimeRemainingColumn(),
            )
            self._bar = Progress(*columns, console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task(self._what, total=total)
            self._bar.start()
        self._bar.update(self._task, completed=done)
