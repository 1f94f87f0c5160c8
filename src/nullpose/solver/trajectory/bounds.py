"""Bounds that no trajectory exceeds: the best at each instant, and for the worst a few instants at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import SolveError
from nullpose.objectives import FloatArray
from nullpose.solver.compiling import limit_clock
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import Outcome, solve_and_prove
from nullpose.solver.trajectory.course import Course
from nullpose.solver.trajectory.search import Flight

_OPTIMUM_GAP = 1e-3  # of the best at one instant, where the gap asked for is not finer
_SHARE = 0.1  # of the gap asked for, at an instant
_LEAST_WEIGHT = 1e-2  # of an instant that counts, over the largest
_PARTS = 16  # of one box, at most, and room
_MOST_BOXES = 20_000  # at one instant
_TRIES = 6  # levels between the best trajectory and the best at each instant


@dataclass(frozen=True, eq=False)
class Clairvoyant:
    """The best pose at each instant, if the vehicle could be anywhere: no trajectory has more.

    Args:
        poses: (t, 6) positions and axes.
        logs: (t,) log ratios there.
        bounds: (t,) no pose has more at the instant.
        multipliers: of the ratios at each optimum.
    """

    poses: FloatArray
    logs: FloatArray
    bounds: FloatArray
    multipliers: list[FloatArray] = field(repr=False)


def clairvoyant(course: Course, gap: float, go_on: Callable[[int], None], deadline: float) -> Clairvoyant:
    """Solve each instant alone.

    Args:
        course: the problem.
        gap: nats, asked for.
        go_on: called with how many are done.
        deadline: on ``limit_clock``.

    Raises:
        SolveError: there is no pose at an instant.
    """
    outcomes: list[Outcome] = []
    for family in course.families:
        left_s = max(1e-3, (deadline - limit_clock()) / (len(course.families) - len(outcomes)))
        options = SolveOptions(gap=min(_OPTIMUM_GAP, math.expm1(_SHARE * gap)), time_limit_s=left_s)
        try:
            outcomes.append(solve_and_prove(family, [course.field], options))
        except SolveError as error:
            raise type(error)(f"at t = {course.times_s[len(outcomes)]:g} s: {error}") from None
        go_on(len(outcomes))
    found = [each.incumbent for each in outcomes]
    return Clairvoyant(
        poses=np.array([np.concatenate([each.position_m, each.axis]) for each in found]),
        logs=np.array([each.log_value for each in found]),
        bounds=np.log([float(each.upper_bound or math.inf) for each in outcomes]),
        multipliers=[each.multipliers for each in found],
    )


class KeyInstants:
    """Boxes of positions at some instants at which a level may be kept, on a trajectory through all of them.

    A trajectory that keeps the level is in one box at each of these instants, and from each to the next no
    farther than its speed lets it. Boxes that one level excludes, or from which none at the instant before
    or after is in reach, are dropped; once an instant has none left, no trajectory keeps the level.

    Args:
        course: the problem.
        best: the best at each instant.
        chosen: indices of the instants, in order.
        multipliers: of the ratios at each of them, tried on every box.
    """

    def __init__(
        self, course: Course, best: Clairvoyant, chosen: list[int], multipliers: dict[int, FloatArray]
    ) -> None:
        self.course, self.best, self.chosen, self.multipliers = course, best, chosen, multipliers
        metres = np.append(0.0, np.cumsum(course.reach_m))
        self.legs_m = np.diff(metres[chosen])

    def excludes(self, log_level: float, deadline: float) -> bool:
        """Check that no trajectory keeps a level; False where that is not shown in time."""
        from nullpose.solver.kernels.bounds.node import HALF

        boxes = [self._root(t, log_level) for t in self.chosen]
        if not np.all(np.isfinite(boxes)):  # far away nothing is excluded
            return False
        while all(len(each) for each in boxes):
            if limit_clock() > deadline:
                return False
            # the instant with the largest boxes is next, of those that have not too many
            sizes = [
                float(np.max(each[:, HALF : HALF + 3])) * len(each) ** (1 / 3) * (len(each) < _MOST_BOXES)
                for each in boxes
            ]
            which = int(np.argmax(sizes))
            if not sizes[which] > 0.0:
                return False
            boxes[which] = self._sifted(which, log_level, boxes[which])
            self._drop_unreachable(boxes, which)
        return True

    def _root(self, t: int, log_level: float) -> FloatArray:
        from nullpose.solver.kernels.bounds import node
        from nullpose.solver.kernels.bounds.root import fill_root

        family, row = self.course.families[t], np.zeros(node.COLUMNS)
        weights = self.multipliers.get(t, self.best.multipliers[t]).copy()
        fill_root(
            family.ratios,
            family.domain,
            log_level,
            0.0,
            math.inf,
            weights,
            self.best.poses[t, 3:].copy(),
            row,
        )
        for place, end_m in (
            (0, self.course.ends_m[0]),
            (len(self.course.times_s) - 1, self.course.ends_m[1]),
        ):
            if t == place and end_m is not None:
                row[node.CENTRE : node.HALF], row[node.HALF : node.LEVEL] = end_m, 0.0
        return row[None]

    def _sifted(self, which: int, log_level: float, rows: FloatArray) -> FloatArray:
        """Split the boxes that the level does not exclude."""
        from nullpose.solver.kernels.bounds.branch import branch
        from nullpose.solver.kernels.bounds.records import Goal
        from nullpose.solver.kernels.compiler.jit import entry_of

        t = self.chosen[which]
        family, goal = self.course.families[t], Goal(math.inf, self._root(t, log_level)[0], 0.0)
        problem = family.ratios, family.domain, self.course.field.arrays, math.exp(log_level), goal
        kernel, stack, leaf = (
            entry_of(branch),
            np.empty((_PARTS, rows.shape[1])),
            np.empty((1, rows.shape[1])),
        )
        none, parts = np.empty(3), [rows[:0]]
        for row in rows:  # each as a run of one box, which leaves its parts
            stack[0] = row
            _, top, *_ = kernel(*problem, stack, 1, leaf, 0, 1, none, none)
            parts.append(stack[:top].copy())
        return np.vstack(parts)

    def _drop_unreachable(self, boxes: list[FloatArray], which: int) -> None:
        """Drop boxes out of reach of all at the next instant and the one before, outwards from one."""
        last = len(boxes) - 1
        ahead = [(i, i + 1) for i in range(which, last)] + [(i, i - 1) for i in range(which, 0, -1)]
        for i, other in [(j, i) for i, j in ahead] + ahead[::-1]:  # outwards from it, and back
            if len(boxes[i]) and len(boxes[other]):
                boxes[i] = self._near(boxes[i], boxes[other], self.legs_m[min(i, other)])

    def _near(self, rows: FloatArray, others: FloatArray, reach_m: float) -> FloatArray:
        from nullpose.solver.kernels.bounds.reach import keep_near

        keep: NDArray[np.bool_] = np.ones(len(rows), dtype=np.bool_)
        keep_near(rows, others, float(reach_m), keep)
        return rows[keep]


def worst_bound(
    course: Course,
    flight: Flight,
    best: Clairvoyant,
    gap: float,
    deadline: float,
    on_bound: Callable[[Flight, float], None],
) -> None:
    """Bound the worst instant of any trajectory by a few instants: the level asked for, or one between.

    Args:
        course: the problem.
        flight: the best so far, with multipliers.
        best: the best at each instant.
        gap: asked for, nats.
        deadline: on ``limit_clock``.
        on_bound: called with the flight and each bound.
    """
    assert flight.multipliers is not None
    weights = np.array([float(np.sum(each)) for each in flight.multipliers])
    chosen = [int(t) for t in np.flatnonzero(weights > _LEAST_WEIGHT * np.max(weights))]
    keys = KeyInstants(course, best, chosen, {t: flight.multipliers[t] for t in chosen})
    low, high = flight.score + gap, course.aim.score(best.bounds)
    level = low
    for left in range(_TRIES, 0, -1):
        if keys.excludes(level, limit_clock() + (deadline - limit_clock()) / left):
            high = level
            on_bound(flight, high)
        else:
            low = level
        if high <= flight.score + gap or limit_clock() > deadline:
            return
        level = 0.5 * (low + high)
