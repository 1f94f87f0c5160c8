"""GeoJSON (RFC 7946) and KML, as far as their features."""

from __future__ import annotations

import json
from typing import Any

from nullpose.files import parse_json
from nullpose.scenario.faults import refusal
from nullpose.scenario.kml import features_of_kml
from nullpose.scenario.wording import described

_READERS = {".geojson": parse_json, ".json": parse_json, ".kml": features_of_kml}
ENDINGS = tuple(_READERS)
"""How the names of files end that features are read of."""
_WGS84 = ("CRS84", "CRS84h", "EPSG::4326", "EPSG:4326", "EPSG::4979", "EPSG:4979")


def features_of(text: str, ending: str) -> list[Any]:
    """Returns the features of a GeoJSON or KML file, one or more, not looked at yet.

    Args:
        text: the file's content.
        ending: of the file's name, which tells the kind.

    Raises:
        ScenarioError: it cannot be read, or is no FeatureCollection with features.
    """
    data = _READERS[ending](text)
    require(isinstance(data, dict), "", data, "a FeatureCollection")
    is_collection = data.get("type") == "FeatureCollection"
    require(is_collection, "type", data.get("type"), '"FeatureCollection", of features with properties')
    features: Any = data.get("features")
    system = json.dumps(data.get("crs"))
    require(isinstance(features, list) and features, "features", features, "a list of one feature or more")
    is_wgs84 = "crs" not in data or system.rstrip('}"]').endswith(_WGS84)
    require(is_wgs84, "crs", system, "WGS-84 (RFC 7946 has no other); convert the file")
    return list(features)


def require(fits: object, place: str, given: object, allowed: str) -> None:
    """Raises the fault of a value that does not fit.

    Args:
        fits: whether it does.
        place: where in the file it stands.
        given: the value.
        allowed: what it must be.

    Raises:
        ScenarioError: it does not fit.
    """
    if not fits:
        raise refusal(place, f"got {described(given)}, must be {allowed}")


def type_of(value: Any) -> object:
    """Returns what a GeoJSON object says it is; a value that is no object as it stands."""
    return value.get("type") if isinstance(value, dict) else value
