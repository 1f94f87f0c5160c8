"""A result or a flight as a plan of QGroundControl: where to hover or fly, at which yaw, in which fence."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.files import PlainTable, json_text
from nullpose.physics import Pose, evaluate, objective_of_links, pose_frames
from nullpose.report.export.places import map_altitude_m, require_origin
from nullpose.report.numbers import with_unit
from nullpose.scenario import Airspace, NoFlyZone, Origin, Scenario
from nullpose.scenario.airspace import BORDER_M
from nullpose.scenario.geodesy import geodetic_from_enu
from nullpose.solver import Result
from nullpose.solver.trajectory import Trajectory

_HOVER, _WAYPOINT, _CHANGE_SPEED = 17, 16, 178  # MAV_CMD_NAV_LOITER_UNLIM, _NAV_WAYPOINT, _DO_CHANGE_SPEED
_OF_MISSION, _AT_LEAST_M_S = 2, 0.1  # MAV_FRAME_MISSION, and a speed
_OVER_SEA, _OVER_HOME = (0, 2), (3, 1)  # MAV_FRAME, and AltitudeMode of QGroundControl
_PX4, _MULTIROTOR = 12, 2  # MAV_AUTOPILOT, MAV_TYPE


def plan_file(result: Result) -> bytes:
    """Write a result as a plan: one waypoint to hover at, and the geofence with the no-fly zones.

    The altitude is over the sea where the origin states its own, and otherwise over home, which is the
    origin. A zone of a plan has all altitudes: one above or below the pose is left out.

    Raises:
        UsageError: the scenario has no origin.
    """
    return _content(result.scenario, [result.pose], [_at_pose(_HOVER, result.scenario, result.pose, 0.0)])


def flight_plan_file(flight: Trajectory) -> bytes:
    """Write a flight as a plan: a waypoint for each instant and before it the speed to it; and the geofence.

    Where the flight is slower than the lowest speed it waits at the waypoint. Zones are as in
    :func:`plan_file`: one above or below any of the poses is left out.

    Raises:
        UsageError: the scenario has no origin.
    """
    items = [_at_pose(_WAYPOINT, flight.scenario, flight.poses[0], 0.0)]
    speeds_m_s = np.maximum(flight.speeds_m_s, _AT_LEAST_M_S)
    waits_s = np.diff(flight.times_s) * (1.0 - flight.speeds_m_s / speeds_m_s)
    for pose, speed_m_s, wait_s in zip(flight.poses[1:], speeds_m_s.tolist(), waits_s.tolist(), strict=True):
        # param 1: over ground; param 3: the throttle as it is
        items.append(_item(_CHANGE_SPEED, [1, speed_m_s, -1, 0, 0, 0, 0]))
        items.append(_at_pose(_WAYPOINT, flight.scenario, pose, wait_s))
    return _content(flight.scenario, flight.poses, items)


def _item(command: int, params: Sequence[float], frame: int = _OF_MISSION) -> PlainTable:
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": frame,
        "params": list(params),
        "autoContinue": True,
    }


def _at_pose(command: int, scenario: Scenario, pose: Pose, wait_s: float) -> PlainTable:
    """Write a command at the place of a pose, with its heading, and how long to stay there."""
    origin = require_origin(scenario)
    place = origin.place(pose.position_m)
    altitude_m = map_altitude_m(origin, place)
    frame, mode = _OVER_SEA if "alt_msl_m" in place else _OVER_HOME
    where = [place["lat_deg"], place["lon_deg"], altitude_m]
    item = _item(command, [wait_s, 0, 0, _heading_deg(scenario, pose), *where], frame)
    return item | {"Altitude": altitude_m, "AltitudeMode": mode, "AMSLAltAboveTerrain": None}


def _content(scenario: Scenario, poses: Sequence[Pose], items: Sequence[PlainTable]) -> bytes:
    origin = require_origin(scenario)
    content = {
        "fileType": "Plan",
        "groundStation": "QGroundControl",
        "mission": {
            "items": [item | {"doJumpId": number} for number, item in enumerate(items, start=1)],
            # its altitude is over the sea, as a plan has it, or else over the ellipsoid
            "plannedHomePosition": [
                *origin.geodetic.tolist()[:2],
                float(origin.geodetic[2]) if origin.alt_msl_m is None else origin.alt_msl_m,
            ],
            "firmwareType": _PX4,
            "vehicleType": _MULTIROTOR,
            "cruiseSpeed": 5,
            "hoverSpeed": 5,
            "version": 2,
        },
        "geoFence": _fence(origin, scenario.airspace, poses),
        "rallyPoints": {"points": [], "version": 2},
        "version": 1,
    }
    return f"{json_text(content)}\n".encode()


def loss_words(result: Result) -> str:
    """Say what a level hover there leaves, since a plan drops the attitude; and what else to look out for.

    Raises:
        UsageError: the scenario has no origin.
    """
    scenario, pose, quantity = result.scenario, result.pose, result.objective.quantity
    values = [
        quantity.in_unit(objective_of_links(scenario, evaluate(scenario, each)))
        for each in (Pose(pose.position_m, 0.0, 0.0, pose.yaw_rad, pose.mount_rad), pose)
    ]
    left, whole = (with_unit(value, quantity) for value in values)
    sentences = [
        f"a plan holds no attitude: at a level hover there, at yaw {_heading_deg(scenario, pose):.1f} deg "
        f"clockwise from north, the {quantity.smallest} is {left}; with the pose's attitude it is {whole}"
    ]
    if require_origin(scenario).alt_msl_m is None:
        sentences.append(
            "the altitude counts from home: take off at the origin's altitude; home's is over the "
            "ellipsoid, since the origin does not state it over the sea"
        )
    if zones := [zone.name for zone in scenario.airspace.no_fly if _is_over_or_under(zone, pose)]:
        sentences.append(f"left out, being above or below the pose: {', '.join(zones)}")
    return "; ".join(sentences)


def _heading_deg(scenario: Scenario, pose: Pose) -> float:
    """Convert the yaw to degrees clockwise from north, in [0, 360)."""
    return math.degrees(pose_frames(scenario, pose).ned.yaw_rad) % 360.0


def _fence(origin: Origin, airspace: Airspace, poses: Sequence[Pose]) -> PlainTable:
    """List the geofence to stay in, and the zones to stay out of, as polygons and circles."""
    shapes: list[PlainTable] = [
        _shape(origin, zone)
        for zone in airspace.no_fly
        if not any(_is_over_or_under(zone, pose) for pose in poses)
    ]
    if airspace.geofence_m is not None:
        shapes.insert(
            0, {"polygon": _corners(origin, airspace.geofence_outline_m), "inclusion": True, "version": 1}
        )
    return {
        **{f"{kind}s": [shape for shape in shapes if kind in shape] for kind in ("polygon", "circle")},
        "version": 2,
    }


def _shape(origin: Origin, zone: NoFlyZone) -> PlainTable:
    """Write a zone as a circle or polygon to stay out of."""
    rules = {"inclusion": False, "version": 1}
    if zone.centre_m is None:
        return {"polygon": _corners(origin, zone.outline_m)} | rules
    return {"circle": {"center": _corners(origin, zone.centre_m), "radius": zone.radius_m}} | rules


def _corners(origin: Origin, east_north_m: ArrayLike) -> list[Any]:
    """Convert places at the origin's altitude, (..., 2), to latitudes and longitudes [degrees]."""
    level_m = np.insert(np.asarray(east_north_m, dtype=float), 2, 0.0, axis=-1)
    return list(geodetic_from_enu(level_m, origin.geodetic)[..., :2].tolist())


def _is_over_or_under(zone: NoFlyZone, pose: Pose) -> bool:
    """Check if a pose would be inside a zone that had all altitudes."""
    return float(zone.model_copy(update={"altitude_m": None}).depth_m(pose.position_m)) > BORDER_M
