"""How high a building is, and whether it stands, as files of buildings state it."""

from __future__ import annotations

import math
import re
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import shapely

from nullpose.errors import Fault
from nullpose.scenario.altitude_limits import FOOT_M
from nullpose.scenario.buildings import HIGHEST_M, Building
from nullpose.scenario.faults import call_each, described, raise_all, require
from nullpose.scenario.geo_file import Feature

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

    levels = _LEVELS if rules.storey_height_m else ()
    readings: list[tuple[Any, ...]] = [
        (BY_ROOF, rules.roof_property, rules.ground_property),
        (BY_HEIGHT, "height"),
    ]
    readings += [(BY_LEVELS, key) for key in levels]
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
    read = {*_BASES, "height", rules.roof_property, rules.ground_property}
    read |= {*_LEVELS} if by == BY_LEVELS else set()
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
