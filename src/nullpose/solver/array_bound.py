"""What no position, yaw and combining of an array exceeds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.solver.array_task import ArrayTask, silent
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import solve_and_prove

_MOST_BOXES = 300_000
_LEAST_BOXES = 20_000
_WORK = 3e7  # boxes times what one costs: nodes, jammers and elements
_ROUNDING = 5e-10
_INSIDE = 0.9  # the gap that is aimed at, of the gap that is asked for: bound and value are rounded
_LEAST_GAP = 1e-8  # of the vertical case's proof


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayBound:
    """A bound on the smallest ratio of an array.

    Args:
        value: nothing exceeds this.
        boxes: boxes examined.
        state: (4,) a promising place that turned up on the way; None if none did.
    """

    value: float
    boxes: int
    state: FloatArray | None = None


def array_bound(task: ArrayTask, log_value: float, *, gap: float) -> ArrayBound:
    """Bound the smallest ratio over all positions, yaws and weights, by branch and bound.

    A branch and bound over positions and yaws, the best first
    (:mod:`nullpose.solver.kernels.array_enclosure` bounds a box): it stops at the gap asked for or
    at a number of boxes, with the bound reached. Turning the vehicle by half a turn, or a circle by one of
    its elements, changes nothing; so that much yaw is looked at. One element is the vertical case, whose own
    branch and bound is used.

    Args:
        task: the array and its scene.
        log_value: log ratio of a state.
        gap: relative gap to that at which it is done.
    """
    value = math.exp(log_value)
    upright = _vertical_bound(task, gap)
    if task.elements == 1 or upright.value <= value * (1.0 + gap):
        return upright
    from nullpose.solver.kernels.array_branch import branch_array

    nodes, jammers = task.problem.nodes, len(task.problem.points_m) - task.problem.nodes
    most = _WORK / (nodes * (1 + jammers) * task.elements)
    low_m, high_m = task.reach(log_value - _ROUNDING)
    half_m = 0.5 * (high_m - low_m) * (1.0 + _ROUNDING)
    root = np.array([[*(0.5 * (low_m + high_m)), 0.0], [*half_m, math.pi / task.symmetry]])
    state = np.full(4, math.nan)
    bound, boxes = branch_array(
        task.problem,
        task.family.domain,
        root,
        value * (1.0 + _INSIDE * gap),
        int(min(max(most, _LEAST_BOXES), _MOST_BOXES)),
        state,
    )
    return ArrayBound(
        value=min(upright.value, float(bound) * (1.0 + _ROUNDING)),
        boxes=upright.boxes + int(boxes),
        state=state if np.all(np.isfinite(state)) else None,
    )


def _vertical_bound(task: ArrayTask, gap: float) -> ArrayBound:
    """Bound by K times one vertical dipole with the jammers silent; for K = 1, not silent.

    With ``R >= sigma^2 I``, ``h_k^H R^-1 h_k <= |h_k|^2 / sigma^2``, and ``|h_k|^2`` is K times what one
    vertical dipole receives at the same position. Where the jammers can be nulled for nothing, the optimum
    is a flat ridge, along which a branch and bound is slow, and this bound is met.
    """
    family = task.family
    if task.elements > 1:
        family = silent(family)
    options = SolveOptions(gap=max(_INSIDE * gap, _LEAST_GAP), node_limit=_MOST_BOXES)
    outcome = solve_and_prove(family, [AxisField.vertical()], options)
    assert outcome.upper_bound is not None, "a proof was asked for"
    value = task.elements * outcome.upper_bound * (1.0 + _ROUNDING)
    return ArrayBound(value=value, boxes=outcome.nodes)
