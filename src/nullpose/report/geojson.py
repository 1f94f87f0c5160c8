"""A solution on the map: GeoJSON (RFC 7946)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.errors import UsageError
from nullpose.files import write_text
from nullpose.physics import pose_frames
from nullpose.report.geometry import azimuth_rad, outline_m, tilt_rad
from nullpose.report.plain import json_text
from nullpose.report.results import binding_nodes
from nullpose.scenario import Origin, Scenario
from nullpose.scenario.geodesy import geodetic_from_enu
from nullpose.solve import Result

__all__ = ["require_origin", "solution_geojson", "write_geojson"]

_Feature = dict[str, object]


def require_origin(scenario: Scenario) -> Origin:
    """Return the scenario's origin.

    Args:
        scenario: what is to be put on the map.

    Raises:
        UsageError: it has none.
    """
    if scenario.origin is None:
        raise UsageError(
            "GeoJSON: the scenario has no origin, so where on the Earth it lies is not known; add a table "
            "headed [origin] with lat_deg, lon_deg and alt_m of the place where position_m is [0, 0, 0]"
        )
    return scenario.origin


def solution_geojson(solution: Result) -> dict[str, object]:
    """Return a solution as a GeoJSON FeatureCollection, ready for JSON.

    Points for the pose, the nodes, the jammers and the eavesdroppers, with altitudes over the ellipsoid;
    polygons for the airspace, if it is bounded on all sides, the geofence and the no-fly zones. Property
    ``kind`` tells them apart. Angles are in degrees; ``altitude_m`` of a polygon is z in the local frame.

    Args:
        solution: what was found.

    Raises:
        UsageError: the scenario has no origin.
    """
    return {"type": "FeatureCollection", "features": _features(solution)}


def write_geojson(solution: Result, path: Path) -> Path:
    """Return the path of a GeoJSON file after writing a solution to it, one feature a line.

    Args:
        solution: what was found.
        path: the file.

    Raises:
        UsageError: the scenario has no origin.
        OutputError: the file cannot be written.
    """
    lines = ",\n".join(json_text(feature, indent=None) for feature in _features(solution))
    return write_text(path, f'{{"type": "FeatureCollection", "features": [\n{lines}\n]}}\n')


def _features(solution: Result) -> list[_Feature]:
    origin = require_origin(solution.scenario)
    return [*_points(solution, origin), *_outlines(solution.scenario, origin)]


def _points(solution: Result, origin: Origin) -> Iterator[_Feature]:
    scenario = solution.scenario
    yield _point(origin, solution.pose.position_m, **_pose_properties(solution))
    links = {link.node: link for link in solution.links}
    binding = binding_nodes(solution)
    for node in scenario.nodes:
        link = {key: value for key, value in asdict(links[node.name]).items() if value is not None}
        name = link.pop("node")
        yield _point(origin, node.position_m, kind="node", name=name, binding=name in binding, **link)
    for jammer in scenario.jammers:
        own = {"power_w": jammer.transmit_power_w, "uncertainty_m": jammer.uncertainty_reach_m}
        yield _point(origin, jammer.position_m, kind="jammer", name=jammer.name, **own)
    for each in scenario.eavesdroppers:
        reach_m = each.uncertainty_reach_m
        yield _point(origin, each.position_m, kind="eavesdropper", name=each.name, uncertainty_m=reach_m)


def _pose_properties(solution: Result) -> dict[str, object]:
    objective, pose = solution.objective, solution.pose
    frames = pose_frames(solution.scenario, pose)
    angles = {
        f"{name}_{angle}_deg": math.degrees(getattr(frame, f"{angle}_rad"))
        for name, frame in (("enu", frames.enu), ("ned", frames.ned))
        for angle in ("roll", "pitch", "yaw")
    }
    return {
        "kind": "pose",
        "name": solution.label,
        "status": solution.status.value,
        "rigour": solution.rigour.value,
        "objective": objective.name,
        "value": objective.value,
        "value_db": objective.value_db,
        "upper_bound": objective.upper_bound,
        **angles,
        "enu_quaternion_wxyz": list(frames.enu.quaternion_wxyz),
        "ned_quaternion_wxyz": list(frames.ned.quaternion_wxyz),
        "antenna_tilt_deg": math.degrees(tilt_rad(pose)),
        "antenna_bearing_deg": (90.0 - math.degrees(azimuth_rad(pose))) % 360.0,
    }


def _outlines(scenario: Scenario, origin: Origin) -> Iterator[_Feature]:
    airspace = scenario.airspace
    height_m = airspace.altitude_m[0]
    if airspace.x_m is not None and airspace.y_m is not None:
        (west, east), (south, north) = airspace.x_m, airspace.y_m
        box = np.array([(west, south), (east, south), (east, north), (west, north)])
        yield _polygon(origin, box, height_m, kind="airspace", altitude_m=airspace.altitude_m)
    if airspace.geofence_m is not None:
        fence = airspace.geofence_outline_m
        yield _polygon(origin, fence, height_m, kind="geofence", altitude_m=airspace.altitude_m)
    for zone in airspace.no_fly:
        round_one = {} if zone.radius_m is None else {"radius_m": zone.radius_m}
        own = {"kind": "no-fly", "name": zone.name, "altitude_m": zone.altitude_m, **round_one}
        yield _polygon(origin, outline_m(zone), max(zone.floor_m, height_m), **own)


def _point(origin: Origin, position_m: ArrayLike, **properties: object) -> _Feature:
    place = np.asarray(position_m, dtype=float)
    lat_deg, lon_deg, alt_m = geodetic_from_enu(place, origin.geodetic).tolist()
    coordinates = [round(lon_deg, 9), round(lat_deg, 9), round(alt_m, 4)]
    return _feature(
        {"type": "Point", "coordinates": coordinates}, properties | {"position_m": place.tolist()}
    )


def _polygon(
    origin: Origin, outline_m: NDArray[np.float64], height_m: float, **properties: object
) -> _Feature:
    """Return an outline as a polygon, at a height [m] over the local frame's zero."""
    heights_m = np.full((len(outline_m), 1), height_m)
    places = geodetic_from_enu(np.concatenate([outline_m, heights_m], axis=1), origin.geodetic).tolist()
    ring = [[round(lon_deg, 9), round(lat_deg, 9)] for lat_deg, lon_deg, _ in places]
    return _feature({"type": "Polygon", "coordinates": [[*ring, ring[0]]]}, properties)


def _feature(geometry: Mapping[str, object], properties: Mapping[str, object]) -> _Feature:
    return {"type": "Feature", "geometry": geometry, "properties": properties}
