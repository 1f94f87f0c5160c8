"""The drone in the scene: body, antenna, pattern, null and links."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import Antenna, PatternAntenna
from nullpose.physics import Pose, rotation_world_from_body
from nullpose.report.geometry import null_angle_rad
from nullpose.report.numbers import fixed
from nullpose.solve import Result
from nullpose.studio.answer import Answer
from nullpose.studio.colours import KIND_COLOURS, SLOTS, linear_colours, scale_colours
from nullpose.studio.drawing import add_coloured_mesh, add_label, add_lines, add_mesh
from nullpose.studio.meshes import (
    beam_mesh,
    body_mesh,
    null_line_m,
    pattern_mesh,
    relative_gain,
    rod_mesh,
    rotor_mesh,
)

if TYPE_CHECKING:
    from viser import SceneApi

LINK_RANGE_DB = (-6.0, 12.0)
"""Range of the links' colours, dB, while no map has set one."""

_NULL = KIND_COLOURS["jammers"]
_OPEN_RAD = math.radians(110.0)  # of the pattern, towards the camera
_FAINT = 0.01  # gain over the largest: along an axis with more there is no null to point
_BEAM_RAD = math.asin(math.sqrt(_FAINT))  # half the angle within which a dipole has less
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
        self._has_null = self._turns = True

    def show(
        self,
        answer: Answer,
        text: str,
        size_m: float,
        link_range_db: tuple[float, float],
        eye_m: ArrayLike,
        *,
        pattern: bool,
    ) -> None:
        """Put the drone where an answer has it.

        Args:
            answer: pose and links.
            text: its label.
            size_m: of the scene, from which the drone's drawn size follows.
            link_range_db: ends of the links' colours, dB.
            eye_m: (3,) where the camera stands, towards which the pattern is open, metres.
            pattern: whether the radiation pattern is shown.
        """
        from viser.transforms import SO3

        result, pose = answer.result, answer.result.pose
        wanted = (result.scenario.antenna_record, size_m)
        if wanted != self._built:
            self.hide()
            self._built = wanted
            self._build(*wanted, pose, eye_m)
        parts, here = self._parts, pose.position_m
        parts["body"].position = here
        parts["body"].wxyz = SO3.from_rpy_radians(pose.roll_rad, pose.pitch_rad, pose.yaw_rad).wxyz
        parts["antenna"].wxyz = SO3.from_y_radians(pose.mount_rad).wxyz
        parts["pattern"].visible = pattern
        if self._turns:  # a pattern that is the same all round is turned to have its opening face the camera
            parts["pattern"].wxyz = SO3.from_z_radians(_azimuth_rad(pose, eye_m)).wxyz
        self._show_null(result, size_m)
        parts["label"].position = here + size_m * _LABEL_AT[self._slot]
        parts["label"].text = text
        nodes = result.scenario.node_positions_m
        ends = np.stack([np.broadcast_to(here, nodes.shape), nodes], axis=1)
        worst = np.array([link.node in answer.worst_nodes for link in result.links])
        colours = linear_colours(scale_colours([link.sinr_db for link in result.links], *link_range_db))
        lines = {
            "drop": np.array([[here, [*here[:2], 0.0]]]),
            "links": ends,
            "worst": ends[worst],
        }
        for name, segments in lines.items():
            parts[name].points = segments.astype(np.float32)
        parts["links"].colors = np.repeat(colours[:, None], 2, axis=1)
        parts["worst"].colors = np.repeat(colours[worst][:, None], 2, axis=1)

    def _show_null(self, result: Result, size_m: float) -> None:
        """Draw the null to the ground, the cone of little gain around it, and its angle to a jammer."""
        parts, pose = self._parts, result.pose
        ends = null_line_m(pose, 0.16 * size_m, most_m=1.5 * size_m)
        parts["null"].points = ends[None].astype(np.float32)
        parts["beam"].vertices = beam_mesh(pose.position_m, ends[1], _BEAM_RAD).vertices.astype(np.float32)
        angles = {
            one.name: math.degrees(null_angle_rad(pose, one.position_m)) for one in result.scenario.jammers
        }
        nearest = min(angles, key=lambda name: angles[name], default="")
        parts["angle"].text = f"null {fixed(angles[nearest], 1)}\u00b0 off {nearest}" if nearest else "null"
        parts["angle"].position = 0.35 * pose.position_m + 0.65 * ends[1]
        for name in ("null", "beam", "angle"):
            parts[name].visible = self._has_null and (name != "angle" or self._slot == 0)

    def hide(self) -> None:
        """Take the drone out of the scene."""
        self._scene.remove_by_name(self._name)
        self._built = None

    def _build(self, antenna: Antenna, size_m: float, pose: Pose, eye_m: ArrayLike) -> None:
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
        poles = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
        self._turns = not isinstance(antenna, PatternAntenna) or antenna.harmonics.is_axisymmetric
        self._has_null = self._turns and bool(np.all(relative_gain(antenna, poles) < _FAINT))
        towards_rad = 0.0 if self._turns else _azimuth_rad(pose, eye_m)
        self._add_pattern(frames["pattern"], antenna, 0.13 * size_m, towards_rad)
        beam = beam_mesh(np.zeros(3), [0.0, 0.0, -1.0], _BEAM_RAD)
        self._parts["beam"] = add_mesh(scene, f"{name}/beam", beam, _NULL, opacity=0.22, side="double")
        self._parts["angle"] = add_label(scene, f"{name}/angle", "", np.zeros(3), 0.9, "center-left")
        self._parts["label"] = add_label(scene, f"{name}/label", "", np.zeros(3), 1.0, _ANCHORS[slot])
        for line, (colour, thickness) in _LINES.items():
            self._parts[line] = add_lines(scene, f"{name}/{line}", np.zeros((1, 2, 3)), colour, thickness)

    def _add_pattern(self, name: str, antenna: Antenna, radius_m: float, towards_rad: float) -> None:
        """Draw the pattern: a surface that is open towards the camera, or wires for the second."""
        if self._slot == 1:
            wires, _ = pattern_mesh(antenna, radius_m, 18, 24)
            add_mesh(self._scene, f"{name}/wires", wires, SLOTS[1], wireframe=True)
            return
        surface, gain = pattern_mesh(antenna, radius_m, open_rad=_OPEN_RAD, towards_rad=towards_rad)
        add_coloured_mesh(self._scene, f"{name}/surface", surface, scale_colours(gain, 0.0, 1.0))


def _azimuth_rad(pose: Pose, eye_m: ArrayLike) -> float:
    """Return the azimuth, in the antenna's axes, of the way from the drone to the camera."""
    body = rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    antenna = rotation_world_from_body(0.0, pose.mount_rad, 0.0)
    x, y, _ = (body @ antenna).T @ np.subtract(eye_m, pose.position_m)
    return math.atan2(y, x)
