"""What the scene says of the place that a hand points at: a point's link, or the map's value."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import interpn

from nullpose.physics import antenna_gain, to_db
from nullpose.report.geometry import axis_angle_rad, distance_m
from nullpose.studio.answer import Answer, signed
from nullpose.studio.picking import ground_place_m, picked
from nullpose.studio.state import Key, State


def reading(
    state: State, size_m: float, eye_m: ArrayLike, direction: ArrayLike
) -> tuple[Key | None, list[str]]:
    """Read the scene where a ray from the camera meets it: the point there, if there is one, and lines.

    Args:
        state: of the page.
        size_m: of the scene as it is drawn, metres.
        eye_m: (3,) where the camera is, metres.
        direction: (3,) of the ray.
    """
    if (key := picked(state, size_m, eye_m, direction)) is not None and key[0] != "no_fly":
        point, answer = dict(state.points())[key], state.current(state.case)
        return key, [point.name, *([] if answer is None else _link_lines(answer, key, point.position_m))]
    field = None if state.scale is None else state.scale.field
    place_m = ground_place_m(size_m, eye_m, direction, 0.0 if field is None else field.altitude_m)
    if place_m is None:
        return None, []
    lines = ["{} m east, {} m north".format(*(signed(number, 1) for number in place_m))]
    if state.corners_m:
        lines.append(f"{np.linalg.norm(place_m - state.corners_m[-1]):.1f} m from the last corner")
    value = math.nan
    if field is not None:
        (value,) = interpn(
            (field.north_m, field.east_m),
            field.values,
            place_m[::-1],
            bounds_error=False,
            fill_value=math.nan,
        )
        lines = [f"{signed(float(value))} {field.unit}"] * math.isfinite(value) + lines
    return None, lines if state.tool or math.isfinite(value) else []


def _link_lines(answer: Answer, key: Key, point_m: ArrayLike) -> list[str]:
    pose, antenna = answer.result.pose, answer.result.scenario.antenna_record
    lines = [f"SINR {signed(answer.result.links[key[1]].sinr_db)} dB"] if key[0] == "nodes" else []
    lines.append(f"{distance_m(pose, point_m):.1f} m from the drone")
    if antenna.is_quadratic:
        lines.append(f"{math.degrees(axis_angle_rad(pose, point_m)):.1f}\u00b0 off the null")
    (gain,) = antenna_gain(pose.position_m, pose.orientation(antenna), np.atleast_2d(point_m), antenna)
    return [*lines, f"gain {signed(float(to_db(gain)))} dB"]
