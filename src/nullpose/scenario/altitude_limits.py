"""The lowest and the highest altitude of a feature, as files of areas state them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import shapely

from nullpose.files import PlainTable
from nullpose.scenario.faults import refusal, require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.units import EARTHLY_RANGES

RANGES = ("altitude_m", *EARTHLY_RANGES)
"""The keys of a zone's altitudes."""
_FAR_M = 1e6  # an end that is not limited
FOOT_M = 0.3048
_WEATHER_M = 600.0  # a flight level is no further from 100 ft times it over the sea, at 950 to 1080 hPa
_FLAT_M = 0.1  # a roof alone has less between its lowest and highest corner
_UNITS_M = {"M": 1.0, "METER": 1.0, "METRE": 1.0, "0": 1.0, "FT": FOOT_M, "F": FOOT_M, "1": FOOT_M}
_FLIGHT_LEVELS = ("FL", "6")  # openAIP writes units and datums as words or as numbers
_DATUMS = {"GND": "altitude_m", "AGL": "altitude_m", "SFC": "altitude_m", "0": "altitude_m"} | {
    **dict.fromkeys(("MSL", "AMSL", "STD", "1", "2"), "altitude_msl_m"),
    **dict.fromkeys(("WGS84", "W84", "HAE"), "altitude_ellipsoid_m"),
}
_OF_KML = {"absolute": "altitude_msl_m", "relativeToGround": "altitude_m"}
_LIKE_LIMITS = re.compile(r"upper|lower|floor|ceiling|limit|(?:\b|_)alt(?:\b|_|i)", re.IGNORECASE)
_LIKE_TIMES = re.compile(r"applicab|schedule|hours|timestamp|^(?:begin|end)$|activ", re.IGNORECASE)

Ground = Mapping[str, float | None]
"""The origin's ground by the keys of a zone's altitudes, metres; None where the origin does not state it."""


def altitude_limits(feature: Feature, ground_m: Ground) -> tuple[PlainTable, list[str]]:
    """Read a feature's altitudes by the key of a zone, with remarks on what is not read.

    Keys of a zone come first, then ED-318's layer, openAIP's ceilings, and KML's heights. Flight levels are
    widened by 600 m for the weather.

    Args:
        feature: of any file.
        ground_m: of the scenario.

    Raises:
        ScenarioError: the limits cannot be read, or need what the origin does not state.
    """
    properties, limits = feature.properties, _limits(feature)
    found, unread = {key: properties[key] for key in RANGES if key in properties}, list[str]()
    if not found and limits:
        low, high = (_end(*limit) for limit in limits)
        found = _joined(feature, low, high, ground_m)
    elif not found:
        found, has_height = _of_kml(feature)
        likely = [key for key in properties if _LIKE_LIMITS.search(key) and key != "altitudeMode"]
        unread = [] if found else likely + ["height"] * has_height
    times = [key for key in properties if _LIKE_TIMES.search(key)]
    remarks = [f"counts at all altitudes; not read: {', '.join(unread)}"] if unread else []
    return found, [*remarks, *([f"counts at all times; not read: {', '.join(times)}"] if times else [])]


def _limits(feature: Feature) -> list[tuple[str, object, object, object]]:
    """Return place, value, unit and datum of the lower and the upper limit; nothing where none is stated."""
    properties, place = feature.properties, feature.place
    layer = properties.get("layer")
    if isinstance(layer, dict):  # of ED-318
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


class _End(NamedTuple):
    """A lower or an upper limit: its height, the key that says over what, and how far it may be off."""

    height_m: float
    over: str
    off_m: float = 0.0


def _end(place: str, value: object, unit: object, datum: object) -> _End | None:
    if value is None:
        return None
    unit, datum = str(unit).upper(), str(datum).upper()
    if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _FAR_M:
        if unit in _FLIGHT_LEVELS:
            return _End(100.0 * FOOT_M * value, "altitude_msl_m", _WEATHER_M)
        if unit in _UNITS_M and datum in _DATUMS:
            off_m = _WEATHER_M if datum in ("STD", "2") else 0.0
            return _End(value * _UNITS_M[unit], _DATUMS[datum], off_m)
    raise refusal(
        place, f"got {value!r} in {unit} over {datum}, must be a number in M, FT or FL over GND, MSL or WGS84"
    )


def _joined(feature: Feature, low: _End | None, high: _End | None, ground_m: Ground) -> PlainTable:
    """Return both ends over one thing; the ground is a lower end for every upper one."""
    if low and low[:2] == (0.0, "altitude_m"):
        low = None
    if not (low or high):
        return {}
    key, ends_m = (high or low or _End(0.0, "altitude_m")).over, [-_FAR_M, _FAR_M]
    for side, end in enumerate((low, high)):
        if end:
            shifted_m = end.height_m + shift_m(feature.place, end.over, key, ground_m)
            ends_m[side] = shifted_m + (end.off_m if side else -end.off_m)
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


def _of_kml(feature: Feature) -> tuple[PlainTable, bool]:
    """Read the altitudes between roof and floor, or from the ground up to what is extruded.

    Returns:
        The altitudes, and whether the corners have heights whose altitudeMode gives them a meaning.
    """
    mode = feature.properties.get("altitudeMode")
    if mode not in _OF_KML or feature.geometry is None:
        return {}, False
    heights_m = shapely.get_coordinates(feature.geometry, include_z=True)[:, 2]
    heights_m = heights_m[np.isfinite(heights_m)]
    low_m, high_m = heights_m.min(initial=np.inf), heights_m.max(initial=-np.inf)
    is_extruded = feature.properties.get("extrude") in (1, True)
    if not len(heights_m) or (high_m - low_m < _FLAT_M and not is_extruded):
        return {}, bool(np.any(heights_m))
    return {_OF_KML[mode]: [-_FAR_M if is_extruded else float(low_m), float(high_m)]}, True
