"""The drone in the scene: body, antenna, pattern, null, and the links to its nodes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import Antenna
from nullpose.physics import Pose, rotation_world_from_body
from nullpose.report.geometry import null_angle_rad
from nullpose.solver import Result
from nullpose.studio.answer import Answer
from nullpose.studio.drawing import add_coloured_mesh, add_label, add_lines, add_mesh, put
from nullpose.studio.look import LIGHT, Look, linear_colours, scale_colours
from nullpose.studio.meshes import (
    Mesh,
    beam_mesh,
    body_mesh,
    merged,
    null_line_m,
    pattern_mesh,
    relative_gain,
    revolved_mesh,
    rod_mesh,
    rotor_mesh,
)

if TYPE_CHECKING:
    from viser import SceneApi

_OPEN_RAD = math.radians(110.0)  # of the pattern, towards the camera
_RINGS, _MOST_RINGS = 24, 60  # of the pattern from pole to pole: without a graphics card triangles take long
_FAINT = 0.01  # gain over the largest: along an axis with more there is no null to point
_BEAM_RAD = math.asin(math.sqrt(_FAINT))  # half the angle within which a dipole has less
_LABEL_AT = (np.array([0.0, 0.0, 0.17]), np.array([0.0, 0.14, 0.0]))  # above, and to the right
_ANCHORS = ("bottom-center", "center-left")
_WIDTHS = (0.003, 0.005, 0.0075, 0.01)  # of links by the quarter of the colours' range, sizes of the scene
_OUTLINE = 0.0022  # beyond both sides of a link, sizes of the scene
_SIDES = 8  # of an outline
_NOWHERE = np.zeros((1, 2, 3))


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

    def render(
        self,
        answer: Answer,
        label: str,
        size_m: float,
        link_range_db: tuple[float, float],
        eye_m: ArrayLike,
        *,
        has_pattern: bool,
    ) -> None:
        """Put the drone at the pose of an answer.

        Args:
            answer: pose and links.
            label: the text above it.
            size_m: of the scene, from which the drone's drawn size follows.
            link_range_db: ends of the links' colours, dB.
            eye_m: (3,) where the camera stands, towards which the pattern is open, metres.
            has_pattern: whether the radiation pattern is shown.
        """
        from viser.transforms import SO3

        result, pose = answer.result, answer.result.pose
        if (result.scenario.antenna_record, size_m) != self._built:
            self.hide()
            self._build(result.scenario.antenna_record, size_m, pose, eye_m)
        parts, place_m = self._parts, pose.position_m
        parts["body"].position = place_m
        parts["body"].wxyz = SO3.from_rpy_radians(pose.roll_rad, pose.pitch_rad, pose.yaw_rad).wxyz
        parts["antenna"].wxyz = SO3.from_y_radians(pose.mount_rad).wxyz
        put(parts["pattern"], visible=has_pattern)
        self._pose = pose
        self.face(eye_m)
        put(parts["label"], text=label)
        parts["label"].position = place_m + size_m * _LABEL_AT[self._slot]
        parts["drop"].points = np.array([[place_m, [*place_m[:2], 0.0]]], dtype=np.float32)
        self._render_null(result, size_m)
        self._render_links(result, link_range_db, size_m)

    def face(self, eye_m: ArrayLike) -> None:
        """Turn the opening of an axisymmetric pattern towards the camera.

        Args:
            eye_m: (3,) where the camera stands, metres.
        """
        from viser.transforms import SO3

        if self._built is not None and self._pose is not None and self._built[0].is_axisymmetric:
            self._parts["pattern"].wxyz = SO3.from_z_radians(_azimuth_rad(self._pose, eye_m)).wxyz

    def hide(self) -> None:
        """Take the drone out of the scene."""
        if self._built is not None:
            self._scene.remove_by_name(self._name)
            self._built = None

    def _render_null(self, result: Result, size_m: float) -> None:
        """Draw the null to the ground, the cone of little gain around it, and its angle to a jammer."""
        parts, pose = self._parts, result.pose
        ends = null_line_m(pose, 0.16 * size_m, most_m=1.5 * size_m)
        parts["null"].points = ends[None].astype(np.float32)
        parts["beam"].vertices = beam_mesh(pose.position_m, ends[1], _BEAM_RAD).vertices.astype(np.float32)
        has_null = _has_null(result.scenario.antenna_record)
        for name, is_shown in (("null", True), ("beam", True), ("angle", self._slot == 0)):
            put(parts[name], visible=has_null and is_shown)
        angles = [
            (null_angle_rad(pose, jammer.position_m), jammer.name) for jammer in result.scenario.jammers
        ]
        angle_rad, name = min(angles, default=(0.0, ""))
        off = f" {math.degrees(angle_rad):z.1f}\u00b0 off {name}" if name else ""
        put(parts["angle"], text=f"null{off}")
        parts["angle"].position = 0.35 * pose.position_m + 0.65 * ends[1]

    def _render_links(self, result: Result, range_db: tuple[float, float], size_m: float) -> None:
        """Draw lines to the nodes, brighter and wider for a higher SINR, with an outline."""
        sinr_db = np.array([link.sinr_db for link in result.links])
        nodes = result.scenario.node_positions_m
        ends = np.stack([nodes, np.broadcast_to(result.pose.position_m, nodes.shape)], axis=1)
        colours = np.repeat(linear_colours(scale_colours(sinr_db, *range_db))[:, None], 2, axis=1)
        quarter = np.digitize(sinr_db, np.linspace(*range_db, len(_WIDTHS) + 1)[1:-1])
        for i in range(len(_WIDTHS)):
            links, chosen = self._parts[f"links-{i}"], quarter == i
            put(links, visible=bool(chosen.any()))
            if links.visible:
                links.points, links.colors = ends[chosen].astype(np.float32), colours[chosen]
        # one mesh, and no batch of instances: of those the browser misses a picture when their count changes
        tubes = _tubes(ends, size_m * (0.5 * np.array(_WIDTHS)[quarter] + _OUTLINE))
        outline = self._parts.get("outline")
        if outline is None or len(outline.faces) != len(
            tubes.faces
        ):  # far sides, seen beside the links inside
            name = f"{self._name}/links-outline"
            self._parts["outline"] = add_mesh(self._scene, name, tubes, self._look.outline, side="back")
        else:
            outline.vertices = tubes.vertices.astype(np.float32)

    def _build(self, antenna: Antenna, size_m: float, pose: Pose, eye_m: ArrayLike) -> None:
        scene, slot, name, look = self._scene, self._slot, self._name, self._look
        arm_m, body = 0.055 * size_m, f"{self._name}/body"
        frames = {"body": body, "antenna": f"{body}/antenna", "pattern": f"{body}/antenna/pattern"}
        parts = self._parts = {part: scene.add_frame(frames[part], show_axes=False) for part in frames}
        add_mesh(scene, f"{body}/hull", body_mesh(arm_m), look.hulls[slot], flat_shading=True)
        add_mesh(scene, f"{body}/rotors", rotor_mesh(arm_m), look.slots[slot], opacity=0.45)
        add_mesh(scene, f"{body}/antenna/rod", rod_mesh(0.2 * size_m), look.null)
        towards_rad = 0.0 if antenna.is_axisymmetric else _azimuth_rad(pose, eye_m)
        self._add_pattern(frames["pattern"], antenna, 0.13 * size_m, towards_rad)
        beam = beam_mesh(np.zeros(3), [0.0, 0.0, -1.0], _BEAM_RAD)
        parts["beam"] = add_mesh(scene, f"{name}/beam", beam, look.null, opacity=0.3, side="back")
        parts["null"] = add_lines(scene, f"{name}/null", _NOWHERE, look.null, 3.0)
        parts["drop"] = add_lines(scene, f"{name}/drop", _NOWHERE, look.drop, 1.2)
        parts["label"] = add_label(scene, f"{name}/label", "", np.zeros(3), 1.2, _ANCHORS[slot])
        parts["angle"] = add_label(scene, f"{name}/angle", "", np.zeros(3), 0.9, "center-left")
        for i, width in enumerate(_WIDTHS):
            lines = add_lines(scene, f"{name}/links-{i}", _NOWHERE, _NOWHERE, width * size_m, "world")
            parts[f"links-{i}"] = lines
        self._built = antenna, size_m

    def _add_pattern(self, name: str, antenna: Antenna, radius_m: float, towards_rad: float) -> None:
        """Draw the pattern: a surface that is open towards the camera, or wires for the second case."""
        if self._slot == 1:
            wires, _ = pattern_mesh(antenna, radius_m, 18, 24)
            add_mesh(self._scene, f"{name}/wires", wires, self._look.slots[1], wireframe=True)
            return
        degree = 0 if antenna.is_quadratic else antenna.harmonics.degree
        rings = min(_MOST_RINGS, _RINGS + 3 * degree)  # more where it may have more lobes
        surface, gain = pattern_mesh(
            antenna, radius_m, rings, 3 * rings // 2, open_rad=_OPEN_RAD, towards_rad=towards_rad
        )
        add_coloured_mesh(self._scene, f"{name}/surface", surface, scale_colours(gain, 0.0, 1.0))


def _tubes(ends_m: NDArray[np.float64], radius_m: NDArray[np.float64]) -> Mesh:
    """Build tubes around lines, (n, 2, 3), of radii, (n,), as one shape."""
    along = ends_m[:, 1] - ends_m[:, 0]
    sideways = np.where(np.abs(along[:, :1]) < np.abs(along[:, 1:2]), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    across = np.cross(along, sideways)
    across *= radius_m[:, None] / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    other = np.cross(along, across) / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    tube = revolved_mesh([1.0, 1.0], [0.0, 1.0], _SIDES)
    turned = tube.vertices @ np.stack([across, other, along], axis=1)
    starts = zip(turned, ends_m[:, 0], strict=True)
    return merged(Mesh(vertices + start, tube.faces) for vertices, start in starts)


def _has_null(antenna: Antenna) -> bool:
    """Tell whether an antenna has next to no gain along its axis, both ways."""
    poles = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    return antenna.is_axisymmetric and bool(np.all(relative_gain(antenna, poles) < _FAINT))


def _azimuth_rad(pose: Pose, eye_m: ArrayLike) -> float:
    """Return the azimuth, in the antenna's axes, of the direction from the drone to the camera."""
    body = rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    antenna = rotation_world_from_body(0.0, pose.mount_rad, 0.0)
    x, y, _ = (body @ antenna).T @ np.subtract(eye_m, pose.position_m)
    return math.atan2(y, x)
