"""How high a building is, as files of buildings state it."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np
import shapely

from nullpose.scenario.altitude_limits import FOOT_M
from nullpose.scenario.buildings import HIGHEST_M, Building
from nullpose.scenario.faults import require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.wording import described

BY_ROOF, BY_HEIGHT, BY_LEVELS, ASSUMED = "by roof less ground", "by height", "by levels", "assumed"
"""How a height may be stated, the first first."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
_LENGTH = re.compile(
    rf"({_NUMBER})\s*(m|metres?|meters?|ft|feet|foot|')?\s*(?:(\d+\.?\d*)\s*(?:\"|''|in))?", re.I
)
_FEET = ("ft", "feet", "foot", "'")
_LEVELS = ("building:levels", "levels")
_LIKE_HEIGHTS = re.compile(r"height|level|floor|store?y|stories|elev|h(?:oe|ö)he|(?:\b|_)alt(?:\b|_|i)", re.I)
_LIKE_BASES = re.compile(r"(?:\b|_)min(?:\b|_)", re.I)
_OF_CORNERS = "altitudes of corners"
_BELOW_GROUND = "underground"


class BuildingHeight(NamedTuple):
    """Where a building of a file begins and ends.

    Args:
        base_m: height above the ground below which it is open [m].
        ends_m: the lowest and the highest that its roof may be [m].
        by: how it is stated, in words; empty if it is not.
        unread: properties that look like a height and were not read.
    """

    base_m: float
    ends_m: tuple[float, float]
    by: str
    unread: tuple[str, ...]


def height_of(feature: Feature, rules: Building) -> BuildingHeight:
    """Read a feature's height: roof less ground where both are named, ``height``, levels, or what is assumed.

    Args:
        feature: of a file.
        rules: the table that names the file.

    Raises:
        ScenarioError: it cannot be read.
    """
    by, ends_m = _roof(feature, rules)
    base_m = _length_m(feature, "min_height", rules) if "min_height" in feature.properties else 0.0
    read = {"min_height", "height", rules.roof_property, rules.ground_property}
    read |= {*_LEVELS} if by == BY_LEVELS else set()
    unread = tuple(
        key
        for key in feature.properties
        if key not in read
        and _BELOW_GROUND not in key
        and _LIKE_HEIGHTS.search(key)
        and (by in (BY_LEVELS, ASSUMED) or _LIKE_BASES.search(key))
    )
    corners = shapely.get_coordinates(feature.geometry, include_z=True)
    if by in (BY_LEVELS, ASSUMED) and np.nan_to_num(corners[:, 2]).any():
        unread += (_OF_CORNERS,)
    if by:
        require(
            0.0 <= base_m <= ends_m[0] and 0.0 < ends_m[1] <= HIGHEST_M,
            feature.place,
            f"its roof is {ends_m[1]:g} m above the ground ({by}), must be above 0, at most {HIGHEST_M:g}, "
            f"and no lower than its min_height, {base_m:g} m, itself 0 or more; correct it in the file",
        )
    return BuildingHeight(base_m, ends_m, by, unread)


def _roof(feature: Feature, rules: Building) -> tuple[str, tuple[float, float]]:
    """Read the words for how the roof is stated, and both ends of its height above the ground [m]."""
    properties = feature.properties
    if rules.roof_property in properties and rules.ground_property in properties:
        roof_m, ground_m = (
            _length_m(feature, str(key), rules) for key in (rules.roof_property, rules.ground_property)
        )
        return BY_ROOF, (roof_m - ground_m,) * 2
    if "height" in properties:
        return BY_HEIGHT, (_length_m(feature, "height", rules),) * 2
    key = next((key for key in _LEVELS if key in properties), None)
    if key is not None and rules.storey_height_m is not None:
        return BY_LEVELS, (_number(feature, key) * rules.storey_height_m,) * 2
    if rules.missing_height_m is not None:
        missing_m = rules.missing_height_m
        return ASSUMED, missing_m if isinstance(missing_m, tuple) else (missing_m, missing_m)
    return "", (0.0, 0.0)


def _length_m(feature: Feature, key: str, rules: Building) -> float:
    """Read a length, a number or a text such as ``22 m`` or ``72'6"`` [m]."""
    value, place = feature.properties[key], f"{feature.place}.{key}"
    found = _LENGTH.fullmatch(str(value).strip()) if _is_plain(value) else None
    number, unit, inches = found.groups() if found else ("nan", None, None)
    is_feet = (unit or rules.height_unit or "m").lower() in _FEET
    require(
        math.isfinite(float(number)) and (is_feet or inches is None),
        place,
        f'got {described(value)}, must be a number of metres, alone or as in "22 m"; correct it in the file',
    )
    require(
        not is_feet or rules.height_unit == "ft",
        place,
        f'got {described(value)}, in feet, must be in metres; write height_unit = "ft" beside buildings_from '
        "if its heights without a unit are in feet too",
    )
    return (float(number) + float(inches or 0.0) / 12.0) * FOOT_M if is_feet else float(number)


def _number(feature: Feature, key: str) -> float:
    value = feature.properties[key]
    require(
        _is_plain(value) and re.fullmatch(_NUMBER, str(value).strip()),
        f"{feature.place}.{key}",
        f"got {described(value)}, must be a number of levels; correct it in the file",
    )
    return float(value)


def _is_plain(value: object) -> bool:
    return isinstance(value, int | float | str) and not isinstance(value, bool)
