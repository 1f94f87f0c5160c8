"""The members of GeoJSON and of plans of QGroundControl, and the names of other JSON that holds areas."""

from __future__ import annotations

import re
from typing import Any

from nullpose.files import PlainTable, parse_json
from nullpose.scenario.faults import described, refusal, require, value_of

_GEOMETRIES = ("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon")
_WGS84 = re.compile(r"(?:.*[:/])?(?:CRS84h?|4326|4979|4258)")
_LINES = re.compile(r"\s*(?:\x1e|\{.*\}[ \t\r]*\n\s*\{)")
_OTHERS = {
    r'"horizontalProjection"|"UASZone|"geometry"\s*:\s*\[': "ED-269 JSON; convert it to ED-318, a GeoJSON",
    r'"rings"|"esri\w+"': "ArcGIS JSON; ask the server for f=geojson",
    r'"elements"\s*:': "Overpass JSON; export GeoJSON from overpass turbo, or use osmtogeojson",
    r'"Topology"': "TopoJSON; export GeoJSON, as mapshaper does",
    r'"outline_(?:polygon|circle)"': "JSON of volumes (ASTM F3411, F3548); write GeoJSON",
    r'"items"\s*:\s*\[': "an answer of a server, as openAIP's; put its items into the features of a "
    "FeatureCollection",
    r'"(?:sub_areas|polygon_points)"': "JSON of DJI; write GeoJSON",
}
HOME = "mission.plannedHomePosition"
"""Where a plan states the place from which the vehicle starts."""
_PLAN_KEYS = {"polygons", "circles", "version", "breachReturn"}


def members_of(text: str) -> dict[str, Any]:
    """Return the members of a GeoJSON text, or a plan's as such members, by their place in it.

    A plan has its fence and zones, of which ``inclusion`` is a property, and its home as a point.

    Raises:
        ScenarioError: it is other JSON, not in latitude and longitude, or a part of a longer list.
    """
    require(
        not _LINES.match(text),
        "",
        'this is GeoJSON in lines, a feature on each, which is not read; write {"type": "FeatureCollection", '
        '"features": [ before them, commas between them and ]} after',
    )
    data = parse_json(text)
    kind, members = value_of(data, "type"), value_of(data, "features")
    if value_of(data, "fileType") == "Plan":
        return _members_of_plan(data)
    is_known = kind in (*_GEOMETRIES, "GeometryCollection", "Feature", "FeatureCollection")
    listed = members if isinstance(members, list) else []
    if not is_known or any(isinstance(value_of(each, "geometry"), list) for each in listed):
        for sign, words in _OTHERS.items():
            require(not re.search(sign, text), "", f"this is {words.replace(';', ', which is not read;')}")
    require(isinstance(data, dict), "", f"got {described(data)}, must be a FeatureCollection")
    if is_known and kind != "FeatureCollection":
        listed = [data if kind == "Feature" else {"type": "Feature", "geometry": data}]
    require(is_known, "type", f'got {described(kind)}, must be "FeatureCollection", "Feature" or a geometry')
    require(listed, "features", f"got {described(members)}, must be a list of one feature or more")
    if "crs" in data:
        reference = value_of(data["crs"], "properties") or data["crs"]
        require_wgs84(str(value_of(reference, "name") or value_of(reference, "code") or described(reference)))
    require(
        not any(value_of(each, "exceededTransferLimit") for each in (data, data.get("properties")))
        and data.get("numberMatched") in (None, "unknown", len(listed)),
        "features",
        f"it has {len(listed)}, a part of what its server holds (exceededTransferLimit, numberMatched); "
        "load all of them",
    )
    return {f"features[{index}]": member for index, member in enumerate(listed)}


def _members_of_plan(plan: PlainTable) -> PlainTable:
    """Return the shapes of a plan's fence, with ``inclusion``, and its home."""
    fence, home = plan.get("geoFence"), value_of(plan.get("mission"), "plannedHomePosition")
    unread = sorted(fence.keys() - _PLAN_KEYS) if isinstance(fence, dict) else ["geoFence"]
    require(not unread, "geoFence", f"{', '.join(unread)} is not read; save the plan anew")
    found: PlainTable = {}
    if isinstance(home, list) and len(home) == 3:
        found[HOME] = _feature(
            "Point", home, {"origin": dict(zip(("lat_deg", "lon_deg", "alt_msl_m"), home, strict=True))}
        )
    for kind in ("polygon", "circle"):
        listed = value_of(fence, f"{kind}s") or []
        for index, each in enumerate(listed if isinstance(listed, list) else [listed]):
            shape, place = value_of(each, kind), f"geoFence.{kind}s[{index}]"
            rules = {"inclusion": value_of(each, "inclusion"), "radius_m": value_of(shape, "radius")}
            require(
                isinstance(rules["inclusion"], bool) and (kind == "polygon" or rules["radius_m"] is not None),
                place,
                "must state inclusion, true or false, and of a circle the radius",
            )
            corners = [shape] if kind == "polygon" else value_of(shape, "center")
            found[place] = _feature({"polygon": "Polygon", "circle": "Point"}[kind], corners, rules)
    return found


def _feature(kind: str, places: object, properties: PlainTable) -> PlainTable:
    shape = {"type": kind, "coordinates": _turned(places)}
    return {"type": "Feature", "geometry": shape, "properties": properties}


def _turned(places: object) -> object:
    """Put the longitude before the latitude; an altitude after them is left out."""
    if isinstance(places, list) and any(isinstance(each, list) for each in places):
        return [_turned(each) for each in places]
    return places[1::-1] if isinstance(places, list) else places


def require_wgs84(system: str) -> None:
    """Refuse the name of a reference system that is not in latitude and longitude of WGS 84 or ETRS89."""
    if not _WGS84.fullmatch(system):
        name = re.search(r'"([^"]+)"', system)
        got = f"got {name[1] if name else system[:60]}" if system != "None" else "there is none"
        raise refusal("crs", f"{got}, must be WGS 84 (EPSG:4326) or EPSG:4258; convert the file")
