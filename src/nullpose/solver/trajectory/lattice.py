"""Trajectories over a lattice of positions, by dynamic programming: where the search begins."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import FloatArray, IntArray
from nullpose.solver.trajectory.course import Course, likely_poses
from nullpose.solver.trajectory.segments import half_spaces

INSIDE = 0.98
"""Share of the speed limit that a start uses: the climb goes on from strictly inside."""
_POINTS = 700  # of the lattice, about
_FINEST_M = 4.0
_LONGEST = 8.0  # finest steps beyond the reach of an instant that a stride may have
_CLEAR_M = 1e-3


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
        return cls(course, points_m, gains, step_m, _ways_m(course, points_m))

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

    def best_place(self, is_worst: bool) -> FloatArray:
        """Return the position of the largest sum of gains, or of the largest least gain, (3,)."""
        values = np.min(self.gains, axis=0) if is_worst else np.sum(self.gains, axis=0)
        return np.asarray(self.points_m[np.argmax(values)])

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


def _ways_m(course: Course, points_m: FloatArray) -> FloatArray:
    apart_m = np.linalg.norm(points_m[:, None] - points_m, axis=2)
    domain = course.families[0].domain
    if len(domain.piece_start) > 1:
        starts, ends = np.nonzero(apart_m <= float(np.max(course.reach_m)) + _LONGEST * _FINEST_M)
        none = np.empty((len(starts), 0, 3))
        spaces = half_spaces(domain, points_m[starts], points_m[ends], none, none, 0.0)
        clear = np.all(spaces.slacks_m > _CLEAR_M, axis=1)
        apart_m[starts[~clear], ends[~clear]] = np.inf
    return np.asarray(apart_m)
