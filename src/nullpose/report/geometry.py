"""Angles and distances of a pose, as a reader asks for them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from nullpose.channel.buildings import shadows_of
from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.scenario import GroundPoint, NoFlyZone, Scenario

_SIDES = 72  # of the polygon that stands for a cylinder; 0.1 % of the radius larger at most


def axis_angle_rad(pose: Pose, point_m: ArrayLike, is_even: bool = True) -> float:
    """Measure the angle between the antenna's axis and the direction to a point.

    It is ``atan2(|u x r|, u . r)``, which keeps its digits at both ends: from 0 to pi, or, for an antenna
    whose opposite directions have the same gain, to pi/2, the axis having no sign.
    """
    to_point = np.asarray(point_m, dtype=float) - pose.position_m
    across, along = np.linalg.norm(np.cross(pose.antenna_axis, to_point)), pose.antenna_axis @ to_point
    return math.atan2(across, abs(along) if is_even else along)


def distance_m(pose: Pose, point_m: ArrayLike) -> float:
    """Measure the distance of the drone from a point, shape ``(3,)``, metres."""
    return float(np.linalg.norm(np.asarray(point_m, dtype=float) - pose.position_m))


def tilt_rad(pose: Pose, is_even: bool = True) -> float:
    """Measure the angle between the antenna's axis and the vertical, from 0 to pi, or pi/2 without a sign."""
    east, north, up = pose.antenna_axis
    return math.atan2(math.hypot(east, north), abs(up) if is_even else up)


def azimuth_rad(pose: Pose, is_even: bool = True) -> float:
    """Measure the direction in which the axis leans, from x (east) towards y (north).

    That is its upper end where it has no sign. In (-pi, pi]; 0 for a vertical axis, which leans nowhere.
    """
    east, north, up = (float(component) for component in pose.antenna_axis)
    sign = -1.0 if is_even and up < 0.0 else 1.0
    return math.atan2(sign * north, sign * east) if math.hypot(east, north) > 0.0 else 0.0


def outline_m(zone: NoFlyZone) -> FloatArray:
    """List a zone's corners seen from above, (n, 2), counter-clockwise, metres; of a cylinder, around it."""
    if zone.centre_m is None or zone.radius_m is None:
        return zone.outline_m
    around = math.tau * np.arange(_SIDES) / _SIDES
    reach_m = zone.radius_m / math.cos(math.pi / _SIDES)
    return np.asarray(zone.centre_m + reach_m * np.stack([np.cos(around), np.sin(around)], axis=-1))


def shadow_outlines_m(
    scenario: Scenario, point: GroundPoint, altitude_m: float, frame_m: FloatArray
) -> list[FloatArray]:
    """List where buildings block the line of sight to a point, at one altitude: convex polygons, (n, 2).

    Args:
        scenario: whose buildings they are.
        point: on the ground.
        altitude_m: where the drone is, metres.
        frame_m: low and high corner of what is cut out, (2, 2), metres.
    """
    if scenario.prisms is None:
        return []
    places_m, (low, high) = np.array([point.position_m]), frame_m
    shadows = shadows_of(scenario.prisms, places_m, np.array([scenario.is_unwanted(point)]))
    frame = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    outlines = [_cut(frame, sides, altitude_m) for sides in np.split(shadows.sides, shadows.start[1:-1])]
    return [outline for outline in outlines if len(outline)]


def _cut(corners_m: FloatArray, sides: FloatArray, altitude_m: float) -> FloatArray:
    """Cut a level convex polygon by half-spaces, one after the other."""
    for *normal, up, offset, _ in sides:
        if not len(corners_m):
            break
        away, onward = corners_m @ normal + up * altitude_m - offset, np.roll(corners_m, -1, axis=0)
        is_inside, step = away <= 0.0, away - np.roll(away, -1)
        is_crossed = is_inside != np.roll(is_inside, -1)
        share = np.divide(away, step, out=np.zeros_like(away), where=is_crossed)
        ends = np.stack([corners_m, corners_m + share[:, None] * (onward - corners_m)], axis=1)
        corners_m = ends[np.stack([is_inside, is_crossed], axis=1)]
    return corners_m
