"""The inner problem: the worst errors at one pose, ratio by ratio, as the kernels take it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.family import build_family
from nullpose.family.robust import BindingCase, point_uncertainty_m
from nullpose.physics.error_case import ErrorCase, ratios_under, rotation_between
from nullpose.scenario import Scenario

__all__ = ["Inner", "Worst"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_ROUND_SET = 1e-12  # semi-axes this close make a ball
_FLATTEST = 1e-9  # semi-axes are at least this share of the largest
_EXACT = 1e-9  # accuracy where nothing has to be split
_MOST_CELLS = 200_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Worst:
    """The worst found for one ratio at a pose, and a bound on it.

    Args:
        ratio: index of the ratio in the nominal family.
        node: index of its node.
        eavesdropper: index of its eavesdropper; 0 where there are none.
        lower: no error makes the ratio smaller than this; 0 if that was not asked for.
        value: the ratio in the case, by the plain physics; 0 if the null is on the node.
        case: the worst error case found.
        cells: cells of errors examined.
    """

    ratio: int
    node: int
    eavesdropper: int
    lower: float
    value: float
    case: ErrorCase
    cells: int

    @property
    def binding(self) -> BindingCase:
        """The case and its ratio, for the finite family."""
        return BindingCase(self.ratio, self.case)


class Inner:
    """What may go wrong in a scenario, prepared once for many poses.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver, and how well all of it is known.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.family = build_family(scenario)
        self.angle_rad = math.radians(scenario.receiver.attitude_error_deg)
        self.reach_m = float(scenario.receiver.position_error_m)
        self.radii, self.axes, self.semi = _shapes(point_uncertainty_m(scenario))

    def worst(self, position_m: FloatArray, axis: FloatArray, accuracy: float = 1.0) -> tuple[Worst, ...]:
        """Return the worst error case of every ratio at a pose.

        Args:
            position_m: (3,) the commanded position.
            axis: (3,) the commanded antenna axis, of unit length.
            accuracy: relative distance of the bound from the worst found; 1 asks for no bound.
        """
        return tuple(self._worst(ratio, position_m, axis, accuracy) for ratio in range(self.n_ratios))

    @property
    def n_ratios(self) -> int:
        """How many ratios the nominal family has."""
        return len(self.family.numerator_point)

    def _worst(self, ratio: int, p: FloatArray, u: FloatArray, accuracy: float) -> Worst:
        from nullpose.solve.kernels.worst_case import Errors, Ratio
        from nullpose.solve.kernels.worst_case_bound import worst_case
        from nullpose.solve.kernels.worst_case_links import Sets

        family, n_nodes = self.family, len(self.scenario.nodes)
        group = family.denominator_of[ratio]
        entries = slice(family.denominator_start[group], family.denominator_start[group + 1])
        points = family.denominator_point[entries]
        noise = float(family.denominator_isotropic[group])
        node_m = family.points_m[family.numerator_point[ratio]] - p
        numbers = Ratio(
            isotropic=float(family.numerator_isotropic[ratio]) / noise,
            weight=float(family.numerator_weight[ratio]) / noise,
            node=tuple(node_m.tolist()),
            shares=family.denominator_weight[entries] / noise,
            centres=family.points_m[points] - p,
            sets=Sets(self.radii[points], self.axes[points], self.semi[points])
            if np.any(self.radii < 0.0)
            else Sets(self.radii[points], None, None),
        )
        errors = Errors(_frame(u), math.cos(self.angle_rad), math.sin(self.angle_rad), self.reach_m)
        if np.all(numbers.sets.radii >= 0.0) and self.angle_rad == self.reach_m == 0.0:
            accuracy = min(accuracy, _EXACT)  # closed form
        y, offset, places = np.empty(3), np.empty(3), np.empty((len(points), 3))
        lower, worst, cells = worst_case(numbers, errors, accuracy, _MOST_CELLS, y, offset, places)
        case = self._case(u, y, offset, points, places - (numbers.centres - offset))
        node = int(family.numerator_point[ratio])
        eavesdropper = int(points[0]) - n_nodes if self.scenario.objective == "secrecy-rate" else 0
        # a null on the node is exact in the case, not in its rounded evaluation
        value = float(ratios_under(self.scenario, p, u, case)[node, eavesdropper]) if worst > 0.0 else 0.0
        return Worst(
            ratio=ratio,
            node=node,
            eavesdropper=eavesdropper,
            lower=float(lower),
            value=value,
            case=case,
            cells=int(cells),
        )

    def _case(
        self, u: FloatArray, y: FloatArray, offset: FloatArray, points: IntArray, moved: FloatArray
    ) -> ErrorCase:
        blank = ErrorCase.none(self.scenario)
        secret = self.scenario.objective == "secrecy-rate"
        offsets_m = np.array(blank.eavesdropper_offsets_m if secret else blank.jammer_offsets_m)
        known = self.radii[points] == 0.0
        offsets_m[points - len(self.scenario.nodes)] = np.where(known[:, None], 0.0, moved)
        rotation = rotation_between(u, y if float(u @ y) >= 0.0 else -y)
        return ErrorCase(  # what cannot err has no rounding error either
            position_offset_m=offset if self.reach_m > 0.0 else np.zeros(3),
            rotation_world=rotation if self.angle_rad > 0.0 else np.eye(3),
            jammer_offsets_m=blank.jammer_offsets_m if secret else offsets_m,
            eavesdropper_offsets_m=offsets_m if secret else blank.eavesdropper_offsets_m,
        )


def _frame(u: FloatArray) -> Any:
    """Return the axis and two unit vectors across it."""
    first = np.cross(u, np.eye(3)[np.argmin(np.abs(u))])
    first /= np.linalg.norm(first)
    return tuple(tuple(each.tolist()) for each in (u, first, np.cross(u, first)))


def _shapes(sets_m: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the radius of each set that is a ball, -1 for others, and axes and half lengths of all."""
    axes, semi, _ = np.linalg.svd(sets_m)
    largest = semi[:, :1]
    is_ball = np.all(semi >= largest * (1.0 - _ROUND_SET), axis=1)
    grown = largest[:, 0] * (1.0 + 4.0 * np.finfo(float).eps)  # what rounding may have taken off
    semi = np.maximum(semi, _FLATTEST * largest) * (1.0 + 4.0 * np.finfo(float).eps)
    return np.where(is_ball, grown, -1.0), np.ascontiguousarray(np.swapaxes(axes, 1, 2)), semi
