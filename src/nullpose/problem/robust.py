"""The family of a scenario under finitely many error cases: an upper bound on what can be guaranteed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.physics.error_case import ErrorCase
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Scenario


class BindingCase(NamedTuple):
    """An error case and the one ratio of the nominal family that it is bad for."""

    ratio: int  # its index in the nominal family
    case: ErrorCase

    def is_same(self, other: BindingCase) -> bool:
        """Compare with another case, to the last bit."""
        return self.ratio == other.ratio and self.case.is_same(other.case)


def build_robust_family(scenario: Scenario, cases: Sequence[BindingCase]) -> Family:
    """Build the family with one ratio for each case: the nominal ratio when the case comes true.

    Moving the drone by d moves all points by -d, and turning its axis by R is the turn that the points see,
    so ratio s is that of ``points - d_s + offsets_s`` with the turn ``R_s``. Ratios share a denominator if
    they do in the nominal family and their errors are the same. A pose's smallest ratio here is at least
    its guaranteed one; keep-outs and airspace are the nominal ones.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver and airspace.
        cases: one or more.
    """
    nominal, moved = build_family(scenario, any_channel=True), f"{scenario.interferer}_offsets_m"
    ratios = nominal.ratios
    copies: dict[bytes, tuple[int, FloatArray, FloatArray, int]] = {}  # each moved and turned point once

    def copied(point: int, point_m: FloatArray, rotation: FloatArray) -> int:
        """Index a copy, new or not."""
        return copies.setdefault(
            point_m.tobytes() + rotation.tobytes(), (len(copies), point_m, rotation, point)
        )[0]

    # each denominator once: its number, the copies in it and their weights
    groups: dict[tuple[int, bytes], tuple[int, list[int], FloatArray]] = {}
    numerator_point, denominator_of = [], []
    for ratio, case in cases:
        offsets_m = _of_points(nominal, scenario, getattr(case, moved))
        moved_m = ratios.points_m - case.position_offset_m + offsets_m
        rotation = case.rotation_world
        point, group = int(ratios.numerator_point[ratio]), int(ratios.denominator_of[ratio])
        numerator_point.append(copied(point, moved_m[point], rotation))
        bounds = slice(ratios.denominator_start[group], ratios.denominator_start[group + 1])
        disturbers = ratios.denominator_point[bounds].tolist()
        entries = [copied(each, moved_m[each], rotation) for each in disturbers]
        key = (group, moved_m[disturbers].tobytes() + rotation.tobytes())
        found = groups.setdefault(key, (len(groups), entries, ratios.denominator_weight[bounds]))
        denominator_of.append(found[0])
    of_cases = np.array([case.ratio for case in cases], dtype=np.int64)
    _, points_m, rotations, originals = map(np.array, zip(*copies.values(), strict=True))
    _, entries_of, weights = zip(*groups.values(), strict=True)
    return nominal.changed(
        **{
            name: rows[originals]
            for name in ("ground_axes", "ground_leaks", "channels")
            if len(rows := getattr(ratios, name))
        },
        points_m=points_m,
        turn=rotations if np.any(rotations != np.eye(3)) else np.zeros((0, 3, 3)),
        numerator_isotropic=ratios.numerator_isotropic[of_cases],
        numerator_weight=ratios.numerator_weight[of_cases],
        numerator_point=np.array(numerator_point, dtype=np.int64),
        denominator_of=np.array(denominator_of, dtype=np.int64),
        denominator_isotropic=ratios.denominator_isotropic[[group for group, _ in groups]],
        denominator_start=np.cumsum([0, *map(len, entries_of)]),
        denominator_point=np.array([*chain(*entries_of)], dtype=np.int64),
        denominator_weight=np.concatenate(weights),
    )


def point_uncertainty_m(scenario: Scenario) -> FloatArray:
    """Collect the radii of the balls in which each point of the family may be, (m,), metres."""
    return _of_points(
        build_family(scenario, any_channel=True), scenario, scenario.of_interferers("uncertainty_m")
    )


def _of_points(nominal: Family, scenario: Scenario, of_interferers: FloatArray) -> FloatArray:
    """Spread arrays of the points in the denominators over all points, with zeros for the others."""
    first = len(scenario.nodes)
    of_points = np.zeros((len(nominal.ratios.points_m), *of_interferers.shape[1:]))
    of_points[first : first + len(of_interferers)] = of_interferers
    return of_points
