"""The loop of every branch and bound: threads work off boxes until none is left or a limit is met."""

from __future__ import annotations

from abc import ABC, abstractmethod
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext

from nullpose.objectives import FloatArray
from nullpose.solver.compiling import limit_clock
from nullpose.solver.kernels.compiler.interpreted import ended_when
from nullpose.solver.options import SolveOptions
from nullpose.solver.worker_pool import Kernel, WorkerPool, processors

INTERRUPT = "an interrupt"
"""The reason of a run that was ended by Ctrl-C."""
MOST_LEAVES = 250_000
"""Leaves that a certificate has at most; a proof with more goes on, and has none."""
_MOST_BYTES = 4e9  # of boxes still to do, and of leaves where they are kept
INSIDE = 1.0 - 1e-4
"""The gap that is aimed at, of the gap asked for: value and bound are rounded."""


class BranchAndBound(ABC):
    """A run that excludes boxes at one level after another, whatever a box is and whatever excludes it.

    Args:
        limits: target gap, time, nodes and progress.
        began: when the clock of the limits began, that of ``limit_clock``.
        nodes: boxes examined before, which count towards the limit.
    """

    chunk: int  # boxes of a queue between two looks at the clock
    nodes_of_search: int  # boxes that take as long as a thorough search, which is made after so many
    proved: float  # no pose has its smallest ratio above this

    def __init__(self, limits: SolveOptions, began: float, nodes: int = 0) -> None:
        self.limits, self.nodes = limits, 0
        self.deadline = began + limits.time_limit_s
        self.node_limit = max(1, limits.node_limit - nodes)
        self.keeps_leaves = True
        self.rounding = 1e-9  # a pose better by less, relative, is the incumbent evaluated in another order

    @property
    @abstractmethod
    def value(self) -> float:
        """The smallest ratio of the best pose so far."""

    @abstractmethod
    def exclusion_kernel(self, gap: float) -> Kernel:
        """Return the kernel that excludes all above ``value (1 + gap)``."""

    @abstractmethod
    def improve(self, position_m: FloatArray, orientation: FloatArray) -> bool:
        """Take up a pose that a kernel found, or where a climb from it leads; check that it is better."""

    @abstractmethod
    def search_thoroughly(self) -> None:
        """Search as without a proof, once: what a light search missed must not be lost to a long proof."""

    @abstractmethod
    def has_space(self, workers: WorkerPool) -> bool:
        """Check that the leaves so far, and more of them, may be kept."""

    def work_off(self, workers: WorkerPool, gap: float, most: int, deadline: float) -> str:
        """Exclude all above ``value (1 + gap)``; return why it stopped short, or nothing.

        Args:
            workers: with the boxes.
            gap: relative.
            most: boxes to examine at most.
            deadline: on ``limit_clock``.
        """
        with ended_when(lambda: limit_clock() > deadline):
            return self._work_off(workers, gap, self.nodes + most, deadline)
        return self._time_is_up()

    def _time_is_up(self) -> str:
        return f"the time limit of {self.limits.time_limit_s:g} s"

    def _work_off(self, workers: WorkerPool, gap: float, until: int, deadline: float) -> str:
        threads = self.limits.threads or processors()
        with ThreadPoolExecutor(threads) if threads > 1 else nullcontext() as pool:
            while not workers.done:
                if limit_clock() > deadline:
                    return self._time_is_up()
                if self.nodes >= until:
                    return f"the node limit of {self.limits.node_limit}"
                if workers.stuck:
                    return "shadows of buildings that meet in one point"
                self.nodes += workers.work(self.exclusion_kernel(gap), self.chunk, until - self.nodes, pool)
                improved = [self.improve(*pose) for pose in workers.better()]
                if improved and not any(improved):
                    self.rounding *= 10.0
                if self.nodes >= self.nodes_of_search and not workers.done:
                    self.search_thoroughly()
                self.keeps_leaves = self.keeps_leaves and self.has_space(workers)
                if not self.keeps_leaves:
                    workers.drop_leaves()
                if workers.size_bytes > _MOST_BYTES:
                    return f"the {_MOST_BYTES / 1e9:g} GB that boxes may take"
                if self.limits.on_progress is not None and not workers.done:
                    self.limits.on_progress(self.proved / self.value - 1.0, self.nodes)
        return ""
