"""The local maximum that a trajectory leads to, by an interior-point method over all of its poses at once.

``maximise sum_t gain(z_t)``, or one level z for all instants, subject to ``log ratio_k(p_t, u_t) >= z_t``,
to what the airspace allows at the instants and along the segments, and to ``|p_{t+1} - p_t| <= v dt``.
Its Newton system has a block for each instant and one for each step: a band.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from nullpose.objectives import FloatArray
from nullpose.problem.family import Family
from nullpose.problem.records import Domain
from nullpose.solver.compiling import limit_clock
from nullpose.solver.trajectory.course import Course
from nullpose.solver.trajectory.segments import half_spaces

_FALL = 0.2  # of the barrier's weight, from one to the next
_STEPS = 40  # of Newton's method at each
_NEAR_M, _LONGEST_M = 12.0, 5.0  # obstacles that count, and the longest move of a step
_HALVINGS = 12
_ENOUGH = 0.02  # of the barrier's weight: gains below end Newton's method


@dataclass(frozen=True, eq=False)
class _Model:
    """The barrier problem around a trajectory.

    Args:
        poses: (t, 6) positions and axes.
        levels: (t,) of the instants.
        value: of the barrier.
        directions: (t, 5, 6) change of a pose by each search variable.
        system: (t, 6, 6) minus the second derivatives within an instant, by its variables and its level.
        across: (t - 1, 6, 6) those between an instant and the one before.
        gradient: (t, 6).
    """

    poses: FloatArray
    levels: FloatArray
    value: float
    directions: FloatArray
    system: FloatArray
    across: FloatArray
    gradient: FloatArray


class Climb:
    """A climb from one trajectory.

    Args:
        course: the problem.
        poses: (t, 6) positions and axes to begin with, strictly inside of what is allowed.
        turns_only: whether the positions stay as they are.
    """

    def __init__(self, course: Course, poses: FloatArray, *, turns_only: bool = False) -> None:
        from nullpose.solver.kernels.compiler.jit import entry_of
        from nullpose.solver.kernels.search import flight
        from nullpose.solver.kernels.search.local_coordinates import move

        self.course, self.poses, self.mu = course, poses, 1.0
        self.value_pose, self.model_pose = entry_of(flight.value_pose), entry_of(flight.model_pose)
        self.move, self.axes = entry_of(move), course.field.arrays
        self.points_m = np.stack([family.ratios.points_m for family in course.families])
        self.domains: list[Domain] = []
        ends = (0, course.ends_m[0]), (len(poses) - 1, course.ends_m[1])
        self.held = {t: place_m for t, place_m in ends if place_m is not None}
        if turns_only:
            self.held = dict(enumerate(poses[:, :3]))

    def run(self, mu_start: float, mu_end: float, deadline: float = math.inf) -> FloatArray:
        """Climb until the barrier's weight has fallen to its end, or to a deadline; return the poses."""
        self.mu = mu_start
        while True:
            self._to_stationary()
            if self.mu <= mu_end or limit_clock() > deadline:
                return self.poses
            self.mu = max(mu_end, _FALL * self.mu)

    def prices(self) -> FloatArray:
        """Return the multipliers of the speed limit at the end, as vectors, (t - 1, 3): gain by metre."""
        steps_m = np.diff(self.poses[:, :3], axis=0)
        gaps = self.course.reach_m**2 - np.sum(steps_m**2, axis=1)
        return np.asarray(2.0 * self.mu * steps_m / gaps[:, None])

    def multipliers(self) -> list[FloatArray]:
        """Return those of the ratios at each instant, which sum to one there, or over all instants."""
        each = [
            self._values(family, domain, pose)
            for family, domain, pose in zip(self.course.families, self.domains, self.poses, strict=True)
        ]
        logs = [values[rows] for values, rows in each]
        return [self.mu / (reached - level) for reached, level in zip(logs, self._levels(logs), strict=True)]

    def _to_stationary(self) -> None:
        self._update_domains()
        model, drift_m = self._model(self.poses), 0.0
        for _ in range(_STEPS):
            if model is None:
                return
            moved = self._step(model)
            if moved is None:
                return
            gained = moved.value - model.value
            drift_m += float(np.max(np.linalg.norm(moved.poses[:, :3] - self.poses[:, :3], axis=1)))
            model, self.poses = moved, moved.poses
            if gained < _ENOUGH * self.mu:
                return
            if drift_m > _LONGEST_M:  # those that were left out may have come near
                self._update_domains()
                model, drift_m = self._model(self.poses), 0.0

    def _update_domains(self) -> None:
        """Choose the half spaces that keep the segments clear."""
        places_m, families = self.poses[:, :3], self.course.families
        domain, radius_m = families[0].domain, families[0].domain.keep_out_m
        spaces = half_spaces(
            domain, places_m[:-1], places_m[1:], self.points_m[:-1], self.points_m[1:], radius_m
        )
        near, count = spaces.slacks_m < _NEAR_M, len(places_m)
        planes = [
            np.dstack([np.zeros(near.shape), spaces.normals, offsets])
            for offsets in (spaces.starts, spaces.ends)
        ]
        none, self.domains = np.zeros((0, 5)), []
        for t in range(count):
            is_held = t in self.held  # which may be on a border
            after = none if is_held or t == count - 1 else planes[0][t, near[t]]
            before = none if is_held or t == 0 else planes[1][t - 1, near[t - 1]]
            sides = np.concatenate([before, after])
            low_m, high_m = self.held.get(t, domain.low_m), self.held.get(t, domain.high_m)
            # pieces have one side each; balls and zones are among them
            self.domains.append(
                Domain(low_m, high_m, np.zeros((0, 3)), radius_m, np.arange(len(sides) + 1), sides)
            )

    def _model(self, poses: FloatArray) -> _Model | None:
        """Model the barrier problem around poses; None where one is not strictly inside."""
        course, count = self.course, len(poses)
        steps_m = np.diff(poses[:, :3], axis=0)
        gaps = course.reach_m**2 - np.sum(steps_m**2, axis=1)
        if not np.all(gaps > 0.0):
            return None
        each = [
            self._values(family, domain, pose)
            for family, domain, pose in zip(course.families, self.domains, poses, strict=True)
        ]
        if not np.all(np.concatenate([values for values, _ in each]) > -math.inf):
            return None
        levels = self._levels([values[rows] for values, rows in each])
        directions, system = np.zeros((count, 5, 6)), np.zeros((count, 6, 6))
        gradient, value = np.zeros((count, 6)), 0.0
        for t, (family, domain) in enumerate(zip(course.families, self.domains, strict=True)):
            _, inside = self.model_pose(
                family.ratios,
                domain,
                self.axes,
                poses[t],
                each[t][0],
                levels[t],
                self.mu,
                directions[t],
                system[t],
                gradient[t],
            )
            value += inside
        if not value > -math.inf:
            return None
        system += np.tril(system, -1).transpose(0, 2, 1)
        scale = self.mu / gaps
        value += float(self.mu * np.sum(np.log(gaps / course.reach_m**2)))
        bend = 2.0 * scale[:, None, None] * np.eye(3) + np.einsum(
            "t,ti,tj->tij", 4.0 * scale / gaps, steps_m, steps_m
        )
        moves = directions[:, :, :3]
        pull = -2.0 * scale[:, None] * steps_m  # the gradient by the later position
        gradient[1:, :5] += np.einsum("tai,ti->ta", moves[1:], pull)
        gradient[:-1, :5] -= np.einsum("tai,ti->ta", moves[:-1], pull)
        system[1:, :5, :5] += np.einsum("tai,tij,tbj->tab", moves[1:], bend, moves[1:])
        system[:-1, :5, :5] += np.einsum("tai,tij,tbj->tab", moves[:-1], bend, moves[:-1])
        across = np.zeros((count - 1, 6, 6))
        across[:, :5, :5] = -np.einsum("tai,tij,tbj->tab", moves[1:], bend, moves[:-1])
        if course.aim.is_worst:
            value += levels[0]
        else:
            slope, curve = course.aim.slopes(levels)
            value += float(np.sum(course.aim.gains(levels)))
            gradient[:, 5] += slope
            system[:, 5, 5] -= curve
        return _Model(poses, levels, value, directions, system, across, gradient)

    def _values(self, family: Family, domain: Domain, pose: FloatArray) -> tuple[FloatArray, slice]:
        ratios = family.ratios
        rows = len(ratios.numerator_point) + len(ratios.pairs) + (len(ratios.shares) > 0)
        values = np.empty(rows + 8 + len(domain.piece_sides))
        first, last = self.value_pose(ratios, domain, self.axes, pose, values)
        return values, slice(first, last)

    def _levels(self, logs: list[FloatArray]) -> FloatArray:
        """Return the best level of each instant, or the one of all."""
        from nullpose.solver.kernels.linear_algebra.barrier import best_level

        if self.course.aim.is_worst:
            return np.full(len(logs), best_level(np.concatenate(logs), self.mu))
        return np.array([best_level(each, self.mu) for each in logs])

    def _step(self, model: _Model) -> _Model | None:
        """Take Newton's step, shortened until the barrier rises; None if none does."""
        step = self._newton(model)
        moves_m = np.einsum("ta,tai->ti", step[:, :5], model.directions[:, :, :3])
        slope = float(np.sum(step * model.gradient))
        share = min(1.0, _LONGEST_M / max(1e-12, float(np.max(np.linalg.norm(moves_m, axis=1)))))
        share = min(share, 0.7 / max(1e-12, float(np.max(np.abs(step[:, :5])))))
        for _ in range(_HALVINGS):
            poses = np.empty_like(model.poses)
            for t in range(len(poses)):
                self.move(self.axes, model.poses[t], model.directions[t], 5, step[t], share, poses[t])
            moved = self._model(poses)
            if moved is not None and moved.value >= model.value + 1e-4 * share * slope:
                return moved
            share *= 0.4
        return None

    def _newton(self, model: _Model) -> FloatArray:
        """Solve for Newton's step, shifted until it climbs, (t, 6)."""
        count = len(model.poses)
        system, right = model.system.copy(), model.gradient.copy()
        border = np.zeros((count, 6))
        if self.course.aim.is_worst:  # one level for all borders the band
            border[:, :5], corner = system[:, :5, 5], float(np.sum(system[:, 5, 5]))
            rest = 1.0 + float(np.sum(right[:, 5]))
            system[:, 5, :], system[:, :, 5], right[:, 5] = 0.0, 0.0, 0.0
        diagonal = np.abs(np.einsum("tii->ti", model.system))
        idle = np.einsum("tii->ti", system) == 0.0
        system[:, np.arange(6), np.arange(6)] += idle
        shift = 0.0
        while True:
            system_shifted = system.copy()
            system_shifted[:, np.arange(5), np.arange(5)] += shift * (1.0 + diagonal[:, :5])
            try:
                both = _solve_band(system_shifted, model.across, np.stack([right, border], axis=-1))
            except LinAlgError:
                shift = max(1e-4, 8.0 * shift)
                continue
            if not self.course.aim.is_worst:
                return both[..., 0]
            left = corner - float(np.sum(border * both[..., 1]))
            if left > 0.0:
                level = (rest - float(np.sum(border * both[..., 0]))) / left
                return both[..., 0] - level * both[..., 1]
            shift = max(1e-4, 8.0 * shift)


def _solve_band(system: FloatArray, across: FloatArray, right: FloatArray) -> FloatArray:
    """Solve with a block tridiagonal matrix, (t, 6, 6) and (t - 1, 6, 6), for (t, 6, k)."""
    count, size = len(system), 6
    band = np.zeros((2 * size, count, size))
    for a in range(size):
        for b in range(a + 1):
            band[a - b, :, b] = system[:, a, b]
        for b in range(size):
            band[size + a - b, :-1, b] = across[:, a, b]
    flat = right.reshape(count * size, -1)
    solved = solveh_banded(band.reshape(2 * size, -1), flat, lower=True, check_finite=False)
    return np.asarray(solved.reshape(right.shape))
