"""Where the camera stands: as near as it can be with the scene on its canvas, and clear of the card."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from nullpose.physics import Pose
from nullpose.scenario import Scenario
from nullpose.studio.ground import grid_m, scene_size_m

if TYPE_CHECKING:
    from viser import CameraHandle, InitialCameraConfig

FloatArray = NDArray[np.float64]

CARD_PX = (352.0, 336.0)
"""Width and height of the canvas's upper left corner that the card covers for one case, pixels."""

_CANVAS_PX = (1000.0, 800.0)  # where none is known
_AHEAD = -np.array([0.82, -0.52, 0.64]) / np.linalg.norm([0.82, -0.52, 0.64])  # the camera's view
_FOV_RAD = math.radians(50.0)  # upright; a wider one bends the scene at its edges
_MARGIN = 0.88  # of half the canvas, which leaves space for labels
_ROUNDS = 6  # of centring
_TURNS = 24  # directions from which a turning scene is seen whole
_FAR = 100.0  # sizes of the scene that the camera sees, so that it can be moved away
_TALL = 0.08  # of a point with its label, sizes of the scene
_DRONE = [(0.0, 0.0, 0.2), *(tuple(sign * axis) for axis in 0.13 * np.eye(3) for sign in (-1.0, 1.0))]
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
) -> None:
    """Point a camera at the whole of a scene: points, drone, and the ground between them.

    The card covers nothing of it: where it would, the scene stands right of it or below it, whichever is
    nearer.

    Args:
        camera: viser's.
        scenario: the scene.
        pose: of the drone, if there is one.
        turns: whether all is to be seen too while the camera goes around the scene's centre.
    """
    matter, size_m = matter_m(scenario, pose), scene_size_m(scenario)
    if turns:
        centre_m = centre_of_m(scenario)
        around = Rotation.from_rotvec(np.outer(np.linspace(0.0, math.tau, _TURNS), [0.0, 0.0, 1.0]))
        matter = np.vstack([turn.apply(matter - centre_m) + centre_m for turn in around])
    camera.fov = _FOV_RAD
    canvas, (right_of, below) = canvas_px(camera), CARD_PX
    whole, *others = (
        _fit(canvas, camera.fov, matter, corner) for corner in ((0.0, 0.0), (right_of, 0.0), (0.0, below))
    )
    is_covered = canvas[0] < 2.0 * right_of or np.any(np.all(whole.seen_px < CARD_PX, axis=1))
    fit = min(others, key=lambda other: other.distance_m) if is_covered else whole
    camera.position = fit.position_m
    # on the ground, about which a hand turns it
    camera.look_at = fit.position_m - _AHEAD * fit.position_m[2] / _AHEAD[2]
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    camera.near = 0.02 * size_m
    camera.far = _FAR * size_m


class _Fit(NamedTuple):
    """A camera's position, its distance, and where it sees points: (n, 2) pixels to the right and down."""

    position_m: FloatArray
    distance_m: float
    seen_px: FloatArray


def _fit(canvas: FloatArray, fov_rad: float, points_m: FloatArray, corner_px: tuple[float, float]) -> _Fit:
    """Find the nearest position with all points right of and below a corner."""
    right = np.cross(_AHEAD, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    sides = np.stack([right, np.cross(right, _AHEAD)])
    slope = 2.0 * math.tan(0.5 * fov_rad) / canvas[1]  # of a pixel, at a distance of one
    half = 0.5 * _MARGIN * slope * (canvas - corner_px)
    centre = 0.5 * slope * np.array(corner_px) * [1.0, -1.0]
    middle = 0.5 * (points_m.min(axis=0) + points_m.max(axis=0))
    for _ in range(_ROUNDS):
        aside, depth = (points_m - middle) @ sides.T, (points_m - middle) @ _AHEAD[:, None]
        distance_m = float(np.max(np.abs(aside - depth * centre) / half - depth))
        seen = (aside + distance_m * centre) / (depth + distance_m)
        off = 0.5 * (seen.min(axis=0) + seen.max(axis=0)) - centre
        middle = middle + distance_m * off @ sides
    position = middle - distance_m * (_AHEAD + centre @ sides)
    return _Fit(position, distance_m, 0.5 * canvas + seen * [1.0, -1.0] / slope)


def centre_of_m(scenario: Scenario) -> FloatArray:
    """Find the centre of a scene on the ground, about which it is turned, (3,) metres.

    Args:
        scenario: the scene.
    """
    return np.append(np.mean(grid_m(scenario)[:2], axis=0), 0.0)


def matter_m(scenario: Scenario, pose: Pose | None) -> FloatArray:
    """Return the ends of points with labels, of the drone and of the ground's grid, (n, 3) metres.

    Args:
        scenario: the scene.
        pose: of the drone, if there is one.
    """
    size_m, (low, high, _) = scene_size_m(scenario), grid_m(scenario)
    points = [point.position_m for point in (*scenario.nodes, *scenario.jammers, *scenario.eavesdroppers)]
    ground = [[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])]
    drone = np.empty((0, 3)) if pose is None else pose.position_m + size_m * np.array(_DRONE)
    return np.vstack([points, np.add(points, [0.0, 0.0, _TALL * size_m]), ground, drone])
