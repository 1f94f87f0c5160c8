"""The gap of a proof as it closes, on standard error."""

from __future__ import annotations

import math
import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self

import typer

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

__all__ = ["GapBar"]

_QUIET_S = 1.0  # work shorter than this shows no progress
_LOG_EVERY_S = 10.0


class GapBar:
    """Progress of a proof: a bar on a terminal, a line now and then in a log, nothing for short work.

    The bar is logarithmic: each tenth of the gap is as hard to close as the one before.

    Args:
        target: the relative gap that is aimed at.
    """

    def __init__(self, target: float) -> None:
        self._target = target
        self._widest = 0.0
        self._began = self._logged = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, gap: float, boxes: int) -> None:
        """Take note of the gap proved so far and of the boxes examined."""
        self._widest = max(self._widest, gap)
        now = time.monotonic()
        if now - self._began < _QUIET_S:
            return
        words = f"gap {gap:.1e} of {self._target:.1e}, {boxes} boxes"
        if self._bar is not None or sys.stderr.isatty():  # a drawn bar stands in for it, and may deny that
            self._draw(gap, words)
        elif now - self._logged >= _LOG_EVERY_S:
            self._logged = now
            typer.echo(f"proving: {words}", err=True)

    def closed(self, gap: float) -> float:
        """Return the share of the way from the widest gap seen to the target, in orders of magnitude."""
        if not gap > self._target:
            return 1.0
        if not self._widest > gap:
            return 0.0
        return math.log(self._widest / gap) / math.log(self._widest / self._target)

    def _draw(self, gap: float, words: str) -> None:
        if self._bar is None or self._task is None:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

            columns = (
                TextColumn("proving"),
                BarColumn(),
                TextColumn("{task.description}"),
                TimeElapsedColumn(),
            )
            self._bar = Progress(*columns, console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task(words, total=1.0)
            self._bar.start()
        self._bar.update(self._task, completed=self.closed(gap), description=words)
