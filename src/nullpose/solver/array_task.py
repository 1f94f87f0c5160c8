"""An array's problem as numbers: what the search and the bound work on."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.physics.array import element_positions
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.records import ArrayProblem
from nullpose.scenario import Array, Scenario

_CLEAR_M = 1e-9  # how far beyond a wall a position is put, more than the rounding of its coordinates
_REPAIRS = 50


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayTask:
    """Maximise the smallest log ratio over states: east, north, up and yaw.

    Args:
        family: one dipole's ratios in the same scene, and the domain.
        problem: what the array receives, in the form of the kernels.
        symmetry: by how many equal rotations the elements come to lie on each other.
    """

    family: Family
    problem: ArrayProblem
    symmetry: int

    @classmethod
    def of(cls, scenario: Scenario, array: Array) -> ArrayTask:
        """Prepare the task of an array in a scenario.

        Args:
            scenario: nodes, jammers, receiver and airspace; the drone receives.
            array: elements, layout and spacing.
        """
        family = build_family(scenario)
        places = element_positions(array.elements, array.layout, array.spacing_wavelengths)
        strengths_m2 = np.concatenate([family.numerator_weight, family.denominator_weight])
        base = np.ascontiguousarray(places[:, :2])
        return cls(
            family=family,
            problem=ArrayProblem(family.points_m, strengths_m2, len(scenario.nodes), base),
            symmetry=max(2, array.elements) if array.layout == "circular" else 2,
        )

    def calmed(self, most: float) -> ArrayTask:
        """Weaken jammers to at most so many times the strongest node.

        Args:
            most: ratio of the strengths.
        """
        strengths, nodes = self.problem.strengths_m2.copy(), self.problem.nodes
        strengths[nodes:] = np.minimum(strengths[nodes:], most * np.max(strengths[:nodes]))
        return replace(self, problem=self.problem._replace(strengths_m2=strengths))

    @property
    def jamming(self) -> float:
        """How many times as strong the strongest jammer is as the strongest node; 0 without jammers."""
        strengths, nodes = self.problem.strengths_m2, self.problem.nodes
        return float(np.max(strengths[nodes:], initial=0.0) / np.max(strengths[:nodes]))

    @property
    def elements(self) -> int:
        """The number of elements."""
        return len(self.problem.base)

    def value(self, state: FloatArray) -> float:
        """Evaluate the smallest log ratio at any state; minus infinity if a node is not heard."""
        from nullpose.solver.kernels.array_response import respond

        return float(respond(self.problem, state, np.empty(self.problem.nodes), np.empty((0, len(state)))))

    def reach(self, level: float) -> tuple[FloatArray, FloatArray]:
        """Bound the positions whose smallest log ratio can reach a level by a finite box.

        ``|s_k - p|^2 <= K g0 P_k / (sigma^2 t)``, since no combining exceeds K times one dipole's gain
        without jamming. Where neither that nor the airspace bounds it, a box around the points.

        Args:
            level: a log ratio; minus infinity if none is known.
        """
        from nullpose.solver.kernels.search import cut_box

        family, points_m, low_m, high_m = self.family, self.family.points_m, np.empty(3), np.empty(3)
        one_dipole = level - math.log(self.elements)
        cut_box(family.arrays, family.low_m, family.high_m, one_dipole, low_m, high_m)
        around_m = family.high_m[2] - family.low_m[2] + 10.0 * family.keep_out_m
        low_m = np.where(np.isfinite(low_m), low_m, np.min(points_m, axis=0) - around_m)
        high_m = np.where(np.isfinite(high_m), high_m, np.max(points_m, axis=0) + around_m)
        return low_m, np.maximum(low_m, high_m)

    def walls(self, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Measure how far a position is outside each keep-out ball and forbidden piece.

        Args:
            position_m: (3,).

        Returns:
            Distances, (w,) metres, negative inside; and their slopes, (w, 3), unit vectors.
        """
        from nullpose.solver.kernels.array_climb import walls

        distance_m, slopes = walls(self.family.domain, position_m)
        return distance_m, slopes

    def repaired(self, position_m: FloatArray) -> FloatArray | None:
        """Move a position into the domain if it is a little outside; None if that failed.

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
            outward = slopes[worst] if np.any(slopes[worst]) else np.array([0.0, 0.0, 1.0])
            position_m = np.clip(position_m + (_CLEAR_M - distance[worst]) * outward, low_m, high_m)
        return None


def silent(family: Family) -> Family:
    """Leave only noise in a family's denominators; its points are still kept clear of.

    Args:
        family: ratios over interferers.
    """
    return family.changed(
        denominator_start=np.zeros_like(family.denominator_start),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
    )
