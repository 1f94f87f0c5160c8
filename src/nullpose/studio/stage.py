"""A state drawn in 3-D, in a page and in an exported scene: ground, map and drones."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from viser import SceneApi

from nullpose.report.numbers import MINUS
from nullpose.studio.drawing import FLAT, add_label, add_lines
from nullpose.studio.drone import Drone
from nullpose.studio.field_map import Scale
from nullpose.studio.ground import Ground, OnDrag, scene_size_m
from nullpose.studio.look import LIGHT, Look, round_steps, scale_colours
from nullpose.studio.readout import drone_text
from nullpose.studio.state import State
from nullpose.study.value_map import Field

_OTHER_SIZE = (0.6, 1.7)  # a scene that much smaller or larger is drawn anew, at its own size
_LIFT_M = 0.05  # of the map off the grid on the ground
_FINER = 6  # pixels for each step of the map's grid
_FADE = 4.0  # how steeply the map fades in at its edges
_MOST_LABELS = 4


class Stage:
    """The scene of one page, which draws its states: of each only the difference to the one before.

    Args:
        scene: viser's.
        look: the colours.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points are not dragged.

    Attributes:
        size_m: of the scene as it is drawn, metres.
        eye_m: (3,) where the camera stands, towards which the patterns are open, metres.
    """

    def __init__(self, scene: SceneApi, look: Look = LIGHT, on_drag: OnDrag | None = None) -> None:
        self._scene, self._look = scene, look
        self._ground = Ground(scene, on_drag, look)
        self._drones = [Drone(scene, slot, look) for slot in (0, 1)]
        self._map: object = None
        self.size_m = np.inf
        self.eye_m: ArrayLike = np.ones(3)

    def render(self, state: State) -> None:
        """Draw a state.

        Args:
            state: of the page.
        """
        size_m = scene_size_m(state.scenario)
        if not _OTHER_SIZE[0] < size_m / self.size_m < _OTHER_SIZE[1]:
            self.size_m = size_m
        self._ground.render(state, self.size_m)
        shown = state.field_map, state.map_name
        if shown != self._map:
            self._map = shown
            self._scene.remove_by_name("/map")
            if state.scale is not None:
                _draw_map(self._scene, state.scale, self._look)
        for slot, drone in enumerate(self._drones):
            answer = state.answer(state.cases[slot]) if slot < len(state.cases) else None
            if answer is None or len(answer.result.links) != len(state.scenario.nodes):
                drone.hide()
                continue
            sizes = self.size_m, state.link_range_db, self.eye_m
            drone.render(answer, drone_text(state, slot), *sizes, has_pattern=state.has_pattern)

    def face(self, eye_m: ArrayLike) -> None:
        """Turn the patterns' openings towards the camera.

        Args:
            eye_m: (3,) where it stands, metres.
        """
        self.eye_m = eye_m
        for drone in self._drones:
            drone.face(eye_m)


def _draw_map(scene: SceneApi, scale: Scale, look: Look) -> None:
    """Draw a map as a coloured plane with contours, a little above its altitude."""
    field, (low, high) = scale.field, scale.ends
    east, north, altitude_m = field.east_m, field.north_m, field.altitude_m + _LIFT_M
    width = float(east[-1] + east[1] - 2.0 * east[0])
    height = float(north[-1] - north[0] + east[1] - east[0])
    scene.add_image(
        "/map/colours",
        _image(field, low, high, look.map_alpha),
        width,
        height,
        format="png",
        wxyz=(0.0, 1.0, 0.0, 0.0),  # the image's rows run towards the south
        position=(0.5 * (east[0] + east[-1]), 0.5 * (north[0] + north[-1]), altitude_m),
        **FLAT,
    )
    contours = _contours(field, low, high)
    if contours:
        lines = [line for level in contours.values() for line in level]
        flat = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
        raised = np.insert(flat, 2, altitude_m + 1e-3 * width, axis=-1)
        add_lines(scene, "/map/contours", raised, look.contour, 1.3)
    for level in list(contours)[:: max(1, len(contours) // _MOST_LABELS)]:
        points = np.concatenate(contours[level])
        x, y = points[np.argmax(points[:, 0])]  # eastmost: in front, beside the labels of the points
        text = f"{level:g} {field.unit}".replace("-", MINUS)
        add_label(scene, f"/map/level-{level:g}", text, (x, y, altitude_m), 0.7, "center-center")


def _image(field: Field, low: float, high: float, map_alpha: int) -> NDArray[np.uint8]:
    """Paint a field as an image, north up, see-through where there is no value."""
    from scipy.ndimage import zoom

    has_value = np.isfinite(field.values)
    filled = np.where(has_value, np.clip(np.nan_to_num(field.values, nan=low), low, high), low)
    fine = zoom(filled, _FINER, order=1, mode="nearest", grid_mode=True)
    solid = zoom(has_value.astype(float), _FINER, order=0, mode="nearest", grid_mode=True) > 0.5
    across, along = (np.sin(np.linspace(0.0, np.pi, n)) for n in fine.shape)
    fade = np.minimum(1.0, _FADE * np.minimum(across[:, None], along))  # no hard edge in a dark page
    alpha = np.where(solid, map_alpha * fade, 0).astype(np.uint8)
    return np.dstack([scale_colours(fine, low, high), alpha])[::-1]


def _contours(field: Field, low: float, high: float) -> dict[float, list[NDArray[np.float64]]]:
    """Return the contours by their level, each a list of points, (n, 2)."""
    from contourpy import contour_generator

    generator = contour_generator(field.east_m, field.north_m, np.ma.masked_invalid(field.values))
    contours = {}
    for level in round_steps(low, high, 8):
        lines = [np.asarray(line) for line in generator.lines(level) if len(line) > 4]
        if lines and low <= level <= high:
            contours[float(level)] = lines
    return contours
