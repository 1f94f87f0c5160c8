"""A page's scene, and an exported one: ground, map and drones of a state, drawn with what differs."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from viser import MeshHandle, SceneApi, SceneNodeDragEvent, SceneNodeHandle

from nullpose.report.numbers import MINUS
from nullpose.studio.drawing import FLAT, Shape, Shapes, label, lines
from nullpose.studio.drone import drone_shapes, flight_shapes
from nullpose.studio.field_map import Scale
from nullpose.studio.ground import ground_shapes, scene_size_m, shadow_shapes
from nullpose.studio.look import LIGHT, Look, Rgb, round_steps, scale_colours
from nullpose.studio.state import Key, State
from nullpose.study import Field

Drag: TypeAlias = "SceneNodeDragEvent[MeshHandle]"
OnDrag = Callable[[Key, Drag], None]
"""Called with a point's key and each step of a drag of its body."""

_OTHER_SIZE = (0.6, 1.7)  # marks keep their size until the scene is that much smaller or larger
_LIFT_M = 0.05  # of the map off the grid on the ground
_PIXELS = 270  # along the longer side of a map
_FADE = 4.0  # how steeply the map fades in at its edges
_MOST_LABELS = 4
_CHANGEABLE = {"position", "wxyz", "scale", "text", "font_screen_scale", "points", "colors", "vertices"}
"""The values that can be changed of a shape that is shown; for others it is added again."""


class Stage:
    """The scene of one page, which shows its states: of each only the difference to the one before.

    Args:
        scene: viser's.
        look: the colours.
        on_drag: None for a scene whose points are not dragged.

    Attributes:
        size_m: of the scene as it is drawn, metres.
        is_narrow: whether the canvas is a phone's, with space for small and few labels only.
        eye_m: (3,) where the camera stands, towards which the patterns are open, metres.
    """

    def __init__(self, scene: SceneApi, look: Look = LIGHT, on_drag: OnDrag | None = None) -> None:
        self._scene, self._look, self._on_drag = scene, look, on_drag
        self._shapes: Shapes = {}
        self._handles: dict[str, SceneNodeHandle] = {}
        self.size_m, self.is_narrow = np.inf, False
        self.eye_m: ArrayLike = np.ones(3)

    def render(self, state: State) -> None:
        """Draw a state.

        Args:
            state: of the page.
        """
        size_m = scene_size_m(state.scenario)
        if not _OTHER_SIZE[0] < size_m / self.size_m < _OTHER_SIZE[1]:
            self.size_m = size_m
        shapes = ground_shapes(state, self.size_m, self._look)
        shapes |= shadow_shapes(state, self.size_m, self._look)
        shapes |= flight_shapes(state, self.size_m, self._look)
        for slot in range(len(state.cases)):
            shapes |= drone_shapes(state, slot, self.size_m, self.eye_m, self._look)
        if state.scale is not None:
            contour = self._look.colours["contour"] if state.scenario.prisms is None else None
            shapes |= _map_shapes(state.scale, self._look.map_alpha, contour)
        self._show(_narrowed(shapes) if self.is_narrow else shapes)

    def _show(self, shapes: Shapes) -> None:
        for name in self._shapes.keys() - shapes.keys():
            self._scene.remove_by_name(name)
            del self._shapes[name]
        for name, shape in shapes.items():
            before, values = self._shapes.get(name, Shape("", {})), shape.values
            anew = {key: each for key, each in values.items() if not _same(before.values.get(key), each)}
            if before.kind != shape.kind or not anew.keys() <= _CHANGEABLE:
                self._add(name, shape)
            else:
                for key, value in anew.items():
                    setattr(self._handles[name], key, value)
            self._shapes[name] = shape

    def _add(self, name: str, shape: Shape) -> None:
        handle = self._handles[name] = getattr(self._scene, f"add_{shape.kind}")(name, **shape.values)
        if shape.key is not None and self._on_drag is not None:

            async def dragged(event: Drag, key: Key = shape.key, on_drag: OnDrag = self._on_drag) -> None:
                on_drag(key, event)

            handle.on_drag("left")(dragged)
            handle.on_drag("left", modifier="shift")(dragged)


def _narrowed(shapes: Shapes) -> Shapes:
    """Leave out the labels of contours and of the null, and make all others smaller."""
    return {
        name: shape._replace(values={**shape.values, "font_screen_scale": 0.75})
        if shape.kind == "label"
        else shape
        for name, shape in shapes.items()
        if not name.startswith(("/map/level", "/drone-a/angle/"))
    }


def _same(before: object, value: object) -> bool:
    if isinstance(value, np.ndarray):
        return before is value or np.array_equal(np.asarray(before), value)
    return bool(before == value)


@lru_cache(8)
def _map_shapes(scale: Scale, map_alpha: int, contour: Rgb | None) -> Shapes:
    """Draw a map as a coloured plane with contours, a little above its altitude.

    There are none without a colour for them: at the edge of a shadow all would run as one.
    """
    field, (low, high) = scale.field, scale.ends
    east, north, altitude_m = field.east_m, field.north_m, field.altitude_m + _LIFT_M
    width = float(east[-1] + east[1] - 2.0 * east[0])
    plane = {
        "image": _image(field, low, high, map_alpha),
        "render_width": width,
        "render_height": float(north[-1] - north[0] + east[1] - east[0]),
        "format": "png",
        "wxyz": np.array([0.0, 1.0, 0.0, 0.0]),  # the image's rows run towards the south
        "position": np.array([0.5 * (east[0] + east[-1]), 0.5 * (north[0] + north[-1]), altitude_m]),
    }
    shapes = {"/map/colours": Shape("image", plane | FLAT)}
    if contour is None:
        return shapes
    if contours := _contours(field, low, high):
        segments = [np.stack([line[:-1], line[1:]], axis=1) for level in contours.values() for line in level]
        shapes["/map/contours"] = lines(
            np.insert(np.concatenate(segments), 2, altitude_m + 1e-3 * width, axis=-1), contour, 1.3
        )
    for level in list(contours)[:: max(1, len(contours) // _MOST_LABELS)]:
        points = np.concatenate(contours[level])
        x, y = points[np.argmax(points[:, 0])]  # eastmost: in front, beside the labels of the points
        shapes[f"/map/level-{level:g}"] = label(
            f"{level:g} {field.unit}".replace("-", MINUS), (x, y, altitude_m), 0.7, "center-center"
        )
    return shapes


def _image(field: Field, low: float, high: float, map_alpha: int) -> NDArray[np.uint8]:
    """Paint a field as an image, north up, see-through where there is no value."""
    from scipy.ndimage import zoom

    has_value = np.isfinite(field.values)
    filled = np.where(has_value, np.clip(np.nan_to_num(field.values, nan=low), low, high), low)
    finer = max(1, _PIXELS // max(filled.shape))
    fine = zoom(filled, finer, order=1, mode="nearest", grid_mode=True)
    solid = zoom(has_value.astype(float), finer, order=0, mode="nearest", grid_mode=True) > 0.5
    across, along = (np.sin(np.linspace(0.0, np.pi, n)) for n in fine.shape)
    fade = np.minimum(1.0, _FADE * np.minimum(across[:, None], along))  # no hard edge in a dark page
    alpha = np.where(solid, map_alpha * fade, 0).astype(np.uint8)
    return np.dstack([scale_colours(fine, low, high), alpha])[::-1]


def _contours(field: Field, low: float, high: float) -> dict[float, list[NDArray[np.float64]]]:
    """Return the contours by their level, each a list of points, (n, 2)."""
    from contourpy import contour_generator

    generator = contour_generator(field.east_m, field.north_m, np.ma.masked_invalid(field.values))
    contours = {
        float(level): [np.asarray(line) for line in generator.lines(level) if len(line) > 4]
        for level in round_steps(low, high, 8)
        if low <= level <= high
    }
    return {level: found for level, found in contours.items() if found}
