"""Scenes in motion: their instants, where everything is at each, and still scenes whose points move on."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, reduce
from itertools import chain
from operator import getitem
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, Field

from nullpose.errors import ScenarioError, UsageError, require_usage
from nullpose.files import PlainTable
from nullpose.scenario.airspace import BORDER_M, Airspace
from nullpose.scenario.faults import EXCHANGED, Place, faults_of, value_of
from nullpose.scenario.geodesy import geodetic_from_enu
from nullpose.scenario.ground_points import PLACE, SAME_PLACE_M, GroundPoint
from nullpose.scenario.origin import FARTHEST_M, POINT_LISTS, Origin, in_metres
from nullpose.scenario.reach import free_distance_m
from nullpose.scenario.rules import Limits
from nullpose.scenario.section import Floats, Section, read_only
from nullpose.scenario.track import MOTION
from nullpose.scenario.units import ALTITUDE_KEYS

if TYPE_CHECKING:
    from nullpose.scenario.scenario import Scenario

_Point = TypeVar("_Point", bound=GroundPoint)
MOST_INSTANTS = 100_000
"""The most instants of a scene."""
FLIGHT_KEYS = ("speed_max_m_s", "start_m", "end_m")
"""The keys of an airframe that count in a scene in motion alone."""
_MOTION = tuple(chain(*MOTION.groups))
_SAME_PLACE_M = 1e-3
_ROUNDING = 1e-9  # of a step: a last step as short as this is none
_Span = Annotated[float, Limits("a time in s", 1e-6, 1e9, "it is more than 0")]


class Time(Section):
    """The instants of a scene in motion: 0, one step, two steps and so on, and the end.

    Args:
        duration_s: time of the last instant [s].
        step_s: from one instant to the next [s]; the last step may be shorter.
    """

    duration_s: _Span = Field(description="How long the scene lasts, in seconds.", examples=[60.0])
    step_s: _Span = Field(
        description="From one instant to the next, in seconds; the last step may be shorter.", examples=[1.0]
    )

    def faults(self, raw: PlainTable) -> list[tuple[Place, str]]:
        """List a step that is longer than the scene, or so short that it has too many instants."""
        if self.duration_s is None or self.step_s is None:
            return []
        return faults_of(
            (
                self.step_s > self.duration_s,
                ("step_s",),
                f"got {self.step_s:g}, must be at most duration_s = {self.duration_s:g}; make it shorter",
            ),
            (
                self._steps >= MOST_INSTANTS,
                ("step_s",),
                f"got {self.step_s:g}, with which there are {self._steps + 1:,} instants, must be at most "
                f"{MOST_INSTANTS:,}; make it longer, or duration_s shorter",
            ),
        )

    @property
    def _steps(self) -> int:
        return math.ceil(self.duration_s / self.step_s - _ROUNDING)

    @cached_property
    def instants_s(self) -> Floats:
        """The times of the instants [s], (n,); the last is exactly the duration."""
        return read_only([*(self.step_s * np.arange(self._steps)), self.duration_s], (-1,))


def is_moving(point: GroundPoint) -> bool:
    """Tell whether a point of a scenario states a motion."""
    return point.velocity_m_s is not None or point.track is not None


def places_m(point: GroundPoint, origin: Origin | None, times_s: ArrayLike) -> Floats:
    """Compute where a point is at some times, east, north and up from the origin [m], (..., 3).

    Args:
        point: of a sound scenario.
        origin: of the scenario.
        times_s: from 0 to its duration [s], (...).
    """
    times_s = np.asarray(times_s, dtype=np.float64)
    start_m = np.asarray(point.position_m)
    if point.track is None:
        velocity_m_s = np.asarray(point.velocity_m_s or (0.0, 0.0, 0.0))
        return np.asarray(start_m + times_s[..., None] * velocity_m_s)
    rows_s, rows_m = np.array(point.track)[:, 0], _track_m(point, origin)
    if rows_s[0] > 0.0:
        rows_s, rows_m = np.append(0.0, rows_s), np.vstack([start_m, rows_m])
    return np.stack([np.interp(times_s, rows_s, axis) for axis in rows_m.T], axis=-1)


def _track_m(point: GroundPoint, origin: Origin | None) -> Floats:
    """Return the places of the rows of a track [m], (n, 3); none if the origin does not tell them."""
    places: Floats = np.array(point.track)[:, 1:]
    if point.lat_deg is None:
        return places
    table = dict(zip(("lat_deg", "lon_deg", _altitude_key(point)), places.T, strict=True))
    found = {} if origin is None else in_metres(table, origin)
    return np.asarray(found.get("position_m", np.empty((0, 3))))


def _altitude_key(point: GroundPoint) -> str:
    return next((key for key in ALTITUDE_KEYS if getattr(point, key) is not None), ALTITUDE_KEYS[0])


def _keys_in(table: object, keys: Sequence[str]) -> list[str]:
    return [key for key in keys if value_of(table, key) is not None]


def time_of(scenario: Scenario, purpose: str) -> Time:
    """Return the times of a scene in motion.

    Args:
        scenario: any.
        purpose: what they are needed for.

    Raises:
        UsageError: nothing moves in the scene.
    """
    if scenario.time is None:
        raise UsageError(f"{purpose}, but the scene has no [time]; allowed: a scene in motion; add [time]")
    return scenario.time


def still_at(scenario: Scenario, t_s: float) -> Scenario:
    """Return the scenario in which everything stands where it is at an instant, as :meth:`Scenario.at`."""
    last_s = time_of(scenario, f"at: given {t_s:g} s").duration_s
    require_usage(
        0.0 <= t_s <= last_s, f"at: given {t_s:g} s; allowed: 0 to {last_s:g} s, the duration of the scene"
    )
    origin, end, airframe = scenario.origin, scenario.destination, scenario.airframe
    words = f"(at {t_s:.10g} s)"
    still: PlainTable = {
        "time": None,
        "at_s": t_s,
        "name": f"{scenario.name} {words}".strip(),
        "airframe": airframe and airframe.model_copy(update=dict.fromkeys(FLIGHT_KEYS)),
    }
    try:
        points = {
            kind: tuple(_still(point, origin, t_s) for point in getattr(scenario, kind))
            for kind in POINT_LISTS
        }
        return scenario.model_copy(update=still | points | {"destination": end and _still(end, origin, t_s)})
    except ScenarioError as error:
        raise ScenarioError(error.faults, f"the scene {words}") from None


def _still(point: _Point, origin: Origin | None, t_s: float) -> _Point:
    """Return a point that stands where one that may move is at a time."""
    if not is_moving(point):
        return point
    position_m = places_m(point, origin, t_s)
    update: PlainTable = {"position_m": position_m, **dict.fromkeys(_MOTION)}
    if point.lat_deg is not None and origin is not None:
        key = _altitude_key(point)
        lat_deg, lon_deg, height_m = geodetic_from_enu(position_m, origin.geodetic).tolist()
        zero_m = 0.0 if key == "alt_agl_m" else getattr(origin, key)
        update |= {"lat_deg": lat_deg, "lon_deg": lon_deg, key: height_m - origin.geodetic[2] + zero_m}
    return point.model_copy(update=update)


def motion_faults(
    scenario: Scenario, points: Mapping[Place, GroundPoint], raw: Any
) -> Iterator[tuple[Place, str]]:
    """Yield the faults between the instants of a scene and what moves in it, each with its place.

    Args:
        scenario: as for ``scenario_faults``.
        points: its points by their place.
        raw: the raw scenario.
    """
    time, airframe = scenario.time, scenario.airframe
    moves = [(*place, key) for place, point in points.items() for key in _keys_in(point, _MOTION)]
    if raw.get("time") is None:
        flight = [("airframe", key) for key in _keys_in(airframe, FLIGHT_KEYS)]
        for place in [*moves, *flight][:1]:
            yield (
                place,
                "given, but the scene has no [time]; add a table headed [time] with duration_s and step_s, "
                "or remove this key",
            )
        return
    moves_when_read = any(_keys_in(reduce(getitem, place, raw), _MOTION) for place in points)
    yield from faults_of(
        (
            raw.get("at_s") is not None,
            ("at_s",),
            "given, but the scene has a [time] and so many instants; remove either",
        ),
        (
            not moves and not moves_when_read,
            ("time",),
            "given, but nothing moves; give a point velocity_m_s, track or track_from, or remove this table",
        ),
    )
    for place, point in points.items():
        if point.track is not None:
            yield from _track_faults(place, point, scenario.origin, time)
    if time and airframe and airframe.start_m and airframe.end_m and airframe.speed_max_m_s is not None:
        apart_m = math.dist(airframe.start_m, airframe.end_m)
        reach_m = airframe.speed_max_m_s * time.duration_s
        if apart_m > reach_m:
            yield (
                ("airframe", "end_m"),
                f"it is {apart_m:g} m from start_m, must be at most {reach_m:g}, which is speed_max_m_s = "
                f"{airframe.speed_max_m_s:g} times duration_s = {time.duration_s:g}; move it nearer",
            )


def _track_faults(
    place: Place, point: GroundPoint, origin: Origin | None, time: Time | None
) -> Iterator[tuple[Place, str]]:
    """Yield a track that ends early, that does not begin at the point's place, or goes far away."""
    rows, last = point.track or (), len(point.track or ()) - 1
    if time and time.duration_s is not None and rows[last][0] < time.duration_s:
        yield (
            (*place, "track", last, 0),
            f"the track ends at t = {rows[last][0]:g}, must go on to duration_s = {time.duration_s:g}; add a "
            "row, or make duration_s shorter",
        )
    rows_m = _track_m(point, origin)
    if point.position_m is None or not len(rows_m):
        return
    near = (np.linalg.norm(rows_m, axis=1) <= FARTHEST_M) & (np.abs(np.array(rows)[:, 1]) <= 90.0)
    if point.lat_deg is not None and not near.all():
        _, lat_deg, lon_deg, _ = rows[index := int(np.argmin(near))]
        yield (
            (*place, "track", index),
            f"got latitude {lat_deg:g} and longitude {lon_deg:g}, must be within {FARTHEST_M / 1e3:.0f} km "
            f"of the origin; {EXCHANGED}",
        )
    elif rows[0][0] == 0.0 and (apart_m := math.dist(rows_m[0], point.position_m)) > _SAME_PLACE_M:
        yield (
            (*place, "track", 0),
            f"at t = 0 it is {apart_m:.3g} m from the place stated beside it, must be one place; remove the "
            "place, or begin at it",
        )


def flight_faults(
    scenario: Scenario, airspace: Airspace, points: Mapping[Place, GroundPoint]
) -> Iterator[tuple[Place, str]]:
    """Yield a start or an end of the flight at which the vehicle may not be.

    Args:
        scenario: whose points and times are sound.
        airspace: with the buildings.
        points: all the ground points by their place.
    """
    ends = {"start_m": 0.0, "end_m": scenario.time.duration_s} if scenario.time else {}
    for key, t_s in ends.items():
        if (at_m := getattr(scenario.airframe, key, None)) is None:
            continue
        near_m = np.array([places_m(point, scenario.origin, t_s) for point in points.values()])
        if free_distance_m(airspace, near_m, np.array([at_m]))[0] < -BORDER_M:
            yield (
                ("airframe", key),
                f"got {list(at_m)}, which is outside the airspace, in a no-fly zone or a building, or less "
                f"than keep_out_m = {airspace.keep_out_m:g} m from a node or jammer at t = {t_s:g}; move it",
            )


_NEAR_M = 1e6  # of the origin along each axis: beyond, and for what is no number, a place is judged in full
LINE = np.array([0.48, 0.6, 0.64]) * [1.0, np.sqrt(0.9), np.sqrt(1.1)]
"""A direction, nearly of unit length, along which few points of a scene are at one place."""
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
    update = _points_at(
        scenario, places_m, lambda point, at_m: BaseModel.model_copy(point, update={"position_m": at_m})
    )
    moved = BaseModel.model_copy(scenario, update=update)
    for name in vars(moved).keys() - type(scenario).model_fields.keys():
        if not name.endswith(_OF_NO_PLACE):
            del vars(moved)[name]
    at_m = moved.point_positions_m
    is_sound = (
        np.all(np.abs(at_m) <= _NEAR_M)
        and np.all(np.diff(np.sort(at_m @ LINE)) > 2.0 * SAME_PLACE_M)
        and not any(building.holds(place_m) for building in scenario.buildings for place_m in at_m)
        and not (scenario.is_uncertain or any(point.lat_deg is not None for point in scenario.points))
    )
    if is_sound:
        return moved
    earthly = dict.fromkeys(PLACE.others("position_m"))
    update = _points_at(scenario, places_m, lambda point, at_m: dict(point) | earthly | {"position_m": at_m})
    return scenario.model_copy(update=update)


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
