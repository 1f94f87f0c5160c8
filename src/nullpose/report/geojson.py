"""A solution on the map: GeoJSON (RFC 7946)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.files import PlainTable, json_text, write_text
from nullpose.physics import Pose, pose_frames
from nullpose.physics.types import FloatArray
from nullpose.report.geometry import azimuth_rad, outline_m, tilt_rad
from nullpose.report.links import binding_nodes
from nullpose.report.words import channel_words
from nullpose.scenario import Origin, Scenario
from nullpose.scenario.geodesy import geodetic_from_enu
from nullpose.solver import Result
from nullpose.solver.robust import RobustDetails

_Feature = dict[str, object]


def require_origin(scenario: Scenario) -> Origin:
    """Look up the origin that puts a scenario on the map.

    Raises:
        UsageError: it has none.
    """
    if scenario.origin is None:
        raise UsageError(
            "GeoJSON: the scenario has no origin, so where on the Earth it lies is not known; add a table "
            "headed [origin] with lat_deg, lon_deg and alt_m (or alt_msl_m) of the place where position_m is "
            "[0, 0, 0]"
        )
    return scenario.origin


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
    points = (_point(origin, np.asarray(place_m), properties) for place_m, properties in _points(solution))
    polygons = (_polygon(origin, *outline) for outline in _outlines(solution.scenario))
    return {"type": "FeatureCollection", "features": [*points, *polygons]}


def write_geojson(solution: Result, path: Path) -> Path:
    """Write a result to a GeoJSON file, a feature on a line; return its path.

    Raises:
        UsageError: the scenario has no origin.
        OutputError: the file cannot be written.
    """
    lines = ",\n".join(json_text(feature, indent=None) for feature in solution_geojson(solution)["features"])
    return write_text(path, f'{{"type": "FeatureCollection", "features": [\n{lines}\n]}}\n')


def _points(solution: Result) -> Iterator[tuple[ArrayLike, _Feature]]:
    """Yield the pose, the nodes, the jammers and the eavesdroppers: position in metres, and properties."""
    scenario, binding = solution.scenario, binding_nodes(solution)
    objective = solution.objective
    properties: _Feature = {
        "kind": "pose",
        "name": solution.label,
        "status": solution.status.value,
        "rigour": solution.rigour.value,
        "objective": objective.name,
        "value": objective.value,
        "value_db": objective.value_db,
        "upper_bound": objective.upper_bound,
    }
    channel = channel_words(scenario)
    properties |= {} if channel is None else {"channel": channel}
    yield solution.pose.position_m, properties | _angles(scenario, solution.pose)
    if isinstance(solution.details, RobustDetails):
        nominal = solution.details.nominal
        named = {"kind": "pose-as-stated", "name": "best pose as stated", "guaranteed": nominal.guaranteed}
        yield nominal.pose.position_m, named | _angles(scenario, nominal.pose)
    for node, link in zip(scenario.nodes, solution.links, strict=True):
        values = dict(link.values)
        yield node.position_m, {"kind": "node", "name": node.name, "binding": node.name in binding, **values}
    for jammer in scenario.jammers:
        reach = {"power_w": jammer.transmit_power_w, "uncertainty_m": jammer.uncertainty_reach_m}
        yield jammer.position_m, {"kind": "jammer", "name": jammer.name, **reach}
    for point in scenario.eavesdroppers:
        reach = {"uncertainty_m": point.uncertainty_reach_m}
        yield point.position_m, {"kind": "eavesdropper", "name": point.name, **reach}


def _angles(scenario: Scenario, pose: Pose) -> dict[str, object]:
    """Convert the attitude to the frames of other programs, and the antenna's axis to two angles."""
    frames, is_even = pose_frames(scenario, pose), scenario.antenna_record.is_even
    return {
        **{
            f"{name}_{angle}_deg": math.degrees(getattr(frame, f"{angle}_rad"))
            for name, frame in (("enu", frames.enu), ("ned", frames.ned))
            for angle in ("roll", "pitch", "yaw")
        },
        "enu_quaternion_wxyz": list(frames.enu.quaternion_wxyz),
        "ned_quaternion_wxyz": list(frames.ned.quaternion_wxyz),
        "antenna_tilt_deg": math.degrees(tilt_rad(pose, is_even)),
        "antenna_bearing_deg": (90.0 - math.degrees(azimuth_rad(pose, is_even))) % 360.0,
    }


def _outlines(scenario: Scenario) -> Iterator[tuple[Sequence[FloatArray], float, _Feature]]:
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
        properties: _Feature = {"kind": "no-fly", "name": zone.name, "altitude_m": zone.altitude_m}
        properties |= {} if zone.radius_m is None else {"radius_m": zone.radius_m}
        yield [outline_m(zone)], max(zone.floor_m, height_m), properties
    for each in scenario.buildings:
        rings = [each.outline_m, *(yard[::-1] for yard in each.courtyard_outlines_m)]
        heights: _Feature = {"height_m": each.height_m, "base_m": each.base_m}
        yield rings, each.base_m, {"kind": "building", "name": each.name, **heights}


def _point(origin: Origin, place: FloatArray, properties: _Feature) -> _Feature:
    where = origin.place(place)
    coordinates = [round(where["lon_deg"], 9), round(where["lat_deg"], 9)]
    if "alt_m" in where:  # the third coordinate is over the ellipsoid, and over nothing else
        coordinates.append(round(where["alt_m"], 4))
    sea = {"alt_msl_m": round(where["alt_msl_m"], 4)} if "alt_msl_m" in where else {}
    return _feature("Point", coordinates, properties | sea | {"position_m": place.tolist()})


def _polygon(
    origin: Origin, rings_m: Sequence[FloatArray], height_m: float, properties: _Feature
) -> _Feature:
    """Build a polygon of its rings, at a height [m] over the local frame's zero."""
    rings = []
    for corners_m in rings_m:
        places_m = np.column_stack([corners_m, np.full(len(corners_m), height_m)])
        places = geodetic_from_enu(places_m, origin.geodetic).tolist()
        ring = [[round(lon_deg, 9), round(lat_deg, 9)] for lat_deg, lon_deg, _ in places]
        rings.append([*ring, ring[0]])
    return _feature("Polygon", rings, properties)


def _feature(kind: str, coordinates: Sequence[object], properties: _Feature) -> _Feature:
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": properties,
    }
