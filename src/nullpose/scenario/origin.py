"""Where on the Earth the local frame stands, and points that are stated by latitude and longitude."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import PydanticCustomError

from nullpose.scenario.arrays import read_only
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.geodesy import enu_from_geodetic
from nullpose.scenario.section import Section
from nullpose.scenario.units import Quantity
from nullpose.scenario.wording import nearest, plain

__all__ = [
    "FARTHEST_M",
    "GEODETIC_KEYS",
    "Altitude",
    "Latitude",
    "Longitude",
    "Origin",
    "located",
    "origin_faults",
    "unlocated",
]

GEODETIC_KEYS = ("lat_deg", "lon_deg", "alt_m")
"""The keys that state a place on the Earth: all three, or none."""

FARTHEST_M = 1e5
"""A point farther from the origin than this is taken for a mistake [m]."""

_SAME_M = 1e-3  # position_m and the geodetic keys may be given together if they agree within this
_POINT_LISTS = ("nodes", "jammers", "eavesdroppers")
_WORDS = "lat_deg, lon_deg and alt_m"

_LATITUDE = Quantity("a latitude in degrees", -90.0, 90.0, "north of the equator is positive")
_LONGITUDE = Quantity("a longitude in degrees", -180.0, 180.0, "east of Greenwich is positive")
_ALTITUDE = Quantity(
    "an altitude in m over the WGS-84 ellipsoid", -1e4, 1e5, "it is not the height above the ground"
)
Latitude = Annotated[float, _LATITUDE]
Longitude = Annotated[float, _LONGITUDE]
Altitude = Annotated[float, _ALTITUDE]


class Origin(Section):
    """The place on the Earth (WGS-84) where east, north and up are zero.

    Args:
        lat_deg: geodetic latitude [degrees], north positive.
        lon_deg: longitude [degrees], east positive.
        alt_m: altitude over the ellipsoid [m], not over the sea or the ground.
    """

    header: ClassVar[str] = "a table headed [origin]"

    lat_deg: Latitude = Field(
        description="Latitude of the origin in degrees (WGS-84), north positive.", examples=[50.0]
    )
    lon_deg: Longitude = Field(
        description="Longitude of the origin in degrees (WGS-84), east positive.", examples=[14.5]
    )
    alt_m: Altitude = Field(
        description="Altitude of the origin in metres over the WGS-84 ellipsoid.", examples=[250.0]
    )

    @property
    def geodetic(self) -> NDArray[np.float64]:
        """Latitude, longitude [degrees] and altitude [m], (3,), read-only."""
        return read_only([self.lat_deg, self.lon_deg, self.alt_m], (3,))


@dataclass(frozen=True, slots=True)
class _Point:
    """How a raw node, jammer or eavesdropper states its place."""

    place: Place
    geodetic: bool
    local: bool
    position_m: object
    enu_m: tuple[float, float, float] | None
    """Where its latitude and longitude put it, if that can be told [m]."""

    @property
    def far(self) -> bool:
        return self.enu_m is not None and bool(np.linalg.norm(self.enu_m) > FARTHEST_M)


def located(
    data: Mapping[str, object], unknown_m: tuple[float, float, float] | None = None
) -> Mapping[str, object]:
    """Returns a raw scenario in which points stated by latitude and longitude have their position_m too.

    Args:
        data: the raw scenario.
        unknown_m: what stands for a position that cannot be told, for want of an origin, say; the scenario
            has a fault then. Without it such a point stays without a position.
    """
    points = _points(data)
    if not any(point.geodetic and not point.local for point in points):
        return data
    changed = dict(data)
    for point in points:
        if point.local or not point.geodetic:
            continue
        key, index = point.place
        position_m = unknown_m if point.enu_m is None or point.far else point.enu_m
        if position_m is not None:
            members = changed[str(key)] = list(_members(changed, str(key)))
            members[int(index)] = {**_table(members[int(index)]), "position_m": position_m}
    return changed


def unlocated(data: Mapping[str, object]) -> None:
    """Takes position_m from the points of a plain scenario that are stated by latitude and longitude too.

    Args:
        data: the scenario's dictionary, which is changed.
    """
    for key in _POINT_LISTS:
        for member in _members(data, key):
            if isinstance(member, dict) and any(member.get(way) is not None for way in GEODETIC_KEYS):
                member.pop("position_m", None)


def origin_faults(data: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    """Yields what is wrong between the origin and the points of a raw scenario, each with its place."""
    points = _points(data)
    earthly = [point for point in points if point.geodetic]
    if earthly and data.get("origin") is None and not _misspelt_origin(data):
        yield (
            ("origin",),
            f"missing, but {path_of(earthly[0].place)} is stated by {_WORDS}; add a table headed [origin] "
            f"with {_WORDS} of the place where position_m is to be [0, 0, 0]",
        )
    yield from _mixed(points)
    for point in earthly:
        if point.enu_m is None:
            continue
        if point.far:
            yield (
                point.place,
                f"{_WORDS} are {np.linalg.norm(point.enu_m) / 1e3:.0f} km from the origin, must be within "
                f"{FARTHEST_M / 1e3:.0f} km; are latitude and longitude exchanged, or a sign lost?",
            )
        elif (apart_m := _apart_m(point)) > _SAME_M:
            yield (
                point.place,
                f"position_m and {_WORDS} are {apart_m:.3g} m apart, must be one place; remove either",
            )


def _misspelt_origin(data: Mapping[str, object]) -> bool:
    return any(nearest(str(key), ("origin",), at_least=0.8) for key in data)


def _mixed(points: list[_Point]) -> Iterator[tuple[Place, str]]:
    """Yields the first point that is stated in another way than the first of all.

    A point that has both, as in files that are written from scenarios, goes with either.
    """
    single = [point for point in points if point.local != point.geodetic]
    other = next((point for point in single if point.local != single[0].local), None)
    if other is not None:
        ways = ("position_m", _WORDS)
        mine, first = ways if other.local else ways[::-1]
        yield (
            other.place,
            f"stated by {mine}, but {path_of(single[0].place)} by {first}; "
            "state all points of a file in one of the two ways",
        )


def _apart_m(point: _Point) -> float:
    """Returns how far a point's two places are apart [m]; 0 if it has one, or one that is no position."""
    position_m = plain(point.position_m)
    if point.enu_m is None or not isinstance(position_m, list | tuple) or len(position_m) != 3:
        return 0.0
    if not all(isinstance(x, int | float) and abs(x) < 1e9 for x in position_m):
        return 0.0
    return float(np.linalg.norm(np.subtract(position_m, point.enu_m)))


def _points(data: Mapping[str, object]) -> list[_Point]:
    members = [
        ((key, index), _table(raw)) for key in _POINT_LISTS for index, raw in enumerate(_members(data, key))
    ]
    places = [_geodetic(table) for _, table in members]
    enu = iter(
        _enu_m([place for place in places if place is not None], _geodetic(_table(data.get("origin"))))
    )
    return [
        _Point(
            place=where,
            geodetic=any(table.get(key) is not None for key in GEODETIC_KEYS),
            local=table.get("position_m") is not None,
            position_m=table.get("position_m"),
            enu_m=None if place is None else next(enu),
        )
        for (where, table), place in zip(members, places, strict=True)
    ]


def _enu_m(
    places: list[tuple[float, float, float]], origin: tuple[float, float, float] | None
) -> list[tuple[float, float, float] | None]:
    if not places or origin is None:
        return [None] * len(places)
    return [(x, y, z) for x, y, z in enu_from_geodetic(places, origin).tolist()]


def _members(data: Mapping[str, object], key: str) -> list[object]:
    members = plain(data.get(key))
    return list(members) if isinstance(members, list | tuple) else []


def _table(raw: object) -> Mapping[str, object]:
    """Returns a raw table, or one already built, as a mapping; an empty one if it is neither."""
    if isinstance(raw, Section):
        return {key: getattr(raw, key) for key in type(raw).model_fields}
    return raw if isinstance(raw, Mapping) else {}


def _geodetic(table: Mapping[str, object]) -> tuple[float, float, float] | None:
    try:
        return (
            _LATITUDE.read(table.get("lat_deg")),
            _LONGITUDE.read(table.get("lon_deg")),
            _ALTITUDE.read(table.get("alt_m")),
        )
    except PydanticCustomError:
        return None
