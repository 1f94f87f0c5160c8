"""The drone in the scene: body, antenna, pattern, null and links."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import Antenna, PatternAntenna
from nullpose.studio.answer import Answer
from nullpose.studio.colours import KIND_COLOURS, SLOTS, linear_colours, scale_colours
from nullpose.studio.drawing import add_coloured_mesh, add_label, add_lines, add_mesh
from nullpose.studio.meshes import (
    body_mesh,
    doughnut_bands,
    doughnut_mesh,
    null_line_m,
    pattern_mesh,
    rod_mesh,
    rotor_mesh,
)

if TYPE_CHECKING:
    from viser import SceneApi

LINK_RANGE_DB = (-6.0, 12.0)
"""Range of the links' colours, dB, while no map has set one."""

_NULL = KIND_COLOURS["jammers"]
_LABEL_AT = (np.array([0.0, 0.0, 0.17]), np.array([0.0, 0.14, 0.0]))  # above, and to the right at first
_ANCHORS = ("bottom-center", "center-left")
_HULLS = ((60, 64, 72), (120, 124, 130))
_EACH = np.zeros((1, 2, 3))  # their ends have colours of their own
_LINES: dict[str, tuple[ArrayLike, float]] = {
    "null": (_NULL, 3.0),
    "drop": ((120, 120, 120), 1.2),
    "links": (_EACH, 3.0),
    "worst": (_EACH, 8.0),
}


class Drone:
    """One case's drone with its pattern, null and links.

    Args:
        scene: the page's scene.
        slot: 0 for the chosen case, 1 for the compared one.
    """

    def __init__(self, scene: SceneApi, slot: int) -> None:
        self._scene, self._slot, self._name = scene, slot, f"/drone-{'ab'[slot]}"
        self._parts: dict[str, Any] = {}
        self._built: tuple[Antenna, float] | None = None

    def show(
        self, answer: Answer, text: str, size_m: float, link_range_db: tuple[float, float], *, pattern: bool
    ) -> None:
        """Put the drone where an answer has it.

        Args:
            answer: pose and links.
            text: its label.
            size_m: of the scene, from which the drone's drawn size follows.
            link_range_db: ends of the links' colours, dB.
            pattern: whether the radiation pattern is shown.
        """
        from viser.transforms import SO3

        result, pose = answer.result, answer.result.pose
        wanted = (result.scenario.antenna_record, size_m)
        if wanted != self._built:
            self.hide()
            self._built = wanted
            self._build(*wanted)
        parts, here = self._parts, pose.position_m
        parts["body"].position = here
        parts["body"].wxyz = SO3.from_rpy_radians(pose.roll_rad, pose.pitch_rad, pose.yaw_rad).wxyz
        parts["antenna"].wxyz = SO3.from_y_radians(pose.mount_rad).wxyz
        parts["pattern"].visible = pattern
        parts["label"].position = here + size_m * _LABEL_AT[self._slot]
        parts["label"].text = text
        nodes = result.scenario.node_positions_m
        ends = np.stack([np.broadcast_to(here, nodes.shape), nodes], axis=1)
        worst = np.array([link.node in answer.worst_nodes for link in result.links])
        colours = linear_colours(scale_colours([link.sinr_db for link in result.links], *link_range_db))
        lines = {
            "null": null_line_m(pose, 0.16 * size_m, most_m=1.5 * size_m)[None],
            "drop": np.array([[here, [*here[:2], 0.0]]]),
            "links": ends,
            "worst": ends[worst],
        }
        for name, segments in lines.items():
            parts[name].points = segments.astype(np.float32)
        parts["links"].colors = np.repeat(colours[:, None], 2, axis=1)
        parts["worst"].colors = np.repeat(colours[worst][:, None], 2, axis=1)

    def hide(self) -> None:
        """Take the drone out of the scene."""
        self._scene.remove_by_name(self._name)
        self._built = None

    def _build(self, antenna: Antenna, size_m: float) -> None:
        scene, slot, name = self._scene, self._slot, self._name
        frames = {
            "body": f"{name}/body",
            "antenna": f"{name}/body/antenna",
            "pattern": f"{name}/body/antenna/pattern",
        }
        for part, place in frames.items():
            self._parts[part] = scene.add_frame(place, show_axes=False)
        arm_m = 0.055 * size_m
        add_mesh(scene, f"{name}/body/hull", body_mesh(arm_m), _HULLS[slot], flat_shading=True)
        add_mesh(scene, f"{name}/body/rotors", rotor_mesh(arm_m), SLOTS[slot], opacity=0.45)
        add_mesh(scene, f"{name}/body/antenna/rod", rod_mesh(0.2 * size_m), _NULL)
        self._add_pattern(frames["pattern"], antenna, 0.11 * size_m)
        self._parts["label"] = add_label(scene, f"{name}/label", "", np.zeros(3), 1.0, _ANCHORS[slot])
        for line, (colour, thickness) in _LINES.items():
            self._parts[line] = add_lines(scene, f"{name}/{line}", np.zeros((1, 2, 3)), colour, thickness)

    def _add_pattern(self, name: str, antenna: Antenna, radius_m: float) -> None:
        """Draw the pattern: see-through bands of one gain each, or wires for the second."""
        if isinstance(antenna, PatternAntenna):
            surface = pattern_mesh(antenna, radius_m)
            gains = np.linalg.norm(surface.vertices, axis=1) / radius_m
            if self._slot == 1:
                add_mesh(self._scene, f"{name}/wires", surface, SLOTS[1], wireframe=True)
            else:
                add_coloured_mesh(self._scene, f"{name}/surface", surface, scale_colours(gains, 0.0, 1.0))
            return
        if self._slot == 1:
            wires = doughnut_mesh(antenna, radius_m, np.linspace(0.0, np.pi, 19), 24)
            add_mesh(self._scene, f"{name}/wires", wires, SLOTS[1], wireframe=True)
            return
        for i, (band, gain) in enumerate(doughnut_bands(antenna, radius_m)):
            # its near side only: both of them, finely meshed, took a quarter of the time of a picture
            add_mesh(self._scene, f"{name}/band-{i}", band, scale_colours(gain, 0.0, 1.0), opacity=0.5)
