"""Workers that share the nodes of one branch and bound stage: one thread each, since kernels need no lock."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Task", "WorkerPool", "processors"]

FloatArray = NDArray[np.float64]

_FEWEST_TO_SHARE = 8
_MOST_WORKERS = 8
_BLOCK = 32_768
_DEPTH = 1024  # rows that a stack is given beyond those it begins with: growing it later holds it twice


def processors() -> int:
    """Return how many processors this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """What every worker does: the arguments of the kernel that come before its own stack.

    Args:
        branch: the kernel.
        better: its code of a pose that beats the incumbent.
        arguments: family, domain, axis field, level, goal.
        budget: nodes to work off before it reports.
    """

    branch: Any
    better: int
    arguments: tuple[Any, ...]
    budget: int


class _Worker:
    """A stack of nodes to do and the leaves made of them."""

    def __init__(self, columns: int) -> None:
        self.stack = np.empty((256, columns))
        self.blocks: list[FloatArray] = []  # full ones: growing one array would hold it twice
        self.leaves = np.empty((1024, columns))
        self.top = self.filled = 0
        self.position_m, self.axis = np.empty(3), np.empty(3)
        self.better = False

    def take(self, rows: FloatArray) -> None:
        """Put nodes on the stack."""
        self.stack = _grown(self.stack, self.top, len(rows) + _DEPTH)
        self.stack[self.top : self.top + len(rows)] = rows
        self.top += len(rows)

    def give(self) -> FloatArray:
        """Return every second node of the stack, which has one less half of its nodes then."""
        kept, given = self.stack[: self.top : 2].copy(), self.stack[1 : self.top : 2].copy()
        self.top = len(kept)
        self.stack[: self.top] = kept
        return given

    @property
    def made(self) -> int:
        """How many leaves it has made."""
        return sum(len(block) for block in self.blocks) + self.filled

    def hand_over(self, out: FloatArray) -> None:
        """Move the leaves into an array of their number, and let go of each block once it is copied."""
        used = 0
        self.stack = out[:0]
        last, self.leaves = self.leaves[: self.filled], out[:0]
        for block in chain(_popped(self.blocks), (last,)):
            out[used : used + len(block)] = block
            used += len(block)

    def work(self, task: Task) -> int:
        """Work off a budget of nodes; return how many it was."""
        self.better = False
        total = 0
        while self.top and total < task.budget and not self.better:
            self.stack = _grown(self.stack, self.top, 16)
            if self.filled == len(self.leaves):
                self.blocks.append(self.leaves)
                self.leaves = np.empty((min(_BLOCK, 2 * self.filled), self.leaves.shape[1]))
                self.filled = 0
            code, self.top, self.filled, done, _ = task.branch(
                *task.arguments,
                self.stack,
                self.top,
                self.leaves,
                self.filled,
                task.budget - total,
                self.position_m,
                self.axis,
            )
            total += done
            self.better = code == task.better
        return total


class WorkerPool:
    """One worker or several, and the nodes among them.

    Args:
        start: (n, columns) the nodes to begin with.
        workers: how many threads.
    """

    def __init__(self, start: FloatArray, workers: int) -> None:
        self._workers = [_Worker(start.shape[1]) for _ in range(max(1, min(workers, _MOST_WORKERS)))]
        self._columns = start.shape[1]
        for i, worker in enumerate(self._workers):
            worker.take(start[i :: len(self._workers)])

    @property
    def done(self) -> bool:
        """Whether no node is left."""
        return not any(worker.top for worker in self._workers)

    @property
    def filled(self) -> int:
        """How many leaves there are."""
        return sum(worker.made for worker in self._workers)

    def work(self, task: Task, pool: ThreadPoolExecutor | None) -> int:
        """Let every worker with nodes work off a budget; return how many nodes it was in all."""
        self._share()
        busy = [worker for worker in self._workers if worker.top]
        if pool is None or len(busy) == 1:
            return sum(worker.work(task) for worker in busy)
        return sum(pool.map(lambda worker: worker.work(task), busy))

    def better(self) -> list[tuple[FloatArray, FloatArray]]:
        """Return the poses, position and axis, that beat the incumbent."""
        return [(w.position_m.copy(), w.axis.copy()) for w in self._workers if w.better]

    def leaves(self) -> FloatArray:
        """Return all leaves made; the workers give up theirs, since memory for both would be too much."""
        together = np.empty((self.filled, self._columns))
        used = 0
        for worker in self._workers:
            made = worker.made
            worker.hand_over(together[used : used + made])
            used += made
        return together

    def _share(self) -> None:
        for idle in self._workers:
            richest = max(self._workers, key=lambda worker: worker.top)
            if not idle.top and richest.top >= _FEWEST_TO_SHARE:
                idle.take(richest.give())


def _popped(blocks: list[FloatArray]) -> Iterator[FloatArray]:
    """Yield the blocks in order, each removed from the list."""
    while blocks:
        yield blocks.pop(0)


def _grown(array: FloatArray, used: int, spare: int) -> FloatArray:
    """Return the array, longer by half or more if its used part leaves fewer than ``spare`` rows."""
    if used + spare <= len(array):
        return array
    larger = np.empty((max(used + spare, len(array) + len(array) // 2), array.shape[1]))
    larger[:used] = array[:used]
    return larger
