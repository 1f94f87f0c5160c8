"""The family of a scenario under finitely many error cases: an upper bound on what can be guaranteed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from nullpose.family.build import build_family
from nullpose.family.ratios import Family, FloatArray
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


def build_robust_family(scenario: Scenario, cases: Sequence[BindingCase]) -> Family:
    """Return the family with one ratio for each case: the nominal ratio when the case comes true.

    Moving the drone by d moves all points by -d, and turning its axis by R is the turn that the points see,
    so ratio s is that of ``points - d_s + offsets_s`` with the turn ``R_s`` and a denominator of its own. Any
    pose's smallest ratio here is at least its guaranteed one; keep-outs and airspace are the nominal ones.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver and airspace.
        cases: one or more.
    """
    nominal = build_family(scenario)
    points: list[FloatArray] = []
    turns: list[FloatArray] = []
    entries: list[int] = []
    weights: list[FloatArray] = []
    start = [0]
    for each in cases:
        group = nominal.denominator_of[each.ratio]
        bounds = slice(nominal.denominator_start[group], nominal.denominator_start[group + 1])
        offsets_m = disturber_offsets_m(scenario, each.case)
        old = [nominal.numerator_point[each.ratio], *nominal.denominator_point[bounds]]
        turns += [each.case.rotation_world] * len(old)
        entries += range(len(points) + 1, len(points) + len(old))
        points += [nominal.points_m[j] - each.case.position_offset_m + offsets_m[j] for j in old]
        weights.append(nominal.denominator_weight[bounds])
        start.append(len(entries))
    ratios = np.array([each.ratio for each in cases], dtype=np.int64)
    lengths = 1 + np.diff(start)
    return replace(
        nominal,
        points_m=np.array(points),
        turn=np.array(turns),
        numerator_isotropic=nominal.numerator_isotropic[ratios],
        numerator_weight=nominal.numerator_weight[ratios],
        numerator_point=np.cumsum(lengths, dtype=np.int64) - lengths,
        denominator_of=np.arange(len(cases), dtype=np.int64),
        denominator_isotropic=nominal.denominator_isotropic[nominal.denominator_of[ratios]],
        denominator_start=np.array(start, dtype=np.int64),
        denominator_point=np.array(entries, dtype=np.int64),
        denominator_weight=np.concatenate(weights),
    )


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
