"""The search over positions and attitudes for an antenna with a pattern."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from nullpose.antenna import PatternAntenna
from nullpose.objectives import FloatArray
from nullpose.problem.family import Family
from nullpose.problem.records import AttitudeReach
from nullpose.solver.local_search import EpigraphSearch

_THOROUGH = 10_000, 60  # states drawn and climbed from, where no proof follows
_LIGHT = 4_000, 20  # where one does, which repairs what this misses
_LIGHT_ROUND = 1_500, 8  # likewise, for an antenna that is the same all round
_FEW = 12  # degree up to which lobes are few


class PatternSearch(EpigraphSearch):
    """A search over states: the position, and the rotation to the world from the antenna's axes row by row.

    Args:
        family: ratios and domain.
        antenna: its pattern.
        reach: the attitudes there are.
        seed: of the states drawn.
    """

    angles = 3

    def __init__(self, family: Family, antenna: PatternAntenna, reach: AttitudeReach, seed: int) -> None:
        super().__init__(family, antenna.peak, seed)
        self.pattern, self.lowest, self.reach = antenna.arrays, antenna.lowest, reach

    def search(self, *, light: bool) -> bool:
        """Find the best pose; tell whether the search was light.

        Args:
            light: whether few states are enough, since a proof follows; not for an antenna of many lobes.
        """
        lobes = max(1, self.pattern.cosine.shape[0] // _FEW)  # of which most climbs lead to a small one
        light = light and lobes == 1
        few = _LIGHT_ROUND if self.reach.spins else _LIGHT
        self.run(*(few if light else (lobes * count for count in _THOROUGH)))
        return light

    @property
    def pose(self) -> tuple[FloatArray, FloatArray]:
        """Position and rotation of the best state."""
        return self.state[:3], self.state[3:].reshape(3, 3)

    def improve(self, position_m: FloatArray, rotation: FloatArray) -> bool:
        """Take up a pose, and what a climb from there leads to; return whether that is better than before.

        Args:
            position_m: (3,).
            rotation: (3, 3) to the world from the antenna's axes.
        """
        before = self.best
        self.climb(np.append(position_m, self._bring_within_reach(rotation)))
        return self.best > before

    def orient(self, positions_m: FloatArray) -> FloatArray:
        """Draw a state at each of some positions."""
        rotations = self._draw_attitudes(len(positions_m))
        rotations[1::2] = self._aim_nulls(positions_m[1::2])
        return np.hstack([positions_m, self._bring_within_reach(rotations).reshape(-1, 9)])

    def judge(self, states: FloatArray) -> FloatArray:
        """Evaluate the smallest log ratio of states."""
        from nullpose.solver.kernels.search.pattern_search import judge

        values = np.empty(len(states))
        judge(self.family.ratios, self.family.domain, self.pattern, states, values)
        self.evaluations += len(states)
        return values

    def move(self, state: FloatArray, step: FloatArray) -> FloatArray:
        """Move a state by a step."""
        from nullpose.solver.kernels.search.pattern_search import move

        position_m, rotation = np.empty(3), np.empty((3, 3))
        move(self.reach, state, step, self.unit_m(state), position_m, rotation)
        return np.append(position_m, rotation)

    def ratios(self, state: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Evaluate the log ratios of a moved state, and their slopes."""
        from nullpose.solver.kernels.search.pattern_search import fill_slopes

        count = len(self.family.ratios.numerator_point)
        logs, slopes = np.empty(count), np.empty((count, 6))
        fill_slopes(
            self.family.ratios, self.pattern, self.reach, state, step, self.unit_m(state), logs, slopes
        )
        self.evaluations += 13
        return logs, slopes

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

    @property
    def anchor(self) -> int:
        """Index of the point that the cells are aligned with: the one that sways the value most."""
        weight = np.zeros(len(self.family.ratios.points_m))
        np.add.at(weight, self.family.ratios.numerator_point, self.family.ratios.numerator_weight)
        weight /= len(self.family.ratios.numerator_point) * math.exp(self.best)
        np.add.at(weight, self.family.ratios.denominator_point, self.family.ratios.denominator_weight)
        return int(np.argmax(self._heard(weight)))

    @property
    def interference(self) -> float:
        """The strongest interferer over the noise at the best position, for an isotropic gain of 1."""
        weight = np.zeros(len(self.family.ratios.points_m))
        np.add.at(weight, self.family.ratios.denominator_point, self.family.ratios.denominator_weight)
        return float(np.max(self._heard(weight)))

    def _heard(self, weight: FloatArray) -> FloatArray:
        """Evaluate weights of points, (m,) m², over squared distances from the best position."""
        return np.asarray(weight / np.sum((self.family.ratios.points_m - self.state[:3]) ** 2, axis=1))

    def _draw_attitudes(self, count: int) -> FloatArray:
        """Draw rotations that the airframe reaches, (count, 3, 3)."""
        if (tilt_max_rad := self.reach.tilt_max_rad) >= math.pi:
            return np.asarray(Rotation.random(count, random_state=self.rng).as_matrix())
        tilt = tilt_max_rad * self.rng.uniform(size=count) * self.rng.choice([0.0, 1.0], size=count)
        yaw, towards = self.rng.uniform(-math.pi, math.pi, (2, count))
        return np.asarray(
            Rotation.from_euler("ZYZ", np.stack([towards, tilt, yaw - towards], axis=1)).as_matrix()
            @ Rotation.from_euler("y", self.reach.mount_rad).as_matrix()
        )

    def _aim_nulls(self, positions_m: FloatArray) -> FloatArray:
        """Draw rotations that have the strongest interferer, or the first point, where the gain is low."""
        weights = self.family.ratios.denominator_weight
        strongest = self.family.ratios.denominator_point[np.argmax(weights)] if len(weights) else 0
        to_strongest_m = self.family.ratios.points_m[strongest] - positions_m
        spins = Rotation.from_rotvec(
            np.outer(self.rng.uniform(-math.pi, math.pi, len(to_strongest_m)), [0.0, 0.0, 1.0])
        ).as_matrix()
        chosen = self.lowest[self.rng.integers(len(self.lowest), size=len(to_strongest_m))]
        return np.asarray(_frames(to_strongest_m) @ spins @ _frames(chosen).transpose(0, 2, 1))

    def _bring_within_reach(self, rotations: FloatArray) -> FloatArray:
        """Turn rotations, (..., 3, 3), to the nearest that the airframe reaches, exact to rounding."""
        from nullpose.solver.kernels.search.pattern_search import bring_within_reach

        nearest = np.array(rotations, order="C")
        for each in nearest.reshape(-1, 3, 3):
            bring_within_reach(self.reach, each)
        return nearest


def _frames(third: FloatArray) -> FloatArray:
    """Build rotations whose third columns are along some vectors, (n, 3, 3)."""
    w = third / np.linalg.norm(third, axis=1, keepdims=True)
    u = np.cross(np.eye(3)[np.argmin(np.abs(w), axis=1)], w)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return np.stack([u, np.cross(w, u), w], axis=2)
