"""The lowest and the highest altitude of a feature, as files of areas state them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from nullpose.scenario.faults import refusal
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.units import EARTHLY_RANGES

RANGES = ("altitude_m", *EARTHLY_RANGES)
"""The keys of a zone's altitudes."""
_FAR_M = 1e6  # an end that is not limited
_FOOT_M = 0.3048
_WEATHER_M = 600.0  # a flight level is no further from 100 ft times it over the sea, at 950 to 1080 hPa
_FLAT_M = 0.1  # a roof alone has less between its lowest and highest corner
_UNITS_M = {"M": 1.0, "METER": 1.0, "METRE": 1.0, "0": 1.0, "FT": _FOOT_M, "F": _FOOT_M, "1": _FOOT_M}
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


def altitude_limits(feature: Feature, ground_m: Ground) -> tuple[dict[str, Any], list[str]]:
    """Return a feature's altitudes by the key of a zone, and remarks on what is not read.

    Own keys come first, then ED-318's layer, openAIP's ceilings, and KML's heights. Flight levels are
    widened by 600 m for the weather.

    Args:
        feature: of any file.
        ground_m: of the scenario.

    Raises:
        ScenarioError: the limits cannot be read, or need what the origin does not state.
    """
    properties = feature.properties
    found = {key: properties[key] for key in RANGES if key in properties}
    remarks = []
    if not found:
        ends = _ends_of_layer(feature) or _ends_of_ceilings(feature)
        found = _joined(feature, *ends, ground_m) if ends else _heights_of_kml(feature)
    if not found:
        unread = [key for key in properties if _LIKE_LIMITS.search(key) and key != "altitudeMode"]
        remarks += [f"counts at all altitudes; {_pairs(properties, unread)} not read"] if unread else []
        remarks += ["counts at all altitudes; one height alone is not read"] if _is_raised(feature) else []
    times = [key for key in properties if _LIKE_TIMES.search(key)]
    remarks += [f"counts at all times; {_pairs(properties, times)} not read"] if times else []
    return found, remarks


def _pairs(properties: Mapping[str, Any], keys: list[str]) -> str:
    words = ", ".join(f"{key} = {str(properties[key])[:40]}" for key in keys[:3])
    return f"its {words}{' and more' if len(keys) > 3 else ''} {'are' if len(keys) > 1 else 'is'}"


_End = tuple[float, str, float]  # metres, the key that says over what, how far it may be off


def _ends_of_layer(feature: Feature) -> tuple[_End | None, _End | None] | None:
    """Return the limits that ED-318 states in a geometry."""
    layer = feature.properties.get("layer")
    if not isinstance(layer, dict):
        return None

    def end(word: str) -> _End | None:
        reference = layer.get(f"{word}Reference", "AGL")
        return _end(f"{feature.place}.layer.{word}", layer.get(word), layer.get("uom", "m"), reference)

    return end("lower"), end("upper")


def _ends_of_ceilings(feature: Feature) -> tuple[_End | None, _End | None] | None:
    """Return the limits that openAIP states."""

    def end(name: str) -> _End | None:
        limit = feature.properties.get(name) or {}
        keys = ("value", "unit", "referenceDatum")
        return _end(f"{feature.place}.{name}", *(limit.get(key) for key in keys))

    for low, high in (("lowerCeiling", "upperCeiling"), ("lowerLimit", "upperLimit")):
        limits = [feature.properties[name] for name in (low, high) if name in feature.properties]
        if limits and all(isinstance(limit, dict) for limit in limits):
            return end(low), end(high)
    return None


def _end(place: str, value: Any, unit: Any, datum: Any) -> _End | None:
    if value is None:
        return None
    unit, datum = str(unit).upper(), str(datum).upper()
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _FAR_M
    if unit in _FLIGHT_LEVELS and is_number:
        return 100.0 * _FOOT_M * value, "altitude_msl_m", _WEATHER_M
    if not is_number or unit not in _UNITS_M or datum not in _DATUMS:
        raise refusal(
            place,
            f"got {value!r} in {unit} over {datum}, must be a number in M, FT or FL over GND, MSL or WGS84",
        )
    return value * _UNITS_M[unit], _DATUMS[datum], _WEATHER_M if datum in ("STD", "2") else 0.0


def _joined(feature: Feature, low: _End | None, high: _End | None, ground_m: Ground) -> dict[str, Any]:
    """Return both ends over one thing; the ground is a lower end for every upper one."""
    if low and low[:2] == (0.0, "altitude_m"):
        low = None
    key, ends_m = (high or low or (0.0, "altitude_m", 0.0))[1], [-_FAR_M, _FAR_M]
    for side, end in enumerate((low, high)):
        if end:
            height_m, over, off_m = end
            ends_m[side] = (
                height_m + shift_m(feature.place, over, key, ground_m) + (off_m if side else -off_m)
            )
    return {key: ends_m} if low or high else {}


def shift_m(place: str, over: str, key: str, ground_m: Ground) -> float:
    """Return what to add to an altitude over one thing to have it over another.

    Args:
        place: where it is stated, for messages.
        over: the key of the first, as ``altitude_msl_m``.
        key: that of the other.
        ground_m: the origin's ground.

    Raises:
        ScenarioError: the origin does not state its altitude over both.
    """
    absent = [EARTHLY_RANGES[each] for each in {over, key} if ground_m[each] is None] if over != key else []
    if absent:
        raise refusal(
            place,
            f"it states {over}, to be compared with {key}; add {' and '.join(absent)} to [origin], which "
            "says how far these are apart",
        )
    return 0.0 if over == key else (ground_m[key] or 0.0) - (ground_m[over] or 0.0)


def _heights_m(feature: Feature) -> np.ndarray[Any, Any]:
    """Return the heights of a placemark's corners, where its altitudeMode gives them a meaning."""
    import shapely

    if feature.properties.get("altitudeMode") not in _OF_KML or feature.geometry is None:
        return np.zeros(0)
    heights_m = shapely.get_coordinates(feature.geometry, include_z=True)[:, 2]
    return np.asarray(heights_m[np.isfinite(heights_m)])


def _heights_of_kml(feature: Feature) -> dict[str, Any]:
    """Return the altitudes between roof and floor, or from the ground up to what is extruded."""
    heights_m = _heights_m(feature)
    if not len(heights_m):
        return {}
    low_m, high_m = float(heights_m.min()), float(heights_m.max())
    if feature.properties.get("extrude") in (1, True):
        low_m = -_FAR_M
    elif high_m - low_m < _FLAT_M:
        return {}
    return {_OF_KML[feature.properties["altitudeMode"]]: [low_m, high_m]}


def _is_raised(feature: Feature) -> bool:
    return bool(np.any(_heights_m(feature)))
