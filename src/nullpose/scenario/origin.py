"""Where on the Earth the local frame stands, the metres of what is stated there, and its faults."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import reduce
from itertools import chain
from operator import getitem
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, ValidationError

from nullpose.errors import require_usage
from nullpose.files import PlainTable
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.buildings import Building
from nullpose.scenario.faults import EXCHANGED, Place, path_of, value_of
from nullpose.scenario.geodesy import enu_from_geodetic, geodetic_from_enu
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.no_fly import NoFlyZone
from nullpose.scenario.section import Floats, Section, optional, read_only
from nullpose.scenario.track import place_of_start
from nullpose.scenario.units import (
    ALTITUDE_KEYS,
    EARTHLY,
    EARTHLY_CORNERS,
    EARTHLY_RANGES,
    PLACE_KEYS,
    Altitude,
    Latitude,
    Longitude,
    SeaAltitude,
)
from nullpose.scenario.ways import Ways

FARTHEST_M = 1e5
"""What is farther from the origin than this is taken for a mistake [m]."""

DRAWN_LISTS = ("nodes", "jammers", "eavesdroppers")
"""The keys of a scenario's points that a study may draw."""
POINT_LISTS = (*DRAWN_LISTS, "sources")
"""The keys of all its points in lists."""
_PLACEHOLDERS: PlainTable = {  # of what cannot be told; such a scenario is refused for that
    "position_m": [0.0, 0.0, 0.0],
    "centre_m": [0.0, 0.0],
    "altitude_m": [1.0, 2.0],
    "geofence_m": [[0.0, 0.0], [1e4, 0.0], [0.0, 1e4]],
    "polygon_m": [[0.0, 0.0], [1e4, 0.0], [0.0, 1e4]],
    "courtyards_m": [],
}


class Origin(Section, ways=(Ways((("alt_m",), ("alt_msl_m",)), most=2),)):
    """The place on the Earth (WGS-84) where east, north and up are zero.

    Args:
        lat_deg: geodetic latitude [degrees], north positive.
        lon_deg: longitude [degrees], east positive.
        alt_m: altitude over the ellipsoid [m], not over the sea or the ground; or else
        alt_msl_m: altitude over the sea [m]; both where altitudes of both kinds are stated or wanted.
    """

    lat_deg: Latitude = Field(
        description="Latitude of the origin in degrees (WGS-84), north positive.", examples=[50.0]
    )
    lon_deg: Longitude = Field(
        description="Longitude of the origin in degrees (WGS-84), east positive.", examples=[14.5]
    )
    alt_m: Altitude | None = optional(
        "Altitude of the origin in metres over the WGS-84 ellipsoid. This, alt_msl_m or both.", 250.0
    )
    alt_msl_m: SeaAltitude | None = optional(
        "Altitude of the origin in metres over the sea (the geoid). This, alt_m or both, which "
        "says how far sea and ellipsoid are apart.",
        205.0,
    )

    @property
    def geodetic(self) -> NDArray[np.float64]:
        """Latitude, longitude [degrees] and altitude [m], (3,), read-only.

        The altitude is over the ellipsoid, or over the sea if only that is known: in the local frame the two
        differ by less than a hundred-thousandth of a distance.
        """
        return read_only(
            [self.lat_deg, self.lon_deg, (self.alt_msl_m if self.alt_m is None else self.alt_m) or 0.0], (3,)
        )

    def place(self, position_m: ArrayLike) -> dict[str, float]:
        """Convert a position to a place on the Earth.

        Args:
            position_m: east, north and up from the origin [m], (3,).

        Returns:
            ``lat_deg``, ``lon_deg`` and, as far as the origin tells its own, ``alt_m`` over the ellipsoid and
            ``alt_msl_m`` over the sea [m].

        Example:
            >>> origin = Origin(lat_deg=50.0, lon_deg=14.5, alt_m=230.0, alt_msl_m=185.0)
            >>> {key: round(value, 6) for key, value in origin.place([0.0, 0.0, 20.0]).items()}
            {'lat_deg': 50.0, 'lon_deg': 14.5, 'alt_m': 250.0, 'alt_msl_m': 205.0}
        """
        lat_deg, lon_deg, height_m = geodetic_from_enu(position_m, self.geodetic).tolist()
        bases_m = {"alt_m": self.alt_m, "alt_msl_m": self.alt_msl_m}
        zero_m = float(self.geodetic[2])
        return {"lat_deg": lat_deg, "lon_deg": lon_deg} | {
            key: height_m + (base - zero_m) for key, base in bases_m.items() if base is not None
        }

    def position_m(self, place: Mapping[str, float]) -> Floats:
        """Convert a place on the Earth to east, north and up from the origin [m], (3,).

        Args:
            place: ``lat_deg``, ``lon_deg`` [degrees], and ``alt_m`` over the ellipsoid, ``alt_msl_m`` over
                the sea or ``alt_agl_m`` above the ground at the origin [m].

        Raises:
            UsageError: it is more than 100 km away; or its altitude is over what the origin does not state.

        Example:
            >>> origin = Origin(lat_deg=50.0, lon_deg=14.5, alt_m=230.0)
            >>> origin.position_m({"lat_deg": 50.001, "lon_deg": 14.5, "alt_agl_m": 20.0}).round(2) + 0.0
            array([  0.  , 111.23,  20.  ])
        """
        *_, altitude = place
        require_usage(
            altitude == "alt_agl_m" or getattr(self, altitude) is not None,
            f"{altitude}: given, but [origin] does not state its own {altitude}; allowed: an altitude "
            f"over what the origin states, or alt_agl_m; add {altitude} to [origin]",
        )
        lat_deg, lon_deg = place["lat_deg"], place["lon_deg"]
        found_m = in_metres(place, self)["position_m"]
        require_usage(
            abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0 and size_m(found_m) <= FARTHEST_M,
            f"lat_deg, lon_deg: given {lat_deg:g}, {lon_deg:g}; allowed: within "
            f"{FARTHEST_M / 1e3:.0f} km of the origin ({self.lat_deg:g}, {self.lon_deg:g}); {EXCHANGED}",
        )
        return found_m


def located(data: Mapping[str, object]) -> Mapping[str, object]:
    """Return a raw scenario in which what is stated on the Earth is there in metres too.

    Where that cannot be told, for want of an origin or because it is too far from it, there are placeholders:
    such a scenario is refused for that.

    Args:
        data: the raw scenario.
    """
    try:
        origin = Origin.model_validate(data.get("origin"))
    except ValidationError:
        origin = None
    kinds: dict[str, type[Section]] = {
        **dict.fromkeys((*POINT_LISTS, "destination"), GroundPoint),
        "buildings": Building,
        "airspace": Airspace,
    }
    start = _keys_of_starts(data)
    whole = {**data} | {key: _located(kinds[key], data[key], origin, start) for key in kinds if key in data}
    if isinstance(airspace := whole.get("airspace"), Mapping) and "no_fly" in airspace:
        whole["airspace"] = {**airspace, "no_fly": _located(NoFlyZone, airspace["no_fly"], origin)}
    return whole


def _keys_of_starts(data: Mapping[str, object]) -> Sequence[str]:
    """List the keys of the place at which the tracks of a raw scenario begin on the Earth; none in metres.

    They are on the Earth in a scenario with an origin in which no point states its place in metres alone.
    """
    listed = [data.get(key) for key in (*POINT_LISTS, "destination")]
    points = chain.from_iterable(each if isinstance(each, list | tuple) else [each] for each in listed)
    is_metric = any(
        value_of(each, "position_m") is not None and value_of(each, "lat_deg") is None for each in points
    )
    if is_metric or (origin := data.get("origin")) is None:
        return ()
    return "lat_deg", "lon_deg", "alt_msl_m" if value_of(origin, "alt_m") is None else "alt_m"


def _located(kind: type[Section], raw: object, origin: Origin | None, start: Sequence[str] = ()) -> Any:
    """Return a raw table, or a list of such, with the metres that follow from what it states on the Earth.

    A point that states no place is where its track begins.
    """
    if isinstance(raw, list | tuple):
        return [_located(kind, each, origin, start) for each in raw]
    if not isinstance(raw, Mapping):
        return raw
    if start and not raw.keys() & PLACE_KEYS and (place := place_of_start(raw)):
        raw = {**raw, **dict(zip(start, place, strict=True))}
    earthly = {key: raw[key] for key in EARTHLY if raw.get(key) is not None}
    if not (wanted := [EARTHLY[key] for key in earthly if raw.get(EARTHLY[key]) is None]):
        return raw
    sound = dict(kind._sound_part(earthly))
    found = {} if origin is None else in_metres(sound, origin)
    near: dict[str, Any] = {
        key: value.tolist()
        for key, value in found.items()
        if key == "altitude_m" or size_m(value) <= FARTHEST_M
    }
    if rings := sound.get("courtyards_lat_lon_deg"):
        near["courtyards_m"] = [
            yard["polygon_m"]
            for yard in (_located(kind, {"polygon_lat_lon_deg": ring}, origin) for ring in rings)
        ]
    return {**raw} | {key: near.get(key, _PLACEHOLDERS[key]) for key in wanted}


def in_metres(table: Mapping[str, Any], origin: Origin) -> dict[str, Floats]:
    """Convert the keys of a table that state places on the Earth to metres, by key.

    Args:
        table: of a point, an airspace or a zone; None stands for what is not stated or at fault.
        origin: where the metres count from.
    """
    *_, base_m = origin.geodetic
    found: dict[str, Floats] = {
        metric: enu_from_geodetic(np.insert(corners, 2, base_m, axis=-1), origin.geodetic)[..., :2]
        for key, metric in EARTHLY_CORNERS.items()
        if (corners := table.get(key)) is not None
    }
    heights_m = [
        value + (base_m - zero_m)
        for key in ALTITUDE_KEYS
        if (value := table.get(key)) is not None
        and (zero_m := 0.0 if key == "alt_agl_m" else getattr(origin, key)) is not None
    ]
    place: list[Any] = [table.get(key) for key in ("lat_deg", "lon_deg")]
    if heights_m and all(each is not None for each in place):
        whole = np.stack([*place, heights_m[0]], axis=-1)
        found["position_m"] = enu_from_geodetic(whole, origin.geodetic)
    for key, of_origin in EARTHLY_RANGES.items():
        ends_m, zero_m = table.get(key), getattr(origin, of_origin)
        if ends_m is not None and zero_m is not None:
            found["altitude_m"] = np.subtract(ends_m, zero_m)
    return found


def size_m(values: Floats) -> float:
    """Measure the greatest length of some vectors, or of one [m]."""
    return float(np.linalg.norm(np.atleast_2d(values), axis=-1).max())


_SAME_PLACE_M = 1e-3  # metres and degrees of one thing may be given together if they agree within this
_OVER = {"alt_m": "over the ellipsoid", "alt_msl_m": "over the sea"}


def origin_faults(
    origin: Origin | None, tables: Mapping[Place, Section], raw: PlainTable
) -> Iterator[tuple[Place, str]]:
    """Yield the faults between the origin and the points and areas of a scenario, each with its place.

    Args:
        origin: the origin, if there is one.
        tables: the points, the airspace and its zones, by their place.
        raw: the raw scenario, which says in which way each is stated.
    """
    earthly = {
        place: keys
        for place, table in tables.items()
        if (keys := [key for key in EARTHLY if getattr(table, key, None) is not None])
    }
    yield from _mixed(
        {place: table for place, table in tables.items() if isinstance(table, GroundPoint)}, raw
    )
    if origin is None:
        for place, keys in list(earthly.items())[:1]:
            yield (
                ("origin",),
                f"missing, but {path_of(place)} is stated by {_words(keys)}; add a table headed [origin] "
                "with lat_deg, lon_deg and alt_m (or alt_msl_m) of the place where position_m is to be "
                "[0, 0, 0]",
            )
        return
    yield from _unknown_altitudes(origin, earthly)
    metres = {place: in_metres(dict(tables[place]), origin) for place in earthly}
    far = list(_far(metres))
    yield from far
    if not far:
        yield from _apart(tables, earthly, metres)


def _words(keys: Sequence[str]) -> str:
    return " and ".join(filter(None, [", ".join(keys[:-1]), keys[-1]]))


def _more(places: Collection[Place]) -> str:
    """Say in brackets in how many further places the same is at fault."""
    return f" (and so in {len(places) - 1} more)" if len(places) > 1 else ""


def _unknown_altitudes(
    origin: Origin, earthly: Mapping[Place, Collection[str]]
) -> Iterator[tuple[Place, str]]:
    """Yield, once for each kind of altitude, that the origin does not say its own of that kind."""
    for base, over in _OVER.items():
        keys = {base, *(key for key, of_origin in EARTHLY_RANGES.items() if of_origin == base)}
        at_fault = [
            (*place, key) for place, keys_there in earthly.items() for key in keys_there if key in keys
        ]
        if getattr(origin, base) is None and at_fault:
            (other,) = _OVER.keys() - {base}
            yield (
                at_fault[0],
                f"an altitude {over}, but [origin] states only {other}, {_OVER[other]}"
                f"{_more(at_fault)}; the two differ by up to 100 m; add {base} to [origin], or state "
                "altitudes as [origin] does",
            )


def _far(metres: Mapping[Place, Mapping[str, Floats]]) -> Iterator[tuple[Place, str]]:
    """Yield, once for all, that places are too far from the origin."""
    far_m = {
        (*place, *(key for key, of in EARTHLY_CORNERS.items() if of == metric)): size_m(value)
        for place, values in metres.items()
        for metric, value in values.items()
        if metric != "altitude_m" and size_m(value) > FARTHEST_M
    }
    for place, away_m in list(far_m.items())[:1]:
        yield (
            place,
            f"lat_deg and lon_deg are {away_m / 1e3:.0f} km from the origin, must be within "
            f"{FARTHEST_M / 1e3:.0f} km{_more(far_m)}; is a sign lost, or {EXCHANGED}",
        )


def _apart(
    tables: Mapping[Place, Section],
    earthly: Mapping[Place, Sequence[str]],
    metres: Mapping[Place, Mapping[str, Floats]],
) -> Iterator[tuple[Place, str]]:
    """Yield what is stated in metres and on the Earth, and not at one place."""
    for place, values in metres.items():
        for key, value in values.items():
            both = value if getattr(tables[place], key) is None else np.array(getattr(tables[place], key))
            apart = both - value if both.shape == value.shape else np.array(np.inf)
            if (apart_m := size_m(apart[:, None] if key == "altitude_m" else apart)) > _SAME_PLACE_M:
                how = _words([each for each in earthly[place] if EARTHLY[each] == key])
                yield (place, f"{key} and {how} are {apart_m:.3g} m apart, must be one place; remove either")


def _mixed(points: Mapping[Place, GroundPoint], raw: Any) -> Iterator[tuple[Place, str]]:
    """Yield the first point that is stated in another way than the first of all.

    A point that has both, as in files that are written from scenarios, goes with either.
    """
    firsts: dict[bool, tuple[str, Place]] = {}
    for place, point in points.items():
        table = reduce(getitem, place, raw)
        has_metres = not isinstance(table, Mapping) or table.get("position_m") is not None
        if has_metres != _is_earthly(point):
            keys = [key for key in EARTHLY if getattr(point, key, None) is not None]
            firsts.setdefault(has_metres, ("position_m" if has_metres else _words(keys), place))
    if len(firsts) == 2:
        (first_words, first), (words, place) = firsts.values()
        yield place, f"stated by {words}, but {path_of(first)} by {first_words}; state all in one way"


def _is_earthly(point: GroundPoint) -> bool:
    altitudes = [getattr(point, key) for key in ALTITUDE_KEYS]
    return None not in (point.lat_deg, point.lon_deg) and altitudes.count(None) < len(altitudes)


def is_placed(point: GroundPoint) -> bool:
    """Tell whether a point of a scenario that may be at fault has a position, and no half of another."""
    has_part = any(getattr(point, key) is not None for key in ("lat_deg", "lon_deg", *ALTITUDE_KEYS))
    return point.position_m is not None and has_part == _is_earthly(point)
