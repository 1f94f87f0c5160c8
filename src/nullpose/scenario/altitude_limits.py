"""The lowest and the highest altitude of a feature, as files of areas state them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TypeAlias

import numpy as np
import shapely

from nullpose.files import PlainTable
from nullpose.scenario.faults import refusal, require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.shapes import is_solid
from nullpose.scenario.units import EARTHLY_RANGES

RANGES = ("altitude_m", *EARTHLY_RANGES)
"""The keys of a zone's altitudes."""
_FAR_M = 1e6  # an end that is not limited
FOOT_M = 0.3048
_WEATHER_M = 600.0  # a flight level is no further from 100 ft times it over the sea, at 950 to 1080 hPa
_FLAT_M = 0.1  # a roof alone has less between its lowest and highest corner
_UNITS_M = {
    **dict.fromkeys(("M", "MTR", "METER", "METERS", "METRE", "METRES", "0"), 1.0),
    **dict.fromkeys(("FT", "F", "FOOT", "FEET", "1"), FOOT_M),
}
_FLIGHT_LEVELS = ("FL", "6")  # openAIP writes units and datums as words or as numbers
_DATUMS = {"GND": "altitude_m", "AGL": "altitude_m", "SFC": "altitude_m", "0": "altitude_m"} | {
    **dict.fromkeys(("MSL", "AMSL", "STD", "1", "2"), "altitude_msl_m"),
    **dict.fromkeys(("WGS84", "W84", "HAE"), "altitude_ellipsoid_m"),
}
_WEATHER = (
    f"is narrowed, being a fence, by {_WEATHER_M:g} m for the weather; state altitude_m or altitude_msl_m"
)
_ON_THE_GROUND = ("clampToGround", "clampToSeaFloor")
_OF_KML = {"absolute": "altitude_msl_m", "relativeToGround": "altitude_m"}
_LIKE_LIMITS = re.compile(
    r"upper|lower|floor|ceil|altit|altura|elev|height|hauteur|plafond|hoogte|roof|hoehe|höhe|grenze|vertical"
    r"|agl|msl|limite(?!d)|flight_?level|^(?:(?:min|max|low|high)(?:est)?|h|z)(?:_?(?:min|max|m|ft))?$"
    r"|(?<![a-z])(?:(?:min|max|rel|abs)_?)?(?:alts?|top|bottom|base|limits?|z|fl|hgt)"
    r"(?:_?(?:min|max|m|ft))?(?![a-z])"
)
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_NO_LIMITS = {"altitudeMode", "alt_name", "alt_text", "speed_limit"}
_SAYS_LIMITS = re.compile(
    r"\b(?:A?MSL|AGL|GND|SFC|UNL|FL ?\d+)\b|altitude|ceiling|height|hauteur|höhe", re.IGNORECASE
)
_LIKE_TIMES = re.compile(
    r"applicab|schedul|hours|timestamp|^(?:begin|start|end|until|when|status)$|activ|valid|expir|effectiv"
    r"|(?:start|end)_?(?:date|time)",
    re.IGNORECASE,
)

Ground = Mapping[str, float | None]
"""The origin's ground by the keys of a zone's altitudes, metres; None where the origin does not state it."""


def altitude_limits(
    feature: Feature, ground_m: Ground, *, is_fence: bool = False
) -> tuple[PlainTable, list[str]]:
    """Read a feature's altitudes by the key of a zone, with remarks on what is not read.

    Keys of a zone come first, then ED-318's layer, openAIP's ceilings, and KML's heights. Where the weather
    moves flight levels, by 600 m, a zone is widened and a fence is narrowed.

    Args:
        feature: of any file.
        ground_m: of the scenario.
        is_fence: whether it is safe to read less than it allows; otherwise, less than it forbids.

    Raises:
        ScenarioError: the limits cannot be read, or need what the origin does not state; or a fence states
            some that are not read.
    """
    properties = feature.properties
    found, read = {key: properties[key] for key in RANGES if key in properties}, {*RANGES}
    is_ours, is_narrowed, likely = bool(found), False, dict(_likely(properties))
    if not is_ours and (limits := _limits(feature)):
        low, high = (_end(*limit) for limit in limits)
        found = _joined(feature, low, high, ground_m, -1.0 if is_fence else 1.0)
        read = {place.removeprefix(f"{feature.place}.") for place, *_ in limits}
        read |= {f"{path}Reference" for path in read}
        is_narrowed = is_fence and any(end[2] for end in (low, high) if end)
    elif not is_ours:
        found, unread_heights = _of_corners(feature, ground_m, is_fence)
        likely |= unread_heights
    unread = [path for path in likely if path not in read]
    numbers = [
        path
        for path in unread
        if any(letter.isdigit() for letter in str(likely[path])) and (_is_limit(path) or not found)
    ]
    require(
        not (is_fence and numbers and not is_ours),
        feature.place,
        f"it is a fence and may bound the altitude by what is not read: {', '.join(numbers)}; write "
        "altitude_m = [low, high] beside it (or altitude_msl_m), which then counts alone, or remove it",
    )
    times = [key for key in properties if _LIKE_TIMES.search(key)]
    counts = f"counts at {' and '.join(found) or 'all altitudes'}"
    remarks = {
        f"{counts}; not read: {', '.join(unread)}": bool(unread),
        _WEATHER: is_narrowed,
        f"counts at all times; not read: {', '.join(times)}": bool(times),
    }
    return found, [remark for remark, is_so in remarks.items() if is_so]


def _likely(properties: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield what looks like a limit of altitudes: its keys, joined by points, and its value."""
    for key, value in properties.items():
        if _is_limit(key) or (isinstance(value, str) and _SAYS_LIMITS.search(value)):
            yield key, value
        else:
            inner = value if isinstance(value, list) else [value]
            tables = (dict(_likely(each)) for each in inner if isinstance(each, dict))
            yield from ((f"{key}.{path}", each) for table in tables for path, each in table.items())


def _is_limit(key: str) -> bool:
    """Tell whether a key looks like that of an altitude."""
    return key not in _NO_LIMITS and bool(_LIKE_LIMITS.search(_CAMEL.sub("_", key).lower()))


def _limits(feature: Feature) -> list[tuple[str, object, object, object]]:
    """Return place, value, unit and datum of the lower and the upper limit; nothing where none is stated."""
    properties, place = feature.properties, feature.place
    if isinstance(layer := properties.get("layer"), dict) and {"lower", "upper"} & layer.keys():  # of ED-318
        return [
            (
                f"{place}.layer.{word}",
                layer.get(word),
                layer.get("uom", "m"),
                layer.get(f"{word}Reference", "AGL"),
            )
            for word in ("lower", "upper")
        ]
    for names in (("lowerCeiling", "upperCeiling"), ("lowerLimit", "upperLimit")):  # of openAIP
        limits = {name: properties[name] for name in names if name in properties}
        if limits and all(isinstance(limit, dict) for limit in limits.values()):
            keys = ("value", "unit", "referenceDatum")
            return [(f"{place}.{name}", *map(limits.get(name, {}).get, keys)) for name in names]
    return []


_End: TypeAlias = tuple[float, str, float]
"""A lower or an upper limit: its height [m], the key that says over what, and how far it may be off [m]."""


def _end(place: str, value: object, unit: object, datum: object) -> _End | None:
    if value is None:
        return None
    unit, datum = str(unit).upper(), str(datum).upper()
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _FAR_M:
        if unit in _FLIGHT_LEVELS:
            return 100.0 * FOOT_M * value, "altitude_msl_m", _WEATHER_M
        if unit in _UNITS_M and datum in _DATUMS:
            return value * _UNITS_M[unit], _DATUMS[datum], _WEATHER_M if datum in ("STD", "2") else 0.0
    raise refusal(
        place, f"got {value!r} in {unit} over {datum}, must be a number in M, FT or FL over GND, MSL or WGS84"
    )


def _joined(
    feature: Feature, low: _End | None, high: _End | None, ground_m: Ground, outwards: float
) -> PlainTable:
    """Return both ends over one thing; the ground is a lower end for every upper one."""
    low = None if low and low[:2] == (0.0, "altitude_m") else low
    if not (low or high):
        return {}
    key, ends_m = (high or low or ("", "altitude_m"))[1], [-_FAR_M, _FAR_M]
    for side, end in enumerate((low, high)):
        if end:
            height_m, over, off_m = end
            ends_m[side] = height_m + shift_m(feature.place, over, key, ground_m)
            ends_m[side] += outwards * (off_m if side else -off_m)
    require(
        ends_m[0] <= ends_m[1] or outwards > 0.0, feature.place, f"no altitude is left of it: it {_WEATHER}"
    )
    return {key: ends_m}


def shift_m(place: str, over: str, key: str, ground_m: Ground) -> float:
    """Return the height to add to an altitude over one thing to have it over another.

    Args:
        place: where it is stated, for messages.
        over: the key of the first, as ``altitude_msl_m``.
        key: that of the other.
        ground_m: the origin's ground.

    Raises:
        ScenarioError: the origin does not state its altitude over both.
    """
    if over == key:
        return 0.0
    absent = [EARTHLY_RANGES[each] for each in {over, key} if ground_m[each] is None]
    require(
        not absent,
        place,
        f"it states {over}, to be compared with {key}; add {' and '.join(absent)} to [origin], which says "
        "how far these are apart",
    )
    return (ground_m[key] or 0.0) - (ground_m[over] or 0.0)


def _of_corners(feature: Feature, ground_m: Ground, is_fence: bool) -> tuple[PlainTable, PlainTable]:
    """Read the altitudes between roof and floor, or from the ground up to what is extruded, in KML.

    Corners on the ground are no roof; nor is a face by itself, which may follow the terrain. A zone reaches
    up to its highest corner; a fence that is extruded up to its lowest, and a solid is one if it is level.

    Returns:
        The altitudes, and what of the heights of the corners is not read.
    """
    mode, extrude = (feature.properties.get(key, "") for key in ("altitudeMode", "extrude"))
    heights_m = shapely.get_coordinates(feature.geometry, include_z=True)[:, 2]
    heights_m = heights_m[np.isfinite(heights_m)]
    if mode in _ON_THE_GROUND or not np.any(heights_m):
        return {}, {}
    low_m, high_m = float(heights_m.min()), float(heights_m.max())
    is_above = mode in _OF_KML and high_m > (ground_m[_OF_KML[mode]] or 0.0)
    if is_above and extrude in (1, True):
        return {_OF_KML[mode]: [-_FAR_M, low_m if is_fence else high_m]}, {}
    is_level = np.minimum(heights_m - low_m, high_m - heights_m).max() < _FLAT_M
    is_read = high_m - low_m >= _FLAT_M and is_solid(feature.geometry) and (is_level or not is_fence)
    if is_above and is_read:
        return {_OF_KML[mode]: [low_m, high_m]}, {}
    return {}, {f"heights of its corners{f' ({mode})' if mode else ''}": high_m}
