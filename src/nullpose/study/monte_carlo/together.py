"""The cases of many scenes that can be solved together, in one compiled loop."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

from nullpose.scenario import Airframe, Scenario
from nullpose.schemes import Scheme
from nullpose.solve import ManySolutions, solve_many
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.rows import FAILED, Row
from nullpose.study.monte_carlo.solving import limits_of
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["Instance", "solved_together"]

Instance = tuple[int, int, Scenario]
"""A scene's number, a combination's number, and the scene at that combination."""


def solved_together(spec: StudySpec, instances: Sequence[Instance]) -> dict[tuple[int, int, int], Row]:
    """Return the rows of those cases that can be solved together, by scene, combination and case.

    A row is the same whatever is solved beside it. What cannot be solved so is left out.

    Args:
        spec: the study.
        instances: the scenes.
    """
    rows: dict[tuple[int, int, int], Row] = {}
    for places in _groups(spec):
        for vehicles, some in _by_vehicles(spec, places, instances):
            for row in _rows(spec, places, vehicles, some):
                rows[row.scene, row.point, row.case] = row
    return rows


def _groups(spec: StudySpec) -> list[list[int]]:
    """Return the places of cases with one dipole and the same target and limits, group by group."""
    groups: dict[str, list[int]] = defaultdict(list)
    for place, case in enumerate(spec.cases):
        if _is_usual(case):
            groups[repr(limits_of(spec, case))].append(place)
    return list(groups.values())


def _is_usual(case: StudyCase) -> bool:
    return (
        not case.robust and case.array is None and case.pose is None and case.scheme in (None, Scheme.OPTIMUM)
    )


def _by_vehicles(
    spec: StudySpec, places: Sequence[int], instances: Sequence[Instance]
) -> Iterator[tuple[tuple[Airframe | None, ...], list[Instance]]]:
    """Yield the scenes that have the same vehicles in all cases, with these; scenes without arrays."""
    found: dict[tuple[Airframe | None, ...], list[Instance]] = defaultdict(list)
    for index, point, scene in instances:
        if scene.objective == "min-sinr":
            vehicles = tuple(spec.cases[place].airframe or scene.airframe for place in places)
            plain = scene if scene.array is None else scene.model_copy(update={"array": None})
            found[vehicles].append((index, point, plain))
    yield from found.items()


def _rows(
    spec: StudySpec,
    places: Sequence[int],
    vehicles: tuple[Airframe | None, ...],
    instances: Sequence[Instance],
) -> Iterator[Row]:
    scenes = [scene for _, _, scene in instances]
    began = time.perf_counter()
    try:
        found = solve_many(scenes, airframes=vehicles, **limits_of(spec, spec.cases[places[0]]))
    except Exception:  # one of them is at fault: the others are not lost, nor solved in another way
        middle = len(instances) // 2
        for some in (instances[:middle], instances[middle:]) if middle else ():
            yield from _rows(spec, places, vehicles, some)
        return
    seconds = (time.perf_counter() - began) / (len(scenes) * len(places))
    for number, (index, point, scene) in enumerate(instances):
        for column, place in enumerate(places):
            values = _values(found, number, column, scene)
            yield Row(scene=index, point=point, case=place, seconds=seconds, **values)


def _values(found: ManySolutions, number: int, column: int, scene: Scenario) -> dict[str, Any]:
    at = (number, column)
    status = found.status[at]
    if status is None:
        return {"status": FAILED, "reason": str(found.reason[at])}
    value, bound = float(found.value[at]), float(found.upper_bound[at])
    x_m, y_m, z_m = found.position_m[at].tolist()
    return {
        "status": str(status.value),
        "reason": str(found.reason[at]),
        "value": value,
        "bound": bound if math.isfinite(bound) else None,
        "gap": bound / value - 1.0 if math.isfinite(bound) else None,
        "position_m": (x_m, y_m, z_m),
        "attitude_rad": (float(found.roll_rad[at]), float(found.pitch_rad[at]), float(found.yaw_rad[at])),
        "binding_node": scene.node_names[int(found.binding_node[at])],
        "boxes": int(found.boxes[at]),
    }
