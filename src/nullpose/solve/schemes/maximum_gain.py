"""Maximum gain (paper eqs. 3.4 and 3.5): the dipole serves the nodes, the position the SINR."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nullpose.family import AxisField, Family, build_family
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.multistart import multistart
from nullpose.solve.position_search import search_positions

__all__ = ["axis_field", "find"]


def axis_field(first_m: NDArray[np.float64], second_m: NDArray[np.float64]) -> AxisField:
    """Return the field ``(s1 - p) x (s2 - p) = s1 x s2 + (s2 - s1) x p`` (paper eq. 3.4, any length).

    Args:
        first_m: the first node's position, (3,), metres.
        second_m: the second node's position, (3,), metres.
    """
    x, y, z = second_m - first_m
    matrix = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return AxisField.affine(np.cross(first_m, second_m), matrix)


def find(scenario: Scenario, *, seed: int) -> Found:
    """Return the best position found with the axis at maximum gain towards the nodes.

    For two nodes that is eq. 3.4. For another number the axis maximises the smallest received node power,
    the jammers ignored; among several such axes, the one that receives least jamming is taken.

    Args:
        scenario: what to solve.
        seed: seed of the multistart.
    """
    family = build_family(scenario)
    if len(scenario.nodes) == 2:
        return multistart(family, axis_field(*scenario.node_positions_m), seed=seed)
    return _find_for_any_number(family, seed=seed)


def _find_for_any_number(family: Family, *, seed: int) -> Found:
    from nullpose.solve.kernels.maximum_gain import maximum_gain_value

    arrays = family.arrays
    axis = np.empty(3)

    def objective(position: NDArray[np.float64]) -> float:
        return float(maximum_gain_value(arrays, position, axis))

    position_m, log_value, starts, evaluations = search_positions(objective, family, seed=seed)
    maximum_gain_value(arrays, position_m, axis)
    return Found(
        position_m=position_m,
        axis=axis,
        log_value=log_value,
        multipliers=np.full(len(family.numerator_point), 1.0 / len(family.numerator_point)),
        starts=starts,
        evaluations=evaluations,
        note=f"{len(family.numerator_point)} node(s), where eq. 3.4 is for two: the axis maximises "
        "the smallest received node power, the jammers ignored",
    )
