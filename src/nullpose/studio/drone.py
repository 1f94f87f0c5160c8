"""The drone in the scene: body, antenna, pattern, null and links."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import Antenna
from nullpose.physics import Pose, rotation_world_from_body
from nullpose.report.geometry import null_angle_rad
from nullpose.solver import Result
from nullpose.studio.answer import Answer
from nullpose.studio.colours import scale_colours
from nullpose.studio.drawing import add_coloured_mesh, add_label, add_lines, add_mesh, put
from nullpose.studio.links import Links
from nullpose.studio.look import LIGHT, Look
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

_OPEN_RAD = math.radians(110.0)  # of the pattern, towards the camera
_RINGS, _MOST_RINGS = 24, 60  # of the pattern from pole to pole: without a graphics card triangles take long
_FAINT = 0.01  # gain over the largest: along an axis with more there is no null to point
_BEAM_RAD = math.asin(math.sqrt(_FAINT))  # half the angle within which a dipole has less
_LABEL_AT = (np.array([0.0, 0.0, 0.17]), np.array([0.0, 0.14, 0.0]))  # above, and to the right
_ANCHORS = ("bottom-center", "center-left")


class Drone:
    """One case's drone with its pattern, null and links.

    Args:
        scene: the page's scene.
        slot: 0 for the chosen case, 1 for the compared one.
        look: the page's colours.
    """

    def __init__(self, scene: SceneApi, slot: int, look: Look = LIGHT) -> None:
        self._scene, self._slot, self._look = scene, slot, look
        self._name = f"/drone-{'ab'[slot]}"
        self._parts: dict[str, Any] = {}
        self._built: tuple[Antenna, float] | None = None
        self._pose: Pose | None = None

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
        self._pose = pose
        self.face(eye_m)
        self._show_null(result, size_m)
        put(parts["label"], text=text)
        parts["label"].position = here + size_m * _LABEL_AT[self._slot]
        parts["drop"].points = np.array([[here, [*here[:2], 0.0]]], dtype=np.float32)
        parts["links"].show(result, link_range_db)

    def face(self, eye_m: ArrayLike) -> None:
        """Turn the opening of a pattern that is the same all round towards the camera.

        Args:
            eye_m: (3,) where the camera stands, metres.
        """
        from viser.transforms import SO3

        if self._built is not None and self._pose is not None and _turns(self._built[0]):
            self._parts["pattern"].wxyz = SO3.from_z_radians(_azimuth_rad(self._pose, eye_m)).wxyz

    def _show_null(self, result: Result, size_m: float) -> None:
        """Draw the null to the ground, the cone of little gain around it, and its angle to a jammer."""
        parts, pose = self._parts, result.pose
        ends = null_line_m(pose, 0.16 * size_m, most_m=1.5 * size_m)
        parts["null"].points = ends[None].astype(np.float32)
        parts["beam"].vertices = beam_mesh(pose.position_m, ends[1], _BEAM_RAD).vertices.astype(np.float32)
        has_null = _has_null(result.scenario.antenna_record)
        for name, is_shown in (("null", True), ("beam", True), ("angle", self._slot == 0)):
            put(parts[name], visible=has_null and is_shown)
        angles = {
            one.name: math.degrees(null_angle_rad(pose, one.position_m)) for one in result.scenario.jammers
        }
        nearest = min(angles, key=lambda name: angles[name], default="")
        put(
            parts["angle"],
            text=f"null {angles[nearest]:z.1f}\u00b0 off {nearest}" if nearest else "null",
        )
        parts["angle"].position = 0.35 * pose.position_m + 0.65 * ends[1]

    def hide(self) -> None:
        """Take the drone out of the scene."""
        self._scene.remove_by_name(self._name)
        self._built = None

    def _build(self, antenna: Antenna, size_m: float, pose: Pose, eye_m: ArrayLike) -> None:
        scene, slot, name, look = self._scene, self._slot, self._name, self._look
        frames = {
            "body": f"{name}/body",
            "antenna": f"{name}/body/antenna",
            "pattern": f"{name}/body/antenna/pattern",
        }
        for part, place in frames.items():
            self._parts[part] = scene.add_frame(place, show_axes=False)
        arm_m = 0.055 * size_m
        add_mesh(scene, f"{name}/body/hull", body_mesh(arm_m), look.hulls[slot], flat_shading=True)
        add_mesh(scene, f"{name}/body/rotors", rotor_mesh(arm_m), look.slots[slot], opacity=0.45)
        add_mesh(scene, f"{name}/body/antenna/rod", rod_mesh(0.2 * size_m), look.null)
        towards_rad = 0.0 if _turns(antenna) else _azimuth_rad(pose, eye_m)
        self._add_pattern(frames["pattern"], antenna, 0.13 * size_m, towards_rad)
        beam = beam_mesh(np.zeros(3), [0.0, 0.0, -1.0], _BEAM_RAD)
        self._parts["beam"] = add_mesh(scene, f"{name}/beam", beam, look.null, opacity=0.3, side="back")
        lines: dict[str, tuple[ArrayLike, float]] = {"null": (look.null, 3.0), "drop": (look.drop, 1.2)}
        for line, (colour, width_px) in lines.items():
            self._parts[line] = add_lines(scene, f"{name}/{line}", np.zeros((1, 2, 3)), colour, width_px)
        for label, scale, anchor in (("label", 1.2, _ANCHORS[slot]), ("angle", 0.9, "center-left")):
            self._parts[label] = add_label(scene, f"{name}/{label}", "", np.zeros(3), scale, anchor)
        self._parts["links"] = Links(scene, name, look, size_m)

    def _add_pattern(self, name: str, antenna: Antenna, radius_m: float, towards_rad: float) -> None:
        """Draw the pattern: a surface that is open towards the camera, or wires for the second."""
        if self._slot == 1:
            wires, _ = pattern_mesh(antenna, radius_m, 18, 24)
            add_mesh(self._scene, f"{name}/wires", wires, self._look.slots[1], wireframe=True)
            return
        degree = antenna.harmonics.degree if not antenna.is_quadratic else 0
        rings = min(_MOST_RINGS, _RINGS + 3 * degree)  # more where it may have more lobes
        opened = {"open_rad": _OPEN_RAD, "towards_rad": towards_rad}
        surface, gain = pattern_mesh(antenna, radius_m, rings, 3 * rings // 2, **opened)
        add_coloured_mesh(self._scene, f"{name}/surface", surface, scale_colours(gain, 0.0, 1.0))


def _turns(antenna: Antenna) -> bool:
    """Return whether a pattern is the same all round."""
    return antenna.is_axisymmetric


def _has_null(antenna: Antenna) -> bool:
    """Return whether there is next to no gain along an antenna's axis, both ways."""
    poles = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    return _turns(antenna) and bool(np.all(relative_gain(antenna, poles) < _FAINT))


def _azimuth_rad(pose: Pose, eye_m: ArrayLike) -> float:
    """Return the azimuth, in the antenna's axes, of the way from the drone to the camera."""
    body = rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    antenna = rotation_world_from_body(0.0, pose.mount_rad, 0.0)
    x, y, _ = (body @ antenna).T @ np.subtract(eye_m, pose.position_m)
    return math.atan2(y, x)
