"""One progress bar for all that takes more than a second, on standard error."""

from __future__ import annotations

import math
import sys
import time
from datetime import timedelta
from typing import TYPE_CHECKING, Self

from nullpose.cli.printing import say

if TYPE_CHECKING:
    from rich.progress import Progress

    from nullpose.study.monte_carlo import StudyProgress

_QUIET_S = 1.0  # work shorter than this shows no progress
_LOG_EVERY_S = 10.0


class ProgressBar:
    """Progress on standard error: a bar on a terminal, a line now and then in a log, nothing for short work.

    Args:
        what: what is going on, in a word or two.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._began = self._logged = time.monotonic()
        self._bar: Progress | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()

    def show(self, share: float, words: str) -> None:
        """Show which share of the work is done, and what there is to say of it."""
        if (now := time.monotonic()) - self._began < _QUIET_S:
            return
        if self._bar is not None or sys.stderr.isatty():  # a drawn bar stands in for it, and may deny that
            self._bar = self._bar or self._new_bar()
            self._bar.update(self._bar.task_ids[0], completed=share, description=words)
        elif now - self._logged >= _LOG_EVERY_S:
            self._logged = now
            self.say(words)

    def say(self, words: str) -> None:
        """Print a line at once, above the bar if there is one."""
        line = f"{self._what}: {words}"
        if self._bar is None:
            say(line, err=True)
        else:
            self._bar.console.print(line, markup=False, highlight=False)

    def _new_bar(self) -> Progress:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        what, words = TextColumn(self._what, markup=False), TextColumn("{task.description}", markup=False)
        bar = Progress(
            what, BarColumn(), words, TimeElapsedColumn(), console=Console(stderr=True), transient=True
        )
        bar.add_task("", total=1.0)
        bar.start()
        return bar


class Ticker(ProgressBar):
    """Progress of work that is done in steps."""

    def __call__(self, done: int, total: int) -> None:
        """Take note of how many of how many steps are done."""
        self.show(done / total, f"{done} of {total} ({100 * done // total} %)")


class GapBar(ProgressBar):
    """Progress of a proof, as the gap closes.

    The bar is logarithmic: each tenth of the gap is as hard to close as the one before.

    Args:
        target: the relative gap that is aimed at.
    """

    def __init__(self, target: float) -> None:
        super().__init__("proving")
        self._target = target
        self._widest = 0.0

    def __call__(self, gap: float, boxes: int) -> None:
        """Take note of the gap proved so far and of the boxes examined."""
        self._widest = max(self._widest, gap)
        self.show(self.closed(gap), f"gap {gap:.1e} of {self._target:.1e}, {boxes} boxes")

    def closed(self, gap: float) -> float:
        """Compute the share of the way from the widest gap seen to the target, in orders of magnitude."""
        if self._widest > gap > self._target:
            return math.log(self._widest / gap) / math.log(self._widest / self._target)
        return 0.0 if gap > self._target else 1.0


class StudyBar(ProgressBar):
    """Progress of a study, with its notes."""

    def __init__(self) -> None:
        super().__init__("study")
        self._last_note = ""

    def __call__(self, progress: StudyProgress) -> None:
        """Take note of how far the study is: scenes, rate, time left, workers and failures."""
        if progress.note and progress.note != self._last_note:
            self._last_note = progress.note
            self.say(progress.note)
        share, left = progress.done / progress.scenes, progress.seconds_left
        parts = [
            f"{progress.done} of {progress.scenes} scenes ({100 * progress.done // progress.scenes} %)",
            f"{progress.rate:.3g} scenes/s" if progress.rate else "",
            "" if left is None else f"{timedelta(seconds=round(left))} left",
            f"{progress.workers} worker{'' if progress.workers == 1 else 's'}",
            f"{progress.failed or 'none'} failed",
        ]
        self.show(share, ", ".join(filter(None, parts)))
