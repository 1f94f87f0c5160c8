"""Fences and no-fly zones from GeoJSON and KML files."""

from __future__ import annotations

from typing import Any

from nullpose.scenario.features import features_of, require, type_of

_AREA_KEYS = ("name", "radius_m", "altitude_m", "altitude_msl_m", "altitude_ellipsoid_m")


def areas_from_features(text: str, ending: str) -> list[dict[str, object]]:
    """Returns the raw no-fly zones that a GeoJSON or KML file holds, each in degrees.

    A Polygon is a zone by its corners, a Point with a property ``radius_m`` a cylinder. The other keys of a
    zone are properties; what else there is of properties is left out, as programs write many of their own.

    Args:
        text: the file's content.
        ending: of the file's name, which tells the kind.

    Raises:
        ScenarioError: it cannot be read, or holds anything else.
    """
    return [_area(f"features[{index}]", feature) for index, feature in enumerate(features_of(text, ending))]


def _area(where: str, feature: Any) -> dict[str, object]:
    geometry: Any = feature.get("geometry") if isinstance(feature, dict) else None
    allowed = 'a geometry of type "Polygon" (or, for a cylinder, "Point" with a property radius_m)'
    require(type_of(geometry) in ("Polygon", "Point"), f"{where}.geometry", type_of(geometry), allowed)
    properties = feature.get("properties")
    stated = properties if isinstance(properties, dict) else {}
    values = {key: stated[key] for key in _AREA_KEYS if stated.get(key) is not None}
    is_polygon, coordinates = geometry["type"] == "Polygon", geometry.get("coordinates")
    rings = coordinates if is_polygon else [[coordinates]]
    fits = isinstance(rings, list) and len(rings) == 1 and isinstance(rings[0], list)
    fits = fits and all(isinstance(place, list) and len(place) in (2, 3) for place in rings[0])
    allowed = "[longitude, latitude] in degrees, of a polygon in one ring without holes"
    require(fits, f"{where}.geometry.coordinates", coordinates, allowed)
    corners = [[place[1], place[0]] for place in rings[0]]
    if is_polygon:
        return values | {"polygon_lat_lon_deg": corners[:-1] if corners[:1] == corners[-1:] else corners}
    return values | {"centre_lat_lon_deg": corners[0]}
