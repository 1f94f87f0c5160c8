"""An antenna with any pattern: search and proof over positions and attitudes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from nullpose.antenna import PatternAntenna
from nullpose.errors import SolveError
from nullpose.objectives import FloatArray
from nullpose.physics.rotation import rotation_world_from_body
from nullpose.problem.family import Family
from nullpose.problem.records import AttitudeReach
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INSIDE, INTERRUPT, MOST_LEAVES, BranchAndBound
from nullpose.solver.compiling import limit_clock
from nullpose.solver.kernels.compiler.interpreted import ended_when
from nullpose.solver.multistart import NO_POSITION, Incumbent
from nullpose.solver.options import SolveOptions
from nullpose.solver.pattern_search import PatternSearch
from nullpose.solver.proof import Proof
from nullpose.solver.rigour import bound_above
from nullpose.solver.solve_and_prove import Outcome
from nullpose.solver.worker_pool import Kernel, WorkerPool

_DIRECT_SHARE = 0.6  # of the time, for the gap asked for; then come wider ones, which show some bound
_GAPS = (0.5, 0.1, 0.02)
_IN_TURN = 150_000  # cells after which the other alignment is tried
_SWING = 4.0  # over the noise: interference let in by turning a null through the reach, above which it leads
_WIDEST_RAD = 1.5  # radians: of a reach for them
_CLEAR = 0.35  # least cosine of the anchor's latitude in a chart


def solve_pattern(scenario: Scenario, family: Family, options: SolveOptions) -> Outcome:
    """Return the best pose for an antenna with a pattern, with a bound if one is asked for.

    A multistart search; then a branch and bound over cells of positions and attitudes, which takes up every
    better pose that it meets. If the time does not suffice for the gap asked for, wider gaps are proved.

    Args:
        scenario: one whose antenna has a pattern.
        family: its ratios and domain, as for an isotropic gain of 1.
        options: what is asked for, its gap stated.

    Raises:
        SolveError: no pose reaches every node.
    """
    antenna = scenario.antenna_record
    assert not antenna.is_quadratic, "the caller asks"
    return PatternRun(family, antenna, reach_of(scenario, antenna), options).outcome()


def reach_of(scenario: Scenario, antenna: PatternAntenna) -> AttitudeReach:
    """Return the attitudes of an antenna that the scenario's airframe reaches.

    Args:
        scenario: with its airframe.
        antenna: with its pattern.
    """
    airframe = scenario.airframe
    tilt, mount = (math.pi, 0.0) if airframe is None else (airframe.tilt_max_rad, airframe.mount_rad)
    up = rotation_world_from_body(0.0, mount, 0.0).T[:, 2].copy()
    return AttitudeReach(tilt, mount, up, antenna.is_axisymmetric, antenna.harmonics.is_even)


class PatternRun(BranchAndBound):
    """One search and one proof.

    Args:
        family: ratios and domain, as for an isotropic gain of 1.
        antenna: its pattern.
        reach: the attitudes there are.
        options: what is asked for.
    """

    chunk, nodes_of_search = 5_000, 300_000

    def __init__(
        self, family: Family, antenna: PatternAntenna, reach: AttitudeReach, options: SolveOptions
    ) -> None:
        super().__init__(options, limit_clock())
        self.family, self.antenna, self.reach = family, antenna, reach
        self.search = PatternSearch(family, antenna, reach, options.seed)
        self.leaves = np.empty((0, 0))
        self.root = np.zeros((2, 3))

    def outcome(self) -> Outcome:
        """Return the best pose and what is proved of it."""
        from nullpose.solver.kernels.bounds.pattern_branch import branch_pattern
        from nullpose.solver.kernels.bounds.root import reach_by_distance

        self.branch = branch_pattern
        self.proved = float(reach_by_distance(self.search.loudest.ratios, self.family.domain)[0])
        began = limit_clock()
        self.deadline = began + self.limits.time_limit_s
        self.thorough = False
        with ended_when(lambda: limit_clock() > self.deadline):
            self.thorough = not self.search.search(light=self.limits.certify)
        if self.search.best == -math.inf:
            self.search.search(light=True)
        if not math.isfinite(self.search.best):
            raise SolveError(NO_POSITION)
        reason = self._proved(began) if self.limits.certify else ""
        position_m, rotation = self.search.pose
        found = Incumbent(
            position_m=position_m,
            axis=self.search.least_tilted(rotation),
            log_value=self.search.best,
            multipliers=np.full(
                len(self.family.ratios.numerator_point), 1.0 / len(self.family.ratios.numerator_point)
            ),
            starts=self.search.starts,
            evaluations=self.search.evaluations,
        )
        if not self.limits.certify:
            return Outcome(incumbent=found)
        bound = float(bound_above(self.value, self.proved))
        proof = Proof(
            incumbent=found,
            upper_bound=bound,
            root=self.root,
            leaves=self.leaves,
            reason=reason,
            nodes=self.nodes,
        )
        cells, proofs = (0, (proof,)) if len(self.leaves) else (self.nodes, ())
        return Outcome(incumbent=found, upper_bound=bound, reason=reason, proofs=proofs, cells=cells)

    @property
    def value(self) -> float:
        """The best smallest ratio so far; 1 at least if it is one of a rate, which is never below zero."""
        return math.exp(max(self.search.best, 0.0) if self.limits.of_rate else self.search.best)

    def _proved(self, began: float) -> str:
        """Close the gap asked for, or else wider ones; return why it was not closed."""
        limits = self.limits
        target = INSIDE * limits.ratio_gap(self.value)
        try:
            if self.proved <= self.value * (1.0 + target):
                return ""
            reason = self._stage(target, began + _DIRECT_SHARE * limits.time_limit_s)
            for gap in _GAPS if reason and self.nodes < self.node_limit else ():
                if gap > target and self._stage(gap, self.deadline):
                    break
            if reason:
                self.search_thoroughly()
            return reason
        except KeyboardInterrupt:
            return INTERRUPT

    def _stage(self, gap: float, until: float) -> str:
        """Exclude all above ``value (1 + gap)``; return why it stopped short, if it did."""
        root, self.keeps_leaves = self.root_of(gap), self.reach.spins
        pools = [WorkerPool(np.array(cells), orientation=(3, 3)) for cells in self._alignments(*root)]
        in_turn = [(pool, _IN_TURN) for pool in pools] if len(pools) > 1 else []
        for workers, most in (*in_turn, (pools[0], self.node_limit)):
            reason = self.work_off(workers, gap, min(most, self.node_limit - self.nodes), until)
            if not reason:
                break
        bound = self.value * (1.0 + gap)
        if not reason and bound < self.proved:
            self.proved, self.root = bound, root
            self.leaves = workers.leaves() if self.keeps_leaves else np.empty((0, 0))
        return reason

    def has_space(self, workers: WorkerPool) -> bool:
        """Check that a certificate can hold the leaves."""
        return workers.filled <= MOST_LEAVES

    def improve(self, position_m: FloatArray, rotation: FloatArray) -> bool:
        """Take up a pose, or what a climb from there leads to; check that it is better."""
        return self.search.improve(position_m, rotation)

    def search_thoroughly(self) -> None:
        """Search as without a proof, once."""
        if not self.thorough:
            self.thorough = True
            alone = PatternSearch(self.family, self.antenna, self.reach, self.limits.seed)  # as --fast draws
            with ended_when(lambda: limit_clock() > self.deadline):
                alone.search(light=False)
                self.search.take(alone.state)
            self.search.starts += alone.starts
            self.search.evaluations += alone.evaluations

    def exclusion_kernel(self, gap: float) -> Kernel:
        """Return the kernel that excludes all above ``value (1 + gap)``."""
        level, floor = self.value * (1.0 + gap), self.value * (1.0 + self.rounding)
        problem = self.family.ratios, self.family.domain, self.antenna.arrays, self.reach
        return partial(self.branch, *problem, level, floor, self.keeps_leaves)

    def root_of(self, gap: float) -> FloatArray:
        """Return corners, (2, 3), of a box outside which no pose reaches the best value, or a gap over it.

        Args:
            gap: relative; it counts for a rate, whose ratios tend to one far away.
        """
        level = math.log(self.value) + (math.log1p(gap) if self.limits.of_rate else 0.0)
        low_m, high_m = self.search.box(level)
        return np.array([low_m, np.maximum(low_m, high_m)])

    def _alignments(self, low_m: FloatArray, high_m: FloatArray) -> list[list[FloatArray]]:
        """List the cells to begin with, aligned to a point or to the zenith, what promises more first.

        The null follows a strong interferer in cells aligned to it; the reach is of angles from the zenith.
        """
        zenith, width_rad = self._zenith_cell(0.5 * (low_m + high_m), 0.5 * (high_m - low_m))
        if width_rad == 0.0:
            return [[zenith]]
        to_point = list(self._roots(low_m, high_m))
        if width_rad > _WIDEST_RAD or not self.reach.spins:
            return [to_point]
        is_strong = width_rad**2 * self.search.interference > _SWING
        return [to_point, [zenith]] if is_strong else [[zenith], to_point]

    def _zenith_cell(self, middle: FloatArray, half: FloatArray) -> tuple[FloatArray, float]:
        """Return a cell of all attitudes aligned to the zenith, and the width of the reach, radians.

        For an antenna that is not the same all round the attitudes are those of a level vehicle.
        """
        from nullpose.solver.kernels.bounds import attitude as a

        cell, reach = self._cell(middle, half), self.reach
        cell[a.ANCHOR], cell[a.HALF + 5] = -1, math.pi
        if not reach.spins:
            cell[3], cell[4] = math.atan2(reach.up[0], reach.up[2]), -math.asin(reach.up[1])
            return cell, reach.tilt_max_rad
        least = max(0.0, reach.mount_rad - reach.tilt_max_rad)
        most = min(math.pi, reach.mount_rad + reach.tilt_max_rad)
        cell[3], cell[a.HALF + 3] = 0.5 * (least + most), 0.5 * (most - least)  # u is the axis' angle
        return cell, most - least

    def _cell(self, middle: FloatArray, half: FloatArray) -> FloatArray:
        """Return a cell of positions, whose multipliers are equal."""
        from nullpose.solver.kernels.bounds import attitude as a

        cell = np.zeros(a.WARM + len(self.family.ratios.numerator_point))
        cell[:3], cell[a.HALF : a.HALF + 3] = middle, half * (1.0 + 1e-12)
        cell[a.WARM :] = 1.0 / len(self.family.ratios.numerator_point)
        return cell

    def _roots(self, low_m: FloatArray, high_m: FloatArray) -> Iterator[FloatArray]:
        """Yield cells of positions in a box and of all attitudes, to begin with."""
        from nullpose.solver.kernels.bounds import attitude as a

        middle, half = 0.5 * (low_m + high_m), 0.5 * (high_m - low_m)
        anchor = self.search.anchor
        clear, chart = max((self._clearance(anchor, chart, middle, half), chart) for chart in range(3))
        if clear < _CLEAR and np.max(half) > self.family.domain.keep_out_m:
            side = int(np.argmax(half))
            lower, upper = high_m.copy(), low_m.copy()
            lower[side] = upper[side] = middle[side]
            yield from self._roots(low_m, lower)
            yield from self._roots(upper, high_m)
            return
        for face in range(1 if self.reach.spins else 6):
            cell = self._cell(middle, half)
            cell[a.HALF + 3 : a.HALF + 6] = math.pi / 4.0, math.pi / 4.0, math.pi
            if self.reach.spins:  # u alone says where the anchor is: half a turn, or a quarter
                cell[3] = cell[a.HALF + 3] = math.pi / 4.0 if self.reach.even else math.pi / 2.0
                cell[a.HALF + 4] = 0.0
            cell[a.FACE], cell[a.CHART], cell[a.ANCHOR] = face, chart, anchor
            yield cell

    def _clearance(self, anchor: int, chart: int, middle: FloatArray, half: FloatArray) -> float:
        """Return the least cosine of the anchor's latitude over a box, in a chart."""
        order = [(chart + i) % 3 for i in range(3)]
        away_m = np.abs(self.family.ratios.points_m[anchor] - middle)[order]
        sides = half[order]
        level = math.hypot(max(0.0, away_m[0] - sides[0]), max(0.0, away_m[2] - sides[2]))
        return level / math.hypot(level, away_m[1] + sides[1]) if level > 0.0 else 0.0
