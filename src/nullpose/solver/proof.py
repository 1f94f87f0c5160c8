"""The branch and bound run: from an incumbent to a bound, anytime."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import partial
from itertools import product

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.compiling import limit_clock
from nullpose.solver.incumbent import Incumbent
from nullpose.solver.multistart import climb
from nullpose.solver.options import SolveOptions
from nullpose.solver.rigour import bound_above
from nullpose.solver.worker_pool import Kernel, WorkerPool, processors

_SMALLEST = 0.99 * 2.0**-50  # of a box or a cell over the root: the verifier takes 50 halvings
_AT_ONCE = 5_000  # nodes that take as long as a thorough search
_DIRECT_NODES = 50_000  # of a try with axes split early; most problems of the paper's size need hundreds
_ALONE_NODES = 20_000  # of them on one thread: to start more takes longer than most proofs
_DIRECT_SHARE = 0.125  # of the time left, at most: then come the stages, which have a bound to show
_LATE_DIRECT_NODES = 200_000  # where splitting them early does not come to an end
_LATE_NODES = 3_000
_LATE_NODES_EACH = 150  # per ratio: where axes are best split late, that is soon seen
_LATE_SEEN = 400
_LATE_LEFT = 0.75  # of the root box: with more left after so many nodes, hardly any try comes to an end
_BARRIERS = (0.01, 0.1, 0.3)  # of climbs from where a try stopped: they may lead to different maxima
_KEPT = 4  # boxes of a limit that are left to the stages, which bound what is far at once
_STAGE = 0.1  # each stage's gap, as a share of the one before
_NEARLY = 2.0  # a stage that ends so near to the target goes all the way
_CHUNK = 4096  # nodes between two looks at the clock, for few ratios
_MOST_BYTES = 2e9  # of a tree; beyond, leaves are not kept, and the next stage begins at the root
_WIDEST_GAP = 1e6
_INSIDE = 1.0 - 1e-4  # the gap that is aimed at, of the gap asked for: value and bound are rounded

MOST_LEAVES = 250_000
"""Leaves that a certificate has at most; a proof with more goes on, and has none."""
INTERRUPT = "an interrupt"
"""The reason of a run that was ended by Ctrl-C."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Proof:
    """What the branch and bound run showed.

    Args:
        incumbent: the incumbent, perhaps better than the one it began with.
        upper_bound: no pose of the domain has its smallest ratio above this.
        root: (2, 3) lowest and highest corner of a box outside which no pose reaches the incumbent.
        leaves: (l, columns) the excluded nodes, in the kernels' layout; they cover the root box. Without
            rows if they are too many for a certificate.
        reason: why the target gap was not reached; empty if it was.
        nodes: nodes examined.
        is_even: of an antenna that is no dipole: whether opposite directions have the same gain.
        axes_above: of a dipole: where axes were split, as in the kernels' goal.
    """

    incumbent: Incumbent
    upper_bound: float
    root: FloatArray
    leaves: FloatArray
    reason: str
    nodes: int
    is_even: bool = False
    axes_above: float = 0.0


class _Run:
    """The state of one run: arrays that the kernels write, and the clock."""

    def __init__(
        self,
        family: Family,
        axis_field: AxisField,
        incumbent: Incumbent,
        limits: SolveOptions,
        began: float,
        nodes: int,
        bound: float,
        search: Callable[[], Incumbent] | None,
    ) -> None:
        from nullpose.solver.kernels import branch, node, root
        from nullpose.solver.kernels.jit import entry_of

        ratios = family.arrays
        self.family, self.axis_field = family, axis_field
        self.kernel, self.node, self.branch = branch, node, entry_of(branch.branch, ratios)
        self.incumbent, self.limits, self.on_progress = incumbent, limits, limits.on_progress
        self.search = search
        self.deadline = began + limits.time_limit_s
        self.node_limit = max(1, limits.node_limit - nodes)
        self.nodes = 0
        # the same on every machine: where improvements are noticed decides which pose is found
        self.chunk = _CHUNK // (1 + (len(ratios.numerator_point) + len(ratios.denominator_point)) // 4)
        self.doubt, self.axes_above = 0.0, self.kernel.EARLY
        self.target = _INSIDE * limits.ratio_gap(self.value)
        self.favourite = np.zeros(node.COLUMNS)
        self.proved, self.farthest = entry_of(root.fill_root, ratios)(
            ratios,
            family.domain,
            incumbent.log_value,
            self.target,
            bound,
            incumbent.multipliers.copy(),
            self.favourite,
        )
        self.root = self.favourite[None]
        self.leaves = self.root.copy()  # one, which shows the bound from distances alone
        self.leaves[0, [node.LEVEL, node.KIND, node.ANCHOR]] = self.proved, node.FAR, self.farthest

    @property
    def value(self) -> float:
        return math.exp(self.incumbent.log_value)

    @property
    def threads(self) -> int:
        return self.limits.threads or processors()

    def directly(self) -> tuple[FloatArray, str]:
        """Try the target from the root; return the leaves and why it stopped short, if it did.

        Splitting axes late takes some hundred nodes where splitting them early takes many thousands, and the
        other way round, and nothing cheap was found that tells which beforehand.
        """
        ratios = len(self.family.arrays.numerator_point)
        now = limit_clock()
        until = now + _DIRECT_SHARE * (self.deadline - now)
        tries = [(self.kernel.EARLY, _ALONE_NODES, _DIRECT_NODES, 1.0)]
        if self.axis_field.is_free and ratios > 2:  # two have no duality gap, or hardly any within a band
            late = min(_LATE_NODES, _LATE_NODES_EACH * ratios)
            tries.insert(0, (self.kernel.LATE, _LATE_SEEN, late, _LATE_LEFT))
            tries.append((self.kernel.LATE, _ALONE_NODES, _LATE_DIRECT_NODES, 1.0))
        least = math.inf
        best = self.kernel.EARLY
        for self.axes_above, alone, nodes, left in tries:
            most = min(nodes, max(1, self.node_limit - self.nodes - _KEPT))
            workers = WorkerPool(self.root, 1)
            done, reason = self.work_off(workers, self.target, min(alone, most), until)
            hopeless = reason and self._volume(workers.nodes()) > left * self._volume(self.root)
            if reason and most > alone and not hopeless and limit_clock() < until:
                done, reason = self.work_off(workers, self.target, most - alone, until, self.threads)
            if not reason or limit_clock() > until or self.nodes >= self.node_limit:
                break
            if self.axis_field.is_free and self._improved_from(workers):
                return self.directly()
            if nodes >= _DIRECT_NODES and self._volume(workers.nodes()) < least:
                least, best = self._volume(workers.nodes()), self.axes_above
        self.axes_above = best  # for the stages that may follow
        return done, reason

    def _improved_from(self, workers: WorkerPool) -> bool:
        """Return whether a clearly better pose lies where a try stopped: boxes may not end because of it."""
        before = self.value
        for (position_m, axis), mu in product(workers.last(), _BARRIERS):
            if np.any(axis):
                self._improve(position_m, axis / np.linalg.norm(axis), mu)
        return self.value > before * (1.0 + self.target)

    def _volume(self, nodes: FloatArray) -> float:
        return float(np.sum(np.prod(nodes[:, self.node.HALF : self.node.LEVEL], axis=1)))

    def work_off(
        self, workers: WorkerPool, gap: float, most: int, deadline: float, threads: int = 1
    ) -> tuple[FloatArray, str]:
        """Exclude all above ``value (1 + gap)``; return the leaves and why it stopped short, if it did.

        The nodes are with the workers already. There are no leaves if they take too much memory.
        """
        none, keep = np.empty((0, self.node.COLUMNS)), True
        until = self.nodes + most
        workers.grow(threads)
        with ThreadPoolExecutor(threads) if threads > 1 else nullcontext() as pool:
            while True:
                budget = max(1, min(self.chunk, until - self.nodes))
                self.nodes += workers.work(self._excluding(gap), budget, pool)
                for position_m, axis in workers.better():
                    self._improve(position_m, axis)
                if self.nodes >= _AT_ONCE and not workers.done:
                    self.search_thoroughly()
                keep = keep and workers.size_bytes + self.leaves.nbytes <= _MOST_BYTES
                if not keep:
                    workers.drop_leaves()
                if workers.done:
                    self.proved, done = min(self.proved, self.value * (1.0 + gap)), workers.leaves()
                    # or the bound was better before
                    if np.all(done[:, self.node.LEVEL] <= self.proved):
                        self.leaves = done
                    return done, ""
                if self.on_progress is not None:
                    self.on_progress(self.proved / self.value - 1.0, self.nodes)
                if limit_clock() > deadline:
                    return none, f"the time limit of {self.limits.time_limit_s:g} s"
                if self.nodes >= until:
                    return none, f"the node limit of {self.limits.node_limit}"

    def _excluding(self, gap: float) -> Kernel:
        """Return the kernel that excludes all above ``value (1 + gap)``."""
        from nullpose.solver.kernels.records import Goal

        goal = Goal(self.value * (1.0 + self.doubt), self.favourite, self.axes_above)
        family, level = self.family, self.value * (1.0 + gap)
        return partial(self.branch, family.arrays, family.domain, self.axis_field.arrays, level, goal)

    def _improve(self, position_m: FloatArray, axis: FloatArray, mu: float = 0.01) -> None:
        from nullpose.solver.kernels.links import min_log_ratio

        family = self.family.arrays
        room = np.empty(len(family.denominator_isotropic)), np.empty(len(family.numerator_point))
        start = float(min_log_ratio(family, position_m, axis, *room))
        found = climb(self.family, self.axis_field, position_m, axis, mu=mu, steps=100)
        if found.log_value < start:
            found = replace(found, log_value=start, position_m=position_m, axis=axis)
        if not self._take(found):  # the two evaluations differ in their rounding: do not ask again
            self.doubt = max(1e-9, 10.0 * self.doubt)

    def _take(self, found: Incumbent) -> bool:
        """Make a pose the incumbent if it is better; return whether it is."""
        if not found.log_value > self.incumbent.log_value:
            return False
        self.incumbent = found
        self.favourite, weights = np.zeros(self.node.COLUMNS), found.multipliers.copy()
        self.node.keep_largest(weights, len(weights), self.favourite)
        return True

    def search_thoroughly(self) -> None:
        """Search as without a proof, once: what a light search missed must not be lost to a long proof."""
        search, self.search = self.search, None
        if search is not None:
            self._take(search())

    def _has_certificate(self, side_m: FloatArray) -> bool:
        """Return whether a certificate can hold the leaves: so many, and halved so often."""
        halves_m = self.leaves[:, self.node.HALF : self.node.LEVEL]
        cells = self.leaves[self.leaves[:, self.node.FACE] >= 0.0, self.node.CELL : self.node.SIDE]
        return (
            len(self.leaves) <= MOST_LEAVES
            and bool(np.all(halves_m >= _SMALLEST * side_m))
            and bool(np.all(cells[:, 1::2] - cells[:, ::2] >= 2.0 * _SMALLEST))
        )

    def result(self, reason: str) -> Proof:
        """Return what the run has come to."""
        middle, side = self.root[0, : self.node.LEVEL].reshape(2, 3)
        return Proof(
            incumbent=self.incumbent,
            upper_bound=float(bound_above(self.value, self.proved)),
            root=np.array([middle - side, middle + side]),
            leaves=self.leaves if self._has_certificate(side) else self.leaves[:0].copy(),
            reason=reason,
            nodes=self.nodes,
            axes_above=self.axes_above,
        )


def prove(
    family: Family,
    axis_field: AxisField,
    incumbent: Incumbent,
    limits: SolveOptions,
    *,
    began: float | None = None,
    nodes: int = 0,
    bound: float = math.inf,
    search: Callable[[], Incumbent] | None = None,
) -> Proof:
    """Return a bound on the best pose, and a better pose if one turns up on the way.

    First the target gap is tried directly. If that takes too many nodes, the gap is closed in stages, each
    refining the leaves of the one before, so that a limit leaves the bound of the last stage finished.

    Args:
        family: the ratios and their domain.
        axis_field: which axes are allowed.
        incumbent: the incumbent.
        limits: target gap, time, nodes and progress; a KeyboardInterrupt during the run ends it with the
            bound reached.
        began: when the clock of the limits began, that of ``limit_clock``; now, if left out.
        nodes: nodes examined before, which count towards the limit.
        bound: known before, of a field that holds all axes of this one; the leaves do not show it.
        search: a thorough search, made once if the proof does not close at once.
    """
    began = limit_clock() if began is None else began
    run = _Run(family, axis_field, incumbent, limits, began, nodes, bound, search)
    target, reason = run.target, ""
    try:
        if run.proved <= run.value * (1.0 + target):  # distances alone have shown it
            return run.result("")
        done, reason = run.directly()
        if reason and run.nodes < run.node_limit and limit_clock() < run.deadline:
            start, gap = run.root, min(_WIDEST_GAP, run.proved / run.value - 1.0)
            while gap > target:
                gap = target if _STAGE * gap <= _NEARLY * target else _STAGE * gap
                most, threads = run.node_limit - run.nodes, run.threads
                done, reason = run.work_off(WorkerPool(start, threads), gap, most, run.deadline, threads)
                if reason:
                    break
                start = done if len(done) else run.root
        if reason:
            run.search_thoroughly()
    except KeyboardInterrupt:
        reason = INTERRUPT
    return run.result(reason)
