"""An array in place of the tilting dipole: the best position and yaw of a level vehicle that carries one."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import Any, Literal, Unpack, get_args

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import UsageError
from nullpose.objectives import Quantity
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
from nullpose.solve.array_hunt import ArrayHunt
from nullpose.solve.array_task import ArrayTask
from nullpose.solve.options import SolveKeywords, SolveOptions
from nullpose.solve.provenance import provenance
from nullpose.solve.result import Objective, Result, Stats, Status, objective_of

__all__ = ["COMBININGS", "ArrayDetails", "solve_array"]

FloatArray = NDArray[np.float64]

Combining = Literal["digital", "analogue"]
"""Each node with its own weights, or one beam of phase shifters for all nodes."""

COMBININGS: tuple[Combining, ...] = get_args(Combining)
"""The ways to combine the elements."""

_WATCHED = 0.25  # effort of the proof where it is about digital combining and another value is asked for


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayDetails:
    """How an array's elements are placed and combined.

    Args:
        combining: ``"digital"`` (each node has its own weights) or ``"analogue"`` (one beam for all).
        elements: number of dipoles.
        layout: ``"linear"`` or ``"circular"``.
        spacing_wavelengths: distance between neighbours, in wavelengths.
        weights: what each element is multiplied by (its conjugate), of unit length: (n_nodes, K) digital,
            (K,) analogue; complex, read-only.
    """

    combining: Combining
    elements: int
    layout: str
    spacing_wavelengths: float
    weights: NDArray[np.complex128]

    def __post_init__(self) -> None:
        weights = np.array(self.weights, dtype=complex)
        weights.flags.writeable = False
        object.__setattr__(self, "weights", weights)

    @property
    def label(self) -> str:
        """The name of the case for tables, as in "array of 4, digital"."""
        return f"array of {self.elements}, {self.combining}"

    @property
    def phases_rad(self) -> NDArray[np.float64]:
        """The phases of the weights, shape as ``weights``, radians."""
        return np.asarray(np.angle(self.weights))

    def to_dict(self, objective: dict[str, Any]) -> dict[str, Any]:
        """Return the array as plain data for JSON; a weight is [real part, imaginary part].

        Args:
            objective: not needed here.
        """
        weights = np.stack([self.weights.real, self.weights.imag], axis=-1).tolist()
        names = ("elements", "layout", "spacing_wavelengths", "combining")
        stated = {name: getattr(self, name) for name in names}
        return {"array": stated | {"weights": weights}}


def solve_array(
    scenario: Scenario,
    combining: str = "digital",
    *,
    elements: int | None = None,
    layout: str | None = None,
    spacing_wavelengths: float | None = None,
    **options: Unpack[SolveKeywords],
) -> Result:
    """Return the best position, yaw and combining of an array of upright dipoles on a level vehicle.

    Maximises the smallest SINR over the nodes, each divided by what the node requires if any does. Digital:
    every node has weights of its own, which follow from position and yaw
    (:func:`nullpose.physics.digital_sinr`). Analogue: one beam of phase shifters serves all nodes
    (:func:`nullpose.physics.analogue_sinr`), and its phases are searched too. The value is
    re-evaluated by the physics from what is reported. The bound comes from a branch and bound over positions
    and yaws with digital combining, which a shared beam cannot exceed and mostly does not come near; an
    analogue value is the best of several independent searches.

    Args:
        scenario: nodes, jammers, receiver and airspace; its airframe and its uncertainty are not consulted.
        combining: ``"digital"`` or ``"analogue"``.
        elements: number of dipoles; the scenario's if left out, as the next two.
        layout: ``"linear"`` or ``"circular"``.
        spacing_wavelengths: distance between neighbours, in wavelengths.
        options: as for :func:`nullpose.solve`; limits of time and boxes are not consulted.

    Raises:
        UsageError: unknown combining, a bad gap or seed, no array given, or another objective than min-sinr.
        ScenarioError: elements, layout or spacing that no array has.
        SolveError: no position reaches every node.
    """
    kind = _combining(combining)
    array = _array(scenario, elements, layout, spacing_wavelengths)
    if scenario.objective_record.transmits:
        raise UsageError(
            f"array: given a scenario with objective {scenario.objective!r}; allowed: one "
            "under which the drone receives; arrays are not there for others"
        )
    asked = SolveOptions(**options).of(scenario)
    seed, target = asked.seed, asked.target
    began = time.perf_counter()
    task = ArrayTask.of(scenario, array, shared=kind == "analogue")
    if not asked.certify:
        hunt, bound = _searched(ArrayHunt(task, seed)), None
    else:
        hunt, bound = _digital(task, target, seed) if kind == "digital" else _analogue(task, target, seed)
    state = hunt.state
    pose = Pose(state[:3], 0.0, 0.0, math.remainder(state[3], 2.0 * math.pi))
    weights, links = _evaluated(scenario, array, kind, pose, state[4:])
    value = Quantity.of(scenario).least(links)
    objective = objective_of(scenario, value, None if bound is None else bound.value)
    status = _status(objective, target)
    return Result(
        scenario=scenario,
        scheme=f"array-{kind}",
        status=status,
        objective=objective,
        pose=pose,
        links=links,
        stats=Stats(
            wall_s=time.perf_counter() - began,
            starts=hunt.starts,
            evaluations=hunt.evaluations,
            boxes=0 if bound is None else bound.boxes,
            searches=len(hunt.ends),
            agreeing=hunt.agreeing,
        ),
        provenance=provenance(seed) | asked.settings,
        reason=_reason(kind) if status is Status.GAP_NOT_REACHED else "",
        details=ArrayDetails(
            combining=kind,
            elements=array.elements,
            layout=array.layout,
            spacing_wavelengths=array.spacing_wavelengths,
            weights=weights,
        ),
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


def _searched(hunt: ArrayHunt) -> ArrayHunt:
    """Search until another search is not likely to change anything."""
    while hunt.is_open:
        hunt.search()
    return hunt


def _digital(task: ArrayTask, gap: float, seed: int) -> tuple[ArrayHunt, ArrayBound]:
    """Return a search and a proof; more searches, and another proof, where that does not get there.

    What turns up in the first proof is taken up by the search.
    """
    hunt = ArrayHunt(task, seed)
    hunt.search()
    first = array_bound(task, hunt.best, gap=gap)
    if hunt.reaches(first.value, gap):
        return hunt, first
    before = hunt.best
    if first.state is not None:
        hunt.look(first.state)
    if _searched(hunt).best <= before + gap:
        return hunt, first
    second = array_bound(task, hunt.best, gap=gap)
    return hunt, replace(second, value=min(first.value, second.value), boxes=first.boxes + second.boxes)


def _analogue(task: ArrayTask, gap: float, seed: int) -> tuple[ArrayHunt, ArrayBound]:
    """Return several searches, and the bound of digital combining."""
    apart = ArrayHunt(task.digital(), seed)
    apart.search()
    bound = array_bound(apart.task, apart.best, gap=gap, effort=_WATCHED)
    hunt = ArrayHunt(task, seed, apart.state[:3])
    while hunt.is_open and not hunt.reaches(bound.value, gap):
        hunt.search()
    return hunt, bound


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


def _status(objective: Objective, gap: float) -> Status:
    if objective.relative_gap is None:
        return Status.BEST_FOUND
    return Status.CERTIFIED if objective.relative_gap <= gap else Status.GAP_NOT_REACHED


def _reason(combining: Combining) -> str:
    """Return why the gap was not reached."""
    if combining == "analogue":
        return "the bound is that of digital combining, which a shared beam does not reach"
    return "the most boxes of positions and yaws that are looked at"
