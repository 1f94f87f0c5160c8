"""Where the camera stands, and how far it sees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import Pose, rotation_world_from_body
from nullpose.scenario import Scenario
from nullpose.studio.eye import Eye
from nullpose.studio.scene import axis_texts, grid_m, scene_size_m

_FAR = 100.0  # sizes of the scene that the camera sees, which leaves room to move away from it
_FROM = [(0.82, -0.52, 0.64), (-0.52, -0.82, 0.64), (0.52, 0.82, 0.64), (-0.82, 0.52, 0.64)]
"""Ways to the camera; the first is taken that has the fewest points behind the drone."""

_SOUTH = (0.0, -0.97, 0.64)
"""Way to the camera that goes around."""

_DRONE = [(0.0, 0.0, 0.2), *(tuple(sign * axis) for axis in 0.13 * np.eye(3) for sign in (-1.0, 1.0))]
"""Its label and its pattern, from where it is, sizes of the scene."""

CARD_PX = (352.0, 336.0)
"""What the overlay covers of the canvas's upper left, for one case, pixels."""

_TALL = 0.08  # of a point with its label, sizes of the scene


def aim(camera: Any, scenario: Scenario, pose: Pose | None = None) -> Eye:
    """Return what a camera sees after letting it look at the whole of a scene.

    That is the points, the drone with its pattern and label, and the ground between them.

    Args:
        camera: of a page, or the one that pages begin with.
        scenario: the scene.
        pose: of the drone, if it is known.
    """
    size_m, eye = scene_size_m(scenario), Eye.of(camera)
    points, drone = _points_m(scenario), _drone_m(size_m, pose)
    matter = np.vstack([_floor_m(scenario), points, drone])
    eyes = [eye._replace(position_m=way, look_at_m=np.zeros(3)).fitted(matter) for way in _FROM]
    eye = min(eyes, key=lambda one: _behind(one, points, drone))  # of the best ones the first
    eye = _beside_card(eye, matter, np.vstack([points, drone]))
    way_m = np.subtract(eye.look_at_m, eye.position_m)
    # turned by hand, it goes around a point that is on the ground
    eye = eye._replace(look_at_m=eye.position_m - way_m * np.asarray(eye.position_m)[2] / way_m[2])
    camera.position, camera.look_at = eye.position_m, eye.look_at_m
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    camera.near = 0.02 * size_m
    camera.far = _FAR * size_m
    return eye


def around(camera: Any, scenario: Scenario, pose: Pose | None = None) -> tuple[Eye, NDArray[np.float64]]:
    """Return what a camera sees south of the drone, and the foot, (3,) metres, of the axis to turn it about.

    On the whole way around, all points and the drone with its pattern are in the canvas.

    Args:
        camera: of a page.
        scenario: the scene.
        pose: of the drone, if it is known.
    """
    size_m, eye = scene_size_m(scenario), Eye.of(camera)
    matter = np.vstack([_points_m(scenario), _drone_m(size_m, pose)])
    foot = np.append((matter.mean(axis=0) if pose is None else pose.position_m)[:2], 0.0)
    turns = [rotation_world_from_body(0.0, 0.0, angle) for angle in np.arange(0.0, math.tau, 0.26)]
    ring = np.vstack([(matter - foot) @ turn.T for turn in turns])
    eye = eye._replace(position_m=np.array(_SOUTH), look_at_m=np.zeros(3)).fitted(ring)
    return _beside_card(eye, ring, _drone_m(size_m, pose) - foot), foot


def _beside_card(eye: Eye, matter_m: NDArray[np.float64], clear_m: NDArray[np.float64]) -> Eye:
    """Return a camera with all that matters beside the card if that would cover what is to be clear of it."""
    covered = np.any(np.all(eye.pixels(clear_m)[:, :2] < CARD_PX, axis=1))
    return eye.beside(matter_m, CARD_PX) if covered or eye.width_px < 2.0 * CARD_PX[0] else eye


def _points_m(scenario: Scenario) -> NDArray[np.float64]:
    """Return where points and the upper ends of their labels are, (n, 3) metres."""
    points = [one.position_m for one in (*scenario.nodes, *scenario.jammers, *scenario.eavesdroppers)]
    return np.vstack([points, np.add(points, [0.0, 0.0, _TALL * scene_size_m(scenario)])])


def _drone_m(size_m: float, pose: Pose | None) -> NDArray[np.float64]:
    """Return where the drone's pattern and label end, (n, 3) metres; nothing without a pose."""
    return np.empty((0, 3)) if pose is None else pose.position_m + size_m * np.array(_DRONE)


def _floor_m(scenario: Scenario) -> NDArray[np.float64]:
    """Return points, (n, 3) metres, around the ground's grid and the numbers beside it."""
    (west, south), (east, north), _ = grid_m(scenario)
    texts = [[x, y] for _, x, y in axis_texts(scenario)]
    return np.insert([[west, south], [east, south], [east, north], [west, north], *texts], 2, 0.0, axis=1)


def _behind(eye: Eye, points_m: NDArray[np.float64], drone_m: NDArray[np.float64]) -> int:
    """Return how many points a camera sees behind the drone with its pattern."""
    if not len(drone_m):
        return 0
    points, drone = eye.pixels(points_m), eye.pixels(drone_m)
    low, high = drone.min(axis=0), drone.max(axis=0)
    inside = np.all((low[:2] < points[:, :2]) & (points[:, :2] < high[:2]), axis=1)
    return int(np.sum(inside & (points[:, 2] > low[2])))
