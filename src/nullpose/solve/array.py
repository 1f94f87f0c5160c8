"""An array in place of the tilting dipole: the best position and yaw of a level vehicle that carries one."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import SolveError, UsageError
from nullpose.family import AxisField
from nullpose.physics import Link, Pose, to_db
from nullpose.physics.array import (
    analogue_sinr,
    analogue_weights,
    digital_sinr,
    digital_weights,
    element_positions,
)
from nullpose.scenario import Array, Scenario
from nullpose.solve.array_bound import ArrayBound, array_bound
from nullpose.solve.array_finish import finished
from nullpose.solve.array_search import search_array
from nullpose.solve.array_solution import ArraySolution, ArrayStats, Combining
from nullpose.solve.array_task import ArrayTask
from nullpose.solve.multistart import landmarks, multistart
from nullpose.solve.objective import Objective, objective_of
from nullpose.solve.provenance import provenance
from nullpose.solve.solution import Status

__all__ = ["COMBININGS", "solve_array"]

FloatArray = NDArray[np.float64]

COMBININGS: tuple[Combining, ...] = ("digital", "analogue")
"""The ways to combine the elements."""

_SEARCHES = 6  # most independent searches
_AGREEING = 3  # searches with the same end after which no more are made
_SAME = 1e-4
_CLOSED = 1e-6  # a value this close to the bound needs no further search
_PROOF_S = 10.0


def solve_array(
    scenario: Scenario,
    combining: str = "digital",
    *,
    elements: int | None = None,
    layout: str | None = None,
    spacing_wavelengths: float | None = None,
    seed: int = 0,
) -> ArraySolution:
    """Return the best position, yaw and combining of an array of upright dipoles on a level vehicle.

    Maximises the smallest SINR over the nodes, each divided by what the node requires if any does. Digital:
    every node has weights of its own, which follow from position and yaw
    (:func:`nullpose.physics.array.digital_sinr`). Analogue: one beam of phase shifters serves all nodes
    (:func:`nullpose.physics.array.analogue_sinr`), and its phases are searched too. The value is
    re-evaluated by the physics from what is reported. It is the best of several independent searches; of the
    optimum it is proved only that it is not above the bound.

    Args:
        scenario: nodes, jammers, receiver and airspace; its airframe and its uncertainty are not consulted.
        combining: ``"digital"`` or ``"analogue"``.
        elements: number of dipoles; the scenario's if left out, as the next two.
        layout: ``"linear"`` or ``"circular"``.
        spacing_wavelengths: distance between neighbours, in wavelengths.
        seed: seed of the searches, a whole number of at least 0; equal seeds give equal answers.

    Raises:
        UsageError: unknown combining, a bad seed, no array given, or another objective than min-sinr.
        ScenarioError: elements, layout or spacing that no array has.
        SolveError: no position reaches every node.
    """
    kind = _combining(combining)
    array = _array(scenario, elements, layout, spacing_wavelengths)
    if scenario.objective != "min-sinr":
        raise UsageError(
            f"array: given a scenario with objective {scenario.objective!r}; allowed: min-sinr; "
            "arrays are not there for other objectives"
        )
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise UsageError(f"seed: given {seed!r}; allowed: a whole number of at least 0")
    began = time.perf_counter()
    task = ArrayTask.of(scenario, array, shared=kind == "analogue")
    bound = array_bound(task, seed=seed, time_limit_s=_PROOF_S)
    state, counts = _search(task, bound, seed)
    pose = Pose(state[:3], 0.0, 0.0, math.remainder(state[3], 2.0 * math.pi))
    weights, links = _evaluated(scenario, array, kind, pose, state[4:])
    objective = objective_of(scenario, links, bound.value)
    if objective.value > bound.value:  # by rounding
        objective = replace(objective, upper_bound=objective.value, relative_gap=0.0)
    return ArraySolution(
        scenario=scenario,
        combining=kind,
        elements=array.elements,
        layout=array.layout,
        spacing_wavelengths=array.spacing_wavelengths,
        status=Status.BEST_FOUND,
        objective=objective,
        pose=pose,
        weights=weights,
        links=links,
        stats=ArrayStats(wall_s=time.perf_counter() - began, boxes=bound.nodes, **counts),
        provenance=provenance(seed),
        note=_note(array.elements, objective),
    )


def _combining(name: str) -> Combining:
    for known in COMBININGS:
        if name == known:
            return known
    raise UsageError(f"combining: given {name!r}; allowed: {', '.join(COMBININGS)}")


def _array(
    scenario: Scenario, elements: int | None, layout: str | None, spacing_wavelengths: float | None
) -> Array:
    """Return the array that is meant: what is given, and the scenario's for the rest."""
    asked = {"elements": elements, "layout": layout, "spacing_wavelengths": spacing_wavelengths}
    stated = {} if scenario.array is None else scenario.array.to_dict()
    values = stated | {key: value for key, value in asked.items() if value is not None}
    missing = [key for key in asked if key not in values]
    if missing:
        raise UsageError(
            f"array: {', '.join(missing)} not given; add a table headed [array] to the scenario, or give "
            "elements, layout and spacing_wavelengths"
        )
    return Array.from_dict(values)


def _search(task: ArrayTask, bound: ArrayBound, seed: int) -> tuple[FloatArray, dict[str, int]]:
    """Return the best state of several independent searches, and the counts for the statistics."""
    vertical = multistart(task.family, AxisField.vertical(), seed=seed)
    places_m = np.vstack([vertical.position_m, bound.position_m, landmarks(task.family)])
    ends: list[float] = []
    best, best_state = -math.inf, np.empty(0)
    starts, evaluations = vertical.starts, vertical.evaluations
    ceiling = math.log(bound.value) - _CLOSED
    while len(ends) < _SEARCHES and best < ceiling and _agreeing(ends) < _AGREEING:
        rng = np.random.default_rng([seed, len(ends)])
        found = search_array(task, rng, places_m)
        each = [finished(task, state) for state in found.states]
        value, state = max(each, key=lambda end: end[0], default=(-math.inf, best_state))
        ends.append(value)
        starts, evaluations = starts + found.climbs, evaluations + found.evaluations
        if value > best:
            best, best_state = value, state
    if not best > -math.inf:
        raise SolveError("no position was found at which every node is received; widen the airspace")
    counts = {
        "starts": starts,
        "evaluations": evaluations,
        "searches": len(ends),
        "agreeing": _agreeing(ends),
    }
    return best_state, counts


def _agreeing(ends: list[float]) -> int:
    """Return how many searches ended at the best value of all."""
    return sum(end > max(ends) - _SAME for end in ends)


def _evaluated(
    scenario: Scenario, array: Array, combining: Combining, pose: Pose, phases_rad: FloatArray
) -> tuple[NDArray[np.complex128], tuple[Link, ...]]:
    """Return the weights and every node's link, by the physics."""
    places = element_positions(array.elements, array.layout, array.spacing_wavelengths, pose.yaw_rad)
    if combining == "digital":
        weights = digital_weights(scenario, pose.position_m, places)
        ratios = digital_sinr(scenario, pose.position_m, places)
    else:
        weights = analogue_weights(phases_rad)
        ratios = analogue_sinr(scenario, pose.position_m, places, phases_rad)
    margins = ratios / scenario.node_required_sinr
    return weights, tuple(
        Link(
            node=name,
            sinr=float(ratio),
            sinr_db=float(to_db(ratio)),
            margin=float(margin) if scenario.has_margins else None,
            margin_db=float(to_db(margin)) if scenario.has_margins else None,
        )
        for name, ratio, margin in zip(scenario.node_names, ratios, margins, strict=True)
    )


def _note(elements: int, objective: Objective) -> str:
    """Return a sentence on what the bound is and how far it lies above the value."""
    above = f"it lies {100.0 * (objective.relative_gap or 0.0):.2g} % above the value"
    if elements == 1:
        return f"one element is the vertical case, and the bound is that case's: {above}"
    return (
        f"the bound is {elements} times what one vertical dipole can receive with the jammers silent; "
        f"{above}, of which nothing else is proved"
    )
