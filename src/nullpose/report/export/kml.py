"""The points of a result as placemarks of KML (OGC 12-007r2)."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, indent, tostring

from nullpose.report.export.places import map_altitude_m, marked_points, require_origin
from nullpose.solver import Result


def kml_file(result: Result) -> bytes:
    """Write a result as KML: pose, nodes, jammers and eavesdroppers, with their properties.

    Altitudes are over the sea where the origin states its own, and otherwise over the ground at the origin.

    Raises:
        UsageError: the scenario has no origin.
    """
    origin = require_origin(result.scenario)
    root = Element("kml", xmlns="http://www.opengis.net/kml/2.2")
    document = SubElement(root, "Document")
    for position_m, properties in marked_points(result):
        mark, place = SubElement(document, "Placemark"), origin.place(position_m)
        SubElement(mark, "name").text = str(properties.pop("name"))
        data = SubElement(mark, "ExtendedData")
        for key in (key for key, value in properties.items() if value is not None):
            SubElement(SubElement(data, "Data", name=key), "value").text = str(properties[key])
        point = SubElement(mark, "Point")
        SubElement(point, "altitudeMode").text = "absolute" if "alt_msl_m" in place else "relativeToGround"
        coordinates = f"{place['lon_deg']:.9f},{place['lat_deg']:.9f},{map_altitude_m(origin, place):.4f}"
        SubElement(point, "coordinates").text = coordinates
    indent(root)
    return bytes(tostring(root, encoding="UTF-8", xml_declaration=True))
