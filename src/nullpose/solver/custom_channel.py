"""Channels that are functions in Python: a search by values, and a bound where they state how they change.

At one position such a channel is free space with another power. Over a box of positions it lies between two
ends, and the proof for free space at the better end of each bounds the box. The box of the largest bound is
halved first.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import count

import numpy as np

from nullpose.errors import SolveError
from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INSIDE, INTERRUPT
from nullpose.solver.compiling import compile_search, limit_clock, precompile
from nullpose.solver.multistart import Incumbent, SearchSettings, multistart
from nullpose.solver.options import SolveOptions
from nullpose.solver.position_search import PositionSearch
from nullpose.solver.proof import prove
from nullpose.solver.rigour import bound_above
from nullpose.solver.solve_and_prove import Outcome

_AT_POSITION = SearchSettings(coarse=1, polished=1, rounds=1, patience=1, landmarks=0)
_SHARE = 0.2  # of the gap asked for, for the proof of each box
_AROUND = 10.0  # keep-out radii around the points in which positions are drawn


class CustomSearch(PositionSearch):
    """The search for the best pose, its axis the best of the fields at each position.

    Args:
        scenario: with channels that are functions.
        family: its ratios and domain.
        fields: the axis fields.
        seed: of the positions drawn.
    """

    def __init__(self, scenario: Scenario, family: Family, fields: Sequence[AxisField], seed: int) -> None:
        super().__init__(self.value_at, family, seed)
        laws = (
            (j, scenario.custom_law(point))
            for j, point in enumerate((*scenario.nodes, *scenario.interferers, *scenario.destinations))
        )
        self.laws = {j: law for j, law in laws if law is not None}
        self.fields = fields

    def scaled(self, most: FloatArray, least: FloatArray) -> Family:
        """Build free space with the nodes' links so many times as strong, (m,), and the others', (m,)."""
        ratios = self.family.ratios
        return self.family.changed(
            numerator_weight=ratios.numerator_weight * most[ratios.numerator_point],
            denominator_weight=ratios.denominator_weight * least[ratios.denominator_point],
        )

    def best_at(self, position_m: FloatArray) -> tuple[Incumbent, int]:
        """Find the best axis at a position, (3,), metres, and its field.

        Raises:
            SolveError: no axis reaches every node.
        """
        excess, _ = self.excess_range(position_m, np.zeros(3))
        place = self.scaled(excess, excess).at(position_m)
        found = [multistart(place, field, seed=0, settings=_AT_POSITION) for field in self.fields]
        chosen = max(range(len(found)), key=lambda i: found[i].log_value)
        return found[chosen], chosen

    def value_at(self, position_m: FloatArray) -> float:
        """Evaluate the largest log ratio at a position, (3,), metres."""
        try:
            return self.best_at(position_m)[0].log_value
        except SolveError:
            return -math.inf

    def box(self, log_value: float) -> tuple[FloatArray, FloatArray]:
        """Return corners of the box in which positions are drawn, whatever the value."""
        points_m, domain = self.family.ratios.points_m, self.family.domain
        around_m = float(np.max(np.ptp(points_m, axis=0))) + _AROUND * domain.keep_out_m
        low_m = np.maximum(domain.low_m, points_m.min(axis=0) - around_m)
        return low_m, np.minimum(domain.high_m, np.maximum(low_m, points_m.max(axis=0) + around_m))

    def excess_range(self, centre_m: FloatArray, half_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Bound the excess gain of each point over a box, (m,) and (m,): least and most."""
        low, high = np.ones((2, len(self.family.ratios.points_m)))
        for j, law in self.laws.items():
            low[j], high[j] = law.excess_range(
                self.family.ratios.points_m[j], centre_m, half_m, self.family.domain.keep_out_m
            )
        return low, high

    def root(self) -> tuple[FloatArray, FloatArray]:
        """Return corners of a box outside which no pose is as good as the best found; perhaps infinite."""
        family, level = self.family, math.exp(self.best)
        low_m, high_m = family.domain.low_m, family.domain.high_m
        if self.laws.keys().isdisjoint(family.ratios.numerator_point.tolist()):
            low_m, high_m = super().box(self.best)
        for k, j in enumerate(family.ratios.numerator_point.tolist()):
            noise = family.ratios.denominator_isotropic[family.ratios.denominator_of[k]]
            least = (level * noise - family.ratios.numerator_isotropic[k]) / family.ratios.numerator_weight[k]
            if least > 0.0 and j in self.laws:
                reach_m = self.laws[j].reach_m(least, family.domain.keep_out_m)
                low_m = np.maximum(low_m, family.ratios.points_m[j] - reach_m)
                high_m = np.minimum(high_m, family.ratios.points_m[j] + reach_m)
        return low_m, np.maximum(low_m, high_m)

    def side_of(self, low_m: FloatArray, high_m: FloatArray) -> int:
        """Choose the side to halve: that which leaves the least range of excess gains, or the longest."""
        half_m = 0.5 * (high_m - low_m)
        parts_m = half_m * (1.0 - 0.5 * np.eye(3))
        ranges = (self.excess_range(0.5 * (low_m + high_m), part_m) for part_m in parts_m)
        spreads = [np.sum(np.log(most / least)) for least, most in ranges]
        return int(np.argmin(np.array(spreads) - 1e-3 * half_m))

    def bound_of(self, low_m: FloatArray, high_m: FloatArray, options: SolveOptions) -> tuple[float, int]:
        """Bound the smallest ratio in a box, the best pose found counting as in it; and count the boxes."""
        from nullpose.solver.kernels.bounds.root import reach_by_distance

        least, most = self.excess_range(0.5 * (low_m + high_m), 0.5 * (high_m - low_m))
        part = self.scaled(most, least).changed(low_m=low_m, high_m=high_m)
        farthest = float(reach_by_distance(part.ratios, part.domain)[0])
        if farthest < math.exp(self.best):
            return farthest, 0
        start = self.best_at(self.state)[0]
        proofs = [prove(part, field, start, options) for field in self.fields]
        for proof in proofs:
            if proof.reason == INTERRUPT:
                raise KeyboardInterrupt
            before = self.best
            if proof.incumbent is not start and self.take(proof.incumbent.position_m) > before:
                self.climb(self.state)
        return max(proof.upper_bound for proof in proofs), sum(proof.nodes for proof in proofs)


def solve_custom(
    scenario: Scenario, family: Family, fields: Sequence[AxisField], options: SolveOptions
) -> Outcome:
    """Search for the best pose, and bound it where every function states how it changes.

    Args:
        scenario: with channels that are functions in Python.
        family: its ratios and domain.
        fields: the axis fields, one or more.
        options: what is asked for, its gap stated.

    Raises:
        SolveError: no pose reaches every node.
    """
    (precompile if options.certify else compile_search)()
    search = CustomSearch(scenario, family, fields, options.seed)
    began = limit_clock()
    search.search()
    bound, boxes, reason = None, 0, ""
    if options.certify:
        bound, boxes, reason = _bounded(search, options, began + options.time_limit_s)
    found, chosen = search.best_at(search.state)
    return Outcome(
        incumbent=replace(found, starts=search.starts, evaluations=search.evaluations),
        chosen=chosen,
        upper_bound=None if bound is None else float(bound_above(math.exp(search.best), bound)),
        reason=reason,
        cells=boxes,
    )


def _bounded(search: CustomSearch, options: SolveOptions, deadline: float) -> tuple[float | None, int, str]:
    """Halve boxes until the gap is closed; return the bound, the boxes and why it stopped short."""
    if not all(law.is_bounded for law in search.laws.values()):
        return None, 0, "a channel of one's own states no bounds on its change"
    if not np.all(np.isfinite(corners_m := search.root())):
        return (
            None,
            0,
            "the airspace has no sides, and nothing else bounds how far away a pose can be as good",
        )
    order = count()
    heap = [(-math.inf, next(order), *corners_m)]
    boxes, reason = 0, ""
    try:
        while not reason:
            value = math.exp(search.best)
            target = INSIDE * options.ratio_gap(value)
            if -heap[0][0] <= value * (1.0 + target):
                break
            _, _, low_m, high_m = heap[0]
            side, middle_m = search.side_of(low_m, high_m), 0.5 * (low_m + high_m)
            upper_m, lower_m = low_m.copy(), high_m.copy()
            upper_m[side] = lower_m[side] = middle_m[side]
            halves = []
            for ends_m in ((low_m, lower_m), (upper_m, high_m)):
                left_s = max(1e-3, deadline - limit_clock())
                bound, examined = search.bound_of(
                    *ends_m,
                    replace(options, gap=_SHARE * target, time_limit_s=left_s, threads=1, on_progress=None),
                )
                halves.append((-min(bound, -heap[0][0]), next(order), *ends_m))
                boxes += examined
            heapq.heappush(heap, halves[1])  # first: an interrupt between both leaves the whole box
            heapq.heapreplace(heap, halves[0])
            if options.on_progress is not None:
                options.on_progress(-heap[0][0] / value - 1.0, boxes)
            if limit_clock() > deadline:
                reason = f"the time limit of {options.time_limit_s:g} s"
            elif boxes >= options.node_limit:
                reason = f"the node limit of {options.node_limit}"
    except KeyboardInterrupt:
        reason = INTERRUPT
    return (None if heap[0][0] == -math.inf else -heap[0][0]), boxes, reason
