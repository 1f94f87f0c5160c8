"""An array in place of the tilting dipole: the best position and yaw of a level vehicle that carries one."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from nullpose.errors import require_usage
from nullpose.files import PlainTable
from nullpose.objectives import USUAL, FloatArray
from nullpose.objectives.min_sinr import with_margins
from nullpose.physics import Pose, objective_of_links
from nullpose.physics.array import ComplexArray, digital_sinr, digital_weights, placed_elements
from nullpose.physics.evaluate import links_of
from nullpose.problem.axis_field import AxisField
from nullpose.scenario import Array, Scenario
from nullpose.solver.array_search import ArraySearch
from nullpose.solver.options import SolveOptions
from nullpose.solver.result import BoundedPose, Stats
from nullpose.solver.solve_and_prove import solve_and_prove

_MOST_BOXES = 300_000
_LEAST_BOXES = 20_000
_WORK = 3e7  # boxes times what one costs: nodes, jammers and elements
_ROUNDING = 5e-10
_INSIDE = 0.9  # the gap that is aimed at, of the gap that is asked for: bound and value are rounded
_LEAST_GAP = 1e-8  # of the vertical case's proof


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayDetails:
    """An array and the weights of its digital combining.

    Args:
        array: number, layout and spacing of the elements.
        weights: what each element is multiplied by for each node (its conjugate), of unit length:
            (n_nodes, K), complex, read-only.
    """

    array: Array
    weights: ComplexArray

    def __post_init__(self) -> None:
        self.weights.flags.writeable = False

    @property
    def label(self) -> str:
        """The name of the case for tables, as in "array of 4, digital"."""
        return f"array of {self.array.elements}, digital"

    def to_dict(self, objective: object) -> PlainTable:
        """Write the array as plain data for JSON; a weight is [real part, imaginary part].

        Args:
            objective: of the result, which has it already.
        """
        weights = np.stack([self.weights.real, self.weights.imag], axis=-1).tolist()
        return {"array": self.array.to_dict() | {"combining": "digital", "weights": weights}}


def solve_array(scenario: Scenario, array: Array, options: SolveOptions) -> BoundedPose:
    """Find the best position, yaw and combining of an array of upright dipoles on a level vehicle.

    Maximises the smallest SINR over the nodes, each divided by what the node requires if any does. Every
    node has weights of its own, which follow from position and yaw (:func:`nullpose.physics.digital_sinr`).
    The bound comes from a branch and bound over positions and yaws. One element is the vertical case.

    Args:
        scenario: its airframe and its uncertainty are not consulted.
        array: what the vehicle carries.
        options: those of the scenario; limits of time and boxes count for one element alone.

    Raises:
        UsageError: the objective is another than min-sinr.
        SolveError: no position reaches every node.
    """
    require_usage(
        scenario.objective == USUAL,
        f'array: given a scenario with objective = "{scenario.objective}"; allowed: objective = "{USUAL}"; '
        "arrays are not there for others; remove [array]",
    )
    search = ArraySearch(scenario, array, options.seed)
    bound = _search_and_prove(search, options)
    pose = Pose(search.state[:3], 0.0, 0.0, math.remainder(search.state[3], 2.0 * math.pi))
    places = placed_elements(scenario, pose)
    links = links_of(scenario, with_margins(scenario, digital_sinr(scenario, pose.position_m, places)))
    reached = bound is None or bound.value <= math.exp(search.best) * (1.0 + options.target)
    return BoundedPose(
        scheme="array-digital",
        pose=pose,
        links=links,
        value=objective_of_links(scenario, links),
        upper_bound=None if bound is None else bound.value,
        reason="" if reached or bound is None else bound.reason,
        settings=options.settings,
        stats=Stats(
            starts=search.starts,
            evaluations=search.evaluations,
            boxes=0 if bound is None else bound.boxes,
            searches=len(search.ends),
            agreeing=search.agreeing,
        ),
        details=ArrayDetails(array=array, weights=digital_weights(scenario, pose.position_m, places)),
    )


def _search_and_prove(search: ArraySearch, options: SolveOptions) -> ArrayBound | None:
    """Search, and prove what is found if that is asked for.

    One search and a proof, then more searches, and another proof, where that does not get there; what turns
    up in the first proof is taken up. One element is the vertical case, with its search and its proof.
    """
    if search.elements == 1:
        outcome = solve_and_prove(search.family, [AxisField.vertical()], options)
        search.start_from(outcome.incumbent)
        value = outcome.upper_bound
        return None if value is None else ArrayBound(value=value, boxes=outcome.nodes, reason=outcome.reason)
    if not options.certify:
        search.search_on()
        return None
    search.search()
    bound, before = array_bound(search, gap=options.target), search.best
    if bound.value <= math.exp(before) * (1.0 + options.target):
        return bound
    if bound.state is not None:
        search.climb(bound.state)
    search.search_on()
    if search.best <= before + options.target:
        return bound
    again = array_bound(search, gap=options.target)
    return replace(again, value=min(bound.value, again.value), boxes=bound.boxes + again.boxes)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayBound:
    """A bound on the smallest ratio of an array.

    Args:
        value: nothing exceeds this.
        boxes: boxes examined.
        state: (4,) a promising place that turned up on the way; None if none did.
        reason: why the gap was not reached, where it was not.
    """

    value: float
    boxes: int
    state: FloatArray | None = None
    reason: str = "box limit reached"


def array_bound(search: ArraySearch, *, gap: float) -> ArrayBound:
    """Bound the smallest ratio over all positions, yaws and weights, by branch and bound.

    A branch and bound over positions and yaws, the best first
    (:mod:`nullpose.solver.kernels.bounds.array_enclosure` bounds a box): it stops at the gap asked for or
    at a number of boxes, with the bound reached. Turning the vehicle by half a turn, or a circle by one of
    its elements, changes nothing; so that much yaw is looked at.

    Args:
        search: the array, its scene and the best state found.
        gap: relative gap to its value at which it is done.
    """
    value, nodes = math.exp(search.best), search.problem.nodes
    if (upright := _vertical_bound(search, gap)).value <= value * (1.0 + gap):
        return upright
    from nullpose.solver.kernels.bounds.array_branch import branch_array

    most = _WORK / (nodes * (1 + len(search.problem.ratios.points_m) - nodes) * search.elements)
    low_m, high_m = search.box(search.best)
    half_m = 0.5 * (high_m - low_m) * (1.0 + _ROUNDING)
    root = np.array([[*(0.5 * (low_m + high_m)), 0.0], [*half_m, math.pi / search.symmetry]])
    state = np.full(4, math.nan)
    level, boxes = value * (1.0 + _INSIDE * gap), int(min(max(most, _LEAST_BOXES), _MOST_BOXES))
    bound, boxes = branch_array(search.problem, search.family.domain, root, level, boxes, state)
    return ArrayBound(
        value=min(upright.value, float(bound) * (1.0 + _ROUNDING)),
        boxes=upright.boxes + int(boxes),
        state=state if np.all(np.isfinite(state)) else None,
    )


def _vertical_bound(search: ArraySearch, gap: float) -> ArrayBound:
    """Bound by K times one vertical dipole with the jammers silent.

    With ``R >= sigma^2 I``, ``h_k^H R^-1 h_k <= |h_k|^2 / sigma^2``, and ``|h_k|^2`` is K times what one
    vertical dipole receives at the same position. Where the jammers can be nulled for nothing, the optimum
    is a flat ridge, along which a branch and bound is slow, and this bound is met.
    """
    family = search.family  # only noise is left in the denominators; interferers are still kept clear of
    family = family.changed(
        denominator_start=np.zeros_like(family.ratios.denominator_start),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
    )
    options = SolveOptions(gap=max(_INSIDE * gap, _LEAST_GAP), node_limit=_MOST_BOXES)
    outcome = solve_and_prove(family, [AxisField.vertical()], options)
    assert outcome.upper_bound is not None, "a proof was asked for"
    return ArrayBound(value=search.elements * outcome.upper_bound * (1.0 + _ROUNDING), boxes=outcome.nodes)
