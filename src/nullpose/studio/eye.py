"""What a camera sees: where on its canvas a point is, and from where it sees them all."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

_CANVAS = 1000.0, 800.0  # pixels, where none is known
_STEPS = 40  # after which a camera is turned and moved well enough
_MARGIN = 0.9  # of half the canvas, which leaves room for labels


class Eye(NamedTuple):
    """A camera whose upper side is up.

    Args:
        position_m: (3,) where it stands, metres.
        look_at_m: (3,) a point in the middle of what it sees, metres.
        fov_rad: angle between the upper and the lower edge of what it sees, radians.
        width_px: of the canvas, pixels.
        height_px: of the canvas, pixels.
    """

    position_m: ArrayLike
    look_at_m: ArrayLike
    fov_rad: float
    width_px: float
    height_px: float

    @classmethod
    def of(cls, camera: Any) -> Eye:
        """Return what a camera of viser's sees; one that has no canvas yet is given a usual one.

        Args:
            camera: of a page, or the one that pages begin with.
        """
        width_px, height_px = (getattr(camera, "image_width", 0), getattr(camera, "image_height", 0))
        size = (width_px, height_px) if width_px and height_px else _CANVAS
        return cls(np.array(camera.position), np.array(camera.look_at), float(camera.fov), *size)

    def pixels(self, points_m: ArrayLike) -> NDArray[np.float64]:
        """Return where on the canvas points are, (n, 3): to the right, down, and metres before the camera.

        Args:
            points_m: (n, 3) metres.
        """
        axes = _axes(np.subtract(self.look_at_m, self.position_m))
        right, up, ahead = axes @ np.subtract(points_m, self.position_m).T
        scale = 0.5 * self.height_px / math.tan(0.5 * self.fov_rad) / np.where(ahead == 0.0, np.nan, ahead)
        x, y = 0.5 * self.width_px + scale * right, 0.5 * self.height_px - scale * up
        return np.stack([x, y, ahead], axis=-1)

    def is_resized(self, other: Eye) -> bool:
        """Return whether only the canvas differs from another's.

        Args:
            other: the other.
        """
        ends = np.stack([self.position_m, self.look_at_m]), np.stack([other.position_m, other.look_at_m])
        return self[3:] != other[3:] and np.allclose(*ends, rtol=1e-3)

    def fitted(self, points_m: ArrayLike) -> Eye:
        """Return the camera that looks the same way, as near as it can be with all points in its canvas.

        Args:
            points_m: (n, 3) metres.
        """
        axes = _axes(np.subtract(self.look_at_m, self.position_m))
        *sides, ahead = axes @ np.asarray(points_m, dtype=float).T
        slopes = _MARGIN * math.tan(0.5 * self.fov_rad) * np.array([self.width_px / self.height_px, 1.0])
        # a point is inside two opposite edges where the camera is between these, or farther away
        ends = [
            (np.max(side - slope * ahead), np.min(side + slope * ahead))
            for side, slope in zip(sides, slopes, strict=True)
        ]
        behind = min(0.5 * (low - high) / slope for (high, low), slope in zip(ends, slopes, strict=True))
        middle = [_middle(side, ahead - behind) for side in sides]
        position = np.array([*middle, behind]) @ axes
        away_m = float(np.mean(ahead)) - behind
        return self._replace(position_m=position, look_at_m=position + away_m * axes[2])

    def beside(self, points_m: ArrayLike, card_px: tuple[float, float]) -> Eye:
        """Return the camera farther away and turned, so that all points are right of a card, or below it.

        Args:
            points_m: (n, 3) metres.
            card_px: width and height of what covers the canvas's upper left, pixels.
        """
        points, (right_of, below) = np.asarray(points_m, dtype=float), card_px
        eyes = [self._within(points, right_of, 0.0), self._within(points, 0.0, below)]
        return min(eyes, key=lambda eye: float(np.linalg.norm(points.mean(axis=0) - eye.position_m)))

    def _within(self, points_m: NDArray[np.float64], left_px: float, top_px: float) -> Eye:
        """Return the camera that has points in the canvas from a left and an upper edge on."""
        size = np.array([self.width_px - left_px, self.height_px - top_px])
        goal, room = np.array([left_px, top_px]) + 0.5 * size, _MARGIN * size
        middle, eye = 0.5 * (points_m.min(axis=0) + points_m.max(axis=0)), self
        for _ in range(_STEPS):
            seen = eye.pixels(points_m)[:, :2]
            low, high = seen.min(axis=0), seen.max(axis=0)
            # half of the way at a time: turning and moving change what the other sees
            aside, below = (0.5 * (low + high) - goal) * math.tan(0.5 * self.fov_rad) / self.height_px
            right, up, ahead = _axes(np.subtract(eye.look_at_m, eye.position_m))
            farther = math.sqrt(float(np.max((high - low) / room)))
            position = middle + farther * np.subtract(eye.position_m, middle)
            eye = eye._replace(position_m=position, look_at_m=position + ahead + aside * right - below * up)
        return eye


def _middle(side: NDArray[np.float64], ahead: NDArray[np.float64]) -> float:
    """Return from where points are seen as far to one side as to the other."""
    from scipy.optimize import brentq

    def aside(middle: float) -> float:
        seen = (side - middle) / np.maximum(ahead, 1e-9)
        return float(seen.max() + seen.min())

    return float(brentq(aside, side.min(), side.max()))


def _axes(ahead: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit vectors to the right, up and ahead of a camera, (3, 3), one in each row."""
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= max(float(np.linalg.norm(right)), 1e-12)
    return np.stack([right, np.cross(right, ahead), ahead])
