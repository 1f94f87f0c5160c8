"""Faults between the parts of a scenario, judged from raw values so that a broken part hides no other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.ground_points import Jammer, Node
from nullpose.scenario.names import is_unnamed, named
from nullpose.scenario.room import has_room
from nullpose.scenario.units import Position
from nullpose.scenario.wording import plain

__all__ = ["cross_faults"]

SAME_PLACE_M = 1e-6
"""Two ground points closer than this are at the same place [m]."""


@dataclass(frozen=True, slots=True)
class _Point:
    """What can be told of a raw node or jammer."""

    place: Place
    name: str | None
    unnamed: bool
    position_m: tuple[float, float, float] | None


def cross_faults(data: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    """Yields the faults between the values of a raw scenario, each with its place.

    Two nodes or jammers may be as close as they like, within the keep-out radius too, but not at the
    same place: neither the null nor the directions of a pair would be defined.
    """
    points = [*_points(data.get("nodes"), "nodes", Node), *_points(data.get("jammers"), "jammers", Jammer)]
    yield from _shared_names(points)
    yield from _shared_places(points)
    yield from _no_room(data.get("airspace"), points)


def _points(members: object, key: str, kind: type[Node] | type[Jammer]) -> Iterator[_Point]:
    members = plain(members)
    if not isinstance(members, list | tuple):
        return
    for index, (raw, member) in enumerate(zip(members, named(members, kind.letter), strict=True)):
        name = _value(member, "name")
        yield _Point(
            place=(key, index),
            name=name if isinstance(name, str) else None,
            unnamed=is_unnamed(raw),
            position_m=_position(_value(member, "position_m")),
        )


def _value(member: object, key: str) -> object:
    return member.get(key) if isinstance(member, Mapping) else getattr(member, key, None)


@cache
def _position_type() -> TypeAdapter[Any]:
    return TypeAdapter(Position)


def _position(value: object) -> tuple[float, float, float] | None:
    try:
        x, y, z = _position_type().validate_python(value)
    except ValidationError:
        return None
    return x, y, z


def _shared_names(points: list[_Point]) -> Iterator[tuple[Place, str]]:
    owners: dict[str, _Point] = {}
    for point in points:
        if point.name is None:
            continue
        owner = owners.setdefault(point.name, point)
        if owner is point:
            continue
        given = f'left out, which means "{point.name}" here' if point.unnamed else f'got "{point.name}"'
        message = f"{given}, the name of {path_of(owner.place)} already; every name may be used once"
        yield (*point.place, "name"), message


def _shared_places(points: list[_Point]) -> Iterator[tuple[Place, str]]:
    placed = [point for point in points if point.position_m is not None]
    positions_m = np.array([point.position_m for point in placed], dtype=np.float64).reshape(-1, 3)
    for index, point in enumerate(placed):
        earlier_m = np.linalg.norm(positions_m[:index] - positions_m[index], axis=1)
        if index == 0 or earlier_m.min() >= SAME_PLACE_M:
            continue
        owner = placed[int(earlier_m.argmin())]
        message = (
            f"got {list(point.position_m or ())}, the place of {path_of(owner.place)} already; "
            "nodes and jammers must be at different places; move or remove one"
        )
        yield (*point.place, "position_m"), message


def _no_room(airspace: object, points: list[_Point]) -> Iterator[tuple[Place, str]]:
    try:
        box = Airspace.model_validate(airspace)
    except ValidationError:
        return
    centres_m = np.array([point.position_m for point in points if point.position_m], dtype=np.float64)
    if not has_room(box.lower_m, box.upper_m, centres_m.reshape(-1, 3), box.keep_out_m):
        message = (
            f"every position in it is less than keep_out_m = {box.keep_out_m!r} m from a node or jammer, so "
            "there is no room for the vehicle; widen altitude_m, x_m or y_m, or make keep_out_m smaller"
        )
        yield ("airspace",), message
