"""A map in the scene: a coloured plane with contours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from viser import SceneApi

from nullpose.report.numbers import MINUS
from nullpose.studio.colours import round_steps, scale_colours, scale_range
from nullpose.studio.drawing import FLAT, add_label, add_lines
from nullpose.studio.look import LIGHT, Look
from nullpose.study.value_map import Field

_LIFT_M = 0.05  # off the grid on the ground
_FINER = 6  # pixels for each step of the grid
_FADE = 4.0  # how steeply the map fades in at its edges
_MOST_LABELS = 4


class Carpet:
    """A field drawn as a coloured plane with contours.

    Args:
        scene: the page's scene.
        look: its colours.
    """

    def __init__(self, scene: SceneApi, look: Look = LIGHT) -> None:
        self._scene, self._look = scene, look

    def show(self, field: Field) -> tuple[float, float]:
        """Return the ends of the scale after drawing a field in place of the one before.

        Args:
            field: what to draw, a little above its altitude.
        """
        self.hide()
        low, high = scale_range(field.values, is_rate=field.unit != "dB")
        east, north, altitude_m = field.east_m, field.north_m, field.altitude_m + _LIFT_M
        width = float(east[-1] + east[1] - 2.0 * east[0])
        height = float(north[-1] - north[0] + east[1] - east[0])
        self._scene.add_image(
            "/map/colours",
            _image(field, low, high, self._look.map_alpha),
            width,
            height,
            format="png",
            wxyz=(0.0, 1.0, 0.0, 0.0),  # the image's rows run towards the south
            position=(0.5 * (east[0] + east[-1]), 0.5 * (north[0] + north[-1]), altitude_m),
            **FLAT,
        )
        contours = _contours(field, low, high)
        if contours:
            flat = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for _, line in contours])
            raised = np.insert(flat, 2, altitude_m + 1e-3 * width, axis=-1)
            add_lines(self._scene, "/map/contours", raised, self._look.contour, 1.3)
        levels = sorted({level for level, _ in contours})
        for level in levels[:: max(1, len(levels) // _MOST_LABELS)]:
            points = np.concatenate([line for each, line in contours if each == level])
            x, y = points[np.argmax(points[:, 0])]  # eastmost: in front, beside the labels of the points
            name, text = f"/map/level-{level:g}", f"{level:g} {field.unit}".replace("-", MINUS)
            add_label(self._scene, name, text, (x, y, altitude_m), 0.7, "center-center")
        return low, high

    def hide(self) -> None:
        """Take the field out of the scene."""
        self._scene.remove_by_name("/map")


def _image(field: Field, low: float, high: float, map_alpha: int) -> NDArray[np.uint8]:
    """Return the field as an image, north up, see-through where there is no value."""
    from scipy.ndimage import zoom

    known = np.isfinite(field.values)
    filled = np.where(known, np.clip(np.nan_to_num(field.values, nan=low), low, high), low)
    fine = zoom(filled, _FINER, order=1, mode="nearest", grid_mode=True)
    solid = zoom(known.astype(float), _FINER, order=0, mode="nearest", grid_mode=True) > 0.5
    across, along = (np.sin(np.linspace(0.0, np.pi, n)) for n in fine.shape)
    fade = np.minimum(1.0, _FADE * np.minimum(across[:, None], along))  # no hard edge in a dark page
    alpha = np.where(solid, map_alpha * fade, 0).astype(np.uint8)
    return np.dstack([scale_colours(fine, low, high), alpha])[::-1]


def _contours(field: Field, low: float, high: float) -> list[tuple[float, NDArray[np.float64]]]:
    """Return the contours, each with its level, as points, (n, 2)."""
    from contourpy import contour_generator

    generator = contour_generator(field.east_m, field.north_m, np.ma.masked_invalid(field.values))
    levels = (level for level in round_steps(low, high, 8) if low <= level <= high)
    return [(level, np.asarray(line)) for level in levels for line in generator.lines(level) if len(line) > 4]
