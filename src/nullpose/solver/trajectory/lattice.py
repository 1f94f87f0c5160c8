"""Trajectories over a lattice of positions, by dynamic programming: where the search begins."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from nullpose.objectives import FloatArray, IntArray
from nullpose.solver.compiling import limit_clock
from nullpose.solver.trajectory.course import Course, likely_poses
from nullpose.solver.trajectory.segments import half_spaces

INSIDE = 0.98
"""Share of the speed limit that a start uses: the climb goes on from strictly inside."""
_POINTS = 700  # of the lattice, about
_FINEST_M = 4.0
_LONGEST = 8.0  # finest steps beyond the reach of an instant that a stride may have
_CLEAR_M, _ON_BORDER_M = 1e-3, 1e-9
_PLACES, _APART = 8, 1.5  # to hover at: how many at first, and how many steps apart
_KEPT, _FINE_M = 2, 0.1  # how many at last, and how fine


@dataclass(frozen=True, eq=False)
class Lattice:
    """Positions, and what each gives at every instant.

    Args:
        course: the problem.
        points_m: (m, 3).
        gains: (t, m) what a position gives at an instant; minus infinity where it may not be.
        step_m: from one position to the next.
        apart_m: (m, m) the length of the straight way, infinite where something is in it.
    """

    course: Course
    points_m: FloatArray
    gains: FloatArray
    step_m: float
    apart_m: FloatArray

    @classmethod
    def around(cls, course: Course, places_m: FloatArray) -> Lattice:
        """Build the lattice around the nodes and some places, such as the best at each instant.

        Args:
            course: the problem.
            places_m: (n, 3).
        """
        nodes_m = np.vstack([f.ratios.points_m[f.ratios.numerator_point] for f in course.families])
        ends_m = [each for each in course.ends_m if each is not None]
        points_m, step_m = _grid(course, np.vstack([nodes_m, places_m, *ends_m]))
        points_m = np.vstack([points_m, *ends_m])
        gains = np.array([_gains_at(course, t, points_m) for t in range(len(course.times_s))])
        for row, end_m in ((0, course.ends_m[0]), (-1, course.ends_m[1])):
            if end_m is not None:
                gains[row, np.linalg.norm(points_m - end_m, axis=1) > _CLEAR_M] = -np.inf
        return cls(course, points_m, gains, step_m, _ways_m(course, points_m, len(ends_m)))

    def best_path(self, is_worst: bool, strides: float) -> FloatArray:
        """Find the path of the largest sum of gains, or of the largest least gain: positions, (t, 3).

        It is at a position of the lattice at some instants, and flies straight between them.

        Args:
            is_worst: whether the least gain counts.
            strides: how many steps of the lattice are flown between these instants at least.
        """
        stages, reaches = self._stages(strides)
        join, fold = (np.minimum, np.min) if is_worst else (np.add, np.sum)
        windows = np.searchsorted(0.5 * (stages[1:] + stages[:-1]), np.arange(len(self.gains)))
        parts = [fold(self.gains[windows == s], axis=0) for s in range(len(stages))]
        best, before = parts[0], []
        for part in parts[1:]:
            options = np.where(reaches, best[:, None], -np.inf)
            before.append(np.argmax(options, axis=0))
            best = join(part, options[before[-1], np.arange(len(part))])
        chosen = [int(np.argmax(best))]
        for leg in reversed(before):
            chosen.append(int(leg[chosen[-1]]))
        stops_m, times_s = self.points_m[chosen[::-1]], self.course.times_s
        return np.stack([np.interp(times_s, times_s[stages], axis) for axis in stops_m.T], axis=-1)

    def best_places(self, is_worst: bool, deadline: float) -> FloatArray:
        """Search for places to hover at, from the best of the lattice, (n, 3), the best first.

        Each is moved to the best of its neighbours, in a grid that is turned anew, half as far where none is
        better. The worst is dropped each time, until two are left.

        Args:
            is_worst: whether the least gain of all instants counts, or their sum.
            deadline: on ``limit_clock``.
        """
        course, random = self.course, np.random.default_rng(0)
        fold = np.min if is_worst else np.sum
        values, chosen = fold(self.gains, axis=0), np.empty((0, 3))
        for place_m in self.points_m[np.argsort(-values, kind="stable")]:
            if np.all(np.linalg.norm(chosen - place_m, axis=1) > _APART * self.step_m):
                chosen = np.vstack([chosen, place_m])
            if len(chosen) == _PLACES:
                break
        domain, grid = course.families[0].domain, np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
        steps_m, best = np.full(len(chosen), 0.5 * self.step_m), np.full(len(chosen), -np.inf)
        while np.max(steps_m) > _FINE_M and limit_clock() < deadline:
            turned = grid @ Rotation.random(rng=random).as_matrix()
            around_m = chosen[:, None] + steps_m[:, None, None] * turned
            around_m = np.clip(around_m, domain.low_m, domain.high_m).reshape(-1, 3)
            gains = [_gains_at(course, t, around_m) for t in range(len(course.times_s))]
            totals = fold(gains, axis=0).reshape(len(chosen), -1)
            top = np.argmax(totals, axis=1)
            is_better = np.max(totals, axis=1) > best
            chosen[is_better] = around_m.reshape(len(chosen), -1, 3)[is_better, top[is_better]]
            steps_m = np.where(is_better & (top != len(grid) // 2), steps_m, 0.5 * steps_m)
            best = np.maximum(best, np.max(totals, axis=1))
            order = np.argsort(-best, kind="stable")[: max(_KEPT, len(best) - 1)]
            chosen, steps_m, best = chosen[order], steps_m[order], best[order]
        return chosen

    def _stages(self, strides: float) -> tuple[IntArray, NDArray[np.bool_]]:
        """Choose instants so far apart that a path may turn; tell which positions are in reach, (m, m)."""
        reach_m, last = self.course.reach_m, len(self.gains) - 1
        stride = math.ceil(strides * self.step_m / max(_CLEAR_M, INSIDE * float(np.median(reach_m))))
        stages = np.unique(np.append(np.arange(0, last, min(stride, last)), last))
        legs_m = np.diff(np.append(0.0, np.cumsum(reach_m))[stages])
        return stages, self.apart_m <= INSIDE * float(np.min(legs_m))


def _grid(course: Course, places_m: FloatArray) -> tuple[FloatArray, float]:
    """Return the positions of a lattice over the ground around places, in two layers, and its step."""
    domain = course.families[0].domain
    low = np.maximum(places_m.min(axis=0)[:2] - _FINEST_M, domain.low_m[:2])
    high = np.maximum(low, np.minimum(places_m.max(axis=0)[:2] + _FINEST_M, domain.high_m[:2]))
    step_m = max(_FINEST_M, math.sqrt(2.0 * float(np.prod(high - low + _FINEST_M)) / _POINTS))
    axes = [np.linspace(a, b, 1 + math.ceil((b - a) / step_m)) for a, b in zip(low, high, strict=True)]
    layers = np.unique([domain.low_m[2], min(domain.high_m[2], domain.low_m[2] + step_m)])
    return np.stack(np.meshgrid(*axes, layers), axis=-1).reshape(-1, 3), step_m


def _gains_at(course: Course, t: int, points_m: FloatArray) -> FloatArray:
    return course.aim.gains(likely_poses(course, t, points_m)[1])


def _ways_m(course: Course, points_m: FloatArray, ends: int) -> FloatArray:
    """Return the lengths of straight ways, (m, m); the last points are ends, which may lie on a border."""
    apart_m = np.linalg.norm(points_m[:, None] - points_m, axis=2)
    domain = course.families[0].domain
    if len(domain.piece_start) > 1:
        starts, ends_of = np.nonzero(apart_m <= float(np.max(course.reach_m)) + _LONGEST * _FINEST_M)
        none = np.empty((len(starts), 0, 3))
        spaces = half_spaces(domain, points_m[starts], points_m[ends_of], none, none, 0.0)
        inner = np.maximum(starts, ends_of) < len(points_m) - ends
        clear = np.all(spaces.slacks_m > np.where(inner, _CLEAR_M, -_ON_BORDER_M)[:, None], axis=1)
        apart_m[starts[~clear], ends_of[~clear]] = np.inf
    return np.asarray(apart_m)
