"""An array in place of the tilting dipole: the best position and yaw of a level vehicle that carries one."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from nullpose.errors import UsageError
from nullpose.objectives import USUAL, Quantity
from nullpose.physics import Pose
from nullpose.physics.array import ComplexArray, digital_sinr, digital_weights, placed_elements
from nullpose.physics.evaluate import links_of
from nullpose.scenario import Array, Scenario
from nullpose.solver.array_bound import ArrayBound, array_bound
from nullpose.solver.array_search import ArrayHunt
from nullpose.solver.array_task import ArrayTask
from nullpose.solver.compiling import working_clock
from nullpose.solver.objective import objective_of, status_of
from nullpose.solver.options import SolveOptions
from nullpose.solver.result import Result, Stats, provenance


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

    def to_dict(self, objective: object) -> dict[str, Any]:
        """Write the array as plain data for JSON; a weight is [real part, imaginary part].

        Args:
            objective: of the result, which has it already.
        """
        weights = np.stack([self.weights.real, self.weights.imag], axis=-1).tolist()
        return {"array": self.array.to_dict() | {"combining": "digital", "weights": weights}}


def solve_array(scenario: Scenario, options: SolveOptions) -> Result:
    """Find the best position, yaw and combining of an array of upright dipoles on a level vehicle.

    Maximises the smallest SINR over the nodes, each divided by what the node requires if any does. Every
    node has weights of its own, which follow from position and yaw (:func:`nullpose.physics.digital_sinr`).
    The bound comes from a branch and bound over positions and yaws.

    Args:
        scenario: one with an array; its airframe and its uncertainty are not consulted.
        options: as given by the user; limits of time and boxes are not consulted.

    Raises:
        UsageError: the objective is another than min-sinr.
        SolveError: no position reaches every node.
    """
    array = scenario.array
    assert array is not None, "the caller asks"
    if scenario.objective != USUAL:
        raise UsageError(
            f"array: given a scenario with objective {scenario.objective!r}; allowed: one "
            "under which the drone receives; arrays are not there for others"
        )
    options = options.of(scenario)
    began = working_clock()
    task = ArrayTask.of(scenario, array)
    hunt, bound = _solved(task, options)
    pose = Pose(hunt.state[:3], 0.0, 0.0, math.remainder(hunt.state[3], 2.0 * math.pi))
    places = placed_elements(scenario, pose)
    ratios = {"sinr": digital_sinr(scenario, pose.position_m, places)}
    if scenario.has_margins:
        ratios["margin"] = ratios["sinr"] / scenario.node_required_sinr
    links = links_of(scenario, ratios)
    value = Quantity.of(scenario).least(links)
    objective = objective_of(scenario, value, None if bound is None else bound.value)
    reached = bound is None or hunt.reaches(bound.value, options.target)
    status, reason = status_of(objective, options.target, "" if reached else "box limit reached")
    return Result(
        scenario=scenario,
        scheme="array-digital",
        status=status,
        objective=objective,
        pose=pose,
        links=links,
        stats=Stats(
            wall_s=working_clock() - began,
            starts=hunt.starts,
            evaluations=hunt.evaluations,
            boxes=0 if bound is None else bound.boxes,
            searches=len(hunt.ends),
            agreeing=hunt.agreeing,
        ),
        provenance=provenance(options.seed) | options.settings,
        reason=reason,
        details=ArrayDetails(array=array, weights=digital_weights(scenario, pose.position_m, places)),
    )


def _solved(task: ArrayTask, options: SolveOptions) -> tuple[ArrayHunt, ArrayBound | None]:
    """Search, and prove what is found if that is asked for.

    One search and a proof, then more searches, and another proof, where that does not get there; what turns
    up in the first proof is taken up.
    """
    hunt = ArrayHunt(task, options.seed)
    if not options.certify:
        hunt.search_on()
        return hunt, None
    hunt.search()
    bound, before = array_bound(task, hunt.best, gap=options.target), hunt.best
    if hunt.reaches(bound.value, options.target):
        return hunt, bound
    if bound.state is not None:
        hunt.look(bound.state)
    hunt.search_on()
    if hunt.best <= before + options.target:
        return hunt, bound
    again = array_bound(task, hunt.best, gap=options.target)
    return hunt, replace(again, value=min(bound.value, again.value), boxes=bound.boxes + again.boxes)
