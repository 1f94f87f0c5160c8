"""The branch and bound of a dipole, from an incumbent to a bound that holds whenever the run is stopped.

Antennas with patterns and arrays have runs of their own, in ``pattern.py`` and ``array_bound.py``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import product

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.branch_and_bound import INSIDE, INTERRUPT, MOST_LEAVES, BranchAndBound
from nullpose.solver.compiling import limit_clock
from nullpose.solver.kernels.compiler.interpreted import ended_when
from nullpose.solver.multistart import Incumbent, climb
from nullpose.solver.options import SolveOptions
from nullpose.solver.rigour import bound_above
from nullpose.solver.worker_pool import Kernel, WorkerPool

MOST_HALVINGS = 50
"""Of a leaf that a certificate can hold, as the verifier has it."""
_THINNEST = 0.99 * 2.0**-MOST_HALVINGS  # side of a box or a cell, over the root's
_ALTERNATE = 3_000  # boxes after which the other way to split is tried
_LATE, _EARLY = 0.0, 1e9  # when axes are split: where no multipliers exclude a box's centre, or always
_TRIES = (
    (_LATE, 400),
    (_LATE, _ALTERNATE),
    (_EARLY, _ALTERNATE),
    (_LATE, 20_000),
    (_EARLY, 30_000),
    (_LATE, 200_000),
    (_EARLY, 200_000),
)
"""Tries of the target from the root: when axes are split, and boxes in all.

Late takes some hundred boxes where early takes many thousands, and in some scenes the other way round.
Nothing cheap was found that tells which.
"""
_DIRECT_SHARE = 0.5  # of the time left, at most: then come the stages, which have a bound to show
_BARRIERS = (0.01, 0.1, 0.3)  # weights of the barrier in climbs, which can lead to different maxima
_FOR_STAGES = 4  # boxes of a limit that are left to the stages, which bound what is far at once
_STAGE = 0.1  # each stage's gap, as a share of the one before
_LAST_STAGE = 2.0  # a stage that would end within so many times the target gap goes to the target
_CHUNK = 4096  # boxes between two looks at the clock, for few ratios
_CHUNKS_A_S = 4_000  # and at most so many times the seconds of the time limit
_MOST_BYTES = 2e9  # of a tree; beyond, leaves are not kept, and the next stage begins at the root
_WIDEST_GAP = 1e6
_GROWTH = 2  # boxes of a try from leaves at most, over those


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Proof:
    """What the branch and bound run showed.

    Args:
        incumbent: the best pose, perhaps better than the one that the run began with.
        upper_bound: no pose of the domain has its smallest ratio above this.
        root: (2, 3) lowest and highest corner of a box outside which no pose reaches the incumbent.
        leaves: (l, columns) the excluded boxes, in the kernels' layout; they cover the root box. Without
            rows if they are too many for a certificate.
        reason: why the target gap was not reached; empty if it was.
        nodes: boxes examined.
    """

    incumbent: Incumbent
    upper_bound: float
    root: FloatArray
    leaves: FloatArray
    reason: str
    nodes: int

    @property
    def gap(self) -> float:
        """What the bound is above the value, relative."""
        return self.upper_bound / math.exp(self.incumbent.log_value) - 1.0


class _Run(BranchAndBound):
    """One run: arrays that the kernels write, and the clock."""

    nodes_of_search = 5_000

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
        from nullpose.solver.kernels.bounds import branch, node, root, signed_sum
        from nullpose.solver.kernels.compiler.jit import entry_of

        super().__init__(limits, began, nodes)
        ratios = family.ratios
        self.family, self.axis_field = family, axis_field
        self.node, self.branch, self.touch = node, entry_of(branch.branch), signed_sum.touch
        self.incumbent, self.search = incumbent, search
        # the same on every machine: where improvements are noticed decides which pose is found
        chunk = _CHUNK // (1 + (len(ratios.numerator_point) + len(ratios.denominator_point)) // 4)
        self.chunk = int(min(chunk, 1.0 + _CHUNKS_A_S * limits.time_limit_s))
        self.target = INSIDE * limits.ratio_gap(self.value)
        self.spare = _LATE
        # two forms have no duality gap (Brickman), unless a band is in force
        self.has_gaps = axis_field.is_free and (
            len(ratios.numerator_point) > 2 or axis_field.band != (0.0, 1.0)
        )
        self.is_mean = len(ratios.shares) > 0  # the gaps of a mean are small, and few boxes have one
        self.incumbent_row = np.zeros(node.COLUMNS)  # its multipliers are the incumbent's
        self.proved, farthest = entry_of(root.fill_root)(
            ratios,
            family.domain,
            incumbent.log_value,
            self.target,
            bound,
            incumbent.multipliers.copy(),
            incumbent.axis,
            self.incumbent_row,
        )
        self.root = self.incumbent_row[None]
        self.leaves = self.root.copy()  # one, which shows the bound from distances alone
        self.leaves[0, [node.LEVEL, node.KIND, node.ANCHOR]] = self.proved, node.FAR, farthest

    @property
    def value(self) -> float:
        return math.exp(self.incumbent.log_value)

    def try_from(self, start: FloatArray) -> tuple[str, bool]:
        """Try the target from other boxes than the root; return why it stopped short, and if time is left."""
        self.nodes_of_search += len(start)
        until = self._half_time
        _, reason = self.exclude_all(WorkerPool(start), self.target, _GROWTH * len(start), until)
        return reason, limit_clock() < until

    def cover_from(self, last: Proof) -> FloatArray:
        """Cover the root by what another proof's leaves have of it, and boxes around that proof's root.

        Where it is of almost the same problem, the multipliers that they have exclude most of them at once.
        """
        ends, columns = self.ends, self.node.LEVEL
        middle_m, side_m = np.moveaxis(last.leaves[:, :columns].reshape(-1, 2, 3), 1, 0)
        shell = _shell(np.clip(last.root, *ends), ends)
        parts = np.concatenate([np.stack([middle_m - side_m, middle_m + side_m], axis=1), shell])
        low_m, high_m = np.maximum(parts[:, 0], ends[0]), np.minimum(parts[:, 1], ends[1])
        rows = np.vstack([last.leaves, np.repeat(self.root, len(shell), axis=0)])
        lap_m = 16.0 * np.spacing(np.max(np.abs(ends)))  # the corners are rounded
        rows[:, :columns] = np.hstack([0.5 * (low_m + high_m), 0.5 * (high_m - low_m) + lap_m])
        return rows[np.all((high_m > low_m) | (ends[0] == ends[1]), axis=1)]

    @property
    def ends(self) -> FloatArray:
        """Lowest and highest corner of the root, (2, 3)."""
        middle, side = self.root[0, : self.node.LEVEL].reshape(2, 3)
        return np.array([middle - side, middle + side])

    @property
    def _half_time(self) -> float:
        """When a share of the time that is left will be over."""
        return (1.0 - _DIRECT_SHARE) * limit_clock() + _DIRECT_SHARE * self.deadline

    def try_target(self) -> tuple[FloatArray, str]:
        """Try the target from the root; return the leaves and why it stopped short, if it did.

        Boxes that do not end may lie around a better pose: if one is found there, the try begins again.
        """
        until = self._half_time
        pools: dict[float, WorkerPool] = {}
        examined, last = {_LATE: 0, _EARLY: 0}, self.node_limit - _FOR_STAGES
        for spare, boxes in _TRIES:
            if spare == _EARLY and not (self.has_gaps and (boxes > _ALTERNATE or not self.is_mean)):
                continue
            workers = pools.setdefault(spare, WorkerPool(self.root))
            self.spare, before = spare, self.nodes
            most = max(1, min(boxes - examined[spare], last - self.nodes))
            leaves, reason = self.exclude_all(workers, self.target, most, until)
            if not reason or limit_clock() > until or self.nodes >= last:
                break
            examined[spare] += self.nodes - before
            if boxes != _ALTERNATE and self.axis_field.is_free and self._improved_from(workers):
                return self.try_target()
        # the stages that may follow split as the try that has less left
        self.spare = min(pools, key=lambda spare: self._volume_m3(pools[spare].boxes()))
        return leaves, reason

    def _volume_m3(self, boxes: FloatArray) -> float:
        """Sum up the volumes of boxes."""
        return float(np.sum(np.prod(2.0 * boxes[:, self.node.HALF : self.node.LEVEL], axis=1)))

    def _improved_from(self, workers: WorkerPool) -> bool:
        """Climb from where a try stopped; check that a clearly better pose is found."""
        before = self.value
        for (position_m, axis), mu in product(workers.last(), _BARRIERS):
            if np.any(axis):
                self._climb_from(position_m, axis / np.linalg.norm(axis), mu)
        return self.value > before * (1.0 + self.target)

    def exclude_all(
        self, workers: WorkerPool, gap: float, most: int, deadline: float
    ) -> tuple[FloatArray, str]:
        """Exclude all above ``value (1 + gap)``; return the leaves and why it stopped short, if it did.

        There are no leaves if they take too much memory: then a stage begins with the root again.
        """
        self.keeps_leaves = True
        reason = self.work_off(workers, gap, most, deadline)
        if reason:
            return self.root[:0], reason
        self.proved, leaves = min(self.proved, self.value * (1.0 + gap)), workers.leaves()
        if np.all(leaves[:, self.node.LEVEL] <= self.proved):  # else the bound from distances is better
            self.leaves = leaves
        return leaves, ""

    def has_space(self, workers: WorkerPool) -> bool:
        return workers.size_bytes + self.leaves.nbytes <= _MOST_BYTES

    def exclusion_kernel(self, gap: float) -> Kernel:
        from nullpose.solver.kernels.bounds.records import Goal

        goal = Goal(self.value * (1.0 + self.rounding), self.incumbent_row, self.spare)
        family, level = self.family, self.value * (1.0 + gap)
        return partial(self.branch, family.ratios, family.domain, self.axis_field.arrays, level, goal)

    def improve(self, position_m: FloatArray, axis: FloatArray) -> bool:
        return self._climb_from(position_m, axis, 0.01)

    def _climb_from(self, position_m: FloatArray, axis: FloatArray, mu: float) -> bool:
        """Take up a pose, or the local maximum that it leads to, if it is better; check that it is."""
        from nullpose.solver.kernels.linear_algebra.links import log_objective

        ratios = self.family.ratios
        logs = np.empty(len(ratios.denominator_isotropic)), np.empty(len(ratios.numerator_point))
        start = float(log_objective(ratios, position_m, axis, *logs))
        found = climb(self.family, self.axis_field, position_m, axis, mu=mu, steps=100)
        if found.log_value < start:
            found = replace(found, log_value=start, position_m=position_m, axis=axis)
        return self._take(found)

    def _take(self, found: Incumbent) -> bool:
        """Make a pose the incumbent if it is better; check that it is."""
        if not found.log_value > self.incumbent.log_value:
            return False
        self.incumbent = found
        self.incumbent_row, weights = np.zeros(self.node.COLUMNS), found.multipliers.copy()
        self.node.keep_largest(weights, len(weights), self.incumbent_row, self.is_mean)
        self.touch(self.incumbent_row, found.axis)
        return True

    def search_thoroughly(self) -> None:
        search, self.search = self.search, None
        if search is not None:
            with ended_when(lambda: limit_clock() > self.deadline):
                self._take(search())

    def _has_certificate(self, side_m: FloatArray) -> bool:
        """Check that a certificate can hold the leaves, by their number and their sides."""
        halves_m = self.leaves[:, self.node.HALF : self.node.LEVEL]
        cells = self.leaves[self.leaves[:, self.node.FACE] >= 0.0, self.node.CELL : self.node.SIDE]
        return (
            len(self.leaves) <= MOST_LEAVES
            and bool(np.all(halves_m >= _THINNEST * side_m))
            and bool(np.all(cells[:, 1::2] - cells[:, ::2] >= 2.0 * _THINNEST))
        )

    def result(self, reason: str) -> Proof:
        """Return the proof as far as the run has come."""
        side = 0.5 * (self.ends[1] - self.ends[0])
        return Proof(
            incumbent=self.incumbent,
            upper_bound=float(bound_above(self.value, self.proved)),
            root=self.ends,
            leaves=self.leaves if self._has_certificate(side) else self.leaves[:0].copy(),
            reason=reason,
            nodes=self.nodes,
        )


def _shell(inner: FloatArray, whole: FloatArray) -> FloatArray:
    """Return boxes that cover what a box has outside of one in it, lowest and highest corners, (s, 2, 3)."""
    parts, left = np.empty((0, 2, 3)), whole.copy()
    for side, end in product(range(3), range(2)):
        if inner[end, side] != left[end, side]:
            part = left.copy()
            part[1 - end, side] = left[end, side] = inner[end, side]
            parts = np.append(parts, part[None], axis=0)
    return parts


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
    last: Proof | None = None,
) -> Proof:
    """Return a bound on the best pose, and a better pose if one turns up on the way.

    First the target gap is tried directly. If that takes too many boxes, the gap is closed in stages, each
    refining the leaves of the one before, so that a limit leaves the bound of the last stage finished.

    Args:
        family: the ratios and their domain.
        axis_field: which axes are allowed.
        incumbent: the best pose of the search.
        limits: target gap, time, boxes and progress; a KeyboardInterrupt during the run ends it with the
            bound reached.
        began: when the clock of the limits began, that of ``limit_clock``; now, if left out.
        nodes: boxes examined before, which count towards the limit.
        bound: one proved before for a field that holds all axes of this one; the leaves do not prove it.
        search: a thorough search, made once if the proof does not close at once.
        last: a proof of almost the same problem, to begin with; leaves that come of its leaves are not for a
            certificate.
    """
    began = limit_clock() if began is None else began
    run = _Run(family, axis_field, incumbent, limits, began, nodes, bound, search)
    target, reason = run.target, ""
    try:
        if run.proved <= run.value * (1.0 + target):  # distances alone have shown it
            return run.result("")
        start, gap, has_time = run.root, min(_WIDEST_GAP, run.proved / run.value - 1.0), True
        if last is not None:
            start = run.cover_from(last)
            gap = min(gap, max(last.gap / _STAGE, target / _STAGE**2))  # most leaves pass the first stage
            reason, has_time = (last.reason, False) if last.reason else run.try_from(start)
            if not reason:
                return run.result("")
        if has_time:  # else the stages go on from where the last proof stopped
            leaves, reason = run.try_target()
        if reason and run.nodes < run.node_limit and limit_clock() < run.deadline:
            while gap > target:
                gap = target if _STAGE * gap <= _LAST_STAGE * target else _STAGE * gap
                leaves, reason = run.exclude_all(
                    WorkerPool(start), gap, run.node_limit - run.nodes, run.deadline
                )
                if reason:
                    break
                start = leaves if len(leaves) else run.root
        if reason:
            run.search_thoroughly()
    except KeyboardInterrupt:
        reason = INTERRUPT
    return run.result(reason)
