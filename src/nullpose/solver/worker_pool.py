"""Workers that share the nodes of one branch and bound stage: one thread each, since kernels need no lock."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeAlias

import numpy as np

from nullpose.objectives import FloatArray

Kernel: TypeAlias = Callable[..., tuple[int, int, int, int, object]]
"""The branch and bound kernel with its arguments before the stack."""

_FEWEST_TO_SHARE = 8
_MOST_WORKERS = 8
_BLOCK = 32_768  # leaves that are made room for at once, at most
_FIRST = 256  # leaves that room is made for: so little is had without asking the system for memory
_DEPTH = 256  # rows that a stack is given beyond those it begins with
_SPARE = 16  # rows of a stack that a kernel needs


def processors() -> int:
    """Count the processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1


class _Worker:
    """A stack of nodes to do, ``top`` of them, and the leaves made of them, ``filled`` of them.

    Both arrays grow in place: a larger copy would hold them twice.
    """

    def __init__(self, nodes: FloatArray, orientation: tuple[int, ...]) -> None:
        rows, columns = nodes.shape
        self.stack, self.leaves = np.empty((rows + _DEPTH, columns)), np.empty((_FIRST, columns))
        self.top = self.filled = 0
        self.position_m, self.orientation = np.empty(3), np.empty(orientation)
        self.better = self.stuck = False
        self.take(nodes)

    def take(self, nodes: FloatArray) -> None:
        """Put nodes on the stack."""
        _make_room(self.stack, self.top + len(nodes) + _DEPTH)
        self.stack[self.top : self.top + len(nodes)] = nodes
        self.top += len(nodes)

    def give(self) -> FloatArray:
        """Hand over every second box of the stack."""
        kept, shared = self.stack[: self.top : 2].copy(), self.stack[1 : self.top : 2].copy()
        self.top = len(kept)
        self.stack[: self.top] = kept
        return shared

    def work(self, kernel: Kernel, budget: int) -> int:
        """Work off a budget of nodes, or less if one beats the incumbent; return how many it was."""
        from nullpose.solver.kernels.bounds.branch import BETTER, STUCK

        self.better, self.stuck, total = False, False, 0
        while self.top and total < budget and not (self.better or self.stuck):
            if self.top + _SPARE > len(self.stack):
                _make_room(self.stack, self.top + self.top // 2 + _SPARE)
            if self.filled == len(self.leaves):
                _make_room(self.leaves, self.filled + min(self.filled, _BLOCK))
            stacks = self.stack, self.top, self.leaves, self.filled
            code, self.top, self.filled, done, _ = kernel(
                *stacks, budget - total, self.position_m, self.orientation
            )
            total += done
            self.better, self.stuck = code == BETTER, code == STUCK
        return total


class WorkerPool:
    """One worker or several, and the nodes among them.

    Args:
        start: (n, columns) the nodes to begin with.
        workers: how many threads.
        orientation: shape of what a pose has beside its position: an axis, or a rotation.
    """

    def __init__(self, start: FloatArray, workers: int, orientation: tuple[int, ...] = (3,)) -> None:
        count = max(1, min(workers, _MOST_WORKERS))
        self._orientation = orientation
        self._workers = [_Worker(start[i::count], orientation) for i in range(count)]

    def grow(self, workers: int) -> None:
        """Bring the pool to so many workers, new ones without nodes."""
        none = self._workers[0].stack[:0]
        more = range(len(self._workers), min(workers, _MOST_WORKERS))
        self._workers += [_Worker(none, self._orientation) for _ in more]

    @property
    def done(self) -> bool:
        """Whether no node is left."""
        return not any(worker.top for worker in self._workers)

    @property
    def stuck(self) -> bool:
        """Whether all nodes that are left are too small to tell more."""
        return not self.done and all(worker.stuck or not worker.top for worker in self._workers)

    @property
    def filled(self) -> int:
        """How many leaves there are."""
        return sum(worker.filled for worker in self._workers)

    @property
    def size_bytes(self) -> int:
        """How much memory nodes and leaves take, bytes, those being twice there as they are put together."""
        return sum(worker.stack.nbytes + 2 * worker.leaves.nbytes for worker in self._workers)

    def drop_leaves(self) -> None:
        """Give back the memory of all leaves made so far."""
        for worker in self._workers:
            worker.filled = 0
            _make_room(worker.leaves, _FIRST)

    def work(self, kernel: Kernel, budget: int, pool: ThreadPoolExecutor | None) -> int:
        """Let every worker with nodes work off a budget; return how many nodes it was in all."""
        for idle in self._workers:
            richest = max(self._workers, key=lambda worker: worker.top)
            if not idle.top and richest.top >= _FEWEST_TO_SHARE:
                idle.take(richest.give())
        busy = [worker for worker in self._workers if worker.top]
        if pool is None or len(busy) == 1:
            return sum(worker.work(kernel, budget) for worker in busy)
        return sum(pool.map(lambda worker: worker.work(kernel, budget), busy))

    def better(self) -> list[tuple[FloatArray, FloatArray]]:
        """Return the poses, position and orientation, that beat the incumbent."""
        return [(w.position_m.copy(), w.orientation.copy()) for w in self._workers if w.better]

    def last(self) -> list[tuple[FloatArray, FloatArray]]:
        """List the places at which workers with boxes left stopped: a middle and an orientation, or zeros."""
        return [(w.position_m.copy(), w.orientation.copy()) for w in self._workers if w.top]

    def boxes(self) -> FloatArray:
        """Collect the boxes still to do, (n, columns)."""
        return np.concatenate([worker.stack[: worker.top] for worker in self._workers])

    def leaves(self) -> FloatArray:
        """Return all leaves made; the workers give up theirs, since memory for both would be too much."""
        first, *others = self._workers
        used, whole = first.filled, first.leaves
        _make_room(whole, self.filled)
        for worker in others:
            whole[used : used + worker.filled] = worker.leaves[: worker.filled]
            used += worker.filled
            del worker.leaves
        return whole


def _make_room(array: FloatArray, rows: int) -> None:
    """Give an array so many rows, in place."""
    array.resize((rows, array.shape[1]), refcheck=False)
