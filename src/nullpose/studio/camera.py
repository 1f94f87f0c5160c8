"""Where the camera stands, and how far it sees."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import Pose
from nullpose.scenario import Scenario
from nullpose.studio.eye import Eye
from nullpose.studio.scene import axis_texts, grid_m, scene_size_m

_FAR = 100.0  # sizes of the scene that the camera sees, which leaves room to move away from it
_FROM = [(0.82, -0.52, 0.64), (-0.52, -0.82, 0.64), (0.52, 0.82, 0.64), (-0.82, 0.52, 0.64)]
"""Ways to the camera; the first is taken that has the fewest points behind the drone."""

_DRONE = [(0.0, 0.0, 0.2), *(tuple(sign * axis) for axis in 0.13 * np.eye(3) for sign in (-1.0, 1.0))]
"""Its label and its pattern, from where it is, sizes of the scene."""

CARD_PX = (352.0, 272.0)
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
    points = np.array(
        [one.position_m for one in (*scenario.nodes, *scenario.jammers, *scenario.eavesdroppers)]
    )
    drone = np.empty((0, 3)) if pose is None else pose.position_m + size_m * np.array(_DRONE)
    matter = np.vstack([_floor_m(scenario), points, np.add(points, [0.0, 0.0, _TALL * size_m]), drone])
    eyes = [eye._replace(position_m=way, look_at_m=np.zeros(3)).fitted(matter) for way in _FROM]
    eye = min(eyes, key=lambda one: _behind(one, points, drone))  # of the best ones the first
    under = eye.pixels(np.vstack([points, drone]))[:, :2] < CARD_PX
    if np.any(np.all(under, axis=1)) or eye.width_px < 2.0 * CARD_PX[0]:  # such as on a phone
        eye = eye.beside(matter, CARD_PX)
    way_m = np.subtract(eye.look_at_m, eye.position_m)
    # turned by hand, it goes around a point that is on the ground
    eye = eye._replace(look_at_m=eye.position_m - way_m * np.asarray(eye.position_m)[2] / way_m[2])
    camera.position, camera.look_at = eye.position_m, eye.look_at_m
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    camera.near = 0.02 * size_m
    camera.far = _FAR * size_m
    return eye


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
