"""Many scenes in one call: a compiled loop, and arrays of results."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import UsageError
from nullpose.family import AxisField, Family, build_family
from nullpose.physics import antenna_axis, attitude_from_axis, attitude_within_tilt, margins_of_many
from nullpose.scenario import Airframe, Scenario
from nullpose.solve.batch import Batch, BatchOutcome, same_shape
from nullpose.solve.options import SolveKeywords, SolveOptions
from nullpose.solve.proof import INTERRUPT
from nullpose.solve.result import Status
from nullpose.solve.rigour import Rigour, bound_above

__all__ = ["NOWHERE", "ManySolutions", "solve_many"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

NOWHERE = "no position was found at which every node is received"
"""The reason of a scene without a pose."""

_BLOCK = 64  # scenes between two reports


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ManySolutions:
    """The answers to many scenes: arrays by scene and airframe, (s, a).

    Args:
        value: the smallest margin over the nodes, which is the smallest SINR (paper eq. 2.2) where no node
            states a weight or a requirement, evaluated at the pose: a power ratio. Not a number where there
            is no pose.
        upper_bound: no pose exceeds this; infinity where nothing is proved.
        status: how each ended, a :class:`Status`; None where there is no pose.
        reason: what kept it from being certified; empty where it was.
        position_m: (s, a, 3) metres.
        roll_rad: radians, as yaw and pitch.
        pitch_rad: likewise.
        yaw_rad: likewise.
        binding_node: index of the node that decides.
        boxes: boxes of positions that the proof examined; 0 where a vehicle with more freedom had shown it.
    """

    value: FloatArray
    upper_bound: FloatArray
    status: NDArray[np.object_]
    reason: NDArray[np.object_]
    position_m: FloatArray
    roll_rad: FloatArray
    pitch_rad: FloatArray
    yaw_rad: FloatArray
    binding_node: IntArray
    boxes: IntArray

    @property
    def rigour(self) -> Rigour:
        """How sure the bounds are: no certificates are kept of many scenes."""
        return Rigour.FLOATING_POINT if np.any(np.isfinite(self.upper_bound)) else Rigour.NONE

    @property
    def relative_gap(self) -> FloatArray:
        """``(upper_bound - value) / value``, (s, a)."""
        return np.asarray(self.upper_bound / self.value - 1.0)

    @classmethod
    def blank(cls, scenes: int, airframes: int) -> ManySolutions:
        """Return one to be filled.

        Args:
            scenes: how many.
            airframes: for each.
        """
        shape = (scenes, airframes)
        return cls(
            value=np.full(shape, math.nan),
            upper_bound=np.full(shape, math.inf),
            status=np.full(shape, None, dtype=object),
            reason=np.full(shape, "", dtype=object),
            position_m=np.full((*shape, 3), math.nan),
            roll_rad=np.full(shape, math.nan),
            pitch_rad=np.full(shape, math.nan),
            yaw_rad=np.full(shape, math.nan),
            binding_node=np.full(shape, -1),
            boxes=np.zeros(shape, dtype=np.int64),
        )


def solve_many(
    scenarios: Sequence[Scenario],
    *,
    airframes: Sequence[Airframe | None] | None = None,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> ManySolutions:
    """Return the best poses of many scenes, each for one airframe or for several, with their bounds.

    What :func:`solve` does for one scene with the scheme optimum, without its cost in Python: scenes of one
    shape are searched and proved in one compiled loop. Airframes are solved from the one with most freedom
    down: what bounds a vehicle bounds any that reaches fewer axes, and its pose is theirs if they reach it,
    so that most of them need no proof of their own. Values are evaluated by :mod:`nullpose.physics`.

    Args:
        scenarios: what to solve; the smallest SINR or margin, not a secrecy rate, and one dipole each.
        airframes: the vehicles to try in every scene, None for an omnidirectional one; each scenario's own
            without them.
        on_progress: called now and then with how many scenes are done and how many there are.
        options: as for :func:`solve`; proofs of the usual size are not interrupted by a time limit.

    Raises:
        UsageError: a scenario of another kind, no scenario, a bad seed or limit.
        KeyboardInterrupt: Ctrl-C; nothing is returned.
    """
    asked = SolveOptions(**options)
    _check(scenarios)
    if airframes is not None and not len(airframes):
        raise UsageError("airframes: given none; allowed: one or more")
    results = ManySolutions.blank(len(scenarios), 1 if airframes is None else len(airframes))
    done = 0
    for indices, families in _groups(scenarios, own=airframes is None):
        first = scenarios[indices[0]]
        of_group = asked.of(first)
        vehicles = [first.airframe] if airframes is None else airframes
        for start in range(0, len(indices), _BLOCK):
            some = np.array(indices[start : start + _BLOCK])
            block = [scenarios[index] for index in some]
            for column, known in _solved(families[start : start + _BLOCK], vehicles, of_group):
                _fill(block, some, vehicles[column], known, column, results)
            done += len(some)
            if on_progress is not None:
                on_progress(done, len(scenarios))
    return results


def _check(scenarios: Sequence[Scenario]) -> None:
    if not len(scenarios):
        raise UsageError("scenarios: given none; allowed: one or more")
    for index, scenario in enumerate(scenarios):
        if scenario.objective_record.transmits or scenario.array is not None:
            kind = "an array" if scenario.array is not None else "a secrecy rate"
            verb = "solve_array" if scenario.array is not None else "solve"
            raise UsageError(
                f"scenarios[{index}]: asks for {kind}; allowed: the smallest SINR or margin of one dipole; "
                f"use {verb}"
            )


def _groups(scenarios: Sequence[Scenario], *, own: bool) -> list[tuple[list[int], list[Family]]]:
    """Return the scenes by the shape of their families, and by their own airframes if those count."""
    groups: dict[object, tuple[list[int], list[Family]]] = defaultdict(lambda: ([], []))
    for index, scenario in enumerate(scenarios):
        family = build_family(scenario)
        indices, families = groups[same_shape(family), scenario.airframe if own else None]
        indices.append(index)
        families.append(family)
    return list(groups.values())


def _solved(
    families: list[Family], vehicles: Sequence[Airframe | None], options: SolveOptions
) -> Iterator[tuple[int, BatchOutcome]]:
    """Yield what each vehicle reaches in scenes of one shape, the one with most freedom first."""
    batch = Batch(families)
    bands = [(0.0, 1.0) if vehicle is None else vehicle.axis_band for vehicle in vehicles]
    solved: dict[tuple[float, float], BatchOutcome] = {}
    for column in sorted(range(len(bands)), key=lambda c: bands[c][0] - bands[c][1]):
        band = bands[column]
        if band not in solved:
            known = BatchOutcome.blank(len(families), len(families[0].numerator_point))
            for wider, larger in solved.items():
                if wider[0] <= band[0] and band[1] <= wider[1]:
                    known.learn_from(larger, band)
            batch.solve_and_prove(AxisField.within(*band), options, known)
            if INTERRUPT in known.reason:
                raise KeyboardInterrupt
            solved[band] = known
        yield column, solved[band]


def _fill(
    scenarios: Sequence[Scenario],
    indices: IntArray,
    airframe: Airframe | None,
    known: BatchOutcome,
    column: int,
    results: ManySolutions,
) -> None:
    """Put an airframe's answers into the results, their values evaluated at the poses."""
    placed = known.placed
    results.reason[indices[~placed], column] = NOWHERE
    some = indices[placed]
    if not len(some):
        return
    position_m = known.position_m[placed]
    mount_rad = 0.0 if airframe is None else airframe.mount_rad
    if airframe is None:
        roll, pitch = attitude_from_axis(known.axis[placed])
        yaw = np.zeros_like(roll)
    else:
        roll, pitch, yaw = attitude_within_tilt(known.axis[placed], airframe.tilt_max_rad, mount_rad)
    axis = antenna_axis(roll, pitch, yaw, mount_rad)
    here = [scenarios[place] for place in np.flatnonzero(placed).tolist()]
    margins = margins_of_many(here, position_m, axis)
    results.binding_node[some, column] = np.argmin(margins, axis=1)
    results.value[some, column] = value = np.min(margins, axis=1)
    results.upper_bound[some, column] = bound_above(value, known.bound[placed])
    results.position_m[some, column] = position_m
    for angle, name in ((roll, "roll_rad"), (pitch, "pitch_rad"), (yaw, "yaw_rad")):
        getattr(results, name)[some, column] = angle
    results.boxes[some, column] = known.boxes[placed]
    certified, proved = known.certified[placed], np.isfinite(known.bound[placed])
    results.status[some, column] = Status.BEST_FOUND
    results.status[some[certified], column] = Status.CERTIFIED
    results.status[some[~certified & proved], column] = Status.GAP_NOT_REACHED
    for index, place in zip(some, np.flatnonzero(placed), strict=True):
        results.reason[index, column] = known.reason[place]
