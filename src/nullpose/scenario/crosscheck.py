"""Faults between the parts of a scenario, judged from raw values so that a broken part hides no other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel, TypeAdapter, ValidationError

from nullpose.scenario.airframe import Airframe
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.array import Array
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.ground_points import Eavesdropper, Jammer, Node
from nullpose.scenario.names import is_unnamed, named
from nullpose.scenario.no_fly import NoFlyZone
from nullpose.scenario.polygon import MOST_CORNERS
from nullpose.scenario.reach import Known, has_any_room, reach_faults
from nullpose.scenario.uncertainty import Uncertain
from nullpose.scenario.units import ErrorMetres, Position
from nullpose.scenario.wording import plain

__all__ = ["cross_faults"]

_Table = TypeVar("_Table", bound=BaseModel)

SAME_PLACE_M = 1e-6
"""Two ground points closer than this are at the same place [m]."""


@dataclass(frozen=True, slots=True)
class _Member:
    """What can be told of a raw member of a list of tables."""

    place: Place
    raw: object
    name: str | None
    unnamed: bool

    @property
    def position_m(self) -> tuple[float, float, float] | None:
        position: tuple[float, float, float] | None = _read(Position, _value(self.raw, "position_m"))
        return position


def cross_faults(data: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    """Yields the faults between the values of a raw scenario, each with its place.

    Two nodes or jammers may be as close as they like, within the keep-out radius too, but not at the
    same place: neither the null nor the directions of a pair would be defined.
    """
    points = [
        *_members(data.get("nodes"), ("nodes",), Node.letter),
        *_members(data.get("jammers"), ("jammers",), Jammer.letter),
        *_members(data.get("eavesdroppers"), ("eavesdroppers",), Eavesdropper.letter),
    ]
    zones = _value(data.get("airspace"), "no_fly")
    yield from _shared_names(points)
    yield from _shared_names(list(_members(zones, ("airspace", "no_fly"), NoFlyZone.letter)))
    yield from _shared_places(points)
    yield from _array_on_a_tilting_vehicle(data)
    airspace = _table(Airspace, data.get("airspace"))
    if airspace is None:
        return
    corners = sum(max(1, len(zone.outline_m)) for zone in airspace.no_fly) + len(airspace.geofence_outline_m)
    if corners > MOST_CORNERS:
        yield (
            ("airspace",),
            f"its geofence and no-fly zones have {corners} corners, must be at most {MOST_CORNERS} in all; "
            "leave out those that change the areas least",
        )
        return
    known = [_known(point) for point in points if point.position_m]
    if has_any_room(airspace, known):
        error_m = _read(ErrorMetres, _value(data.get("receiver"), "position_error_m"))
        yield from reach_faults(airspace, known, error_m or 0.0)
    else:
        yield ("airspace",), _no_room(airspace)


def _members(members: object, at: Place, letter: str) -> Iterator[_Member]:
    members = plain(members)
    if not isinstance(members, list | tuple):
        return
    for index, (raw, member) in enumerate(zip(members, named(members, letter), strict=True)):
        name = _value(member, "name")
        yield _Member((*at, index), raw, name if isinstance(name, str) else None, is_unnamed(raw))


def _value(table: object, key: str) -> object:
    if isinstance(table, Mapping):
        return table.get(key)
    return getattr(table, key, None) if isinstance(table, BaseModel) else None


@cache
def _adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)


def _read(kind: Any, value: object) -> Any:
    """Returns the value as its kind reads it, or None where it has a fault of its own."""
    try:
        return _adapter(kind).validate_python(value)
    except ValidationError:
        return None


def _table(kind: type[_Table], value: object) -> _Table | None:
    try:
        return None if value is None else kind.model_validate(value)
    except ValidationError:
        return None


def _known(point: _Member) -> Known:
    keys = ("uncertainty_m", "uncertainty_attitude_deg")
    given = {key: _value(point.raw, key) for key in keys if point.place[0] != "nodes"}
    extent = _table(Uncertain, given) or Uncertain()
    return Known(
        point.place, np.asarray(point.position_m), extent.uncertainty_matrix_m, extent.uncertainty_reach_m
    )


def _shared_names(members: list[_Member]) -> Iterator[tuple[Place, str]]:
    owners: dict[str, _Member] = {}
    for member in members:
        if member.name is None:
            continue
        owner = owners.setdefault(member.name, member)
        if owner is member:
            continue
        given = f'left out, which means "{member.name}" here' if member.unnamed else f'got "{member.name}"'
        message = f"{given}, the name of {path_of(owner.place)} already; every name may be used once"
        yield (*member.place, "name"), message


def _shared_places(points: list[_Member]) -> Iterator[tuple[Place, str]]:
    placed = [point for point in points if point.position_m is not None]
    positions_m = np.array([point.position_m for point in placed], dtype=np.float64).reshape(-1, 3)
    lists = np.array([point.place[0] for point in placed])
    # Who jams may listen as well: a jammer and an eavesdropper may be at one place.
    may_be = {"jammers": "eavesdroppers", "eavesdroppers": "jammers"}
    for index, point in enumerate(placed):
        earlier_m = np.linalg.norm(positions_m[:index] - positions_m[index], axis=1)
        earlier_m[lists[:index] == may_be.get(lists[index], "")] = np.inf
        if earlier_m.min(initial=np.inf) >= SAME_PLACE_M:
            continue
        owner = placed[int(earlier_m.argmin())]
        kinds = " and ".join(dict.fromkeys([str(owner.place[0]), str(lists[index])]))
        message = (
            f"got {list(point.position_m or ())}, the place of {path_of(owner.place)} already; "
            f"{kinds} must be at different places; move or remove one"
        )
        yield (*point.place, "position_m"), message


def _array_on_a_tilting_vehicle(data: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    airframe, array = _table(Airframe, data.get("airframe")), _table(Array, data.get("array"))
    if airframe is not None and array is not None and airframe.axis_band != (1.0, 1.0):
        message = (
            "an array is of upright dipoles on a level vehicle, but [airframe] tilts it or mounts the dipole "
            "at an angle; remove either table"
        )
        yield ("array",), message


def _no_room(airspace: Airspace) -> str:
    bounds = ["altitude_m, x_m or y_m"]
    causes = [f"is less than keep_out_m = {airspace.keep_out_m!r} m from a node or jammer"]
    if airspace.no_fly:
        causes.append("in a no-fly zone")
        bounds.append("make a zone smaller")
    if airspace.geofence_m is not None:
        causes.append("outside the geofence")
        bounds.append("move the geofence")
    return (
        f"every position in it {', or '.join(causes)}, so there is no room for the vehicle; widen "
        f"{', '.join(bounds)}, or make keep_out_m smaller"
    )
