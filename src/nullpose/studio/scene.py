"""The scene of one page: what stands on the ground, where the drone may fly, and the drone."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario import GroundPoint, Scenario
from nullpose.studio.colours import KIND_COLOURS
from nullpose.studio.field_map import map_extent_m
from nullpose.studio.meshes import (
    Mesh,
    box_mesh,
    cone_mesh,
    diamond_mesh,
    ellipsoid_mesh,
    zone_mesh,
)
from nullpose.studio.view import PointKey, View

if TYPE_CHECKING:
    from viser import SceneApi

__all__ = ["GIZMOS", "Ground", "OnDrag", "add_mesh", "scene_size_m"]

OnDrag = Callable[[PointKey, NDArray[np.float64], str], None]

GIZMOS = "/points"
"""Where the handles of the ground points are in the scene's tree."""

_ZONE = (160, 60, 60)
_WIRE = (150, 150, 150)
_CROWD = 6  # more points than this have smaller labels
_AIRSPACE = (86, 150, 190)
_MARKS = {"nodes": box_mesh, "jammers": cone_mesh, "eavesdroppers": diamond_mesh}
_NICE_M = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4)
_FLAT = {"cast_shadow": False, "receive_shadow": False}


def scene_size_m(scenario: Scenario) -> float:
    """Return the larger side of the ground that the points take up with their margin, metres.

    Args:
        scenario: the scene.
    """
    low, high = map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))
    return float(np.max(high - low))


def add_mesh(scene: SceneApi, name: str, mesh: Mesh, colour: tuple[int, int, int], **style: Any) -> Any:
    """Return the handle of a mesh added to a scene, without shadows.

    Args:
        scene: the page's scene.
        name: its place in the scene's tree.
        mesh: vertices and triangles.
        colour: red, green, blue.
        style: more of what viser takes.
    """
    return scene.add_mesh_simple(
        name,
        mesh.vertices.astype(np.float32),
        mesh.faces.astype(np.uint32),
        color=colour,
        **_FLAT,
        **style,
    )


class Ground:
    """What a scenario states, drawn: grid, points with their handles, airspace, zones, fence, keep-outs.

    Args:
        scene: the page's scene.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points have no handles.
    """

    def __init__(self, scene: SceneApi, on_drag: OnDrag | None) -> None:
        self._scene, self._on_drag = scene, on_drag
        self._drawn: Scenario | None = None
        self._handles: dict[PointKey, Any] = {}
        self._around: list[Any] = []
        self._freed = False
        self.dragged: PointKey | None = None

    def show(self, view: View, *, freed: bool) -> None:
        """Draw a view: moves what is there, and draws anew what else has changed.

        Args:
            view: the view.
            freed: whether points can be dragged off their altitude.
        """
        scenario = view.scenario
        if self._drawn is not None and freed == self._freed and _same_but_for_places(self._drawn, scenario):
            self._move(view)
        else:
            self.draw(view, freed=freed)
        self._drawn = scenario

    def draw(self, view: View, *, freed: bool) -> None:
        """Draw everything anew.

        Args:
            view: the view.
            freed: whether points can be dragged off their altitude.
        """
        for handle in (*self._handles.values(), *self._around):
            handle.remove()
        self._handles, self._around = {}, []
        self._drawn, self._freed = view.scenario, freed
        size_m = scene_size_m(view.scenario)
        self._add_grid(view.scenario, size_m)
        self._add_airspace(view.scenario)
        crowd = sum(1 for _ in view.points())
        for key, point in view.points():
            self._add_point(key, point, size_m, view.scenario.airspace.keep_out_m, crowd)

    def _move(self, view: View) -> None:
        for key, point in view.points():
            handle = self._handles[key]
            if key != self.dragged and not np.allclose(handle.position, point.position_m, atol=1e-6):
                handle.position = point.position_m

    def _add_point(
        self, key: PointKey, point: GroundPoint, size_m: float, keep_out_m: float, crowd: int
    ) -> None:
        kind, index = key
        colour = KIND_COLOURS[kind]
        name = f"{GIZMOS}/{kind}-{index}"
        if self._on_drag is None:
            gizmo: Any = self._scene.add_frame(name, show_axes=False, position=point.position_m)
        else:
            gizmo = self._add_gizmo(key, name, point, size_m, self._on_drag)
        add_mesh(self._scene, f"{name}/mark", _MARKS[kind](0.022 * size_m), colour, flat_shading=True)
        # as wires: what is see-through below the map would be hidden by it
        keep_out = ellipsoid_mesh(keep_out_m * np.eye(3), 6, 10)
        add_mesh(self._scene, f"{name}/keep-out", keep_out, _WIRE, wireframe=True)
        matrix_m = getattr(point, "uncertainty_matrix_m", None)
        if matrix_m is not None and np.any(matrix_m):
            reach = ellipsoid_mesh(matrix_m, 10, 16)
            add_mesh(self._scene, f"{name}/uncertainty", reach, colour, wireframe=True)
        self._scene.add_label(
            f"{name}/label",
            point.name,
            position=(0.0, 0.0, 0.062 * size_m),
            anchor="bottom-center",
            font_screen_scale=1.1 if crowd <= _CROWD else 0.8,
        )

        self._handles[key] = gizmo

    def _add_gizmo(self, key: PointKey, name: str, point: GroundPoint, size_m: float, on_drag: OnDrag) -> Any:
        gizmo = self._scene.add_transform_controls(
            name,
            scale=0.1 * size_m,
            line_width=3.0,
            active_axes=(True, True, self._freed),
            disable_rotations=True,
            depth_test=False,
            opacity=0.75,
            position=point.position_m,
        )

        async def on_update(event: Any) -> None:
            position = np.array(event.target.position, dtype=float)
            if not self._freed:
                position[2] = point.position_m[2]
            on_drag(key, position, event.phase)

        gizmo.on_update(on_update)
        return gizmo

    def hold(self, key: PointKey) -> None:
        """Let one handle be dragged and take away the others', which only cost time meanwhile.

        Args:
            key: whose handle.
        """
        self.dragged = key
        self._show_arrows(lambda other: other == key)

    def let_go(self) -> None:
        """End a drag: every point has its handle again."""
        self.dragged = None
        self._show_arrows(lambda other: True)

    def _show_arrows(self, wanted: Callable[[PointKey], bool]) -> None:
        for key, handle in self._handles.items():
            handle.disable_axes = handle.disable_sliders = not wanted(key)

    def restore(self, view: View) -> None:
        """Put every handle back to where its point is.

        Args:
            view: the view now.
        """
        for key, point in view.points():
            self._handles[key].position = point.position_m

    def _add_grid(self, scenario: Scenario, size_m: float) -> None:
        low, high = map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))
        step_m = next((step for step in _NICE_M if size_m / step <= 12.0), size_m)
        low, high = step_m * np.floor(low / step_m), step_m * np.ceil(high / step_m)
        east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
        lines = [[[x, low[1], 0.0], [x, high[1], 0.0]] for x in east]
        lines += [[[low[0], y, 0.0], [high[0], y, 0.0]] for y in north]
        self._around.append(
            self._scene.add_line_segments(
                "/ground/grid",
                np.array(lines, dtype=np.float32),
                (190, 190, 190),
                thickness=1.2,
                thickness_units="screen",
            )
        )
        every = max(1, (max(len(east), len(north)) + 2) // 4)
        ticks = [
            (f"east-{i}", _signed(x), (x, low[1] - 0.45 * step_m))
            for i, x in enumerate(east)
            if i % every == 0
        ]
        ticks += [
            (f"north-{i}", _signed(y), (high[0] + 0.45 * step_m, y))
            for i, y in enumerate(north)
            if i % every == 0
        ]
        ticks += [
            ("east", "east (m)", (0.5 * (low[0] + high[0]), low[1] - 1.05 * step_m)),
            ("north", "north (m)", (high[0] + 1.3 * step_m, 0.5 * (low[1] + high[1]))),
        ]
        for name, text, (x, y) in ticks:
            self._around.append(
                self._scene.add_label(
                    f"/ground/{name}",
                    text,
                    position=(x, y, 0.0),
                    anchor="center-center",
                    font_screen_scale=0.8,
                )
            )

    def _add_airspace(self, scenario: Scenario) -> None:
        airspace = scenario.airspace
        low, high = map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))
        low, high = np.maximum(low, airspace.lower_m[:2]), np.minimum(high, airspace.upper_m[:2])
        floor_m, ceiling_m = float(airspace.lower_m[2]), float(airspace.upper_m[2])
        if airspace.geofence_m is not None:
            outline = airspace.geofence_outline_m
        else:
            outline = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
        self._around.append(self._outline("/airspace/edges", outline, floor_m, ceiling_m, _AIRSPACE))
        for i, zone in enumerate(airspace.no_fly):
            mesh = zone_mesh(zone, 0.0, ceiling_m)
            self._around.append(
                add_mesh(self._scene, f"/airspace/zone-{i}", mesh, _ZONE, opacity=0.3, side="double")
            )
            self._around.append(
                self._scene.add_label(
                    f"/airspace/zone-label-{i}",
                    f"no-fly {zone.name}",
                    position=(*mesh.vertices[:, :2].mean(axis=0), float(mesh.vertices[:, 2].max())),
                    anchor="bottom-center",
                    font_screen_scale=0.9,
                )
            )

    def _outline(
        self,
        name: str,
        outline: NDArray[np.float64],
        low_m: float,
        high_m: float,
        colour: tuple[int, int, int],
    ) -> Any:
        corners = [np.column_stack([outline, np.full(len(outline), z)]) for z in (low_m, high_m)]
        loops = [np.stack([corner, np.roll(corner, -1, axis=0)], axis=1) for corner in corners]
        posts = np.stack(corners, axis=1)
        return self._scene.add_line_segments(
            name,
            np.concatenate([*loops, posts]).astype(np.float32),
            colour,
            thickness=1.4,
            thickness_units="screen",
        )


def _signed(value: float) -> str:
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")


def _same_but_for_places(first: Scenario, second: Scenario) -> bool:
    """Return whether the same points, by name and uncertainty, stand under the same airspace."""
    if first.airspace != second.airspace:
        return False
    for kind in _MARKS:
        ours, theirs = getattr(first, kind), getattr(second, kind)
        if len(ours) != len(theirs):
            return False
        for one, other in zip(ours, theirs, strict=True):
            shape = (one.name, getattr(one, "uncertainty_m", None))
            if shape != (other.name, getattr(other, "uncertainty_m", None)):
                return False
    return True
