"""Nodes as features of GeoJSON or KML: Points, the nodes' other keys being properties."""

from __future__ import annotations

from typing import Any

from nullpose.errors import ScenarioError
from nullpose.scenario.features import features_of, require, type_of
from nullpose.scenario.listed_nodes import ListedNode
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.units import ALTITUDE_KEYS

_NO_PLACE = "left out, for the place of a feature is its geometry's coordinates; remove this property"
_COORDINATES = "[longitude, latitude, altitude] in degrees and in m over the WGS-84 ellipsoid"
_ADD_HEIGHT = "add the altitude, or a property alt_m, alt_msl_m (sea) or alt_agl_m (above the ground)"


def nodes_from_features(text: str, ending: str) -> list[ListedNode]:
    """Returns the nodes of a GeoJSON or KML file.

    Args:
        text: the file's content. Each feature is a node: a Point with longitude, latitude, altitude, and the
            node's other keys as properties. The altitude may be a property ``alt_m``, ``alt_msl_m`` or
            ``alt_agl_m`` instead.
        ending: of the file's name, which tells the kind.

    Raises:
        ScenarioError: it cannot be read, or is no FeatureCollection with features.
    """
    # One more than are allowed, so that it is refused as a node.
    listed = features_of(text, ending)[: MOST_MEMBERS + 1]
    return [_node(f"features[{index}]", feature) for index, feature in enumerate(listed)]


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
    require(is_feature, "", type_of(feature), 'an object with "type": "Feature"')
    properties, geometry = feature.get("properties"), feature.get("geometry")
    require(properties is None or isinstance(properties, dict), ".properties", properties, "an object")
    is_point = isinstance(geometry, dict) and geometry.get("type") == "Point"
    require(is_point, ".geometry", type_of(geometry), 'a geometry of type "Point"')
    here, coordinates = ".geometry.coordinates", geometry.get("coordinates")
    is_place = isinstance(coordinates, list) and len(coordinates) in (2, 3) and None not in coordinates
    require(is_place, here, coordinates, _COORDINATES)
    values = {key: value for key, value in (properties or {}).items() if value is not None}
    lon_deg, lat_deg, *height_m = coordinates
    stated = any(key in values for key in ALTITUDE_KEYS)
    require(height_m or stated, here, coordinates, f"{_COORDINATES}; {_ADD_HEIGHT}")
    for key in ("position_m", "lat_deg", "lon_deg", *(ALTITUDE_KEYS if height_m else ())):
        require(key not in values, f".properties.{key}", values.get(key), _NO_PLACE)
    place = {"lat_deg": lat_deg, "lon_deg": lon_deg} | ({"alt_m": height_m[0]} if height_m else {})
    return values | place, bool(height_m)
