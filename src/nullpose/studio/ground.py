"""A scenario in the scene of one page: grid, points with arrows on the selected one, airspace and zones."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import to_db
from nullpose.report.geometry import outline_m as zone_outline_m
from nullpose.report.numbers import MINUS
from nullpose.scenario import Eavesdropper, GroundPoint, Jammer, Scenario
from nullpose.studio.answer import signed
from nullpose.studio.drawing import add_label, add_lines, add_mesh, put
from nullpose.studio.look import LIGHT, Look, round_steps
from nullpose.studio.meshes import MARKS, ellipsoid_mesh, prism_edges, prism_mesh
from nullpose.studio.state import POWER_DB, Key, State
from nullpose.study.value_map import map_extent_m

if TYPE_CHECKING:
    from viser import SceneApi

FloatArray = NDArray[np.float64]
OnDrag = Callable[[Key, FloatArray, str], None]

_CROWD = 12  # of more nodes than this only the worst have their SINR in their labels
_RINGS = (0.4, 0.7, 1.0)  # around a jammer, sizes of the largest
_RING_LIFT_M = 0.1  # off the map on the ground
_RING_SIZES = (0.02, 0.12)  # of the largest at the ends of the range of powers, sizes of the scene
_SKETCH = (213, 94, 0)


def scene_size_m(scenario: Scenario) -> float:
    """Return the larger side of the ground that the points take up with their margin, metres."""
    low, high = _extent_m(scenario)
    return float(np.max(high - low))


def grid_m(scenario: Scenario) -> tuple[FloatArray, FloatArray, float]:
    """Return the low and the high corner, each (2,), of the grid on the ground, and its step, metres."""
    low, high = _extent_m(scenario)
    step_m = float(np.diff(round_steps(0.0, float(np.max(high - low)), 12))[0])
    return step_m * np.floor(low / step_m), step_m * np.ceil(high / step_m), step_m


def _extent_m(scenario: Scenario) -> tuple[FloatArray, FloatArray]:
    return map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))


class Ground:
    """A scenario, drawn.

    Args:
        scene: the page's scene.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points are not dragged.
        look: the page's colours.
    """

    def __init__(self, scene: SceneApi, on_drag: OnDrag | None, look: Look = LIGHT) -> None:
        self._scene, self._on_drag, self._look = scene, on_drag, look
        self._ground: object = None
        self._corners: object = ()
        self._points: dict[Key, GroundPoint] = {}
        self._drawn: dict[Key, object] = {}
        self._handles: dict[Key, dict[str, Any]] = {}

    def render(self, state: State, size_m: float) -> None:
        """Draw a state: move the points that are there, and draw anew what has changed otherwise.

        Args:
            state: of the page.
            size_m: of the scene, from which the sizes of what is drawn follow.
        """
        points = self._points = dict(state.points())
        # in whole steps, so that few steps of a drag change them
        corners_m = tuple(np.ravel(grid_m(state.scenario)[:2]).tolist())
        ground = (size_m, state.scenario.airspace, corners_m)
        if ground != self._ground:
            self._ground = ground
            self._draw_grid(state.scenario)
            self._draw_airspace(state.scenario)
        for gone in self._handles.keys() - points.keys():
            self._scene.remove_by_name(_name(gone))
            del self._handles[gone], self._drawn[gone]
        keep_out_m = state.scenario.airspace.keep_out_m
        for key, point in points.items():
            lifted = state.lifts_points if key == state.selected and self._on_drag is not None else None
            drawn = (getattr(point, "uncertainty_m", None), keep_out_m, size_m, lifted, key == state.selected)
            if drawn != self._drawn.get(key):
                self._drawn[key] = drawn
                self._draw_point(key, size_m, keep_out_m if key == state.selected else 0.0, lifted)
            handles = self._handles[key]
            if key != state.dragged:  # whose place the browser sets
                handles["frame"].position = point.position_m
            text, is_large = _label(key, point, state)
            put(handles["label"], text=text, font_screen_scale=1.1 if is_large else 0.9)
            if "rings" in handles:
                self._show_rings(handles["rings"], key, state, size_m)
        self._draw_corners(state, size_m)

    def _show_rings(self, rings: Any, key: Key, state: State, size_m: float) -> None:
        """Put a jammer's rings on the ground, the larger the more power it has over the nodes."""
        radius_m, powers_w = 0.0, state.scenario.jammer_powers_w
        if state.power_db is not None and powers_w[key[1]] > 0.0:
            power_db = state.power_db + to_db(powers_w[key[1]] / powers_w.max())
            radius_m = size_m * float(np.interp(power_db, POWER_DB, _RING_SIZES))
        put(rings, visible=radius_m > 0.0, scale=radius_m or 1.0)
        rings.position = 0.0, 0.0, _RING_LIFT_M - self._points[key].position_m[2]

    def _draw_point(self, key: Key, size_m: float, keep_out_m: float, lifted: bool | None) -> None:
        """Draw a point anew, with arrows unless ``lifted`` is None."""
        scene, name, colour, point = self._scene, _name(key), self._look.kinds[key[0]], self._points[key]
        scene.remove_by_name(name)
        handles = self._handles[key] = {"frame": self._frame(key, size_m, lifted)}
        add_mesh(scene, f"{name}/mark", MARKS[key[0]].placed(0.022 * size_m), colour, flat_shading=True)
        handles["label"] = add_label(scene, f"{name}/label", "", (0.0, 0.0, 0.062 * size_m))
        if keep_out_m > 0.0:  # wires: what is see-through below the map would be hidden by it
            keep_out = ellipsoid_mesh(keep_out_m * np.eye(3), 6, 10)
            add_mesh(scene, f"{name}/keep-out", keep_out, self._look.wire, wireframe=True)
        if isinstance(point, Jammer | Eavesdropper) and point.uncertainty_reach_m > 0.0:
            near = ellipsoid_mesh(point.uncertainty_matrix_m, 10, 16)
            add_mesh(scene, f"{name}/uncertainty", near, colour, wireframe=True)
        if key[0] == "jammers":
            rings = np.concatenate([radius * _circle() for radius in _RINGS])
            handles["rings"] = add_lines(scene, f"{name}/rings", rings, colour, 2.0)

    def _frame(self, key: Key, size_m: float, lifted: bool | None) -> Any:
        on_drag, position_m = self._on_drag, self._points[key].position_m
        if on_drag is None or lifted is None:
            return self._scene.add_frame(_name(key), show_axes=False, position=position_m)
        arrows = self._scene.add_transform_controls(
            _name(key),
            scale=0.1 * size_m,
            line_width=3.0,
            active_axes=(True, True, lifted),
            disable_rotations=True,
            depth_test=False,
            opacity=0.75,
            position=position_m,
        )

        async def on_update(event: Any) -> None:
            position = np.array(event.target.position, dtype=float)
            if not lifted:
                position[2] = self._points[key].position_m[2]
            on_drag(key, position, event.phase)

        arrows.on_update(on_update)
        return arrows

    def _draw_grid(self, scenario: Scenario) -> None:
        self._scene.remove_by_name("/ground")
        low, high, step_m = grid_m(scenario)
        east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
        lines = [[[x, low[1], 0.0], [x, high[1], 0.0]] for x in east]
        lines += [[[low[0], y, 0.0], [high[0], y, 0.0]] for y in north]
        add_lines(self._scene, "/ground/grid", lines, self._look.grid, 1.2)
        every = max(1, (max(len(east), len(north)) + 2) // 4)
        middle = 0.5 * (low + high)
        labels = [
            ("east (m)", middle[0], low[1] - 1.05 * step_m),
            ("north (m)", high[0] + 1.3 * step_m, middle[1]),
        ]
        labels += [(f"{x:g}", x, low[1] - 0.45 * step_m) for x in east[::every]]
        labels += [(f"{y:g}", high[0] + 0.45 * step_m, y) for y in north[::every]]
        for i, (text, x, y) in enumerate(labels):
            text = text.replace("-", MINUS)
            add_label(self._scene, f"/ground/tick-{i}", text, (x, y, 0.0), 0.8, "center-center")

    def _draw_airspace(self, scenario: Scenario) -> None:
        self._scene.remove_by_name("/airspace")
        airspace, colour = scenario.airspace, self._look.zone
        low, high, _ = grid_m(scenario)
        west, south = np.maximum(low, airspace.lower_m[:2])
        east, north = np.minimum(high, airspace.upper_m[:2])
        outline = np.array([[west, south], [east, south], [east, north], [west, north]])
        if airspace.geofence_m is not None:
            outline = airspace.geofence_outline_m
        floor_m, ceiling_m = float(airspace.lower_m[2]), float(airspace.upper_m[2])
        edges = prism_edges(outline, floor_m, ceiling_m)
        add_lines(self._scene, "/airspace/edges", edges, self._look.airspace, 1.4)
        for i, zone in enumerate(airspace.no_fly):
            low_m, high_m = max(0.0, zone.floor_m), max(0.0, zone.floor_m, min(ceiling_m, zone.ceiling_m))
            outline = zone_outline_m(zone)
            floor = prism_mesh(outline, low_m, low_m)
            top = (*floor.vertices[:, :2].mean(axis=0), high_m)
            add_mesh(self._scene, f"/airspace/zone-{i}", floor, colour, opacity=0.25)
            edges = prism_edges(outline, low_m, high_m)
            add_lines(self._scene, f"/airspace/zone-edges-{i}", edges, colour, 1.8)
            add_label(self._scene, f"/airspace/zone-label-{i}", f"no-fly {zone.name}", top)

    def _draw_corners(self, state: State, size_m: float) -> None:
        """Draw a fence as far as it is drawn by now."""
        if state.corners_m == self._corners:
            return
        self._corners = state.corners_m
        self._scene.remove_by_name("/sketch")
        if state.corners_m:
            points = np.insert(np.array(state.corners_m), 2, 0.003 * size_m, axis=1)
            first = points[0] + 0.012 * size_m * np.array([[[-1, 0, 0], [1, 0, 0]], [[0, -1, 0], [0, 1, 0]]])
            lines = np.concatenate([first, np.stack([points[:-1], points[1:]], axis=1)])
            add_lines(self._scene, "/sketch", lines, _SKETCH, 4.0)


def _label(key: Key, point: GroundPoint, state: State) -> tuple[str, bool]:
    """Return a point's name, for a node with its SINR, and whether it is written large."""
    answer = state.current(state.case)
    if answer is None or key[0] != "nodes":
        return point.name, key[0] == "jammers"
    nodes, worst = len(state.scenario.nodes), answer.worst_nodes
    is_worst = point.name in worst
    sinr = f" {signed(answer.result.links[key[1]].sinr_db)} dB" if is_worst or nodes <= _CROWD else ""
    return f"{point.name}{sinr}{', worst' if is_worst and len(worst) < nodes else ''}", is_worst


def _circle() -> FloatArray:
    """Return a circle of size one on the ground as segments, (n, 2, 3)."""
    azimuth = np.linspace(0.0, math.tau, 49)
    circle = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
    return np.stack([circle[:-1], circle[1:]], axis=1)


def _name(key: Key) -> str:
    kind, index = key
    return f"/points/{kind}-{index}"
