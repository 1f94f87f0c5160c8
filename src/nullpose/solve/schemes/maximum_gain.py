"""Maximum gain (paper eqs. 3.4 and 3.5): the dipole serves the nodes, the position the SINR."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nullpose.family import AxisField, Family, build_family
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.found import Found
from nullpose.solve.position_search import search_positions
from nullpose.solve.settle import Settled, settle

__all__ = ["find"]

_RELAXED = "no proof of its own for other than two nodes: the bound is that of the optimum"


def find(scenario: Scenario, effort: Effort) -> Settled:
    """Return the best position with the axis at maximum gain towards the nodes.

    For two nodes that is eq. 3.4. For another number the axis maximises the smallest received node power,
    the jammers ignored; among several such axes, the one that receives least jamming is taken. Its bound is
    then the optimum's, whose axis is free.

    Args:
        scenario: what to solve.
        effort: what it may cost.
    """
    family = build_family(scenario)
    if len(scenario.nodes) == 2:
        return settle(family, [AxisField.broadside(*scenario.node_positions_m)], effort)
    found = _find_for_any_number(family, seed=effort.seed)
    if effort.limits is None:
        return Settled(found=found)
    relaxed = settle(family, [AxisField.free()], effort)
    reason = relaxed.reason or _RELAXED  # an interrupt or a limit comes first
    return Settled(found=found, upper_bound=relaxed.upper_bound, proofs=relaxed.proofs, reason=reason)


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
