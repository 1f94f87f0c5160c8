"""How far a study is, on standard error, and in words."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self

import typer

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from nullpose.study.monte_carlo import StudyProgress, StudyStatus

__all__ = ["StudyBar", "words_of"]

_QUIET_S = 1.0  # work shorter than this shows no progress
_LOG_EVERY_S = 10.0


class StudyBar:
    """Progress of a study: a bar on a terminal, a line now and then in a log; notes always."""

    def __init__(self) -> None:
        self._began = self._logged = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None
        self._noted = ""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, progress: StudyProgress) -> None:
        """Take note of how far the study is."""
        if progress.note and progress.note != self._noted:
            self._noted = progress.note
            self._say(f"study: {progress.note}")
        now = time.monotonic()
        if now - self._began < _QUIET_S:
            return
        if self._bar is not None or sys.stderr.isatty():  # a drawn bar stands in for it, and may deny that
            self._draw(progress)
        elif now - self._logged >= _LOG_EVERY_S:
            self._logged = now
            share = 100 * progress.done // progress.scenes
            typer.echo(
                f"study: {progress.done} of {progress.scenes} scenes ({share} %), {_details(progress)}",
                err=True,
            )

    def _say(self, line: str) -> None:
        if self._bar is None:
            typer.echo(line, err=True)
        else:
            self._bar.console.print(line, markup=False, highlight=False)

    def _draw(self, progress: StudyProgress) -> None:
        if self._bar is None or self._task is None:
            from rich.console import Console
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

            columns = (
                TextColumn("study"),
                BarColumn(),
                MofNCompleteColumn(),
                TextColumn("{task.description}"),
            )
            self._bar = Progress(*columns, console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task("", total=progress.scenes)
            self._bar.start()
        self._bar.update(self._task, completed=progress.done, description=_details(progress))


def _details(progress: StudyProgress) -> str:
    """Return rate, time left, workers and failures in words."""
    left = progress.seconds_left
    parts = [
        f"{progress.rate:.3g} scenes/s" if progress.rate else "",
        "" if left is None else f"{_duration(left)} left",
        f"{progress.workers} worker{'' if progress.workers == 1 else 's'}",
        f"{progress.failed} failed" if progress.failed else "none failed",
    ]
    return ", ".join(part for part in parts if part)


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}"


def words_of(status: StudyStatus) -> str:
    """Return how far a study is, in a few lines.

    Args:
        status: as read from its folder.
    """
    share = 100 * status.done // status.scenes
    state = (
        "complete" if status.complete else f"running: {status.running}" if status.running else "not running"
    )
    lines = [
        *([status.name] if status.name else []),
        f"folder     {status.folder}",
        f"scenes     {status.done} of {status.scenes} ({share} %), {state}",
        f"rows       {status.rows}, {status.failed} of them failures",
        f"parts      {status.parts} of up to {status.chunk} scenes, {status.size / 1e6:.1f} MB",
        f"work       {_duration(status.worked_s)} on workers",
    ]
    if not status.complete and not status.running:
        lines.append("nullpose study run with the same spec and folder goes on from there")
    return "\n".join(lines)
