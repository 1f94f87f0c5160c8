"""The family of a scenario under finitely many error cases: an upper bound on what can be guaranteed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nullpose.family.build import build_family
from nullpose.family.family import Family
from nullpose.objectives import FloatArray
from nullpose.physics.error_case import ErrorCase
from nullpose.scenario import Scenario

__all__ = ["BindingCase", "build_robust_family", "disturber_offsets_m", "point_uncertainty_m"]


@dataclass(frozen=True, slots=True)
class BindingCase:
    """An error case and the one ratio of the nominal family that it is bad for.

    Args:
        ratio: index of the ratio in the nominal family.
        case: the error case.
    """

    ratio: int
    case: ErrorCase

    def is_same(self, other: BindingCase) -> bool:
        """Return whether another is the same case of the same ratio, to the last bit.

        Args:
            other: the other.
        """
        return self.ratio == other.ratio and self.case.is_same(other.case)


def build_robust_family(scenario: Scenario, cases: Sequence[BindingCase]) -> Family:
    """Return the family with one ratio for each case: the nominal ratio when the case comes true.

    Moving the drone by d moves all points by -d, and turning its axis by R is the turn that the points see,
    so ratio s is that of ``points - d_s + offsets_s`` with the turn ``R_s``. Ratios share a denominator if
    they do in the nominal family and their errors are the same. Any pose's smallest ratio here is at least
    its guaranteed one; keep-outs and airspace are the nominal ones.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver and airspace.
        cases: one or more.
    """
    nominal = build_family(scenario)
    copies = _Copies()
    groups: dict[tuple[int, bytes], int] = {}
    numerator_point, denominator_of, of_group = [], [], []
    entries: list[int] = []
    weights: list[FloatArray] = []
    start = [0]
    for each in cases:
        moved_m = nominal.points_m - each.case.position_offset_m + disturber_offsets_m(scenario, each.case)
        rotation = each.case.rotation_world
        numerator_point.append(copies.add(moved_m[nominal.numerator_point[each.ratio]], rotation))
        group = int(nominal.denominator_of[each.ratio])
        bounds = slice(nominal.denominator_start[group], nominal.denominator_start[group + 1])
        disturbers_m = moved_m[nominal.denominator_point[bounds]]
        key = (group, disturbers_m.tobytes() + rotation.tobytes())
        if key not in groups:
            groups[key] = len(groups)
            of_group.append(group)
            entries += [copies.add(point_m, rotation) for point_m in disturbers_m]
            weights.append(nominal.denominator_weight[bounds])
            start.append(len(entries))
        denominator_of.append(groups[key])
    ratios = np.array([each.ratio for each in cases], dtype=np.int64)
    return nominal.changed(
        points_m=np.array(copies.points_m),
        turn=copies.turn,
        numerator_isotropic=nominal.numerator_isotropic[ratios],
        numerator_weight=nominal.numerator_weight[ratios],
        numerator_point=np.array(numerator_point, dtype=np.int64),
        denominator_of=np.array(denominator_of, dtype=np.int64),
        denominator_isotropic=nominal.denominator_isotropic[of_group],
        denominator_start=np.array(start, dtype=np.int64),
        denominator_point=np.array(entries, dtype=np.int64),
        denominator_weight=np.concatenate(weights),
    )


class _Copies:
    """The points of a robust family, each moved point with its turn once."""

    def __init__(self) -> None:
        self.points_m: list[FloatArray] = []
        self.rotations: list[FloatArray] = []
        self._index: dict[bytes, int] = {}

    def add(self, point_m: FloatArray, rotation: FloatArray) -> int:
        """Return the index of a copy, new or not."""
        key = point_m.tobytes() + rotation.tobytes()
        if key not in self._index:
            self._index[key] = len(self.points_m)
            self.points_m.append(point_m)
            self.rotations.append(rotation)
        return self._index[key]

    @property
    def turn(self) -> FloatArray:
        """The turns as a family has them: none at all if no point has one."""
        turn = np.array(self.rotations)
        return turn if np.any(turn != np.eye(3)) else np.zeros((0, 3, 3))


def disturber_offsets_m(scenario: Scenario, case: ErrorCase) -> FloatArray:
    """Return how far each point of the nominal family is from where it is stated, (m, 3), metres.

    Args:
        scenario: its objective says whether jammers or eavesdroppers are in the denominators.
        case: the error case.
    """
    secret = scenario.objective == "secrecy-rate"
    return _of_points(scenario, case.eavesdropper_offsets_m if secret else case.jammer_offsets_m)


def point_uncertainty_m(scenario: Scenario) -> FloatArray:
    """Return the matrices of the sets in which each point of the nominal family may be, (m, 3, 3), metres.

    Args:
        scenario: nodes, which are known, and jammers or eavesdroppers.
    """
    secret = scenario.objective == "secrecy-rate"
    return _of_points(
        scenario, scenario.eavesdropper_uncertainty_m if secret else scenario.jammer_uncertainty_m
    )


def _of_points(scenario: Scenario, of_disturbers: FloatArray) -> FloatArray:
    """Return what belongs to the points in the denominators, with zeros for nodes and for all others."""
    first = len(scenario.nodes)
    others = len(scenario.jammers) if scenario.objective == "secrecy-rate" else 0
    everyone = np.zeros((first + len(of_disturbers) + others, *of_disturbers.shape[1:]))
    everyone[first : first + len(of_disturbers)] = of_disturbers
    return everyone
