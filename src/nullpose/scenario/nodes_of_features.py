"""Nodes as the points of a geographic file, the nodes' other keys being properties."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from nullpose.errors import Fault
from nullpose.scenario.areas import listed_numbers, name_of, parts_of, unique
from nullpose.scenario.faults import refusal
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.ground_points import Node
from nullpose.scenario.listed_nodes import ListedNode
from nullpose.scenario.units import ALTITUDE_KEYS

_OVER = {"absolute": "alt_msl_m", "relativeToGround": "alt_agl_m"}  # altitude modes of KML
_PLACED = ("position_m", "lat_deg", "lon_deg")
_TYPO = 0.75  # similarity from which an unknown property is taken for a key
_NO_HEIGHT = (
    "there is no altitude; add it to the coordinates, or as a property alt_m (ellipsoid), alt_msl_m (sea) or "
    "alt_agl_m (above the ground)"
)
_NO_PLACE = "remove this property: the place is in the coordinates"


def nodes_of_features(features: Sequence[Feature]) -> tuple[list[ListedNode], list[str]]:
    """Return the nodes of a file and an account of what is passed over; no line where nothing is.

    Args:
        features: of the file. Every point is a node.

    Raises:
        ScenarioError: there is no point.
    """
    nodes: list[ListedNode] = []
    passed, unread, taken = Counter[str](), set[str](), set[str]()
    for feature in features:
        points = [] if feature.geometry is None else list(parts_of(feature.geometry))
        passed["feature without a place"] += not points
        values = _values(feature, unread)
        for index, point in enumerate(points):
            if point.geom_type != "Point":
                passed["line" if "Line" in point.geom_type else "polygon"] += 1
                continue
            name = name_of(feature)
            name = unique(f"{name} ({index + 1})" if name and len(points) > 1 else name, taken)
            nodes.append(_node(feature, point, values | ({"name": name} if name else {})))
    if not nodes:
        raise refusal("", f"it has no point, must have one for each node; it has {listed_numbers(passed)}")
    words = [f"passed over: {listed_numbers(passed)}"] if any(passed.values()) else []
    words += [f"properties not read: {', '.join(sorted(unread))}"] if unread else []
    return nodes, [f"nodes: {len(nodes)}; {'; '.join(words)}"] if words else []


def _values(feature: Feature, unread: set[str]) -> dict[str, Any]:
    """Return the properties that are keys of a node or look like one; add the others to those unread."""
    known = set(Node.model_fields)
    likely = {key for key in feature.properties if key in known or get_close_matches(key, known, 1, _TYPO)}
    drawn = {"Name", "altitudeMode", "extrude", "ele"}
    unread |= feature.properties.keys() - likely - drawn
    return {key: feature.properties[key] for key in likely - {"name", "Name"}}


def _node(feature: Feature, point: Any, values: Mapping[str, Any]) -> ListedNode:
    where, here = feature.place, ".geometry.coordinates"
    height_m = point.z if point.has_z and math.isfinite(point.z) else None
    mode = feature.properties.get("altitudeMode")
    is_kml = where.startswith("Placemark")
    key = _OVER.get(str(mode), "" if is_kml else "alt_m")  # KML clamps a point without a mode to the ground
    if "ele" in feature.properties:  # of GPX
        key, height_m = "alt_msl_m", feature.properties["ele"]
    has_height = key != "" and height_m is not None
    for wrong in (*_PLACED, *(ALTITUDE_KEYS if has_height else ())):
        if wrong in values:
            return ListedNode(where, fault=Fault(f".properties.{wrong}", _NO_PLACE))
    if not has_height and not any(each in values for each in ALTITUDE_KEYS):
        return ListedNode(where, fault=Fault(here, _NO_HEIGHT))
    place = {"lat_deg": point.y, "lon_deg": point.x} | ({key: height_m} if has_height else {})
    axes = {"lon_deg": 0, "lat_deg": 1} | ({key: 2} if has_height else {})
    places = {each: f"{here}[{axis}]" for each, axis in axes.items()} | {"position_m": ".geometry"}
    return ListedNode(where, {**values, **place}, ".properties.{}", places)
