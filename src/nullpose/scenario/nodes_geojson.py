"""Nodes as GeoJSON (RFC 7946): a FeatureCollection of Points, the nodes' other keys as properties."""

from __future__ import annotations

import json
from typing import Any

from nullpose.errors import ScenarioError
from nullpose.files import parse_json
from nullpose.scenario.faults import refusal
from nullpose.scenario.listed_nodes import ListedNode
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.wording import described

_NO_PLACE = "left out, for the place of a feature is its geometry's coordinates; remove this property"
_COORDINATES = "[longitude, latitude, altitude] in degrees and in m over the WGS-84 ellipsoid"
_ADD_HEIGHT = "add the altitude, or a property alt_m"
_WGS84 = ("CRS84", "CRS84h", "EPSG::4326", "EPSG:4326", "EPSG::4979", "EPSG:4979")


def nodes_from_geojson(text: str) -> list[ListedNode]:
    """Returns the nodes of a GeoJSON file.

    Args:
        text: the file's content. Each feature is a node: a Point with longitude, latitude, altitude, and the
            node's other keys as properties. The altitude may be a property ``alt_m`` instead.

    Raises:
        ScenarioError: no JSON, or no FeatureCollection with features.
    """
    data = parse_json(text)
    _require(isinstance(data, dict), "", data, "a FeatureCollection of Points")
    is_collection = data.get("type") == "FeatureCollection"
    _require(is_collection, "type", data.get("type"), '"FeatureCollection", of Points with properties')
    features, system = data.get("features"), json.dumps(data.get("crs"))
    _require(isinstance(features, list) and features, "features", features, "a list of one feature or more")
    is_wgs84 = "crs" not in data or system.rstrip('}"]').endswith(_WGS84)
    _require(is_wgs84, "crs", system, "WGS-84 (RFC 7946 has no other); convert the file")
    # One more than are allowed, so that it is refused as a node.
    return [
        _node(f"features[{index}]", feature) for index, feature in enumerate(features[: MOST_MEMBERS + 1])
    ]


def _require(fits: object, place: str, given: object, allowed: str) -> None:
    if not fits:
        raise refusal(place, f"got {described(given)}, must be {allowed}")


def _type(value: Any) -> object:
    return value.get("type") if isinstance(value, dict) else value


def _node(where: str, feature: Any) -> ListedNode:
    """Returns the node that a feature states; unknown properties too, for the node to refuse."""
    try:
        values, has_height = _values(feature)
    except ScenarioError as error:
        return ListedNode(where, fault=error.faults[0])
    axes = {"lon_deg": 0, "lat_deg": 1} | ({"alt_m": 2} if has_height else {})
    places = {key: f".geometry.coordinates[{axis}]" for key, axis in axes.items()}
    return ListedNode(where, values, ".properties.{}", places | {"position_m": ".geometry"})


def _values(feature: Any) -> tuple[dict[str, object], bool]:
    """Returns the raw node, and whether its altitude is the third of the coordinates."""
    is_feature = isinstance(feature, dict) and feature.get("type") == "Feature"
    _require(is_feature, "", _type(feature), 'an object with "type": "Feature"')
    properties, geometry = feature.get("properties"), feature.get("geometry")
    _require(properties is None or isinstance(properties, dict), ".properties", properties, "an object")
    is_point = isinstance(geometry, dict) and geometry.get("type") == "Point"
    _require(is_point, ".geometry", _type(geometry), 'a geometry of type "Point"')
    here, coordinates = ".geometry.coordinates", geometry.get("coordinates")
    is_place = isinstance(coordinates, list) and len(coordinates) in (2, 3) and None not in coordinates
    _require(is_place, here, coordinates, _COORDINATES)
    values = {key: value for key, value in (properties or {}).items() if value is not None}
    lon_deg, lat_deg, *height_m = coordinates
    _require(height_m or "alt_m" in values, here, coordinates, f"{_COORDINATES}; {_ADD_HEIGHT}")
    for key in ("position_m", "lat_deg", "lon_deg", *(["alt_m"] if height_m else [])):
        _require(key not in values, f".properties.{key}", values.get(key), _NO_PLACE)
    alt_m = height_m[0] if height_m else values["alt_m"]
    return values | {"lat_deg": lat_deg, "lon_deg": lon_deg, "alt_m": alt_m}, bool(height_m)
