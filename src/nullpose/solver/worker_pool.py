"""Queues that share the nodes of one branch and bound stage, worked off in rounds.

How many queues there are does not depend on the threads that work them off, nor does what a queue does in a
round. So a run is the same on every machine, however busy it is.
"""

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
_QUEUES = 8
_BLOCK = 32_768  # leaves that are made room for at once, at most
_FIRST = 256  # leaves that room is made for: so little is had without asking the system for memory
_DEPTH = 256  # rows that a stack is given beyond those it begins with
_SPARE = 16  # rows of a stack that a kernel needs


def processors() -> int:
    """Count the processors that this process may use."""
    # affinity is not known on every system
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Queue:
    """A stack of nodes to do, ``top`` of them, and the leaves made of them, ``filled`` of them.

    Both arrays grow in place: a larger copy would hold them twice.
    """

    def __init__(self, nodes: FloatArray, orientation: tuple[int, ...] = (3,)) -> None:
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
    """The queues of a run, and the nodes among them: one queue while there are few.

    Args:
        start: (n, columns) the nodes to begin with.
        orientation: shape of what a pose has beside its position: an axis, or a rotation.
    """

    def __init__(self, start: FloatArray, orientation: tuple[int, ...] = (3,)) -> None:
        self._orientation = orientation
        self._queues = [Queue(start, orientation)]

    @property
    def done(self) -> bool:
        """Whether no node is left."""
        return not any(queue.top for queue in self._queues)

    @property
    def stuck(self) -> bool:
        """Whether all nodes that are left are too small to tell more."""
        return not self.done and all(queue.stuck or not queue.top for queue in self._queues)

    @property
    def filled(self) -> int:
        """How many leaves there are."""
        return sum(queue.filled for queue in self._queues)

    @property
    def size_bytes(self) -> int:
        """How much memory nodes and leaves take, bytes, those being twice there as they are put together."""
        return sum(queue.stack.nbytes + 2 * queue.leaves.nbytes for queue in self._queues)

    def drop_leaves(self) -> None:
        """Give back the memory of all leaves made so far."""
        for queue in self._queues:
            queue.filled = 0
            _make_room(queue.leaves, _FIRST)

    def work(self, kernel: Kernel, chunk: int, most: int, pool: ThreadPoolExecutor | None) -> int:
        """Work off a round of every queue; return how many nodes it was in all.

        Args:
            kernel: what excludes them.
            chunk: nodes of a queue in a round, at most.
            most: nodes in all, about.
            pool: of the threads that share the queues; none if one thread does it all.
        """
        for place in range(_QUEUES):
            richest = max(self._queues, key=lambda queue: queue.top)
            if richest.top < _FEWEST_TO_SHARE:
                break
            if place == len(self._queues):
                self._queues.append(Queue(richest.give(), self._orientation))
            elif not self._queues[place].top:
                self._queues[place].take(richest.give())
        busy = [queue for queue in self._queues if queue.top]
        budget = max(1, min(chunk, most // len(busy)))
        spread = map if pool is None or len(busy) == 1 else pool.map
        return sum(spread(lambda queue: queue.work(kernel, budget), busy))

    def better(self) -> list[tuple[FloatArray, FloatArray]]:
        """Return the poses, position and orientation, that beat the incumbent."""
        return [(q.position_m.copy(), q.orientation.copy()) for q in self._queues if q.better]

    def last(self) -> list[tuple[FloatArray, FloatArray]]:
        """List the places at which queues with boxes left stopped: a middle and an orientation, or zeros."""
        return [(q.position_m.copy(), q.orientation.copy()) for q in self._queues if q.top]

    def boxes(self) -> FloatArray:
        """Collect the boxes still to do, (n, columns)."""
        return np.concatenate([queue.stack[: queue.top] for queue in self._queues])

    def leaves(self) -> FloatArray:
        """Return all leaves made; the queues give up theirs, since memory for both would be too much."""
        first, *others = self._queues
        used, whole = first.filled, first.leaves
        _make_room(whole, self.filled)
        for queue in others:
            whole[used : used + queue.filled] = queue.leaves[: queue.filled]
            used += queue.filled
            del queue.leaves
        return whole


def _make_room(array: FloatArray, rows: int) -> None:
    """Give an array so many rows, in place."""
    array.resize((rows, array.shape[1]), refcheck=False)
