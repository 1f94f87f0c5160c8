"""A solution or a flight on the map: GeoJSON (RFC 7946)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from nullpose.files import PlainTable, json_text
from nullpose.physics.types import FloatArray
from nullpose.report.export.places import marked_points, require_origin
from nullpose.report.geometry import outline_m
from nullpose.scenario import Origin, Scenario
from nullpose.scenario.geodesy import geodetic_from_enu
from nullpose.solver import Result
from nullpose.solver.trajectory import Trajectory


def solution_geojson(solution: Result) -> PlainTable:
    """Build a GeoJSON FeatureCollection of a result.

    Points for the pose, the nodes, the jammers and the eavesdroppers, with altitudes over the ellipsoid (or,
    where the origin tells only that, over the sea, as property ``alt_msl_m``);
    polygons for the airspace, if it is bounded on all sides, the geofence, the no-fly zones and the
    buildings. Property ``kind`` tells them apart; ``channel`` of the pose tells how power falls. Angles are
    in degrees; ``altitude_m`` of a polygon is z in the local frame, as are a building's ``height_m`` and
    ``base_m``.

    Raises:
        UsageError: the scenario has no origin.
    """
    origin = require_origin(solution.scenario)
    points = (
        _point(origin, np.asarray(place_m), properties) for place_m, properties in marked_points(solution)
    )
    return {
        "type": "FeatureCollection",
        "features": [*points, *(_polygon(origin, *outline) for outline in _outlines(solution.scenario))],
    }


def geojson_file(solution: Result) -> bytes:
    """Write a result as GeoJSON, a feature on a line.

    Raises:
        UsageError: the scenario has no origin.
    """
    return _collection(solution_geojson(solution)["features"])


def flight_geojson_file(flight: Trajectory) -> bytes:
    """Write a flight as GeoJSON: a line with its times, attitudes and values, and the outlines.

    Raises:
        UsageError: the scenario has no origin.
    """
    origin, rows = require_origin(flight.scenario), flight.rows()
    places = [_point(origin, place_m, {})["geometry"]["coordinates"] for place_m in flight.positions_m]
    about = {"kind": "flight"} | {name: [row[name] for row in rows] for name in rows[0]}
    outlines = (_polygon(origin, *outline) for outline in _outlines(flight.scenario))
    return _collection([_feature("LineString", places, about), *outlines])


def _collection(features: Iterable[PlainTable]) -> bytes:
    lines = ",\n".join(json_text(feature, indent=None) for feature in features)
    return f'{{"type": "FeatureCollection", "features": [\n{lines}\n]}}\n'.encode()


def _outlines(scenario: Scenario) -> Iterator[tuple[Sequence[FloatArray], float, PlainTable]]:
    """Yield airspace, fence, zones and buildings: rings, the first around it, height, and properties."""
    airspace = scenario.airspace
    height_m, altitude = airspace.altitude_m[0], {"altitude_m": airspace.altitude_m}
    if airspace.x_m is not None and airspace.y_m is not None:
        (west, east), (south, north) = airspace.x_m, airspace.y_m
        corners = np.array([(west, south), (east, south), (east, north), (west, north)])
        yield [corners], height_m, {"kind": "airspace", **altitude}
    if airspace.geofence_m is not None:
        yield [airspace.geofence_outline_m], height_m, {"kind": "geofence", **altitude}
    for zone in airspace.no_fly:
        properties: PlainTable = {"kind": "no-fly", "name": zone.name, "altitude_m": zone.altitude_m}
        properties |= {} if zone.radius_m is None else {"radius_m": zone.radius_m}
        yield [outline_m(zone)], max(zone.floor_m, height_m), properties
    for each in scenario.buildings:
        rings = [each.outline_m, *(yard[::-1] for yard in each.courtyard_outlines_m)]
        heights: PlainTable = {"height_m": each.height_m, "base_m": each.base_m}
        yield rings, each.base_m, {"kind": "building", "name": each.name, **heights}


def _point(origin: Origin, place: FloatArray, properties: PlainTable) -> PlainTable:
    where = origin.place(place)
    # the third coordinate is over the ellipsoid, and over nothing else
    up = [round(where["alt_m"], 4)] if "alt_m" in where else []
    coordinates = [round(where["lon_deg"], 9), round(where["lat_deg"], 9), *up]
    sea = {"alt_msl_m": round(where["alt_msl_m"], 4)} if "alt_msl_m" in where else {}
    return _feature("Point", coordinates, properties | sea | {"position_m": place.tolist()})


def _polygon(
    origin: Origin, rings_m: Sequence[FloatArray], height_m: float, properties: PlainTable
) -> PlainTable:
    """Build a polygon of its rings, at a height [m] over the local frame's zero."""
    rings = []
    for corners_m in rings_m:
        places_m = np.column_stack([corners_m, np.full(len(corners_m), height_m)])
        ring = [
            [round(lon_deg, 9), round(lat_deg, 9)]
            for lat_deg, lon_deg, _ in geodetic_from_enu(places_m, origin.geodetic).tolist()
        ]
        rings.append([*ring, ring[0]])
    return _feature("Polygon", rings, properties)


def _feature(kind: str, coordinates: Sequence[object], properties: PlainTable) -> PlainTable:
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": properties,
    }
