"""How far the work of a study is, for the callback of whoever waits for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias, TypeVar

OnProgress: TypeAlias = Callable[[int, int], None] | None
"""Called with how many steps are done and how many there are; None where nobody waits."""
Step = TypeVar("Step")


def report_steps(steps: Sequence[Step], on_progress: OnProgress) -> Iterator[Step]:
    """Yield steps of work, and report each once the next one is asked for."""
    for done, step in enumerate(steps, start=1):
        yield step
        if on_progress is not None:
            on_progress(done, len(steps))
