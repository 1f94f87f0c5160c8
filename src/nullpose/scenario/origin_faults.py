"""What is wrong between the origin and what is stated on the Earth."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from nullpose.scenario.faults import EXCHANGED, Place, path_of
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.origin import (
    EARTHLY_KEYS,
    FARTHEST_M,
    POINT_LISTS,
    Origin,
    in_metres,
    metric_key,
    size_m,
)
from nullpose.scenario.units import ALTITUDE_KEYS, EARTHLY_CORNERS, EARTHLY_RANGES

_SAME_M = 1e-3  # metres and degrees of one thing may be given together if they agree within this
_OVER = {"alt_m": "over the ellipsoid", "alt_msl_m": "over the sea"}


def origin_faults(
    origin: Origin | None, tables: Mapping[Place, Any], stated: Mapping[str, Any]
) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong between the origin and the points and areas of a scenario, each with its place.

    Args:
        origin: the origin, if there is one.
        tables: the points, the airspace and its zones, by their place.
        stated: the raw scenario, which says in which way each is stated.
    """
    earthly = {
        place: keys
        for place, table in tables.items()
        if (keys := [key for key in EARTHLY_KEYS if getattr(table, key, None) is not None])
    }
    yield from _mixed({place: table for place, table in tables.items() if place[0] in POINT_LISTS}, stated)
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
    found = {place: in_metres(tables[place], origin) for place in earthly}
    far: dict[Place, float] = {}
    swapped_m = 0.0
    for place, values in found.items():
        for metric, value in values.items():
            if metric != "altitude_m" and (away_m := size_m(value)) > FARTHEST_M:
                far[*place, *(key for key in EARTHLY_CORNERS if EARTHLY_CORNERS[key] == metric)] = away_m
                swapped_m = max(swapped_m, size_m(in_metres(tables[place], origin, swapped=True)[metric]))
    if far:
        yield _far(far, swapped_m)
        return
    for place, values in found.items():
        for key, value in values.items():
            own = value if getattr(tables[place], key) is None else np.array(getattr(tables[place], key))
            apart = own - value if own.shape == value.shape else np.array(np.inf)
            if (apart_m := size_m(apart[:, None] if key == "altitude_m" else apart)) > _SAME_M:
                how = _words([each for each in earthly[place] if metric_key(each) == key])
                yield (
                    place,
                    f"{key} and {how} are {apart_m:.3g} m apart, must be one place; remove either",
                )


def _words(keys: Sequence[str]) -> str:
    return " and ".join(filter(None, [", ".join(keys[:-1]), keys[-1]]))


def _unknown_altitudes(
    origin: Origin, earthly: Mapping[Place, Collection[str]]
) -> Iterator[tuple[Place, str]]:
    """Yields, once for each kind of altitude, that the origin does not say its own of that kind."""
    for own, over in _OVER.items():
        if getattr(origin, own) is None:
            keys = {own, *(key for key, base in EARTHLY_RANGES.items() if base == own)}
            at_fault = [(*place, key) for place, stated in earthly.items() for key in stated if key in keys]
            for place in at_fault[:1]:
                (other,) = _OVER.keys() - {own}
                yield (
                    place,
                    f"an altitude {over}, but [origin] states only {other}, {_OVER[other]}"
                    f"{_more(at_fault)}; the two differ by up to 100 m; add {own} to [origin], or state "
                    "altitudes as [origin] does",
                )


def _far(far: Mapping[Place, float], swapped_m: float) -> tuple[Place, str]:
    """Returns, once for all places that are too far from the origin, whether exchanged they would not be."""
    place, away_m = next(iter(far.items()))
    told = (
        f"lat_deg and lon_deg are {away_m / 1e3:.0f} km from the origin, must be within "
        f"{FARTHEST_M / 1e3:.0f} km{_more(far)}"
    )
    if swapped_m <= FARTHEST_M:
        return place, f"{told}; {EXCHANGED} The other way round it is {swapped_m / 1e3:.2g} km"
    return place, f"{told}; is a sign lost, or {EXCHANGED.replace('?', ' in one of the two?')}"


def _more(places: Collection[Place]) -> str:
    """Return in how many further places the same is at fault, in brackets; empty for none."""
    return f" (and so in {len(places) - 1} more)" if len(places) > 1 else ""


def _mixed(points: Mapping[Place, GroundPoint], stated: Mapping[str, Any]) -> Iterator[tuple[Place, str]]:
    """Yield the first point that is stated in another way than the first of all.

    A point that has both, as in files that are written from scenarios, goes with either.
    """
    ways: dict[bool, tuple[str, Place]] = {}
    for place, point in points.items():
        raw = stated[str(place[0])][place[1]]
        in_metres = not isinstance(raw, Mapping) or raw.get("position_m") is not None
        if in_metres != _is_earthly(point):
            keys = [key for key in EARTHLY_KEYS if getattr(point, key, None) is not None]
            ways.setdefault(in_metres, ("position_m" if in_metres else _words(keys), place))
    if len(ways) == 2:
        (first_way, first), (way, place) = ways.values()
        yield place, f"stated by {way}, but {path_of(first)} by {first_way}; state all in one way"


def _is_earthly(point: GroundPoint) -> bool:
    altitudes = [getattr(point, key) for key in ALTITUDE_KEYS]
    return None not in (point.lat_deg, point.lon_deg) and altitudes.count(None) < len(altitudes)


def is_placed(point: GroundPoint) -> bool:
    """Return whether a point of a scenario that may be at fault has a position, and no half of another."""
    begun = any(getattr(point, key) is not None for key in ("lat_deg", "lon_deg", *ALTITUDE_KEYS))
    return point.position_m is not None and begun == _is_earthly(point)
