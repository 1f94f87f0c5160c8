"""KML, the format of Google Earth, read as the GeoJSON that says the same."""

from __future__ import annotations

import json
from typing import Any
from xml.etree import ElementTree

from nullpose.scenario.faults import refusal

_ALTITUDES = {"absolute": "alt_msl_m", "relativeToGround": "alt_agl_m"}


def features_of_kml(text: str) -> dict[str, Any]:
    """Returns the placemarks of a KML file as a GeoJSON FeatureCollection.

    A point's altitude is over the sea where its altitudeMode is absolute, above the ground where it is
    relativeToGround, and not stated otherwise. What ExtendedData holds becomes properties, numbers and lists
    as such.

    Args:
        text: the file's content.

    Raises:
        ScenarioError: no XML, or XML that declares entities.
    """
    try:
        root = ElementTree.fromstring("" if "<!DOCTYPE" in text else text)
    except ElementTree.ParseError as error:
        raise refusal("", f"this is not KML: {error}; export it anew, as .kml and not .kmz") from None
    return {"type": "FeatureCollection", "features": [_feature(each) for each in _inside(root, "Placemark")]}


def _feature(place: ElementTree.Element) -> dict[str, Any]:
    """Returns a placemark as a feature; its geometry is the first point or polygon in it."""
    properties: dict[str, object] = {"name": place.findtext("{*}name", "").strip() or None}
    for data in _inside(place, "Data", "SimpleData"):
        properties[data.get("name", "")] = _value(data.findtext("{*}value", data.text or ""))
    for shape in _inside(place, "Point", "Polygon")[:1]:
        chains = [
            [[_value(number) for number in word.split(",")] for word in (each.text or "").split()]
            for each in _inside(shape, "coordinates")
        ]
        coordinates: Any = [[numbers[:2] for numbers in chain] for chain in chains]
        if _kind(shape) == "Point" and any(chains):
            over = _ALTITUDES.get(shape.findtext("{*}altitudeMode", "").strip(), "")
            properties |= dict(zip([over] * bool(over), chains[0][0][2:], strict=False))
            coordinates = coordinates[0][0]
        geometry = {"type": _kind(shape), "coordinates": coordinates}
        return {"type": "Feature", "properties": properties, "geometry": geometry}
    return {"type": "Feature", "properties": properties, "geometry": None}


def _inside(element: ElementTree.Element, *kinds: str) -> list[ElementTree.Element]:
    return [each for each in element.iter() if _kind(each) in kinds]


def _kind(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


def _value(text: str) -> object:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text.strip()
