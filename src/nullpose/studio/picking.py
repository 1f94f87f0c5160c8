"""Clicks, drags and the pointer in the scene: what they select, move, place or read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import interpn

from nullpose.physics import antenna_gain, to_db
from nullpose.report.geometry import axis_angle_rad, distance_m
from nullpose.studio.answer import Answer, signed
from nullpose.studio.edits import ADDED, with_added, with_fence
from nullpose.studio.state import Key, State
from nullpose.study import Field

FENCE = "fence"
"""The tool that draws a fence, whose corners are clicked one after the other."""
RULER = "ruler"
"""The tool that measures from one click to the next."""

_NEAR_RAD = 0.025  # a point is hit within so much: about a finger's breadth on a screen
_TALL = 0.06  # of the scene's size: a point's mark with its label
_MOST_SIZES = 20.0  # of the scene: farther away there is no ground to build on
_CLOSE = 0.03  # of the scene's size: so near its first corner a click closes a fence


def clicked(state: State, size_m: float, eye_m: ArrayLike, direction: ArrayLike) -> State:
    """Return the state after a click in the scene.

    Args:
        state: before it; its tool decides what the click does.
        size_m: of the scene as it is drawn, metres.
        eye_m: (3,) where the camera is, metres.
        direction: (3,) of the click.

    Raises:
        ScenarioError: the scenario would be faulty.
    """
    if not state.tool:
        return replace(state, selected=picked(state, size_m, eye_m, direction))
    if (place_m := ground_place_m(size_m, eye_m, direction)) is None:
        return state
    if state.tool not in (FENCE, RULER):
        kind = ADDED[state.tool]
        added = with_added(state, state.tool, place_m, size_m)
        return replace(added, tool="", selected=(kind, len(added.members(kind)) - 1))
    corners = state.corners_m
    can_close = state.tool == FENCE and len(corners) > 2
    if can_close and np.linalg.norm(place_m - corners[0]) < _CLOSE * size_m:
        return replace(with_fence(state, corners), tool="", corners_m=())
    return replace(state, corners_m=(*corners, (float(place_m[0]), float(place_m[1]))))


def picked(state: State, size_m: float, eye_m: ArrayLike, direction: ArrayLike) -> Key | None:
    """Return the point that a click is at, or else the zone, or None.

    Args:
        state: with the scene.
        size_m: of the scene, from which the sizes of what is drawn follow.
        eye_m: (3,) where the camera is, metres.
        direction: (3,) of the click.
    """
    points = dict(state.points())
    marks = np.array([point.position_m for point in points.values()])[:, None, :]
    away = marks + np.linspace(0.0, _TALL * size_m, 5)[:, None] * [0.0, 0.0, 1.0] - np.asarray(eye_m)
    ahead = np.asarray(direction) / np.linalg.norm(direction)
    along = away @ ahead
    aside = np.linalg.norm(away - along[..., None] * ahead, axis=-1)
    off_rad = np.where(along > 0.0, np.arctan2(aside, along), np.pi).min(axis=1)
    if off_rad.min() <= _NEAR_RAD:
        return list(points)[int(np.argmin(off_rad))]
    if (ground_m := ground_place_m(size_m, eye_m, direction)) is None:
        return None
    zones: Iterator[Key] = (
        ("no_fly", i)
        for i, zone in enumerate(state.scenario.airspace.no_fly)
        if zone.depth_m([*ground_m, np.clip(0.0, zone.floor_m, zone.ceiling_m)]) >= 0.0
    )
    return next(zones, None)


def ground_place_m(
    size_m: float, eye_m: ArrayLike, direction: ArrayLike, altitude_m: float = 0.0
) -> NDArray[np.float64] | None:
    """Intersect a click with the ground: east and north, (2,); None if it goes past it.

    Args:
        size_m: of the scene.
        eye_m: (3,) where the camera is, metres.
        direction: (3,) of the click.
        altitude_m: of another level plane in place of the ground, metres.
    """
    eye, ahead = np.asarray(eye_m, dtype=float), np.asarray(direction, dtype=float)
    below_m = eye[2] - altitude_m
    if below_m * ahead[2] >= 0.0:
        return None
    reach = -below_m / ahead[2]
    if reach * float(np.linalg.norm(ahead)) > _MOST_SIZES * size_m:
        return None
    return np.asarray((eye + reach * ahead)[:2])


def dragged_to_m(
    size_m: float, grip_m: ArrayLike, eye_m: ArrayLike, direction: ArrayLike, *, is_lifted: bool
) -> NDArray[np.float64] | None:
    """Find where a hand has drawn what it holds, (3,) metres; None if that is past the horizon.

    Args:
        size_m: of the scene.
        grip_m: (3,) where it is held now, metres.
        eye_m: (3,) where the camera is, metres.
        direction: (3,) from there to the hand.
        is_lifted: whether it goes up and down, and not about at its altitude.
    """
    grip, eye, ahead = (np.asarray(each, dtype=float) for each in (grip_m, eye_m, direction))
    if is_lifted:
        reach = (grip - eye)[:2] @ ahead[:2] / max(ahead[:2] @ ahead[:2], 1e-12)
        return np.array([*grip[:2], eye[2] + reach * ahead[2]])
    place_m = ground_place_m(size_m, eye, ahead, grip[2])
    return None if place_m is None else np.append(place_m, grip[2])


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
    values = [] if field is None else _value_lines(field, place_m)
    if not (values or state.tool):
        return None, []
    place = "{} m east, {} m north".format(*(signed(number, 1) for number in place_m))
    away_m = [np.linalg.norm(place_m - corner_m) for corner_m in state.corners_m[-1:]]
    return None, [*values, place, *(f"{metres:.1f} m from the last corner" for metres in away_m)]


def _value_lines(field: Field, place_m: NDArray[np.float64]) -> list[str]:
    """Write the value of a map at a place, (2,); no line where it has none."""
    axes = field.north_m, field.east_m
    (value,) = interpn(axes, field.values, place_m[::-1], bounds_error=False, fill_value=math.nan)
    return [f"{signed(float(value))} {field.unit}"] * math.isfinite(value)


def _link_lines(answer: Answer, key: Key, point_m: ArrayLike) -> list[str]:
    pose, antenna = answer.result.pose, answer.result.scenario.antenna_record
    (gain,) = antenna_gain(pose.position_m, pose.orientation(antenna), np.atleast_2d(point_m), antenna)
    off_null = f"{math.degrees(axis_angle_rad(pose, point_m)):.1f}\u00b0 off the null"
    return [
        *([f"SINR {signed(answer.result.links[key[1]].sinr_db)} dB"] if key[0] == "nodes" else []),
        f"{distance_m(pose, point_m):.1f} m from the drone",
        *([off_null] if antenna.is_quadratic else []),
        f"gain {signed(float(to_db(gain)))} dB",
    ]
