"""An array in place of the tilting dipole: the best position and yaw of a level vehicle that carries one."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import UsageError
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import ErrorCase, Pose
from nullpose.physics.array import (
    analogue_sinr,
    analogue_weights,
    digital_sinr,
    digital_weights,
    element_positions,
)
from nullpose.physics.evaluate import links_of
from nullpose.scenario import Array, Scenario, require_scenario
from nullpose.solve.array_bound import ArrayBound, array_bound
from nullpose.solve.array_search import ArrayHunt
from nullpose.solve.array_task import ArrayTask
from nullpose.solve.compiling import working_clock
from nullpose.solve.options import SolveKeywords, SolveOptions
from nullpose.solve.provenance import provenance
from nullpose.solve.result import Result, Stats, objective_of, status_of

COMBININGS = "digital", "analogue"
"""The ways to combine the elements: each node with its own weights, or one beam of phase shifters for all."""

_SHORT = {
    "digital": "box limit reached",
    "analogue": "the bound is the one for digital combining, which analogue combining cannot exceed",
}  # why a gap was not reached
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

    combining: str
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

    def ratios_under(self, scenario: Scenario, pose: Pose, case: ErrorCase) -> FloatArray:
        """Return every node's margin when error cases come true and digital combining follows them.

        Args:
            scenario: nodes, jammers and receiver.
            pose: the commanded pose.
            case: where vehicle and jammers actually are, in one case or several.
        """
        places = element_positions(self.elements, self.layout, self.spacing_wavelengths, pose.yaw_rad)
        return digital_sinr(scenario, pose.position_m, places, case) / scenario.node_required_sinr

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
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: unknown combining, a bad gap or seed, no array given, or another objective than min-sinr.
        ScenarioError: elements, layout or spacing that no array has.
        SolveError: no position reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> result = nullpose.solve_array(
        ...     scenario, elements=2, layout="linear", spacing_wavelengths=0.5, gap=1e-2
        ... )
        >>> round(result.objective.value_db, 2), result.weights.shape  # a row of weights for each node
        (4.1, (2, 2))
    """
    require_scenario(scenario)
    if combining not in COMBININGS:
        raise UsageError(f"combining: given {combining!r}; allowed: {', '.join(COMBININGS)}")
    array = _array(scenario, elements, layout, spacing_wavelengths)
    if scenario.objective_record.transmits:
        raise UsageError(
            f"array: given a scenario with objective {scenario.objective!r}; allowed: one "
            "under which the drone receives; arrays are not there for others"
        )
    asked = SolveOptions(**options).of(scenario)
    began = working_clock()
    task = ArrayTask.of(scenario, array, shared=combining == "analogue")
    hunt, bound = _solved(task, asked)
    pose = Pose(hunt.state[:3], 0.0, 0.0, math.remainder(hunt.state[3], 2.0 * math.pi))
    weights, ratios = _evaluated(scenario, array, combining, pose, hunt.state[4:])
    links = links_of(scenario, ratios)
    value = Quantity.of(scenario).least(links)
    objective = objective_of(scenario, value, None if bound is None else bound.value)
    reached = bound is None or hunt.reaches(bound.value, asked.target)
    status, reason = status_of(objective, asked.target, "" if reached else _SHORT[combining])
    return Result(
        scenario=scenario,
        scheme=f"array-{combining}",
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
        provenance=provenance(asked.seed) | asked.settings,
        reason=reason,
        details=ArrayDetails(combining=combining, weights=weights, **array.to_dict()),
    )


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


def _solved(task: ArrayTask, asked: SolveOptions) -> tuple[ArrayHunt, ArrayBound | None]:
    """Return the searches, and what is proved if that is asked for.

    Digital: one search and a proof, then more searches, and another proof, where that does not get there;
    what turns up in the first proof is taken up. Analogue: the bound of digital combining, then searches.
    """
    if not asked.certify:
        return _searched(ArrayHunt(task, asked.seed)), None
    hunt = ArrayHunt(task.digital(), asked.seed)
    hunt.search()
    effort = _WATCHED if task.problem.shared else 1.0
    bound = array_bound(hunt.task, hunt.best, gap=asked.target, effort=effort)
    if task.problem.shared:
        return _searched(ArrayHunt(task, asked.seed, hunt.state[:3]), bound.value, asked.target), bound
    if hunt.reaches(bound.value, asked.target):
        return hunt, bound
    before = hunt.best
    if bound.state is not None:
        hunt.look(bound.state)
    if _searched(hunt).best <= before + asked.target:
        return hunt, bound
    again = array_bound(task, hunt.best, gap=asked.target)
    return hunt, replace(again, value=min(bound.value, again.value), boxes=bound.boxes + again.boxes)


def _searched(hunt: ArrayHunt, bound: float = math.inf, gap: float = 0.0) -> ArrayHunt:
    """Search until another search is not likely to change anything, or a bound is reached."""
    while hunt.is_open and not hunt.reaches(bound, gap):
        hunt.search()
    return hunt


def _evaluated(
    scenario: Scenario, array: Array, combining: str, pose: Pose, phases_rad: FloatArray
) -> tuple[NDArray[np.complex128], FloatArray]:
    """Return the weights and every node's SINR, by the physics."""
    places = element_positions(array.elements, array.layout, array.spacing_wavelengths, pose.yaw_rad)
    if combining == "digital":
        weights = digital_weights(scenario, pose.position_m, places)
        return weights, digital_sinr(scenario, pose.position_m, places)
    return analogue_weights(phases_rad), analogue_sinr(scenario, pose.position_m, places, phases_rad)
