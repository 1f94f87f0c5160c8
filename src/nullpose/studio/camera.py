"""Where the camera stands: as near as it can be with the scene on its canvas, and clear of the card."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linprog
from scipy.spatial.transform import Rotation

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario
from nullpose.studio.ground import airspace_outline_m, grid_m, scene_size_m, ticks_m

if TYPE_CHECKING:
    from viser import CameraHandle, InitialCameraConfig


NARROW_PX = 600.0
"""Width of the canvas below which it is a phone's."""
CARD_PX = (352.0, 392.0)
PHONE_CARD_PX = (352.0, 252.0)
"""Width and height of the canvas's upper left corner that the card covers for one case, pixels."""

_SECOND_PX, _HINTS = 180.0, 0.27  # height of a second case; of a phone's, that of title and hints below
_CANVAS_PX = (1000.0, 800.0)  # where none is known
_AHEAD = -np.array([0.82, -0.52, 0.64]) / np.linalg.norm([0.82, -0.52, 0.64])  # the camera's view
_FOV_RAD = math.radians(50.0)  # upright; a wider one bends the scene at its edges
_EDGE_PX, _LABEL_PX = np.array([26.0, 12.0]), np.array([72.0, 16.0])  # around a number, and a label
_CENTRED = 0.01  # a metre more on both sides is worth so many metres nearer
_TURNS = 24  # directions from which a turning scene is seen whole
_FAR = 100.0  # sizes of the scene that the camera sees, so that it can be moved away
_TALL = 0.08  # of a point with its label, sizes of the scene
_DRONE = [(0.0, 0.0, 0.2), *(tuple(sign * axis) for axis in 0.15 * np.eye(3) for sign in (-1.0, 1.0))]
"""Ends of the drone's label and pattern, from its position, sizes of the scene."""


def canvas_px(camera: CameraHandle | InitialCameraConfig | SimpleNamespace) -> FloatArray:
    """Return the width and the height of a camera's canvas, (2,) pixels.

    Args:
        camera: viser's.
    """
    size = getattr(camera, "image_width", 0), getattr(camera, "image_height", 0)
    return np.array(size if all(size) else _CANVAS_PX, dtype=float)


def ray(camera: CameraHandle, across: float, down: float) -> FloatArray:
    """Find the direction from a camera through a place on its canvas, (3,).

    Args:
        camera: viser's.
        across: from the left, widths of the canvas.
        down: from the top, heights of the canvas.
    """
    (width, height), slope = canvas_px(camera), 2.0 * math.tan(0.5 * camera.fov)
    seen = slope * np.array([(across - 0.5) * width / height, down - 0.5, 1.0 / slope])
    return np.asarray(Rotation.from_quat(np.roll(camera.wxyz, -1)).apply(seen))  # real part first


def aim(
    camera: CameraHandle | InitialCameraConfig | SimpleNamespace,
    scenario: Scenario,
    pose: Pose | None = None,
    *,
    turns: bool = False,
    cases: int = 1,
) -> None:
    """Point a camera at the whole of a scene: points, drone, and the ground between them.

    The card covers nothing of it: where it would, the scene stands right of it or below it, whichever is
    nearer. Ground, fence and the names of the axes are on the canvas too; the card may cover them.

    Args:
        camera: viser's.
        scenario: the scene.
        pose: of the drone, if there is one.
        turns: whether all is to be seen too while the camera goes around the scene's centre.
        cases: how many the card has.
    """
    canvas = canvas_px(camera)
    is_narrow = canvas[0] < NARROW_PX
    (wide, high), free = PHONE_CARD_PX if is_narrow else CARD_PX, canvas * [1.0, 1.0 - _HINTS * is_narrow]
    matter, frame, size_m = matter_m(scenario, pose), frame_m(scenario), scene_size_m(scenario)
    if turns:
        centre_m = centre_of_m(scenario)
        around = Rotation.from_rotvec(np.outer(np.linspace(0.0, math.tau, _TURNS), [0.0, 0.0, 1.0]))
        matter, frame = (
            np.vstack([turn.apply(points_m - centre_m) + centre_m for turn in around])
            for points_m in (matter, frame)
        )
    camera.fov = _FOV_RAD
    corners_px = (wide, 0.0), (0.0, high + _SECOND_PX * (cases - 1))
    camera.position = max(
        [_position_m(canvas, free, matter, frame, np.array(corner_px)) for corner_px in corners_px],
        key=_AHEAD.__matmul__,
    )
    # on the ground, about which a hand turns it
    camera.look_at = camera.position - _AHEAD * camera.position[2] / _AHEAD[2]
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    camera.near = 0.02 * size_m
    camera.far = _FAR * size_m


def _position_m(
    canvas: FloatArray, free: FloatArray, matter_m: FloatArray, frame_m: FloatArray, corner_px: FloatArray
) -> FloatArray:
    """Find the nearest position with all matter right of and below a corner, and all on the free canvas.

    In its middle, as far as that brings it no farther away: a linear program, since all is linear in it.
    """
    right = np.cross(_AHEAD, [0.0, 0.0, 1.0]) / np.linalg.norm(_AHEAD[:2])
    sides, slope = (right, np.cross(_AHEAD, right)), 2.0 * math.tan(0.5 * _FOV_RAD) / canvas[1]
    corner = np.minimum(corner_px, free - 3.0 * _LABEL_PX)  # there is always some space
    planes, offsets = [], []
    for points_m, begin_px, edge_px in ((matter_m, corner, _LABEL_PX), (frame_m, 0.0 * canvas, _EDGE_PX)):
        for sign, end_px in ((-1.0, begin_px + edge_px), (1.0, free - edge_px)):
            for side, tangent, margin in zip(sides, slope * (end_px - 0.5 * canvas), np.eye(2), strict=True):
                normal = sign * (side - tangent * _AHEAD)
                planes.append([*-normal, *margin])
                offsets.append(-np.max(points_m @ normal))
    found = linprog(
        [*-_AHEAD, -_CENTRED, -_CENTRED], planes, offsets, bounds=3 * [(None, None)] + 2 * [(0.0, None)]
    )
    return np.asarray(found.x[:3])


def centre_of_m(scenario: Scenario) -> FloatArray:
    """Find the centre of a scene on the ground, about which it is turned, (3,) metres.

    Args:
        scenario: the scene.
    """
    return np.append(np.mean(grid_m(scenario)[:2], axis=0), 0.0)


def matter_m(scenario: Scenario, pose: Pose | None) -> FloatArray:
    """Return the ends of points with labels and of the drone, (n, 3) metres.

    Args:
        scenario: the scene.
        pose: of the drone, if there is one.
    """
    size_m = scene_size_m(scenario)
    points = [point.position_m for point in scenario.points]
    drone = np.empty((0, 3)) if pose is None else pose.position_m + size_m * np.array(_DRONE)
    return np.vstack([points, np.add(points, [0.0, 0.0, _TALL * size_m]), drone])


def frame_m(scenario: Scenario) -> FloatArray:
    """Return the corners of the grid and of the fence, as far as it is near, and the numbers, (n, 3) metres.

    Args:
        scenario: the scene.
    """
    (low, high, _), size_m, airspace = grid_m(scenario), scene_size_m(scenario), scenario.airspace
    corners = np.clip(airspace_outline_m(scenario), low - 0.5 * size_m, high + 0.5 * size_m)
    ends_m = airspace.lower_m[2], min(airspace.upper_m[2], size_m)
    ground = [[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])]
    return np.vstack(
        [
            ground,
            *(np.insert(corners, 2, end_m, axis=1) for end_m in ends_m),
            [[x, y, 0.0] for _, x, y in ticks_m(scenario)],
        ]
    )
