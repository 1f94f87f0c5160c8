"""Faults between the origin and what is stated on the Earth."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import reduce
from operator import getitem
from typing import Any

import numpy as np

from nullpose.files import PlainTable
from nullpose.scenario.arrays import Floats
from nullpose.scenario.faults import EXCHANGED, Place, path_of
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.origin import FARTHEST_M, Origin, in_metres, size_m
from nullpose.scenario.section import Section
from nullpose.scenario.units import ALTITUDE_KEYS, EARTHLY, EARTHLY_CORNERS, EARTHLY_RANGES

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
    metres = {place: in_metres(tables[place], origin) for place in earthly}
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
