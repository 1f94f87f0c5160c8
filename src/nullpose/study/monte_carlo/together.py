"""The cases of many scenes that can be solved together, in one compiled loop."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from nullpose.scenario import Airframe, Scenario
from nullpose.solve import ManySolutions, solve_many
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.rows import FAILED, Row, row_of
from nullpose.study.monte_carlo.solving import found, options_of
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["At", "solved_together"]

At = tuple[int, int]  # a scene's number and that of a combination of swept values


def solved_together(spec: StudySpec, scenes: Mapping[At, Scenario]) -> dict[tuple[int, int, str], Row]:
    """Return the rows of those cases that can be solved together, by scene, combination and case.

    A row is the same whatever is solved beside it. What cannot be solved so is left out.

    Args:
        spec: the study.
        scenes: by number and combination.
    """
    alike: dict[str, list[StudyCase]] = defaultdict(list)  # by target and limits
    for case in spec.cases:
        if case.is_best_pose:
            alike[repr(options_of(spec, case))].append(case)
    vehicles: dict[Airframe | None, dict[At, Scenario]] = defaultdict(dict)  # by the scene's own
    for at, scene in scenes.items():
        if not scene.objective_record.transmits:
            plain = scene if scene.array is None else scene.model_copy(update={"array": None})
            vehicles[scene.airframe][at] = plain
    rows = (
        row
        for cases in alike.values()
        for own, some in vehicles.items()
        for row in _rows(spec, cases, own, some)
    )
    return {(row["scene"], row["point"], row["case"]): row for row in rows}


def _rows(
    spec: StudySpec, cases: Sequence[StudyCase], own: Airframe | None, scenes: Mapping[At, Scenario]
) -> Iterator[Row]:
    """Yield the rows of cases with the same target and limits in scenes with the same vehicle."""
    began, places = time.perf_counter(), list(scenes.items())
    try:
        many = solve_many(
            list(scenes.values()),
            airframes=[case.airframe or own for case in cases],
            **options_of(spec, cases[0]),
        )
    except Exception:  # one of them is at fault: the others are not lost, nor solved in another way
        middle = len(places) // 2
        for some in (places[:middle], places[middle:]) if middle else ():
            yield from _rows(spec, cases, own, dict(some))
        return
    seconds = (time.perf_counter() - began) / (len(scenes) * len(cases))
    for number, (at, scene) in enumerate(places):
        for column, case in enumerate(cases):
            yield row_of(*at, case.name, seconds=seconds, **_known(many, (number, column), scene))


def _known(many: ManySolutions, at: tuple[int, int], scene: Scenario) -> dict[str, Any]:
    status, reason = many.status[at], str(many.reason[at])
    if status is None:
        return {"status": FAILED, "reason": reason}
    place = (*many.position_m[at], many.roll_rad[at], many.pitch_rad[at], many.yaw_rad[at])
    columns = found(status, place, many.value[at], float(many.upper_bound[at]), float(many.relative_gap[at]))
    node = scene.node_names[int(many.binding_node[at])]
    return columns | {"reason": reason, "binding_node": node, "boxes": int(many.boxes[at])}
