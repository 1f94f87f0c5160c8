"""The drone in the scene: body, antenna, pattern, null and links; and the two maps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.studio.answer import Answer
from nullpose.studio.colours import KIND_COLOURS, SLOTS, scale_colour, scale_colours, scale_range
from nullpose.studio.events import Field
from nullpose.studio.meshes import (
    antenna_wxyz,
    attitude_wxyz,
    body_mesh,
    doughnut_mesh,
    gain_bands,
    null_line_m,
    rod_mesh,
    rotor_mesh,
)
from nullpose.studio.scene import add_mesh

if TYPE_CHECKING:
    from viser import SceneApi

__all__ = ["LINK_RANGE_DB", "Carpet", "Drone"]

LINK_RANGE_DB = (-6.0, 12.0)
"""Range of the links' colours, dB, while no map has set one."""

_NULL = KIND_COLOURS["jammers"]
_LABEL_AT = (np.array([0.0, 0.0, 0.17]), np.array([0.0, 0.14, 0.0]))  # above, and to the right at first
_HULLS = ((60, 64, 72), (120, 124, 130))


class Drone:
    """One case's drone with its pattern, null and links.

    Args:
        scene: the page's scene.
        slot: 0 for the chosen case, 1 for the compared one.
        size_m: of the scene, from which the drone's drawn size follows.
    """

    def __init__(self, scene: SceneApi, slot: int, size_m: float) -> None:
        self._scene, self._slot, self._size_m = scene, slot, size_m
        self._root = f"/drone-{'ab'[slot]}"
        self._frame: Any = None
        self._parts: dict[str, Any] = {}
        self._shown: dict[str, Any] = {}

    def show(self, answer: Answer, text: str, link_range_db: tuple[float, float], *, pattern: bool) -> None:
        """Put the drone where an answer has it.

        Args:
            answer: pose and links.
            text: its label.
            link_range_db: ends of the links' colours, dB.
            pattern: whether the radiation pattern is shown.
        """
        if self._frame is None:
            self._build()
        pose, parts = answer.pose, self._parts
        self._frame.position = pose.position_m
        self._frame.wxyz = attitude_wxyz(pose)
        parts["antenna"].wxyz = antenna_wxyz(pose.mount_rad)
        self._set("pattern", pattern)
        label = parts["label"]
        label.position = pose.position_m + self._size_m * _LABEL_AT[self._slot]
        if self._shown.get("text") != text:
            label.text = self._shown["text"] = text
        parts["null"].points = null_line_m(pose, 0.16 * self._size_m, most_m=1.5 * self._size_m)[None].astype(
            np.float32
        )
        drop = np.array([pose.position_m, [*pose.position_m[:2], 0.0]])
        parts["drop"].points = drop[None].astype(np.float32)
        self._show_links(answer, link_range_db)
        self._set("frame", True)

    def hide(self) -> None:
        """Take the drone out of sight."""
        if self._frame is not None:
            self._set("frame", False)

    def remove(self) -> None:
        """Take the drone out of the scene."""
        if self._frame is not None:
            for name in ("label", "null", "drop", "links", "binding"):
                self._parts[name].remove()
            self._frame.remove()
            self._frame = None

    def _set(self, name: str, visible: bool) -> None:
        if self._shown.get(name) == visible:
            return
        self._shown[name] = visible
        if name == "frame":
            self._frame.visible = visible
            for other in ("label", "null", "drop", "links", "binding"):
                self._parts[other].visible = visible
        else:
            self._parts[name].visible = visible

    def _show_links(self, answer: Answer, link_range_db: tuple[float, float]) -> None:
        nodes = answer.scenario.node_positions_m
        if len(nodes) != self._shown.get("links-n"):
            self._shown["links-n"] = len(nodes)
        here = answer.pose.position_m
        ends = np.stack([np.broadcast_to(here, nodes.shape), nodes], axis=1)
        colours = scale_colours([link.sinr_db for link in answer.links], *link_range_db)
        names = [link.node for link in answer.links]
        decides = np.array([name == answer.binding_node for name in names])
        self._parts["links"].points = ends.astype(np.float32)
        self._parts["links"].colors = np.repeat(colours[:, None], 2, axis=1)
        self._parts["binding"].points = ends[decides].astype(np.float32)
        self._parts["binding"].colors = np.repeat(colours[decides][:, None], 2, axis=1)

    def _build(self) -> None:
        scene, root, size_m = self._scene, self._root, self._size_m
        arm_m = 0.055 * size_m
        self._frame = scene.add_frame(root, show_axes=False)
        add_mesh(scene, f"{root}/body", body_mesh(arm_m), _HULLS[self._slot], flat_shading=True)
        add_mesh(scene, f"{root}/rotors", rotor_mesh(arm_m), SLOTS[self._slot], opacity=0.45)
        self._parts["antenna"] = scene.add_frame(f"{root}/antenna", show_axes=False)
        add_mesh(scene, f"{root}/antenna/rod", rod_mesh(0.2 * size_m), _NULL)
        self._parts["pattern"] = self._add_pattern(f"{root}/antenna/pattern")
        self._parts["label"] = scene.add_label(
            f"/labels{root}",
            "",
            anchor="bottom-center" if self._slot == 0 else "center-left",
            font_screen_scale=1.0,
        )
        none = np.zeros((1, 2, 3), dtype=np.float32)
        colours = np.zeros((1, 2, 3), dtype=np.uint8)
        lines = {
            "null": (np.array(_NULL, dtype=np.uint8), 3.0),
            "drop": (np.array((120, 120, 120), dtype=np.uint8), 1.2),
            "links": (colours, 3.0),
            "binding": (colours, 8.0),
        }
        for name, (colour, thickness) in lines.items():
            self._parts[name] = scene.add_line_segments(
                f"/lines{root}/{name}", none, colour, thickness=thickness, thickness_units="screen"
            )
        self._shown = {"frame": True, "pattern": True}

    def _add_pattern(self, name: str) -> Any:
        """Return the frame of the pattern: see-through bands of one gain each, or wires for the second."""
        frame = self._scene.add_frame(name, show_axes=False)
        radius_m = 0.11 * self._size_m
        if self._slot == 1:
            wires = doughnut_mesh(radius_m, 18, 24)
            add_mesh(self._scene, f"{name}/wires", wires, SLOTS[1], wireframe=True)
            return frame
        for i, (band, gain) in enumerate(gain_bands(doughnut_mesh(radius_m))):
            # its near side only: both of them, finely meshed, took a quarter of the time of a picture
            add_mesh(self._scene, f"{name}/band-{i}", band, scale_colour(gain, 0.0, 1.0), opacity=0.5)
        return frame


class Carpet:
    """A field drawn as a coloured plane with contours.

    Args:
        scene: the page's scene.
    """

    def __init__(self, scene: SceneApi) -> None:
        self._scene = scene
        self._parts: list[Any] = []

    def show(self, field: Field, *, lift_m: float = 0.0) -> tuple[float, float]:
        """Return the ends of the scale after drawing a field in place of the one before.

        Args:
            field: what to draw.
            lift_m: how far above its altitude it is drawn, metres.
        """
        self.hide()
        low, high = scale_range(field.values)
        altitude_m = field.altitude_m + lift_m
        image = _image(field, low, high)
        east, north = field.east_m, field.north_m
        half = 0.5 * (east[1] - east[0])
        width, height = east[-1] - east[0] + 2 * half, north[-1] - north[0] + 2 * half
        self._parts.append(
            self._scene.add_image(
                "/map/colours",
                image,
                float(width),
                float(height),
                format="png",
                cast_shadow=False,
                receive_shadow=False,
                wxyz=(0.0, 1.0, 0.0, 0.0),  # the image's rows run towards the south
                position=(0.5 * (east[0] + east[-1]), 0.5 * (north[0] + north[-1]), altitude_m),
            )
        )
        lines, labels = _contours(field, low, high)
        if len(lines):
            lines[..., 2] = altitude_m + 1e-3 * float(width)
            self._parts.append(
                self._scene.add_line_segments(
                    "/map/contours",
                    lines.astype(np.float32),
                    (250, 250, 250),
                    thickness=1.3,
                    thickness_units="screen",
                )
            )
        for i, (text, (x, y)) in enumerate(labels):
            self._parts.append(
                self._scene.add_label(
                    f"/map/level-{i}", text, position=(x, y, altitude_m), anchor="center-center",
                    font_screen_scale=0.7,
                )
            )  # fmt: skip
        return low, high

    def hide(self) -> None:
        """Take the field out of the scene."""
        for part in self._parts:
            part.remove()
        self._parts = []


def _image(field: Field, low: float, high: float) -> NDArray[np.uint8]:
    """Return the field as an image, north up, see-through where there is no value."""
    from scipy.ndimage import zoom

    known = np.isfinite(field.values)
    filled = np.where(known, np.clip(np.nan_to_num(field.values, nan=low), low, high), low)
    fine = zoom(filled, 6, order=1, mode="nearest", grid_mode=True)
    solid = zoom(known.astype(float), 6, order=0, mode="nearest", grid_mode=True) > 0.5
    alpha = np.where(solid, 105, 0).astype(np.uint8)
    return np.dstack([scale_colours(fine, low, high), alpha])[::-1]


def _contours(
    field: Field, low: float, high: float
) -> tuple[NDArray[np.float64], list[tuple[str, tuple[float, float]]]]:
    """Return the contours as segments, (n, 2, 3), their height left at 0, and a label for each level."""
    from contourpy import contour_generator

    span = high - low
    step = next((one for one in (0.5, 1.0, 2.0, 5.0) if span / one <= 8.0), 10.0)
    values = np.ma.masked_invalid(field.values)
    generator = contour_generator(field.east_m, field.north_m, values)
    segments, labels = [], []
    for level in step * np.arange(np.ceil(low / step), np.floor(high / step) + 1.0):
        lines = [np.asarray(line) for line in generator.lines(float(level)) if len(line) > 4]
        segments += [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
        if lines:
            labels.append((f"{level:g} {field.unit}".replace("-", "\N{MINUS SIGN}"), _southmost(lines)))
    if not segments:
        return np.zeros((0, 2, 3)), []
    flat = np.concatenate(segments)
    return np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=-1), labels[
        :: max(1, len(labels) // 4)
    ]


def _southmost(lines: list[NDArray[np.float64]]) -> tuple[float, float]:
    """Return the southmost point of some lines, where labels are out of the way of what is in the middle."""
    points = np.concatenate(lines)
    x, y = points[np.argmin(points[:, 1])]
    return float(x), float(y)
