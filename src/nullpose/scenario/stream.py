"""Still scenes whose points move on many times a second."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import BaseModel

from nullpose.scenario.arrays import Floats
from nullpose.scenario.crosscheck import SAME_PLACE_M
from nullpose.scenario.ground_points import PLACE, GroundPoint

if TYPE_CHECKING:
    from nullpose.scenario.scenario import Scenario

_NEAR_M = 1e6  # of the origin along each axis: beyond, and for what is no number, a place is judged in full
_LINE = np.array([0.48, 0.6, 0.64]) * [1.0, np.sqrt(0.9), np.sqrt(1.1)]  # few points have one shadow on it
_OF_NO_PLACE = ("_powers_w", "_required_sinr", "_antennas", "_channels", "open_airspace", "prisms")
"""How the names of arrays end that stay where points move."""


def move_points(scenario: Scenario, places_m: Mapping[str, Floats]) -> Scenario:
    """Move points of a still scene, in some ten microseconds where it is plain that no place is at fault.

    Args:
        scenario: the scene.
        places_m: places of all points of some keys, as in ``"nodes"``, ``(n, 3)``, metres.

    Raises:
        ScenarioError: a place is no place, or one where no point may be: that of another, say.
    """
    moved = BaseModel.model_copy(scenario, update=_points_at(scenario, places_m, _unjudged))
    for name in vars(moved).keys() - type(scenario).model_fields.keys():
        if not name.endswith(_OF_NO_PLACE):
            del vars(moved)[name]
    at_m = moved.point_positions_m
    is_sound = (
        np.all(np.abs(at_m) <= _NEAR_M)
        and np.all(np.diff(np.sort(at_m @ _LINE)) > 2.0 * SAME_PLACE_M)
        and not any(building.holds(place_m) for building in scenario.buildings for place_m in at_m)
        and not (scenario.is_uncertain or any(point.lat_deg is not None for point in scenario.points))
    )
    return moved if is_sound else scenario.model_copy(update=_points_at(scenario, places_m, _to_judge))


def _points_at(
    scenario: Scenario, places_m: Mapping[str, Floats], make: Callable[[Any, Sequence[float]], object]
) -> dict[str, Any]:
    """Make the points of some keys of a scene at other places."""
    moved: dict[str, Any] = {}
    for kind, at_m in places_m.items():
        points = scenario.destinations if kind == "destination" else getattr(scenario, kind)
        made = tuple(map(make, points, map(tuple, at_m.tolist())))
        moved[kind] = made[0] if kind == "destination" else made
    return moved


def _unjudged(point: GroundPoint, place_m: Sequence[float]) -> GroundPoint:
    return BaseModel.model_copy(point, update={"position_m": place_m})


def _to_judge(point: GroundPoint, place_m: Sequence[float]) -> dict[str, object]:
    return {**dict(point), **dict.fromkeys(PLACE.others("position_m")), "position_m": place_m}
