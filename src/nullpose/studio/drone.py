"""The drone in the scene: body, antenna, pattern, null, and the links to its nodes."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import AnyAntenna
from nullpose.physics import Pose, rotation_world_from_body
from nullpose.report.figures.trajectory import marked_instants
from nullpose.report.geometry import axis_angle_rad
from nullpose.solver import Result
from nullpose.studio.answer import signed
from nullpose.studio.drawing import (
    BODY,
    ROD,
    ROTORS,
    Mesh,
    Shape,
    Shapes,
    coloured_mesh,
    frame,
    label,
    lines,
    mesh,
    pattern_mesh,
    relative_gain,
    revolved_mesh,
)
from nullpose.studio.ground import CROWD
from nullpose.studio.look import Look, linear_colours, scale_colours
from nullpose.studio.readout import drone_text
from nullpose.studio.state import State

_OPEN_RAD = math.radians(110.0)  # of the pattern, towards the camera
_TURN_RAD = math.radians(30.0)  # steps in which the opening of a pattern without symmetry follows the camera
_RINGS, _MOST_RINGS = 24, 60  # of the pattern from pole to pole: without a graphics card triangles take long
_FAINT = 0.01  # gain over the largest: along an axis with more there is no null to point
_FULL = 0.13  # of the pattern's largest gain, sizes of the scene
_SAME = 0.02  # sizes of the scene, and radians: less apart two cones are one
_ABOVE, _BELOW = 0.16, 1.5  # of the null's line, at most, sizes of the scene
_LABEL_AT = ((0.0, 0.0, 0.17), (0.0, 0.14, -0.045), (0.0, 0.14, -0.13))  # above, right, lower: likewise
_ANCHORS = ("bottom-center", "center-left")
_WIDTHS = np.array([0.003, 0.005, 0.0075, 0.01])  # of links by the quarter of the colours' range, likewise
_OUTLINE = 0.0022  # beyond both sides of a link, likewise
_FLOWN, _AXIS = 0.005, 0.045  # width of a flight's line, and half an antenna's axis there, likewise
_BEAM = revolved_mesh([0.0, math.sqrt(_FAINT / (1.0 - _FAINT))], [0.0, -1.0], 40)
"""The cone about the null within which a dipole has that little gain, one long; it faces inwards."""
_TUBE = revolved_mesh([1.0, 1.0], [0.0, 1.0], 8)


def drone_shapes(state: State, slot: int, size_m: float, eye_m: ArrayLike, look: Look) -> Shapes:
    """Draw one case's drone at the pose of its answer; nothing if there is none for the scene's nodes.

    Args:
        state: of the page.
        slot: 0 for the chosen case, 1 for the compared one.
        size_m: of the scene, from which the sizes of what is drawn follow.
        eye_m: (3,) where the camera stands, towards which the pattern is open, metres.
        look: the page's colours.
    """
    first, answer = state.answer(state.case), state.answer(state.cases[slot])
    if answer is None or len(answer.result.links) != len(state.scenario.terminals):
        return {}
    result, pose = answer.result, answer.result.pose
    antenna = result.scenario.antenna_record
    place_m, body = pose.position_m, rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    mount = rotation_world_from_body(0.0, pose.mount_rad, 0.0)
    x, y, _ = (body @ mount).T @ np.subtract(eye_m, place_m)
    azimuth_rad = math.atan2(y, x)
    ink = look.colours[("drone", "compared")[slot]]
    shapes = {
        "body": frame(place_m, body),
        "body/hull": mesh(BODY, ink, flat_shading=True, scale=0.055 * size_m, opacity=(None, 0.5)[slot]),
        "body/rotors": mesh(ROTORS, ink, opacity=0.45, scale=0.055 * size_m),
        "body/antenna": frame(rotation=mount),
        "body/antenna/rod": mesh(ROD, look.colours["null"], scale=0.2 * size_m),
        "drop": lines([place_m * [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0]]], look.colours["wire"], 1.2),
        "label": label(
            drone_text(state, slot), place_m + size_m * np.array(_LABEL_AT[slot]), 1.2, _ANCHORS[slot]
        ),
    }
    if state.has_pattern and slot == 0:
        turn_rad = 0.0 if antenna.is_axisymmetric else _TURN_RAD * round(azimuth_rad / _TURN_RAD)
        towards = rotation_world_from_body(0.0, 0.0, azimuth_rad if antenna.is_axisymmetric else 0.0)
        surface = _pattern(antenna, turn_rad)
        sized = surface._replace(values={**surface.values, "scale": _FULL * size_m})
        shapes |= {"body/antenna/pattern": frame(rotation=towards), "body/antenna/pattern/surface": sized}
    if _has_null(antenna) and not (slot and first and _coincides(pose, first.result.pose, size_m)):
        shapes |= _null(result, body @ mount, size_m, look, is_first=slot == 0)
    shapes |= _links(result, state.link_range_db, size_m, look)
    return {f"/drone-{'ab'[slot]}/{name}": shape for name, shape in shapes.items()}


def flight_shapes(state: State, size_m: float, look: Look) -> Shapes:
    """Draw a flight: a line, dark to bright in time, the antenna's axis at intervals, a drone at the instant.

    Args:
        state: of the page.
        size_m: of the scene, from which the sizes of what is drawn follow.
        look: the page's colours.
    """
    if state.flight is None or (found := state.flight.found) is None or state.scenario.at_s is None:
        return {}
    now, marked = int(np.abs(found.times_s - state.scenario.at_s).argmin()), marked_instants(found)
    pose, places_m, half_m = found.poses[now], found.positions_m, _AXIS * size_m
    colours = linear_colours(scale_colours(found.times_s, *found.times_s[[0, -1]]))
    steps_m = np.stack([places_m[:-1], places_m[1:]], axis=1)
    ends_m = [places_m[i] + np.outer([-half_m, half_m], found.poses[i].antenna_axis) for i in marked]
    value = f"flight {signed(found.quantity.in_unit(float(found.values[now])))} {found.quantity.unit}"
    outline = _tubes(steps_m, np.full(len(steps_m), (0.5 * _FLOWN + _OUTLINE) * size_m))
    return {
        "/flight/outline": mesh(outline, look.colours["outline"], side="back"),
        "/flight/line": lines(
            steps_m, np.stack([colours[:-1], colours[1:]], axis=1), _FLOWN * size_m, "world"
        ),
        "/flight/axes": lines(ends_m, look.colours["null"], 0.5 * _FLOWN * size_m, "world"),
        "/flight/drone": frame(
            pose.position_m, rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
        ),
        "/flight/drone/hull": mesh(
            BODY, look.colours["compared"], flat_shading=True, scale=0.055 * size_m, opacity=0.5
        ),
        "/flight/label": label(value, pose.position_m + size_m * np.array(_LABEL_AT[2]), 1.2, _ANCHORS[1]),
    }


@lru_cache(8)
def _pattern(antenna: AnyAntenna, towards_rad: float) -> Shape:
    """Draw a pattern of size one, open towards the camera."""
    degree = 0 if antenna.is_quadratic else antenna.harmonics.degree
    rings = min(_MOST_RINGS, _RINGS + 3 * degree)  # more where it may have more lobes
    surface, gain = pattern_mesh(antenna, rings, 3 * rings // 2, _OPEN_RAD, towards_rad)
    return coloured_mesh(surface, scale_colours(gain, 0.0, 1.0))


def _null(
    result: Result, attitude: NDArray[np.float64], size_m: float, look: Look, *, is_first: bool
) -> Shapes:
    """Draw the null to the ground, its cone of little gain, and of the first its angle to a jammer."""
    place_m, sign = result.pose.position_m, 1.0 if attitude[2, 2] >= 0.0 else -1.0
    upwards = attitude * [1.0, sign, sign]  # its third axis is the upper half of the antenna's
    below_m = min(_BELOW * size_m, place_m[2] / max(upwards[2, 2], 1e-6))
    ends = place_m + np.outer([_ABOVE * size_m, -below_m], upwards[:, 2])
    shapes = {
        "null": lines(ends[None], look.colours["null"], 0.006 * size_m, "world"),
        "null-outline": mesh(
            _tubes(ends[None], np.array([0.0045 * size_m])), look.colours["outline"], side="back"
        ),
        "beam": mesh(
            _BEAM.placed(below_m * upwards, place_m), look.colours["null"], opacity=0.3, side="back"
        ),
    }
    if is_first:
        angle_rad, name = min(  # a null is for interferers alone
            [
                (axis_angle_rad(result.pose, point.position_m), point.name)
                for point in result.scenario.interferers
            ],
            default=(0.0, ""),
        )
        off = f" {math.degrees(angle_rad):z.1f}\u00b0 off {name}" if name else ""
        shapes["angle"] = frame(0.35 * place_m + 0.65 * ends[1])
        if len(result.links) <= CROWD:
            shapes["angle/label"] = label(f"null{off}", (0.0, 0.0, 0.0), 0.9, "center-right")
    return shapes


def _links(result: Result, range_db: tuple[float, float], size_m: float, look: Look) -> Shapes:
    """Draw lines to the nodes, brighter and wider for a higher SINR, with an outline."""
    sinr_db = np.array([link.sinr_db for link in result.links])
    nodes = result.scenario.terminal_positions_m
    ends = np.stack([nodes, np.broadcast_to(result.pose.position_m, nodes.shape)], axis=1)
    colours = np.repeat(linear_colours(scale_colours(sinr_db, *range_db))[:, None], 2, axis=1)
    quarter = np.digitize(sinr_db, np.linspace(*range_db, len(_WIDTHS) + 1)[1:-1])
    # one mesh, and no batch of instances: of those the browser misses a picture when their count changes
    tubes = _tubes(ends, size_m * (0.5 * _WIDTHS[quarter] + _OUTLINE))
    shapes = {
        "links-outline": mesh(tubes, look.colours["outline"], side="back")
    }  # far sides, seen beside the links
    for i in np.unique(quarter):
        chosen = quarter == i
        shapes[f"links-{i}"] = lines(ends[chosen], colours[chosen], _WIDTHS[i] * size_m, "world")
    return shapes


def _tubes(ends_m: NDArray[np.float64], radius_m: NDArray[np.float64]) -> Mesh:
    """Build tubes around lines, (n, 2, 3), of radii, (n,), as one shape."""
    along = ends_m[:, 1] - ends_m[:, 0]
    sideways = np.where(np.abs(along[:, :1]) < np.abs(along[:, 1:2]), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    across = np.cross(along, sideways)
    across *= radius_m[:, None] / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    other = np.cross(along, across) / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    vertices = ends_m[:, :1] + _TUBE.vertices @ np.stack([across, other, along], axis=1)
    starts = len(_TUBE.vertices) * np.arange(len(ends_m))[:, None, None]
    return Mesh(vertices.reshape(-1, 3), (_TUBE.faces + starts).reshape(-1, 3))


def _coincides(pose: Pose, first: Pose, size_m: float) -> bool:
    """Tell whether a pose's cone would be drawn into that of the first drone."""
    return bool(
        np.linalg.norm(pose.position_m - first.position_m) < _SAME * size_m
        and abs(pose.antenna_axis @ first.antenna_axis) > math.cos(_SAME)
    )


def _has_null(antenna: AnyAntenna) -> bool:
    """Tell whether an antenna has next to no gain along its axis, both ways."""
    poles = np.outer([1.0, -1.0], [0.0, 0.0, 1.0])
    return antenna.is_axisymmetric and bool(np.all(relative_gain(antenna, poles) < _FAINT))
