"""A bound on the mean over a trajectory: the Lagrangian of the speed limit, with branching.

For any vectors ``c_t``, a price for every step, a trajectory with ``|p_{t+1} - p_t| <= s_t`` has

    ``sum_t g_t(p_t) <= sum_t s_t |c_t| + sum_t max_p (g_t(p) + (c_t - c_{t-1}) . p)``,

where ``c`` is zero before the first step and after the last: problems of one instant each. What prices leave
open is split: an instant's box of positions is halved, and both halves are bounded with prices of their own.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from typing import TypeAlias

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.compiling import limit_clock
from nullpose.solver.trajectory.bounds import Clairvoyant
from nullpose.solver.trajectory.course import Aim, Course, likely_poses
from nullpose.solver.trajectory.lattice import INSIDE
from nullpose.solver.trajectory.program import best_prices
from nullpose.solver.trajectory.search import Flight, climbed, is_clear
from nullpose.solver.worker_pool import Queue, processors

_ROUNDS, _ROUNDS_OF_HALVES = 14, 4  # of prices at the first node, and at others
_SHARE, _LEAST_GAP = 0.2, 3e-4  # of what is open: the gap of the problems of one instant, nats
_NOTED = 0.3  # of that gap: positions that are better by less are not noted
_BOXES = 20_000  # of one of them
_SPARE = 1.0  # as in ``Goal``
_LARGEST = 300.0  # of a logarithm: prices that offer more are no use
_LEAST_DROP, _DROPS = 0.05, 48  # below an instant's cap, nats: levels of boxes
_LEAST_GAIN, _FAINTEST = 1e-12, -650.0  # of a rate, and the lowest logarithm
_FIRST_RADIUS, _LATER_RADIUS = 0.3, 0.6  # of the largest price, where a node begins
_LEAST_RADIUS = 3e-3  # of prices around those at hand, nats by metre
_GAIN = 0.02  # of what is open: a round of prices that gains less is the last
_EDGE_M = 1e-9
_MOST_OF_IT, _NO_SHARE, _NO_SPREAD_M2 = 0.5, 1e-6, 1e-6  # of a mixture
_CLIMB_EVERY, _BARRIER, _BLENDS = 6, 1e-2, (0.03, 0.1, 0.3, 0.6)  # nodes, and ways from means to the flight
_Mixture: TypeAlias = list[list[tuple[float, int]]]  # at each instant shares, and positions of its pool


@dataclass(frozen=True)
class _Priced:
    """What prices prove of a node.

    Args:
        prices: (t - 1, 3) nats by metre.
        bounds: (t,) no position of the box at the instant offers more, nats.
        best_m: (t, 3) the position met that offers most.
        mean: what follows for the mean, nats.
    """

    prices: FloatArray
    bounds: FloatArray
    best_m: FloatArray
    mean: float


@dataclass(order=True)
class _Node:
    """A part of all trajectories: at each instant a box of positions.

    Args:
        bound: no such trajectory has a larger mean: minus that, nats.
        number: of the node.
        low_m: (t, 3) lowest corners.
        high_m: (t, 3) highest.
        priced: the best prices so far, in a box around this one's, with their bounds.
        radius: of those tried around them.
        split: the instant and the coordinate to halve, and where.
    """

    bound: float
    number: int
    low_m: FloatArray = field(compare=False)
    high_m: FloatArray = field(compare=False)
    priced: _Priced = field(compare=False)
    radius: float = field(compare=False)
    split: tuple[int, int, float] | None = field(compare=False, default=None)


class PriceBound:
    """The branching over boxes of positions.

    Args:
        course: the problem.
        flight: the best so far, with prices and multipliers.
        best: the best at each instant.
        gap: asked for, nats of the mean.
        deadline: on ``limit_clock``.
        on_bound: called with the flight and the bound.
    """

    def __init__(
        self,
        course: Course,
        flight: Flight,
        best: Clairvoyant,
        gap: float,
        deadline: float,
        on_bound: Callable[[Flight, float], None],
    ) -> None:
        assert flight.prices is not None
        assert flight.multipliers is not None
        self.course, self.flight, self.gap = course, flight, gap
        self.deadline, self.on_bound, self.numbers = deadline, on_bound, count()
        self.threads = ThreadPoolExecutor(processors())
        self.offset = 1.0 if course.aim is Aim.MEAN_RATE else 0.0
        self.total = len(course.times_s)
        self.caps = course.aim.gains(best.bounds)
        self.multipliers, self.flown_m = flight.multipliers, flight.poses[:, :3].copy()
        self.pool_m = [[pose[:3], top[:3]] for pose, top in zip(flight.poses, best.poses, strict=True)]
        self.pool_gain = [
            [self._gain(t, place_m) for place_m in places] for t, places in enumerate(self.pool_m)
        ]

    def run(self) -> None:
        """Tell bounds on the mean, as near as time and gap let them come."""
        if limit_clock() > self.deadline:
            return
        cap, root = float(np.mean(self.caps)), self._root()
        if not (np.all(np.isfinite(root.low_m)) and np.all(np.isfinite(root.high_m))):
            return  # far away nothing is excluded
        open_nodes = [self._bounded(root, -cap, _ROUNDS)]
        while open_nodes:
            node = heapq.heappop(open_nodes)
            bound = min(cap, max(self.flight.score, -node.bound))
            self.on_bound(self.flight, bound)
            if bound <= self.flight.score + self.gap or limit_clock() > self.deadline or node.split is None:
                return
            for child in self._halves(node):
                heapq.heappush(open_nodes, child)
        self.on_bound(self.flight, self.flight.score)  # no part has a flight

    def _root(self) -> _Node:
        """Return the boxes outside which a trajectory falls behind the best, whatever it does elsewhere.

        Outside a box now it is outside a smaller one some steps away, by what it flies in between, and each
        box has a level that nothing outside reaches.
        """
        deficit = self.total * (float(np.mean(self.caps)) - self.flight.score)
        drops = np.geomspace(_LEAST_DROP, max(2.0 * _LEAST_DROP, deficit), _DROPS)
        boxes = np.array([[self._level_box(t, drop) for drop in drops] for t in range(self.total)])
        metres = np.append(0.0, np.cumsum(self.course.reach_m))
        ends = np.empty((self.total, 2, 3))
        for t in range(self.total):
            spread = np.abs(metres - metres[t])[:, None, None]
            for j in range(_DROPS):  # outside of the smallest first
                inside = np.all(boxes[:, :, 0] - spread >= boxes[t, j, 0], axis=2)
                inside &= np.all(boxes[:, :, 1] + spread <= boxes[t, j, 1], axis=2)
                lost = np.max(np.where(inside, drops, 0.0), axis=1)
                if float(np.sum(lost)) > deficit * (1.0 + 1e-9):
                    break
            ends[t] = boxes[t, j]
        domain, prices = self.course.families[0].domain, self.flight.prices
        low_m, high_m = np.maximum(ends[:, 0], domain.low_m), np.minimum(ends[:, 1], domain.high_m)
        for t, end_m in ((0, self.course.ends_m[0]), (-1, self.course.ends_m[1])):
            if end_m is not None:
                low_m[t], high_m[t] = end_m, end_m
        assert prices is not None
        radius = max(_LEAST_RADIUS, _FIRST_RADIUS * float(np.max(np.abs(prices))))
        unknown = np.full((self.total, 4), np.inf)
        priced = _Priced(prices, unknown[:, 0], unknown[:, 1:], math.inf)
        return _Node(0.0, next(self.numbers), *self._reachable(low_m, high_m), priced, radius)

    def _level_box(self, t: int, drop: float) -> FloatArray:
        """Return the box outside which an instant's gain is below its cap by a drop, (2, 3).

        Without end where the airspace ends: there is no outside.
        """
        from nullpose.solver.kernels.search.search import cut_box

        family, least = self.course.families[t], float(self.caps[t]) - drop
        if self.offset:
            least = math.log(math.expm1(least)) if least > _LEAST_GAIN else -math.inf
        low_m, high_m = np.empty(3), np.empty(3)
        domain = family.domain
        cut_box(family.ratios, domain.low_m, domain.high_m, max(least, _FAINTEST), low_m, high_m)
        return np.array(
            [
                np.where(low_m <= domain.low_m, -np.inf, low_m),
                np.where(high_m >= domain.high_m, np.inf, high_m),
            ]
        )

    def _reachable(self, low_m: FloatArray, high_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Cut every box to what is in reach of the boxes before and after it."""
        low_m, high_m, reach_m = low_m.copy(), high_m.copy(), self.course.reach_m
        last = len(low_m) - 1
        for t, before in [(t, t - 1) for t in range(1, last + 1)] + [
            (t, t + 1) for t in range(last - 1, -1, -1)
        ]:
            step_m = reach_m[min(t, before)]
            low_m[t] = np.maximum(low_m[t], low_m[before] - step_m)
            high_m[t] = np.minimum(high_m[t], high_m[before] + step_m)
        return low_m, high_m

    def _halves(self, node: _Node) -> list[_Node]:
        assert node.split is not None
        t, axis, at_m = node.split
        halves = []
        for side in range(2):
            low_m, high_m = node.low_m.copy(), node.high_m.copy()
            (high_m if side == 0 else low_m)[t, axis] = at_m
            low_m, high_m = self._reachable(low_m, high_m)
            if np.all(low_m <= high_m):
                radius = max(node.radius, _LATER_RADIUS * float(np.max(np.abs(node.priced.prices))))
                half = _Node(node.bound, next(self.numbers), low_m, high_m, node.priced, radius)
                halves.append(self._bounded(half, node.bound, _ROUNDS_OF_HALVES))
        return halves

    def _bounded(self, node: _Node, negative_bound: float, rounds: int) -> _Node:
        """Bound a node by prices, bettered round by round; choose what to split."""
        bound, radius, mixture, lower = -negative_bound, node.radius, None, -math.inf
        prices, centre = node.priced.prices, replace(node.priced, mean=math.inf)
        for _ in range(rounds):
            if limit_clock() > self.deadline:
                break
            gap = max(_LEAST_GAP, _SHARE * (bound - self.flight.score))
            found = self._lagrangian(node, prices, gap)
            bound = min(bound, found.mean)
            if math.isfinite(centre.mean):  # a trust region: by how much of what was foreseen came true
                share = (centre.mean - found.mean) / max(1e-12, centre.mean - lower)
                radius *= 2.0 if share > 0.5 else 1.0 if share > 0.1 else 0.3
            if found.mean < centre.mean:
                centre = found
            if bound <= self.flight.score + self.gap:
                break
            lower, prices, mixture = self._master(node, centre.prices, radius)
            if centre.mean - lower < _GAIN * (centre.mean - self.flight.score):
                break
        split = None if mixture is None else self._split(node, mixture)
        return replace(node, bound=-bound, priced=centre, radius=radius, split=split)

    def _lagrangian(self, node: _Node, prices: FloatArray, gap: float) -> _Priced:
        """Bound the mean at prices; add the positions met to the pools.

        At the node's own prices nothing is new where the best position that was met is still in the box.
        """
        tilts = np.diff(np.vstack([np.zeros(3), prices, np.zeros(3)]), axis=0)
        bounds, best_m = np.full(self.total, np.inf), np.full((self.total, 3), np.inf)
        if prices is node.priced.prices:
            bounds, best_m = node.priced.bounds.copy(), node.priced.best_m.copy()
        unknown = np.flatnonzero(np.any((best_m < node.low_m) | (best_m > node.high_m), axis=1))
        met = self.threads.map(lambda t: self._best_offer(node, t, tilts[t], gap), unknown.tolist())
        for t, (most, place_m) in zip(unknown, met, strict=True):
            bounds[t], best_m[t] = min(bounds[t], most), place_m
        flown = float(np.sum(self.course.reach_m * np.linalg.norm(prices, axis=1)))
        return _Priced(prices, bounds, best_m, (flown + float(np.sum(bounds))) / self.total)

    def _best_offer(self, node: _Node, t: int, tilt: FloatArray, gap: float) -> tuple[float, FloatArray]:
        """Bound ``g_t(p) + tilt . p`` over the node's box at an instant, nats; return the best p met, too."""
        from nullpose.solver.kernels.bounds import branch, node as rows
        from nullpose.solver.kernels.bounds.records import Goal
        from nullpose.solver.kernels.compiler.jit import entry_of

        family, low_m, high_m = self.course.families[t], node.low_m[t], node.high_m[t]
        middle_m, flown_m = 0.5 * (low_m + high_m), self.flown_m[t]
        places_m = np.array(self.pool_m[t])
        offers = np.array(self.pool_gain[t]) + (places_m - flown_m) @ tilt
        offers[np.any((places_m < low_m) | (places_m > high_m), axis=1)] = -np.inf
        most = self.caps[t] + float(tilt @ (middle_m - flown_m) + np.abs(tilt) @ (high_m - middle_m))
        first = int(np.argmax(offers))
        best, best_m = max(float(offers[first]), min(-20.0, most - 20.0)), places_m[first]
        row = np.zeros(rows.COLUMNS)
        row[rows.CENTRE : rows.HALF], row[rows.HALF : rows.LEVEL] = middle_m, 0.5 * (high_m - low_m)
        row[rows.FACE] = -1.0
        weights = self.multipliers[t] / np.sum(self.multipliers[t])
        rows.keep_largest(weights, len(weights), row, len(family.ratios.shares) > 0)
        price = np.concatenate([tilt, flown_m, [self.offset]])
        domain = family.domain._replace(low_m=low_m, high_m=high_m)
        fixed = family.ratios, domain, self.course.field.arrays
        kernel, queue, done, met = entry_of(branch.branch), Queue(row[None]), 0, None
        while queue.top and best + gap < min(most, _LARGEST):
            if limit_clock() > self.deadline:
                return most + float(tilt @ flown_m), best_m
            level, value = (math.exp(x) - self.offset for x in (best + gap, best + _NOTED * gap))
            done += queue.work(partial(kernel, *fixed, level, Goal(value, row, _SPARE, price)), _BOXES)
            queue.filled = 0
            if queue.better:
                gain = self._gain_of(t, queue.position_m, queue.orientation)
                if (offer := gain + float(tilt @ (queue.position_m - flown_m))) > best:
                    best, best_m = offer, queue.position_m.copy()
                    met = best_m, gain
            if done >= _BOXES:
                gap, done = 4.0 * gap, 0
        if met is not None:
            self.pool_m[t].append(met[0])
            self.pool_gain[t].append(met[1])
        return float(min(most, best + gap) + tilt @ flown_m), best_m

    def _gain(self, t: int, place_m: FloatArray) -> float:
        return float(self.course.aim.gains(likely_poses(self.course, t, np.array(place_m[None]))[1])[0])

    def _gain_of(self, t: int, place_m: FloatArray, axis: FloatArray) -> float:
        from nullpose.solver.kernels.linear_algebra.links import log_objective

        ratios = self.course.families[t].ratios
        logs = np.empty(len(ratios.denominator_isotropic)), np.empty(len(ratios.numerator_point))
        log = np.array([log_objective(ratios, place_m, axis, *logs)])
        return float(self.course.aim.gains(log)[0])

    def _master(self, node: _Node, prices: FloatArray, radius: float) -> tuple[float, FloatArray, _Mixture]:
        """Find the prices near some that are best for the positions met, and the mixtures that they leave."""
        met = [
            (t, i)
            for t, pool_m in enumerate(self.pool_m)
            for i, place_m in enumerate(pool_m)
            if np.all((node.low_m[t] - _EDGE_M <= place_m) & (place_m <= node.high_m[t] + _EDGE_M))
        ]
        total, prices, shares = best_prices(
            self.course.reach_m,
            np.array([t for t, _ in met]),
            np.array([self.pool_m[t][i] for t, i in met]),
            np.array([self.pool_gain[t][i] for t, i in met]),
            prices,
            radius,
        )
        mixture: _Mixture = [[] for _ in range(self.total)]
        for (t, i), share in zip(met, shares.tolist(), strict=True):
            if share > _NO_SHARE:
                mixture[t].append((share, i))
        return total / self.total, prices, mixture

    def _split(self, node: _Node, mixture: _Mixture) -> tuple[int, int, float]:
        """Choose the instant whose mixture gains most over its mean; climb from the means now and then."""
        means_m, best = self.flown_m.copy(), 0.0
        sides_m = node.high_m - node.low_m
        t, axis = (int(i) for i in np.unravel_index(np.argmax(sides_m), sides_m.shape))
        split = t, axis, float(0.5 * (node.low_m[t, axis] + node.high_m[t, axis]))
        for t, parts in enumerate(mixture):
            shares = np.array([share for share, _ in parts])
            places_m = np.array([self.pool_m[t][i] for _, i in parts]).reshape(-1, 3)
            if not np.sum(shares) > _MOST_OF_IT:
                continue
            shares /= np.sum(shares)
            means_m[t] = shares @ places_m
            spread = shares @ (places_m - means_m[t]) ** 2
            excess = float(shares @ [self.pool_gain[t][i] for _, i in parts]) - self._gain(t, means_m[t])
            axis = int(np.argmax(spread))
            if excess > best and spread[axis] > _NO_SPREAD_M2:
                best, split = excess, (t, axis, float(means_m[t, axis]))
        if node.number % _CLIMB_EVERY == 0:
            self._climb_from(means_m)
        return split

    def _climb_from(self, means_m: FloatArray) -> None:
        """Take up the flight that the means of a mixture lead to, if it is better."""
        slower = replace(self.course, speed_max_m_s=INSIDE * self.course.speed_max_m_s)
        for share in _BLENDS:
            places_m = share * self.flown_m + (1.0 - share) * means_m
            if np.all(np.linalg.norm(np.diff(places_m, axis=0), axis=1) < slower.reach_m):
                if is_clear(self.course, places_m):
                    found = climbed(self.course, places_m, _BARRIER)
                    self.flight = max(self.flight, found, key=lambda each: each.score)
                return
