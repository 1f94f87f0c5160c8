"""The buildings that a scenario file takes from another file: where, how high, and whether they stand."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import shapely

from nullpose.errors import Fault
from nullpose.files import PlainTable
from nullpose.scenario.altitude_limits import FOOT_M
from nullpose.scenario.area_files import reach_deg
from nullpose.scenario.areas import Area, account, area_of, unique
from nullpose.scenario.buildings import HIGHEST_M, MOST_BUILDINGS, Building
from nullpose.scenario.faults import EXCHANGED, call_each, described, raise_all, require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.origin import Origin
from nullpose.scenario.shapes import corners_of

GONE = {
    *("underground", "undergr", "demolished", "razed", "removed", "destroyed", "dismantled", "proposed"),
    *("planned", "was"),
}
"""What is said of buildings that are not there, in OpenStreetMap, Overture and a shapefile's short names."""
ON_POSTS = {"roof", "carport", "canopy", "bridge"}
"""What is said of buildings that are open from the ground up to a base, which they may state."""
OPEN = {*ON_POSTS, "construction", "ruins", "collapsed", "parts"}
"""What is said of buildings that may be open at any height, or lower where their parts are."""
MARK = re.compile(rf"(?:({'|'.join(sorted(GONE | OPEN))}|abandoned|disused):)?building(?::part)?")
"""What OpenStreetMap marks buildings with, of today and of other days."""
_BELOW = r"-\d+(?:\.\d+)?(?:;-\d+)*"  # levels, all below the ground


def state_of(feature: Feature) -> str:
    """Say why a building is not there, or may be open from the ground up; nothing if neither is stated.

    Args:
        feature: of a file.
    """
    properties = feature.properties
    words = {
        str(value).lower()
        for value in map(properties.get, ("building", "building:part", "class", "location", "status"))
    }
    words |= {
        flag.removeprefix("is_").removeprefix("has_")
        for flag in {key.lower() for key, value in properties.items() if value in ("yes", "true", True)}
    }
    if properties.keys().isdisjoint(("building", "building:part")):
        words |= {mark[1] for mark in map(MARK.fullmatch, properties) if mark}
    if any(re.fullmatch(_BELOW, str(properties.get(key))) for key in ("layer", "level")):
        words.add("underground")
    return next(iter([*sorted(words & GONE), *sorted(words & OPEN)]), "")


BY_ROOF, BY_HEIGHT, BY_LEVELS, ASSUMED = "by roof less ground", "by height", "by levels", "assumed"
"""How a height may be stated, the first first."""
_LENGTH = re.compile(
    r"([-+]?(?:\d+\.?\d*|\.\d+))\s*(m|metres?|meters?|ft|feet|foot|')?\s*(?:(\d+\.?\d*)\s*(?:\"|''|in))?",
    re.I,
)
_LEVELS = ("building:levels", "levels", "num_floors")  # of OpenStreetMap and Overture
_BASES = ("min_height", "building:min_level", "min_level", "min_floor")
_LIKE_STATES = r"status|demoli|lifecycle|end_date|\bruin"
_LIKE_HEIGHTS = re.compile(
    rf"height|level|floor|store?y|stories|elev|h(?:oe|ö)he|(?:\b|_)alt(?:\b|_|i)|{_LIKE_STATES}", re.I
)
_LIKE_BASES = re.compile(rf"(?:\b|_)min(?:\b|_)|{_LIKE_STATES}", re.I)
_REMEDY = (
    "correct it in the file, or write missing_height_m = 9 or [4, 12] beside buildings_from, which counts "
    "for all that cannot be read"
)
_NO_HEIGHT = (
    "it states no height (height, or building:levels with storey_height_m){}; write storey_height_m = 3, or "
    "missing_height_m = 9 or [4, 12] for those that state none, beside buildings_from"
)


class BuildingHeight(NamedTuple):
    """Where a building of a file begins and ends.

    Args:
        base_m: height above the ground below which it is open [m].
        ends_m: the lowest and the highest that its roof may be [m]; the base is the lowest where it is not
            sure that it hides anything.
        by: how it is stated, in words; empty if it is not.
        unread: properties that look like a height and were not read.
        state: why it hides no jammer; empty if it does.
        faults: of what is stated and unreadable, in place of which something else counts.
    """

    base_m: float
    ends_m: tuple[float, float]
    by: str
    unread: tuple[str, ...]
    state: str
    faults: tuple[Fault, ...]


def height_of(feature: Feature, rules: Building, state: str = "") -> BuildingHeight:
    """Read a feature's height: roof less ground where both are named, ``height``, levels, or what is assumed.

    What cannot be read, or is no height that a building has, counts as not stated. If that is its base, it
    hides nodes down to the ground and no jammer.

    Args:
        feature: of a file.
        rules: the table that names the file.
        state: why it may be open from the ground up, a word of ``OPEN``; empty if it is closed.

    Raises:
        ScenarioError: something cannot be read, and nothing else counts in its place.
    """
    properties, missing_m = feature.properties, rules.missing_height_m
    length_m = partial(_length_m, feature, rules)
    bases_m, wrong = call_each(length_m, [key for key in _BASES if key in properties][:1])
    base_m = max([0.0, *bases_m])

    def roof_m(by: str, *keys: str) -> tuple[str, tuple[float, float]]:
        high_m, *ground_m = map(length_m, keys)
        end_m = high_m - sum(ground_m)
        require(
            base_m < end_m <= HIGHEST_M,
            feature.place,
            f"its roof is {end_m:g} m above the ground ({by}), must be above its base, {base_m:g} m, and at "
            f"most {HIGHEST_M:g}; {_REMEDY}",
        )
        return by, (end_m, end_m)

    readings: list[tuple[Any, ...]] = [
        (BY_ROOF, rules.roof_property, rules.ground_property),
        (BY_HEIGHT, "height"),
        *((BY_LEVELS, key) for key in _LEVELS if rules.storey_height_m),
    ]
    found, faults = call_each(
        lambda reading: roof_m(*reading),
        [reading for reading in readings if properties.keys() >= {*reading[1:]}],
    )
    if missing_m is not None:
        low_m, high_m = missing_m if isinstance(missing_m, tuple) else (missing_m, missing_m)
        found.append((ASSUMED, (max(low_m, base_m), base_m + high_m)))
    else:
        raise_all(wrong if found else wrong + faults)
    by, (low_m, high_m) = found[0] if found else ("", (0.0, 0.0))
    state = "" if state in ON_POSTS and base_m > 0.0 else state
    ends_m = (base_m if wrong or state else low_m, high_m)
    return BuildingHeight(base_m, ends_m, by, _unread(feature, rules, by), state, (*wrong, *faults))


def _unread(feature: Feature, rules: Building, by: str) -> tuple[str, ...]:
    """List properties that look like a height or a state and were not read."""
    read = {
        *_BASES,
        "height",
        rules.roof_property,
        rules.ground_property,
        *(_LEVELS if by == BY_LEVELS else ()),
    }
    unread = tuple(
        key
        for key in feature.properties
        if key not in read
        and "underground" not in key
        and _LIKE_HEIGHTS.search(key)
        and (by in (BY_LEVELS, ASSUMED) or _LIKE_BASES.search(key))
    )
    corners = shapely.get_coordinates(feature.geometry, include_z=True)
    is_high = by in (BY_LEVELS, ASSUMED) and bool(np.nan_to_num(corners[:, 2]).any())
    return (*unread, *["altitudes of corners"] * is_high)


def _length_m(feature: Feature, rules: Building, key: str) -> float:
    """Read a length, a number or a text such as ``22 m`` or ``72'6"``, or a number of levels [m]."""
    value, place, is_plain = (
        feature.properties[key],
        f"{feature.place}.{key}",
        key not in _LEVELS + _BASES[1:],
    )
    text = "" if isinstance(value, bool | list | dict) else str(value).strip()
    number, unit, inches = match.groups() if (match := _LENGTH.fullmatch(text)) else ("nan", None, None)
    is_feet = (unit or rules.height_unit or "m").lower() in ("ft", "feet", "foot", "'")
    number = float(number)
    require(
        math.isfinite(number) and (is_feet if inches else is_plain or not unit),
        place,
        f"got {described(value)}, must be a number of "
        + ('metres, alone or as in "22 m"' if is_plain else "levels")
        + f"; {_REMEDY}",
    )
    if not is_plain:
        require(rules.storey_height_m or not number, place, f"got {number:g} levels; add storey_height_m = 3")
        return number * (rules.storey_height_m or 0.0)
    require(
        not is_feet or rules.height_unit is not None,
        place,
        f"got {described(value)}, in feet; write beside buildings_from what its heights without a unit are "
        'in, height_unit = "m" or "ft"',
    )
    return (number + float(inches or 0.0) / 12.0) * FOOT_M if is_feet else number


def buildings_of(
    features: Sequence[Feature], rules: Building, origin: Origin, names: set[str], first: int
) -> tuple[list[PlainTable], list[str], dict[str, str]]:
    """Make raw buildings of features: one of each polygon, open where it has a hole.

    Where some features are marked as buildings, as those of OpenStreetMap are, the others are left out. So
    are buildings that are not there. One that may be open, and one that has parts of its own, hides nodes and
    no jammer.

    Args:
        features: of the file.
        rules: the table that names the file.
        origin: the scenario's, None standing for what is not stated or at fault.
        names: that are taken; those of the file are added.
        first: how many buildings the scenario has before them.

    Returns:
        The buildings, notes on what became of the features, and the places in the file of the buildings by
        their path in the scenario.

    Raises:
        ScenarioError: with the faults of all features.
    """
    marked = [
        feature
        for feature in features
        if any(
            MARK.fullmatch(key) and value not in ("no", False) for key, value in feature.properties.items()
        )
    ] or features
    counts, reach = Counter({"other feature": len(features) - len(marked)}), reach_deg(origin)
    parts = [each.geometry for each in marked if "building:part" in each.properties and each.geometry]
    within, gone = shapely.STRtree(shapely.point_on_surface(parts)), Counter[str]()

    def areas_with_height(feature: Feature) -> list[tuple[Area, BuildingHeight]]:
        areas = area_of(feature, reach, counts, is_fence=True)
        counts["point"] += sum(len(area.cylinders) for area in areas)
        areas, state = [area for area in areas if area.polygons], state_of(feature)
        if not state and "building:part" not in feature.properties and areas:
            state = "parts" if len(within.query(feature.geometry, "contains")) else ""
        gone.update([state] * len(areas) if state in GONE else [])
        return [(area, height_of(feature, rules, state)) for area in areas if state not in GONE]

    each, faults = call_each(areas_with_height, marked)
    found: list[tuple[Area, BuildingHeight]] = list(chain.from_iterable(each))
    unstated = [area.place for area, height in found if not height.by]
    more = f", and so {len(unstated) - 1} more" if unstated[1:] else ""
    faults += [Fault(place, _NO_HEIGHT.format(more)) for place in unstated[:1]]  # once for all
    raise_all(faults)
    total = sum(len(area.polygons) for area, _ in found)
    require(
        total <= MOST_BUILDINGS,
        "",
        f"it has {total} buildings in reach, must be at most {MOST_BUILDINGS}; cut it to the "
        "streets of the scene",
    )
    tables = [table for area, height in found for table in _tables(area, height, rules, names)]
    places = {
        f"buildings[{index}]": place
        for index, place in enumerate([area.place for area, _ in found for _ in area.polygons], first)
    }
    return tables, list(_notes(found, counts, gone)), places


def _tables(area: Area, height: BuildingHeight, rules: Building, names: set[str]) -> Iterator[PlainTable]:
    """Yield the raw buildings of an area."""
    low_m, high_m = height.ends_m
    for polygon in area.polygons:
        name = unique(area.name, names)
        yards = [corners_of(ring) for ring in polygon.interiors]
        yield {
            **({"name": name} if name else {}),
            "polygon_lat_lon_deg": corners_of(polygon.exterior),
            **({"courtyards_lat_lon_deg": yards} if yards else {}),
            "height_m": low_m if low_m == high_m else [low_m, high_m],
            "base_m": height.base_m,
            "clearance_m": rules.clearance_m,
        }


def _notes(
    found: Sequence[tuple[Area, BuildingHeight]], counts: Counter[str], gone: Counter[str]
) -> Iterator[str]:
    """Yield how the heights of all buildings are stated and what is passed over, then what is not read."""
    sources = Counter(height.by for area, height in found for _ in area.polygons)
    shares = ", ".join(f"{number} {source}" for source, number in sources.most_common())
    wrong = [height.faults[0].path for _, height in found if height.faults]
    open_ = Counter(height.state for _, height in found if height.state)
    left_out, hiding = (", ".join(f"{n} {word}" for word, n in each.items()) for each in (gone, open_))
    away = counts["area"] - len(found) - gone.total()
    parts = {
        f"not readable: {len(wrong)}, the first {''.join(wrong[:1])}": wrong,
        f"left out: {left_out}": gone,
        f"hiding nodes and no jammer: {hiding}": open_,
        EXCHANGED: away and not found,
        f"out of reach: {away}": away,
    }
    yield account(f"buildings: {sources.total()}{f': {shares}' if shares else ''}", counts, parts)
    if unread := Counter(key for _, height in found for key in height.unread):
        yield f"not read: {', '.join(f'{key} (of {number})' for key, number in unread.items())}"
