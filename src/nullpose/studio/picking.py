"""Where a click in the scene goes: to a point, to a no-fly zone, or to the ground."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.studio.view import Key, View

_NEAR_RAD = 0.025  # a point is hit within so much: about a finger's breadth on a screen
_TALL = 0.06  # of the scene's size: a point's mark with its label
_MOST_SIZES = 20.0  # of the scene: what is further away is no ground to build on


def picked(view: View, size_m: float, eye_m: ArrayLike, way: ArrayLike) -> Key | None:
    """Return the point that a click is at, or else the zone, or None.

    Args:
        view: the view now.
        size_m: of the scene, from which the sizes of what is drawn follow.
        eye_m: (3,) where the camera is, metres.
        way: (3,) the click's direction.
    """
    points = dict(view.points())
    marks = np.array([one.position_m for one in points.values()])[:, None, :]
    away = marks + np.linspace(0.0, _TALL * size_m, 5)[:, None] * [0.0, 0.0, 1.0] - np.asarray(eye_m)
    ahead = np.asarray(way) / np.linalg.norm(way)
    along = away @ ahead
    aside = np.linalg.norm(away - along[..., None] * ahead, axis=-1)
    off_rad = np.where(along > 0.0, np.arctan2(aside, along), np.pi).min(axis=1)
    if off_rad.min() <= _NEAR_RAD:
        return list(points)[int(np.argmin(off_rad))]
    ground_m = ground_place_m(size_m, eye_m, way)
    if ground_m is None:
        return None
    for i, zone in enumerate(view.members("no_fly")):
        if zone.depth_m([*ground_m, np.clip(0.0, zone.floor_m, zone.ceiling_m)]) >= 0.0:
            return "no_fly", i
    return None


def ground_place_m(size_m: float, eye_m: ArrayLike, way: ArrayLike) -> NDArray[np.float64] | None:
    """Return where a click meets the ground, east and north, (2,); None if it goes past it.

    Args:
        size_m: of the scene.
        eye_m: (3,) where the camera is, metres.
        way: (3,) the click's direction.
    """
    eye, ahead = np.asarray(eye_m, dtype=float), np.asarray(way, dtype=float)
    if eye[2] * ahead[2] >= 0.0:
        return None
    reach = -eye[2] / ahead[2]
    if reach * float(np.linalg.norm(ahead)) > _MOST_SIZES * size_m:
        return None
    return np.asarray((eye + reach * ahead)[:2])
