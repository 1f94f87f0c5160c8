"""The branch and bound run: from an incumbent to a bound, anytime."""

from __future__ import annotations

import math
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from nullpose.family import AxisField, Family
from nullpose.family.build import distances_m
from nullpose.objectives import FloatArray
from nullpose.solve.incumbent import Incumbent
from nullpose.solve.multistart import climb
from nullpose.solve.options import SolveOptions
from nullpose.solve.rigour import bound_above
from nullpose.solve.worker_pool import Kernel, WorkerPool, processors

_DIRECT_NODES = 50_000  # of a try with axes split early; most problems of the paper's size need hundreds
_ALONE_NODES = 20_000  # of them on one thread: to start more takes longer than most proofs
_DIRECT_SHARE = 0.125  # of the time left, at most: then come the stages, which have a bound to show
_LATE_NODES = 3_000
_LATE_NODES_EACH = 150  # per ratio: where axes are best split late, that is soon seen
_LATE_SEEN = 400
_LATE_LEFT = 0.75  # of the root box: with more left after so many nodes, hardly any try comes to an end
_KEPT = 4  # boxes of a limit that are left to the stages, which bound what is far at once
_STAGE = 0.1  # each stage's gap, as a share of the one before
_NEARLY = 2.0  # a stage that ends so near to the target goes all the way
_CHUNK = 4096  # nodes between two looks at the clock, for few ratios
_MOST_LEAVES = 250_000
_MOST_REFINED = 200_000  # which are then held twice, beside those made of them
_WIDEST_GAP = 1e6
_INSIDE = 1.0 - 1e-4  # the gap that is aimed at, of the gap asked for: value and bound are rounded

INTERRUPT = "an interrupt"
"""The reason of a run that was ended by Ctrl-C."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Proof:
    """What the branch and bound run showed.

    Args:
        incumbent: the incumbent, perhaps better than the one it began with.
        upper_bound: no pose of the domain has its smallest ratio above this.
        root: (2, 3) lowest and highest corner of a box outside which no pose reaches the incumbent.
        leaves: (l, columns) the excluded nodes, in the kernels' layout; they cover the root box.
        reason: why the target gap was not reached; empty if it was.
        nodes: nodes examined.
        is_even: of an antenna that is no dipole: whether opposite directions have the same gain.
    """

    incumbent: Incumbent
    upper_bound: float
    root: FloatArray
    leaves: FloatArray
    reason: str
    nodes: int
    is_even: bool = False


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
    ) -> None:
        from nullpose.solve.kernels import branch, node
        from nullpose.solve.kernels.linked import entry_of

        self.family, self.axis_field = family, axis_field
        self.kernel, self.node, self.branch = branch, node, entry_of(branch.branch, family.arrays)
        self.incumbent, self.limits, self.on_progress = incumbent, limits, limits.on_progress
        self.deadline = began + limits.time_limit_s
        self.node_limit = max(1, limits.node_limit - nodes)
        self.nodes, self.threads = 0, limits.threads or processors()
        # the same on every machine: where improvements are noticed decides which pose is found
        self.chunk = _CHUNK // (1 + (len(family.numerator_point) + len(family.denominator_point)) // 4)
        self.proved, self.farthest = reach_by_distance(family)
        self.proved = min(self.proved, bound)
        self.doubt, self.axes_above = 0.0, self.kernel.EARLY
        self.target = _INSIDE * limits.ratio_gap(self.value)
        self.favourite = self._favourite()

    @property
    def value(self) -> float:
        return math.exp(self.incumbent.log_value)

    def _favourite(self) -> FloatArray:
        row = np.zeros(self.node.COLUMNS)
        weights = self.incumbent.multipliers.copy()
        self.node.keep_largest(weights, len(weights), row)
        return row

    def root(self) -> FloatArray:
        """Return the box outside which no pose reaches the incumbent, as a first stack."""
        from nullpose.solve.kernels.linked import entry_of
        from nullpose.solve.kernels.search import cut_box

        low, high = np.empty(3), np.empty(3)
        level = self.incumbent.log_value
        if np.any(self.family.numerator_isotropic):  # ratios tend to one far away, however little that is
            level = min(level + math.log1p(self.target), math.log(self.proved))  # the bound that is stated
        # a hair wider than the cut, which is rounded
        level -= 1e-9 if level > 1e-6 or level < 0.0 else 1e-3 * level
        entry_of(cut_box, self.family.arrays)(
            self.family.arrays, self.family.low_m, self.family.high_m, level, low, high
        )
        high = np.maximum(low, high)  # empty where two ratios are out of reach of each other: any place does
        row = self.favourite.copy()
        row[self.node.CENTRE : self.node.HALF] = 0.5 * (low + high)
        row[self.node.HALF : self.node.LEVEL] = 0.5 * (high - low) * (1.0 + 1e-12)
        row[self.node.FACE] = -1.0
        return row[None]

    def directly(self, root: FloatArray) -> tuple[FloatArray, str]:
        """Try the target from the root; return the leaves and why it stopped short, if it did.

        Splitting axes late takes some hundred nodes where splitting them early takes many thousands, and the
        other way round, and nothing cheap was found that tells which beforehand.
        """
        ratios = len(self.family.numerator_point)
        now = time.perf_counter()
        until = now + _DIRECT_SHARE * (self.deadline - now)
        tries = [(self.kernel.EARLY, _ALONE_NODES, _DIRECT_NODES, 1.0)]
        if self.axis_field.is_free and ratios > 2:  # two have no duality gap, or hardly any within a band
            late = min(_LATE_NODES, _LATE_NODES_EACH * ratios)
            tries.insert(0, (self.kernel.LATE, _LATE_SEEN, late, _LATE_LEFT))
        for self.axes_above, alone, nodes, left in tries:
            most = min(nodes, max(1, self.node_limit - self.nodes - _KEPT))
            workers = WorkerPool(root, 1)
            done, reason = self.work_off(workers, self.target, min(alone, most), until)
            hopeless = reason and self._volume(workers.nodes()) > left * self._volume(root)
            if reason and most > alone and not hopeless and time.perf_counter() < until:
                done, reason = self.work_off(workers, self.target, most - alone, until, self.threads)
            if not reason or time.perf_counter() > until or self.nodes >= self.node_limit:
                break
        return done, reason

    def _volume(self, nodes: FloatArray) -> float:
        return float(np.sum(np.prod(nodes[:, self.node.HALF : self.node.LEVEL], axis=1)))

    def stage(self, gap: float, start: FloatArray, most: int) -> tuple[FloatArray, str]:
        """Exclude all above ``value (1 + gap)``; return the leaves and why it stopped short, if it did."""
        return self.work_off(WorkerPool(start, self.threads), gap, most, self.deadline, self.threads)

    def work_off(
        self, workers: WorkerPool, gap: float, most: int, deadline: float, threads: int = 1
    ) -> tuple[FloatArray, str]:
        """Do a stage's work on nodes that are already with the workers."""
        none = np.empty((0, self.node.COLUMNS))
        until = self.nodes + most
        workers.grow(threads)
        with ThreadPoolExecutor(threads) if threads > 1 else nullcontext() as pool:
            while True:
                budget = max(1, min(self.chunk, until - self.nodes))
                self.nodes += workers.work(self._excluding(gap), budget, pool)
                for position_m, axis in workers.better():
                    self._improve(position_m, axis)
                if workers.done:
                    self.proved = min(self.proved, self.value * (1.0 + gap))
                    return workers.leaves(), ""
                if self.on_progress is not None:
                    self.on_progress(self.proved / self.value - 1.0, self.nodes)
                if time.perf_counter() > deadline:
                    return none, f"the time limit of {self.limits.time_limit_s:g} s"
                if self.nodes >= until:
                    return none, f"the node limit of {self.limits.node_limit}"
                if workers.filled > _MOST_LEAVES:
                    return none, f"memory limit reached: {_MOST_LEAVES:,} boxes"

    def _excluding(self, gap: float) -> Kernel:
        """Return the kernel that excludes all above ``value (1 + gap)``."""
        from nullpose.solve.kernels.records import Goal

        goal = Goal(self.value * (1.0 + self.doubt), self.favourite, self.axes_above)
        family, level = self.family, self.value * (1.0 + gap)
        return partial(self.branch, family.arrays, family.domain, self.axis_field.arrays, level, goal)

    def _improve(self, position_m: FloatArray, axis: FloatArray) -> None:
        from nullpose.solve.kernels.links import min_log_ratio

        ratios, groups = len(self.family.numerator_point), len(self.family.denominator_isotropic)
        start = float(min_log_ratio(self.family.arrays, position_m, axis, np.empty(groups), np.empty(ratios)))
        found = climb(self.family, self.axis_field, position_m, axis, mu=0.01, steps=100)
        if found.log_value < start:
            found = replace(found, log_value=start, position_m=position_m, axis=axis)
        if found.log_value > self.incumbent.log_value:
            self.incumbent = replace(
                found,
                starts=self.incumbent.starts + 1,
                evaluations=self.incumbent.evaluations + found.evaluations,
            )
            self.favourite = self._favourite()
        else:  # the two evaluations differ in their rounding: do not ask again
            self.doubt = max(1e-9, 10.0 * self.doubt)

    def result(self, root: FloatArray, leaves: FloatArray, reason: str) -> Proof:
        """Return what the run has come to."""
        middle = root[0, self.node.CENTRE : self.node.CENTRE + 3]
        side = root[0, self.node.HALF : self.node.HALF + 3]
        return Proof(
            incumbent=self.incumbent,
            upper_bound=float(bound_above(self.value, self.proved)),
            root=np.array([middle - side, middle + side]),
            leaves=leaves,
            reason=reason,
            nodes=self.nodes,
        )

    def shown(self, done: FloatArray, leaves: FloatArray) -> FloatArray:
        """Return the leaves that show the bound: a stage's, unless the bound was better before."""
        return done if np.max(done[:, self.node.LEVEL]) <= self.proved else leaves

    def by_distance(self, root: FloatArray) -> FloatArray:
        """Return the leaf that shows the bound from distances alone, by which a run begins."""
        leaf = root.copy()
        leaf[0, self.node.KIND], leaf[0, self.node.ANCHOR] = self.node.FAR, self.farthest
        leaf[0, self.node.LEVEL] = self.proved
        return leaf


def prove(
    family: Family,
    axis_field: AxisField,
    incumbent: Incumbent,
    limits: SolveOptions,
    *,
    began: float | None = None,
    nodes: int = 0,
    bound: float = math.inf,
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
        began: when the clock of the limits began, that of ``time.perf_counter``; now, if left out.
        nodes: nodes examined before, which count towards the limit.
        bound: known before, of a field that holds all axes of this one; the leaves do not show it.
    """
    began = time.perf_counter() if began is None else began
    run = _Run(family, axis_field, incumbent, limits, began, nodes, bound)
    root = run.root()
    leaves = run.by_distance(root)
    target = run.target
    reason = ""
    try:
        if run.proved <= run.value * (1.0 + target):  # distances alone have shown it
            return run.result(root, leaves, "")
        done, reason = run.directly(root)
        if not reason:
            leaves = run.shown(done, leaves)
        elif run.nodes < run.node_limit and time.perf_counter() < run.deadline:
            start, gap = root, min(_WIDEST_GAP, run.proved / run.value - 1.0)
            while gap > target:
                gap = target if _STAGE * gap <= _NEARLY * target else _STAGE * gap
                if len(start) > _MOST_REFINED:
                    reason = f"memory limit reached: {_MOST_REFINED:,} boxes to refine"
                    break
                done, reason = run.stage(gap, start, run.node_limit - run.nodes)
                if reason:
                    break
                leaves, start = run.shown(done, leaves), done
    except KeyboardInterrupt:
        reason = INTERRUPT
    return run.result(root, leaves, reason)


def reach_by_distance(family: Family) -> tuple[float, int]:
    """Return a bound from distances alone, and the ratio that it is from: the most distant node's.

    Args:
        family: ratios and domain; no gain is above 1.
    """
    distance_m = distances_m(family.points_m, family.low_m, family.high_m)[family.numerator_point]
    distance_m = np.maximum(distance_m, family.keep_out_m)
    isotropic = family.denominator_isotropic[family.denominator_of]
    ratios = (family.numerator_isotropic + family.numerator_weight / distance_m**2) / isotropic
    farthest = int(ratios.argmin())
    return float(ratios[farthest]) * (1.0 + 1e-9), farthest
