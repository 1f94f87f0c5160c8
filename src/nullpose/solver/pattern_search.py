"""Multistart search for the best pose of an antenna with a pattern."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from nullpose.antenna import PatternAntenna
from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.problem.records import Reach
from nullpose.solver.multistart import multistart

_THOROUGH = 30_000, 800, 10  # poses judged, climbed from and polished, where no proof follows
_LIGHT = 6_000, 120, 4  # where one does, which repairs what this misses
_LIGHT_ROUND = 1_500, 30, 2  # likewise, for an antenna that is the same all round
_FEW = 12  # degree up to which lobes are few
_WANDERED = 600  # random steps of a climb
_NEAR = 0.2  # radians, and as much of the scene, that the last part of a climb moves at most
_NOT_HEARD = -1e3  # logarithm of a ratio, in place of minus infinity
_STEP = 1e-6  # of differences: radians, or the share of the scene's size


class PatternSearch:
    """The best pose found so far, and how to find better ones.

    Args:
        family: ratios and domain.
        antenna: its pattern.
        reach: the attitudes there are.
        seed: of the poses drawn.
    """

    def __init__(self, family: Family, antenna: PatternAntenna, reach: Reach, seed: int) -> None:
        self.family, self.arrays, self.reach = family, antenna.arrays, reach
        # with the largest gain in every direction
        self.loudest = family.changed(numerator_weight=family.numerator_weight * antenna.peak)
        self.lowest = antenna.lowest
        self.rng = np.random.default_rng(seed)
        self.noise = self.rng.normal(size=(_WANDERED, 6))
        self.best, self.starts, self.evaluations = -math.inf, 0, 0
        self.pose = np.zeros(3), np.eye(3)
        self.links, self.logs = np.empty(len(family.points_m)), np.empty(len(family.numerator_point))

    def compile(self) -> None:
        """Compile what a search and a proof need."""
        from nullpose.solver.kernels import attitude, pattern_branch, pattern_search, search

        self.kernels, self.cut = pattern_search, search.cut_box
        self.judged(np.ones((1, 3)), np.eye(3)[None])
        self._climbed(np.ones(3), self.reached(np.eye(3)))
        self.box(0.0)
        scratch = np.ones(3), np.eye(3), self.links, self.logs
        pattern_search.fill_log_ratios(self.family.arrays, self.arrays, *scratch)
        none, pose = np.empty((8, attitude.WARM + len(self.logs))), (np.empty(3), np.empty((3, 3)))
        problem = self.family.arrays, self.family.domain, self.arrays, self.reach
        pattern_branch.branch_pattern(*problem, 1.0, 1.0, False, none, 0, none, 0, 1, *pose)
        self.evaluations = 0

    def box(self, log_value: float) -> tuple[FloatArray, FloatArray]:
        """Return corners of a box outside which no pose reaches a value.

        Args:
            log_value: logarithm of the smallest ratio.
        """
        low_m, high_m = np.empty(3), np.empty(3)
        self.cut(self.loudest.arrays, self.family.low_m, self.family.high_m, log_value - 1e-9, low_m, high_m)
        return low_m, high_m

    def judged(self, positions_m: FloatArray, rotations: FloatArray) -> FloatArray:
        """Return the smallest log ratio of many poses, minus infinity for positions that are not allowed.

        Args:
            positions_m: (n, 3).
            rotations: (n, 3, 3) to the world from the antenna's axes.
        """
        values = np.empty(len(positions_m))
        problem = self.family.arrays, self.family.domain, self.arrays
        self.kernels.judge(*problem, positions_m, rotations, self.links, self.logs, values)
        self.evaluations += len(positions_m)
        return values

    def run(self, *, light: bool) -> bool:
        """Draw poses, and polish the best of them; return whether these were few.

        Args:
            light: whether few are enough, since a proof follows; not for an antenna of many lobes.
        """
        lobes = max(1, self.arrays.cosine.shape[0] // _FEW)  # of which most climbs lead to a small one
        light = light and lobes == 1
        few = _LIGHT_ROUND if self.reach.spins else _LIGHT
        drawn, climbs, polished = few if light else (lobes * count for count in _THOROUGH)
        points = self.family.points_m
        margin = float(np.max(np.ptp(points, axis=0))) + 10.0 * self.family.keep_out_m
        widest_m = points.min(axis=0) - margin, points.max(axis=0) + margin
        low_m, high_m = (
            np.maximum(self.family.low_m, widest_m[0]),
            np.minimum(self.family.high_m, widest_m[1]),
        )
        for _ in range(2):  # the second time in a box that the first has made small
            positions_m = low_m + (high_m - low_m) * self.rng.uniform(size=(drawn, 3))
            positions_m[::2, 2] = low_m[2]  # the optimum is often on the floor
            rotations = self._attitudes(drawn)
            rotations[1::2] = self.reached(self._nulled(positions_m[1::2]))
            values = self.judged(positions_m, rotations)
            if not np.any(np.isfinite(values)):  # a narrow airspace: begin where a dipole would be
                positions_m[:] = multistart(self.family, AxisField.free(), seed=0).position_m
                values = self.judged(positions_m, rotations)
            climbed = np.argsort(-values)[: min(climbs, int(np.isfinite(values).sum()))]
            for k in climbed:
                values[k] = self._climbed(positions_m[k], rotations[k])
            for k in climbed[np.argsort(-values[climbed])][:polished]:
                self.polish(positions_m[k], rotations[k])
            if not math.isfinite(self.best):
                break
            low_m, high_m = self.box(self.best)
            low_m, high_m = np.maximum(low_m, widest_m[0]), np.minimum(high_m, widest_m[1])
            high_m = np.maximum(low_m, high_m)
        return light

    def _attitudes(self, count: int) -> FloatArray:
        """Return rotations that the airframe reaches, (count, 3, 3)."""
        free = Rotation.random(count, random_state=self.rng).as_matrix()
        if self.reach.tilt_max_rad >= math.pi:
            return np.asarray(free)
        tilt = (
            self.reach.tilt_max_rad * self.rng.uniform(size=count) * self.rng.choice([0.0, 1.0], size=count)
        )
        yaw, towards = self.rng.uniform(-math.pi, math.pi, (2, count))
        body = Rotation.from_euler("ZYZ", np.stack([towards, tilt, yaw - towards], axis=1)).as_matrix()
        return np.asarray(body @ Rotation.from_euler("y", self.reach.mount_rad).as_matrix())

    def _climbed(self, position_m: FloatArray, rotation: FloatArray) -> float:
        """Climb from a pose by random steps, changing it in place; return the smallest log ratio there."""
        position_m[:] = np.clip(position_m, self.family.low_m, self.family.high_m)
        problem = self.family.arrays, self.family.domain, self.arrays, self.reach
        scratch = self.links, self.logs, np.empty(3), np.empty((3, 3))
        self.evaluations += len(self.noise)
        return float(
            self.kernels.wander(
                *problem, self.noise, self._scale_m(position_m), position_m, rotation, *scratch
            )
        )

    def _scale_m(self, position_m: FloatArray) -> float:
        """Return the metres that count as much as a radian."""
        return max(1.0, float(np.linalg.norm(position_m - self.family.points_m[0])))

    def _nulled(self, positions_m: FloatArray) -> FloatArray:
        """Return rotations that have the strongest interferer, or the first point, where the gain is low."""
        weights = self.family.denominator_weight
        strongest = self.family.denominator_point[np.argmax(weights)] if len(weights) else 0
        to_strongest_m = self.family.points_m[strongest] - positions_m
        spins = Rotation.from_rotvec(
            np.outer(self.rng.uniform(-math.pi, math.pi, len(to_strongest_m)), [0.0, 0.0, 1.0])
        )
        chosen = self.lowest[self.rng.integers(len(self.lowest), size=len(to_strongest_m))]
        return np.asarray(_frames(to_strongest_m) @ spins.as_matrix() @ _frames(chosen).transpose(0, 2, 1))

    def improve(self, position_m: FloatArray, rotation: FloatArray) -> bool:
        """Take up a pose, and what a climb from there leads to; return whether that is better than before.

        Args:
            position_m: (3,).
            rotation: (3, 3) to the world from the antenna's axes.
        """
        before = self.best
        rotation = self.reached(rotation)
        self.take(position_m, rotation)
        self.polish(position_m, rotation)
        return self.best > before

    def take(self, position_m: FloatArray, rotation: FloatArray) -> None:
        """Keep a pose if it is allowed and the best so far.

        Args:
            position_m: (3,).
            rotation: (3, 3) to the world from the antenna's axes, one that is reached.
        """
        value = float(self.judged(position_m[None], rotation[None])[0])
        if value > self.best:
            self.best, self.pose = value, (position_m, rotation)

    def reached(self, rotation: FloatArray) -> FloatArray:
        """Return the nearest rotation that the airframe reaches, exact to rounding.

        Args:
            rotation: (3, 3) to the world from the antenna's axes, or many, (n, 3, 3).
        """
        nearest = np.array(rotation, order="C")
        for each in nearest.reshape(-1, 3, 3):
            self.kernels.bring_within_reach(self.reach, each)
        return nearest

    def least_tilted(self, rotation: FloatArray) -> FloatArray:
        """Return the rotation of the same gains and the least tilt.

        Args:
            rotation: (3, 3) to the world from the antenna's axes.
        """
        if not self.reach.spins or self.reach.tilt_max_rad >= math.pi:
            return rotation
        axis = -rotation[:, 2] if self.reach.even and rotation[2, 2] < 0.0 else rotation[:, 2]
        level = math.hypot(axis[0], axis[1])
        side = np.array([-axis[1], axis[0], 0.0]) / level if level > 0.0 else np.array([0.0, 1.0, 0.0])
        return np.stack([np.cross(side, axis), side, axis], axis=1)

    def polish(self, position_m: FloatArray, rotation: FloatArray) -> None:
        """Climb from a pose: by random steps, then by sequential quadratic programming.

        Args:
            position_m: (3,).
            rotation: (3, 3).
        """
        position_m, rotation = position_m.copy(), np.array(rotation, order="C")
        self._climbed(position_m, rotation)
        rotation = self.reached(rotation)
        self.take(position_m, rotation)
        low_m, high_m, scale = self.family.low_m, self.family.high_m, self._scale_m(position_m)
        logs = np.empty((7, len(self.logs)))

        def pose(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            where = np.clip(position_m + scale * x[:3], low_m, high_m)
            return where, self.reached(rotation @ Rotation.from_rotvec(x[3:6]).as_matrix())

        def ratios(x: FloatArray) -> FloatArray:
            self.kernels.fill_log_ratios(self.family.arrays, self.arrays, *pose(x), self.links, logs[0])
            self.evaluations += 1
            return np.asarray(np.maximum(logs[0], _NOT_HEARD))

        def slopes(x: FloatArray) -> FloatArray:
            found = np.empty((len(self.logs), 7))
            for i in range(6):
                step = np.zeros(7)
                step[i] = _STEP
                found[:, i] = (ratios(x + step).copy() - ratios(x - step)) / (2.0 * _STEP)
            found[:, 6] = -1.0
            return found

        level = float(np.min(ratios(np.zeros(7))))
        if level <= _NOT_HEARD:
            return
        constraints: list[Any] = [
            {"type": "ineq", "fun": lambda x: ratios(x).copy() - x[6] - level, "jac": slopes}
        ]
        ends = [
            (max(-_NEAR, (a - p) / scale), min(_NEAR, (b - p) / scale))
            for a, b, p in zip(low_m, high_m, position_m, strict=True)
        ]
        found = minimize(
            lambda x: -x[6],
            np.zeros(7),
            jac=lambda x: np.array([0.0] * 6 + [-1.0]),
            bounds=[*ends, *[(-_NEAR, _NEAR)] * 3, (None, None)],
            constraints=constraints,
            method="SLSQP",
            options={"maxiter": 60, "ftol": 1e-10},
        )
        self.starts += 1
        where, turned = pose(found.x)
        self.take(where, turned)

    @property
    def anchor(self) -> int:
        """Index of the point that the cells are aligned with: the one that sways the value most."""
        weight = np.zeros(len(self.family.points_m))
        np.add.at(weight, self.family.numerator_point, self.family.numerator_weight)
        weight /= len(self.family.numerator_point) * math.exp(self.best)
        np.add.at(weight, self.family.denominator_point, self.family.denominator_weight)
        squares = np.sum((self.family.points_m - self.pose[0]) ** 2, axis=1)
        return int(np.argmax(weight / squares))


def _frames(third: FloatArray) -> FloatArray:
    """Return rotations whose third columns are along given vectors, (n, 3, 3)."""
    w = third / np.linalg.norm(third, axis=1, keepdims=True)
    least = np.eye(3)[np.argmin(np.abs(w), axis=1)]
    u = np.cross(least, w)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return np.stack([u, np.cross(w, u), w], axis=2)
