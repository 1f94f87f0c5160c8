"""An array's problem as numbers: what the search and the finish work on."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nullpose.family import Family, build_family
from nullpose.physics.array import element_positions
from nullpose.scenario import Array, Scenario

__all__ = ["ArrayTask", "Scene", "silent"]

FloatArray = NDArray[np.float64]
Scene = tuple[FloatArray, FloatArray, int]

_CLEAR_M = 1e-9  # how far beyond a wall a position is put, more than the rounding of its coordinates
_REPAIRS = 50


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayTask:
    """Maximise the smallest log ratio over states: east, north, up, yaw and, for a shared beam, the phases.

    Args:
        family: one dipole's ratios in the same scene and domain.
        scene: points, nodes first; strengths, m^2 (power times path gain over noise, a node's divided by
            what it requires); the number of nodes.
        base: (k, 2) elements in body axes, wavelengths.
        symmetry: by how many equal turns the elements come to lie on each other.
        shared: whether one beam serves all nodes.
    """

    family: Family
    scene: Scene
    base: FloatArray
    symmetry: int
    shared: bool

    @classmethod
    def of(cls, scenario: Scenario, array: Array, *, shared: bool) -> ArrayTask:
        """Return the task of an array in a scenario.

        Args:
            scenario: nodes, jammers, receiver and airspace, with objective min-sinr.
            array: elements, layout and spacing.
            shared: whether one beam serves all nodes.
        """
        family = build_family(scenario)
        places = element_positions(array.elements, array.layout, array.spacing_wavelengths)
        return cls(
            family=family,
            scene=(
                family.points_m,
                np.concatenate([family.numerator_weight, family.denominator_weight]),
                len(scenario.nodes),
            ),
            base=np.ascontiguousarray(places[:, :2]),
            symmetry=max(2, array.elements) if array.layout == "circular" else 2,
            shared=shared,
        )

    def digital(self) -> ArrayTask:
        """Return the same task with weights of each node's own."""
        return replace(self, shared=False)

    def calmed(self, most: float) -> ArrayTask:
        """Return the task with every jammer at most so many times as strong as the strongest node.

        Args:
            most: ratio of the strengths.
        """
        points_m, strengths, nodes = self.scene
        limit = most * np.max(strengths[:nodes])
        calmer = np.concatenate([strengths[:nodes], np.minimum(strengths[nodes:], limit)])
        return replace(self, scene=(points_m, calmer, nodes))

    @property
    def jamming(self) -> float:
        """How many times as strong the strongest jammer is as the strongest node; 0 without jammers."""
        _, strengths, nodes = self.scene
        return float(np.max(strengths[nodes:], initial=0.0) / np.max(strengths[:nodes]))

    @property
    def size(self) -> int:
        """The number of variables of a state."""
        return 4 + (len(self.base) if self.shared else 0)

    def value(self, state: FloatArray) -> float:
        """Return the smallest log ratio at a state, wherever it is; minus infinity if a node is not heard."""
        from nullpose.solve.kernels.array_response import array_value

        return float(array_value(self.scene, self.base, self.shared, state))

    def reach(self, level: float) -> tuple[FloatArray, FloatArray]:
        """Return a finite box around every position whose smallest log ratio can reach a level.

        ``|s_k - p|^2 <= K g0 P_k / (sigma^2 t)``, since no combining exceeds K times one dipole's gain
        without jamming. Where neither that nor the airspace bounds it, a box around the points.

        Args:
            level: a log ratio; minus infinity if none is known.
        """
        points_m, strengths, nodes = self.scene
        low_m, high_m = self.family.low_m, self.family.high_m
        if level > -math.inf:
            reach_m = np.sqrt(len(self.base) * strengths[:nodes] * math.exp(-level))[:, None]
            low_m = np.maximum(low_m, np.max(points_m[:nodes] - reach_m, axis=0))
            high_m = np.minimum(high_m, np.min(points_m[:nodes] + reach_m, axis=0))
        around_m = self.family.high_m[2] - self.family.low_m[2] + 10.0 * self.family.keep_out_m
        low_m = np.where(np.isfinite(low_m), low_m, np.min(points_m, axis=0) - around_m)
        high_m = np.where(np.isfinite(high_m), high_m, np.max(points_m, axis=0) + around_m)
        return low_m, np.maximum(low_m, high_m)

    def walls(self, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far a position is outside each keep-out ball and forbidden piece, and the way out.

        Args:
            position_m: (3,).

        Returns:
            Distances, (w,) metres, negative inside; and their slopes, (w, 3), unit vectors.
        """
        from nullpose.solve.kernels.local_coordinates import choose_sides

        family = self.family
        away = position_m - family.keep_out_points_m
        distance = np.maximum(np.linalg.norm(away, axis=1), _CLEAR_M)
        chosen = np.empty(len(family.piece_start) - 1, dtype=np.int64)
        choose_sides(family.domain, position_m, chosen)
        sides = family.piece_sides[chosen]
        across = np.zeros((len(sides), 3))
        across[:, :2] = position_m[:2] - sides[:, 1:3]
        radius = np.maximum(np.linalg.norm(across, axis=1), _CLEAR_M)
        plane = sides[:, 0] == 0.0
        slack = np.where(plane, sides[:, 1:4] @ position_m - sides[:, 4], radius - sides[:, 4])
        slopes = np.where(plane[:, None], sides[:, 1:4], across / radius[:, None])
        return (
            np.concatenate([distance - family.keep_out_m, slack]),
            np.vstack([away / distance[:, None], slopes]),
        )

    def repaired(self, position_m: FloatArray) -> FloatArray | None:
        """Return the position moved into the domain if it was a little outside, or None if that failed.

        Args:
            position_m: (3,).
        """
        low_m, high_m = self.family.low_m, self.family.high_m
        position_m = np.clip(position_m, low_m, high_m)
        for _ in range(_REPAIRS):
            distance, slopes = self.walls(position_m)
            if not np.any(distance < 0.0):
                return position_m
            worst = int(np.argmin(distance))
            way = slopes[worst] if np.any(slopes[worst]) else np.array([0.0, 0.0, 1.0])
            position_m = np.clip(position_m + (_CLEAR_M - distance[worst]) * way, low_m, high_m)
        return None


def silent(family: Family) -> Family:
    """Return the family without what is in the denominators but noise; its points are still kept clear of.

    Args:
        family: ratios over interferers.
    """
    return replace(
        family,
        denominator_start=np.zeros_like(family.denominator_start),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
    )
