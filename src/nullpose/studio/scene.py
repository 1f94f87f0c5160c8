"""What a scenario states, in the scene of one page: points, grid, airspace and zones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.report.geometry import outline_m as zone_outline_m
from nullpose.report.numbers import MINUS
from nullpose.scenario import Eavesdropper, GroundPoint, Jammer, Scenario
from nullpose.studio.colours import KIND_COLOURS, round_steps
from nullpose.studio.drawing import add_label, add_lines, add_mesh
from nullpose.studio.meshes import MARKS, ellipsoid_mesh, prism_edges, zone_mesh
from nullpose.studio.view import Key, View
from nullpose.study.value_map import map_extent_m

if TYPE_CHECKING:
    from viser import SceneApi

FloatArray = NDArray[np.float64]
OnDrag = Callable[[Key, FloatArray, str], None]

_ZONE = (160, 60, 60)
_WIRE = (150, 150, 150)
_GRID = (190, 190, 190)
_AIRSPACE = (86, 150, 190)
_CROWD = 6  # more points than this have smaller labels


def scene_size_m(scenario: Scenario) -> float:
    """Return the larger side of the ground that the points take up with their margin, metres.

    Args:
        scenario: the scene.
    """
    low, high = _extent_m(scenario)
    return float(np.max(high - low))


def _extent_m(scenario: Scenario) -> tuple[FloatArray, FloatArray]:
    return map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))


class Ground:
    """What a scenario states, drawn: grid, points, arrows on one of them, airspace, zones, fence, keep-outs.

    Args:
        scene: the page's scene.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points are not dragged.

    Attributes:
        dragged: the point that is being dragged, whose place the browser sets; or None.
    """

    def __init__(self, scene: SceneApi, on_drag: OnDrag | None) -> None:
        self._scene, self._on_drag = scene, on_drag
        self._ground: object = None
        self._points: dict[Key, GroundPoint] = {}
        self._drawn: dict[Key, object] = {}
        self._handles: dict[Key, Any] = {}
        self.dragged: Key | None = None

    def show(self, view: View, size_m: float, *, selected: Key | None = None, freed: bool = False) -> None:
        """Draw a view: moves the points that are there, and draws anew what has changed otherwise.

        Args:
            view: the view.
            size_m: of the scene, from which the sizes of what is drawn follow.
            selected: the point that has arrows to drag it by, or None.
            freed: whether it can be dragged off its altitude.
        """
        points = self._points = dict(view.points())
        ground = (size_m, view.scenario.airspace, tuple(points))
        if ground != self._ground:
            self._ground = ground
            self._draw_ground(view.scenario)
        for gone in self._handles.keys() - points.keys():
            self._scene.remove_by_name(_name(gone))
            del self._handles[gone], self._drawn[gone]
        keep_out_m, scale = view.scenario.airspace.keep_out_m, 1.1 if len(points) <= _CROWD else 0.8
        for key, point in points.items():
            look = (point.name, getattr(point, "uncertainty_m", None), keep_out_m, size_m, scale)
            drawn = (look, freed if key == selected else None)
            if drawn != self._drawn.get(key):
                self._drawn[key] = drawn
                self._handles[key] = self._handle(key, size_m, drawn[1])
                self._draw_point(key, size_m, keep_out_m, scale)
            handle = self._handles[key]
            if key != self.dragged and not np.allclose(handle.position, point.position_m, atol=1e-6):
                handle.position = point.position_m

    def _draw_ground(self, scenario: Scenario) -> None:
        for part in ("/ground", "/airspace"):
            self._scene.remove_by_name(part)
        self._draw_grid(scenario)
        self._draw_airspace(scenario)

    def _draw_point(self, key: Key, size_m: float, keep_out_m: float, scale: float) -> None:
        name, colour, point = _name(key), KIND_COLOURS[key[0]], self._points[key]
        mark = MARKS[key[0]].placed(0.022 * size_m)
        add_mesh(self._scene, f"{name}/mark", mark, colour, flat_shading=True)
        # wires: what is see-through below the map would be hidden by it
        keep_out = ellipsoid_mesh(keep_out_m * np.eye(3), 6, 10)
        add_mesh(self._scene, f"{name}/keep-out", keep_out, _WIRE, wireframe=True)
        if isinstance(point, Jammer | Eavesdropper) and point.uncertainty_reach_m > 0.0:
            near = ellipsoid_mesh(point.uncertainty_matrix_m, 10, 16)
            add_mesh(self._scene, f"{name}/uncertainty", near, colour, wireframe=True)
        add_label(self._scene, f"{name}/label", point.name, (0.0, 0.0, 0.062 * size_m), scale)

    def _handle(self, key: Key, size_m: float, freed: bool | None) -> Any:
        """Return the frame of a point, in place of the one before; with arrows unless freed is None."""
        self._scene.remove_by_name(_name(key))
        on_drag, position_m = self._on_drag, self._points[key].position_m
        if on_drag is None or freed is None:
            return self._scene.add_frame(_name(key), show_axes=False, position=position_m)
        arrows = self._scene.add_transform_controls(
            _name(key),
            scale=0.1 * size_m,
            line_width=3.0,
            active_axes=(True, True, freed),
            disable_rotations=True,
            depth_test=False,
            opacity=0.75,
            position=position_m,
        )

        async def on_update(event: Any) -> None:
            position = np.array(event.target.position, dtype=float)
            if not freed:
                position[2] = self._points[key].position_m[2]
            on_drag(key, position, event.phase)

        arrows.on_update(on_update)
        return arrows

    def _draw_grid(self, scenario: Scenario) -> None:
        low, high = _extent_m(scenario)
        step_m = np.diff(round_steps(0.0, float(np.max(high - low)), 12))[0]
        low, high = step_m * np.floor(low / step_m), step_m * np.ceil(high / step_m)
        east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
        lines = [[[x, low[1], 0.0], [x, high[1], 0.0]] for x in east]
        lines += [[[low[0], y, 0.0], [high[0], y, 0.0]] for y in north]
        add_lines(self._scene, "/ground/grid", lines, _GRID, 1.2)
        every = max(1, (max(len(east), len(north)) + 2) // 4)
        middle = 0.5 * (low + high)
        ticks = [
            ("east (m)", middle[0], low[1] - 1.05 * step_m),
            ("north (m)", high[0] + 1.3 * step_m, middle[1]),
        ]
        ticks += [(f"{x:g}", x, low[1] - 0.45 * step_m) for x in east[::every]]
        ticks += [(f"{y:g}", high[0] + 0.45 * step_m, y) for y in north[::every]]
        for i, (text, x, y) in enumerate(ticks):
            text = text.replace("-", MINUS)
            add_label(self._scene, f"/ground/tick-{i}", text, (x, y, 0.0), 0.8, "center-center")

    def _draw_airspace(self, scenario: Scenario) -> None:
        airspace = scenario.airspace
        low, high = _extent_m(scenario)
        west, south = np.maximum(low, airspace.lower_m[:2])
        east, north = np.minimum(high, airspace.upper_m[:2])
        outline = np.array([[west, south], [east, south], [east, north], [west, north]])
        if airspace.geofence_m is not None:
            outline = airspace.geofence_outline_m
        floor_m, ceiling_m = float(airspace.lower_m[2]), float(airspace.upper_m[2])
        add_lines(self._scene, "/airspace/edges", prism_edges(outline, floor_m, ceiling_m), _AIRSPACE, 1.4)
        for i, zone in enumerate(airspace.no_fly):
            low_m, high_m = max(0.0, zone.floor_m), max(0.0, zone.floor_m, min(ceiling_m, zone.ceiling_m))
            floor = zone_mesh(zone, low_m, low_m)
            top = (*floor.vertices[:, :2].mean(axis=0), high_m)
            add_mesh(self._scene, f"/airspace/zone-{i}", floor, _ZONE, opacity=0.25)
            edges = prism_edges(zone_outline_m(zone), low_m, high_m)
            add_lines(self._scene, f"/airspace/zone-edges-{i}", edges, _ZONE, 1.8)
            add_label(self._scene, f"/airspace/zone-label-{i}", f"no-fly {zone.name}", top, 0.9)


def _name(key: Key) -> str:
    kind, index = key
    return f"/points/{kind}-{index}"
