"""Where on the Earth the local frame stands, and points that are stated by latitude and longitude."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from nullpose.scenario.arrays import read_only
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.geodesy import enu_from_geodetic
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.section import Section
from nullpose.scenario.units import GEODETIC_KEYS, Altitude, Latitude, Longitude

FARTHEST_M = 1e5
"""A point farther from the origin than this is taken for a mistake [m]."""

_SAME_M = 1e-3  # position_m and the geodetic keys may be given together if they agree within this
POINT_LISTS = ("nodes", "jammers", "eavesdroppers")
"""The keys of a scenario's points."""
_WORDS = "lat_deg, lon_deg and alt_m"


class Origin(Section):
    """The place on the Earth (WGS-84) where east, north and up are zero.

    Args:
        lat_deg: geodetic latitude [degrees], north positive.
        lon_deg: longitude [degrees], east positive.
        alt_m: altitude over the ellipsoid [m], not over the sea or the ground.
    """

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


def located(data: Mapping[str, object]) -> Mapping[str, object]:
    """Returns a raw scenario in which points stated by latitude and longitude have their position_m too.

    Where it cannot be told, for want of an origin or because it is too far from it, position_m is zero: such
    a scenario is refused for that.

    Args:
        data: the raw scenario.
    """
    origin = _place(data.get("origin"))
    members = {key: value for key in POINT_LISTS if isinstance(value := data.get(key), list | tuple)}
    return {**data} | {key: [_located(point, origin) for point in points] for key, points in members.items()}


def _located(point: object, origin: Origin | None) -> object:
    """Returns a raw point with its position_m, if it is stated by latitude and longitude."""
    if not isinstance(point, Mapping):
        return point
    stated = {key for key in ("position_m", *GEODETIC_KEYS) if point.get(key) is not None}
    if not stated or "position_m" in stated:
        return point
    place, position_m = _place(point), np.zeros(3)
    if place is not None and origin is not None:
        position_m = enu_from_geodetic(place.geodetic, origin.geodetic)
    is_near = np.linalg.norm(position_m) <= FARTHEST_M
    return {**point, "position_m": position_m.tolist() if is_near else [0.0, 0.0, 0.0]}


def _place(stated: object) -> Origin | None:
    """Returns the place that a raw table states by latitude and longitude, or None."""
    if isinstance(stated, Mapping):
        stated = {key: stated.get(key) for key in GEODETIC_KEYS}
    with suppress(ValidationError):
        return Origin.model_validate(stated)
    return None


def origin_faults(
    origin: Origin | None, points: Mapping[Place, GroundPoint], stated: Mapping[str, Any]
) -> Iterator[tuple[Place, str]]:
    """Yields what is wrong between the origin and the points of a scenario, each with its place.

    Args:
        origin: the origin, if there is one.
        points: the points by their place.
        stated: the raw scenario, which says in which way each is stated.
    """
    earthly = {place: point for place, point in points.items() if None not in _geodetic(point)}
    if origin is None:
        for place in [place for place, point in points.items() if _geodetic(point) != (None,) * 3][:1]:
            yield (
                ("origin",),
                f"missing, but {path_of(place)} is stated by {_WORDS}; add a table headed [origin] with "
                f"{_WORDS} of the place where position_m is to be [0, 0, 0]",
            )
    yield from _mixed(earthly, points, stated)
    if not earthly or origin is None:
        return
    enu_m = enu_from_geodetic([_geodetic(point) for point in earthly.values()], origin.geodetic)
    for (place, point), place_m in zip(earthly.items(), enu_m, strict=True):
        if (away_m := np.linalg.norm(place_m)) > FARTHEST_M:
            yield (
                place,
                f"{_WORDS} are {away_m / 1e3:.0f} km from the origin, must be within "
                f"{FARTHEST_M / 1e3:.0f} km; are latitude and longitude exchanged, or a sign lost?",
            )
        elif (apart_m := np.linalg.norm(np.subtract(point.position_m or place_m, place_m))) > _SAME_M:
            yield (
                place,
                f"position_m and {_WORDS} are {apart_m:.3g} m apart, must be one place; remove either",
            )


def _mixed(
    earthly: Collection[Place], points: Mapping[Place, GroundPoint], stated: Mapping[str, Any]
) -> Iterator[tuple[Place, str]]:
    """Yields the first point that is stated in another way than the first of all.

    A point that has both, as in files that are written from scenarios, goes with either.
    """
    ways: dict[str, Place] = {}
    for place in points:
        raw = stated[str(place[0])][place[1]]
        in_metres = not isinstance(raw, Mapping) or raw.get("position_m") is not None
        if in_metres != (place in earthly):
            ways.setdefault("position_m" if in_metres else _WORDS, place)
    if len(ways) == 2:
        (first_way, first), (way, place) = ways.items()
        yield place, f"stated by {way}, but {path_of(first)} by {first_way}; state all in one way"


def is_placed(point: GroundPoint) -> bool:
    """Returns whether a point of a scenario that may be at fault has a position, and no half of another."""
    return point.position_m is not None and _geodetic(point).count(None) in (0, 3)


def _geodetic(point: GroundPoint) -> tuple[Any, Any, Any]:
    return (point.lat_deg, point.lon_deg, point.alt_m)
