"""The search for all that is no quadratic link: random states, and climbs from the best of them.

Arrays, antennas with a pattern and objectives that are known by their values alone are searched so.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import lru_cache

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.problem.airspace import loosened
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.multistart import BORDER_M, landmarks, multistart

_STEPS = 200
_SAME = 1e-10  # a climb that gains no more has ended
_PRECISION = 1e-13
_FARTHEST_RAD = 1.5  # that a climb turns at most
_LEAST = -1e3  # logarithm that counts for a ratio of zero
_CLEAR_M = 1e-9  # how far beyond a wall a position is put, more than the rounding of its coordinates
_REPAIRS = 50
_ROUNDING = 1e-9


class LocalSearch(ABC):
    """The best state found so far, and how to find better ones.

    A state begins with the position, (3,) metres.

    Args:
        family: the ratios for a gain of 1, and the domain.
        peak: the largest gain of the antenna in any direction.
        seed: of the states drawn.
    """

    def __init__(self, family: Family, peak: float, seed: int) -> None:
        self.family, self.rng = family, np.random.default_rng(seed)
        self.loudest = family.changed(numerator_weight=family.ratios.numerator_weight * peak)
        self.best, self.state, self.last = -math.inf, np.empty(0), np.empty(0)
        self.starts = self.evaluations = 0

    @abstractmethod
    def orient(self, positions_m: FloatArray) -> FloatArray:
        """Draw a state at each of some positions, (n, 3)."""

    @abstractmethod
    def judge(self, states: FloatArray) -> FloatArray:
        """Evaluate the smallest log ratio of states, (n,), minus infinity where a position is not allowed."""

    @abstractmethod
    def climb(self, state: FloatArray) -> float:
        """Climb to a local optimum, and keep it if it is the best so far; return its value."""

    def box(self, log_value: float) -> tuple[FloatArray, FloatArray]:
        """Return corners of a box outside which no state has its smallest log ratio above a value."""
        from nullpose.solver.kernels.search.search import cut_box

        low_m, high_m, domain = np.empty(3), np.empty(3), self.family.domain
        cut_box(self.loudest.ratios, domain.low_m, domain.high_m, log_value - _ROUNDING, low_m, high_m)
        return low_m, np.maximum(low_m, high_m)

    def run(self, drawn: int, climbed: int) -> float:
        """Draw states, climb from the best of them, and again where a better one can be.

        Args:
            drawn: how many states, each time.
            climbed: from how many of them.

        Returns:
            The best value that a climb ended at.
        """
        from nullpose.solver.kernels.search.domain import push_out

        points_m, ends = self.family.ratios.points_m, [-math.inf]
        around_m = float(np.max(np.ptp(points_m, axis=0))) + 10.0 * self.family.domain.keep_out_m
        places_m = [place for place in landmarks(self.family) if push_out(place, self.family.domain)]
        for _ in range(2):
            corners_m = self.box(self.best)
            low_m = np.clip(points_m.min(axis=0) - around_m, *corners_m)
            high_m = np.clip(points_m.max(axis=0) + around_m, *corners_m)
            positions_m = low_m + (high_m - low_m) * self.rng.uniform(size=(drawn, 3))
            positions_m[::2, 2] = low_m[2]  # the optimum is often on the floor
            positions_m[: len(places_m)] = places_m[:drawn] or positions_m[:0]
            states = self.orient(positions_m)
            if not np.any((values := self.judge(states)) > -math.inf):
                # a narrow airspace: begin where a dipole would be
                positions_m[:] = multistart(self.family, AxisField.free(), seed=0).position_m
                self.family = loosened(self.family, BORDER_M)
                states = self.orient(positions_m)
                values = self.judge(states)
            best = np.argsort(-values)[: min(climbed, np.count_nonzero(values > -math.inf))]
            ends += [self.climb(states[k]) for k in best]
        before = -math.inf
        while self.best > before + _SAME:  # along a curved ridge the steps of one climb may not suffice
            before = self.best
            ends.append(self.climb(self.state))
        return max(ends)

    def take(self, state: FloatArray) -> float:
        """Bring a state into the domain, and keep it if it is the best so far; return its value."""
        inside = state.copy()
        inside[:3] = self._repair(state[:3])
        self.last = inside
        if (value := float(self.judge(inside[None])[0])) > self.best:
            self.best, self.state = value, inside
        return value

    def _repair(self, position_m: FloatArray) -> FloatArray:
        """Move a position into the domain if it is a little outside."""
        from nullpose.solver.kernels.search.domain import walls

        low_m, high_m = self.family.domain.low_m, self.family.domain.high_m
        for _ in range(_REPAIRS):
            position_m = np.clip(position_m, low_m, high_m)
            distance_m, outwards = walls(self.family.domain, position_m)
            if not np.any(distance_m < 0.0):
                break
            worst = int(np.argmin(distance_m))
            position_m = position_m + (_CLEAR_M - distance_m[worst]) * outwards[worst]
        return np.clip(position_m, low_m, high_m)


class EpigraphSearch(LocalSearch):
    """A search that climbs by sequential quadratic programming: ``maximise t: f_k >= t``, outside of walls.

    A step has three shares of ``unit_m`` and then angles.
    """

    angles: int  # of a step
    steps = _STEPS  # of a climb at most

    @abstractmethod
    def move(self, state: FloatArray, step: FloatArray) -> FloatArray:
        """Move a state by a step."""

    @abstractmethod
    def ratios(self, state: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Evaluate the log ratios of a state moved by a step, (r,), and their slopes along it."""

    def unit_m(self, state: FloatArray) -> float:
        """Return the metres that count as much as a radian."""
        return max(1.0, float(np.linalg.norm(state[:3] - self.family.ratios.points_m[0])))

    def climb(self, state: FloatArray) -> float:
        """Climb to a local optimum, and keep it if it is the best so far; return its value."""
        from scipy.optimize import minimize

        from nullpose.solver.kernels.search.domain import walls

        value, unit_m, size = self.take(state), self.unit_m(state), 3 + self.angles

        @lru_cache(maxsize=1)
        def constraints(variables: bytes) -> tuple[FloatArray, FloatArray]:
            """Evaluate the constraints, none of which may be negative, and their slopes."""
            x = np.frombuffer(variables)
            logs, by_step = self.ratios(state, x[:size])
            distance_m, outwards = walls(self.family.domain, state[:3] + unit_m * x[:3])
            slopes = np.zeros((len(logs) + len(distance_m), size + 1))
            slopes[: len(logs), :size], slopes[: len(logs), size] = by_step, -1.0
            slopes[len(logs) :, :3] = outwards
            return np.concatenate([np.maximum(logs, _LEAST) - x[size], distance_m / unit_m]), slopes

        low_m, high_m = self.family.domain.low_m, self.family.domain.high_m
        sides = zip((low_m - state[:3]) / unit_m, (high_m - state[:3]) / unit_m, strict=True)
        uphill = np.append(np.zeros(size), -1.0)
        found = minimize(
            lambda x: -float(x[size]),
            np.append(np.zeros(size), max(value, _LEAST)),
            jac=lambda x: uphill,
            method="SLSQP",
            bounds=[*sides, *[(-_FARTHEST_RAD, _FARTHEST_RAD)] * self.angles, (None, None)],
            constraints={
                "type": "ineq",
                "fun": lambda x: constraints(x.tobytes())[0],
                "jac": lambda x: constraints(x.tobytes())[1],
            },
            options={"maxiter": self.steps, "ftol": _PRECISION},
        )
        self.starts += 1
        if np.all(np.isfinite(found.x)):
            value = max(value, self.take(self.move(state, found.x[:size])))
        return value
