"""Nodes as GeoJSON (RFC 7946): a FeatureCollection of Points, the nodes' other keys as properties."""

from __future__ import annotations

import json
from collections.abc import Mapping

from nullpose.errors import Fault, ScenarioError
from nullpose.files import parse_json
from nullpose.scenario.listed_nodes import WHOLE, ListedNodes, NodesFileError
from nullpose.scenario.section import MOST_MEMBERS
from nullpose.scenario.wording import described

__all__ = ["nodes_from_geojson"]

_COORDINATES = "[longitude, latitude, altitude] in degrees and in m over the WGS-84 ellipsoid"
_PLACE_KEYS = ("position_m", "lat_deg", "lon_deg")
_WGS84 = ("CRS84", "CRS84h", "EPSG::4326", "EPSG:4326", "EPSG::4979", "EPSG:4979")


def nodes_from_geojson(text: str) -> ListedNodes:
    """Returns the nodes of a GeoJSON file.

    Args:
        text: the file's content. Each feature is a node: a Point with longitude, latitude, altitude, and the
            node's other keys as properties. The altitude may be a property ``alt_m`` instead.

    Raises:
        NodesFileError: no JSON, or no FeatureCollection with features.
    """
    features = _features(_json(text))
    members: list[Mapping[str, object]] = []
    faults: list[Fault] = []
    hidden: dict[int, str] = {}
    for index, feature in enumerate(features):
        try:
            members.append(_member(feature))
        except _FeatureError as error:
            faults.append(Fault(f"features[{index}]{error.place}", str(error)))
            members.append(error.rest or {})
            hidden[index] = WHOLE if error.rest is None else "position_m"
    return ListedNodes(
        members=tuple(members),
        where=tuple(f"features[{index}]" for index in range(len(features))),
        place_of=lambda index, key, rest: _place_of(_is_flat(features[index]), key, rest),
        faults=tuple(faults),
        hidden=hidden,
    )


class _FeatureError(Exception):
    """A feature that is no node; ``rest`` is what could be read of it all the same, or None."""

    def __init__(self, place: str, message: str, rest: Mapping[str, object] | None = None) -> None:
        self.place = place
        self.rest = rest
        super().__init__(message)


def _json(text: str) -> object:
    try:
        return parse_json(text)
    except ScenarioError as error:
        raise NodesFileError(*error.faults) from None


def _features(data: object) -> list[object]:
    if not isinstance(data, Mapping):
        raise NodesFileError(Fault("", f"got {described(data)}, must be a FeatureCollection of Points"))
    faults = []
    if data.get("type") != "FeatureCollection":
        got = described(data.get("type"))
        faults.append(Fault("type", f'got {got}, must be "FeatureCollection", of Points with properties'))
    features = data.get("features")
    if not faults and not (isinstance(features, list) and features):
        faults.append(Fault("features", f"got {described(features)}, must be a list of one feature or more"))
    if "crs" in data and not json.dumps(data["crs"]).rstrip('}"]').endswith(_WGS84):
        message = (
            "this names another reference system, must be WGS-84 (RFC 7946 has no other); convert the file"
        )
        faults.append(Fault("crs", message))
    if faults or not isinstance(features, list):
        raise NodesFileError(*faults)
    return features[: MOST_MEMBERS + 1]  # one more than are allowed, so that it is refused as a node


def _member(feature: object) -> dict[str, object]:
    """Returns the node that a feature states; unknown properties too, for the node to refuse."""
    if not isinstance(feature, Mapping) or feature.get("type") != "Feature":
        got = described(feature.get("type") if isinstance(feature, Mapping) else feature)
        raise _FeatureError("", f'got {got}, must be an object with "type": "Feature"')
    properties = feature.get("properties")
    if properties is None:
        properties = {}
    if not isinstance(properties, Mapping):
        raise _FeatureError(".properties", f"got {described(properties)}, must be an object")
    values = {key: value for key, value in properties.items() if value is not None}
    altitude = values.pop("alt_m", None)
    for key in _PLACE_KEYS:
        if values.pop(key, None) is not None:
            message = "the place of a feature is its geometry's coordinates; remove this property"
            raise _FeatureError(f".properties.{key}", message, values)
    return values | _place(feature.get("geometry"), altitude, values)


def _place(geometry: object, altitude: object, values: Mapping[str, object]) -> dict[str, object]:
    if not isinstance(geometry, Mapping) or geometry.get("type") != "Point":
        given = geometry.get("type") if isinstance(geometry, Mapping) else geometry
        raise _FeatureError(
            ".geometry", f'got {described(given)}, must be a geometry of type "Point"', values
        )
    coordinates = geometry.get("coordinates")
    here = ".geometry.coordinates"
    if not isinstance(coordinates, list) or len(coordinates) not in (2, 3) or None in coordinates:
        raise _FeatureError(here, f"got {described(coordinates)}, must be {_COORDINATES}", values)
    if len(coordinates) == 2 and altitude is None:
        message = (
            f"got {described(coordinates)}, must be {_COORDINATES}; add the altitude, or a property alt_m"
        )
        raise _FeatureError(here, message, values)
    if len(coordinates) == 3 and altitude is not None:
        message = "the altitude is the third of the coordinates already; remove this property"
        raise _FeatureError(".properties.alt_m", message, values)
    lon_deg, lat_deg, *heights = coordinates
    return {"lat_deg": lat_deg, "lon_deg": lon_deg, "alt_m": heights[0] if heights else altitude}


def _place_of(flat: bool, key: str, rest: str) -> str:
    """Returns where in a feature a value stands; in a flat one the altitude is a property."""
    axis = {"lon_deg": 0, "lat_deg": 1, "alt_m": 2}.get(key)
    if axis is None or (axis == 2 and flat):
        return ".geometry" if key == "position_m" else f".properties.{key}{rest}"
    return f".geometry.coordinates[{axis}]"


def _is_flat(feature: object) -> bool:
    geometry = feature.get("geometry") if isinstance(feature, Mapping) else None
    coordinates = geometry.get("coordinates") if isinstance(geometry, Mapping) else None
    return isinstance(coordinates, list) and len(coordinates) == 2
