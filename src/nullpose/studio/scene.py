"""What a scenario states, in the scene of one page: points, grid, airspace and zones."""

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
from nullpose.studio.answer import Answer, signed
from nullpose.studio.colours import round_steps
from nullpose.studio.drawing import add_label, add_lines, add_mesh, put
from nullpose.studio.look import LIGHT, Look
from nullpose.studio.meshes import MARKS, ellipsoid_mesh, prism_edges, prism_mesh
from nullpose.studio.view import POWER_DB, Key, View
from nullpose.study.value_map import map_extent_m

if TYPE_CHECKING:
    from viser import SceneApi

FloatArray = NDArray[np.float64]
OnDrag = Callable[[Key, FloatArray, str], None]

_CROWD = 12  # of more nodes than this only the worst have their SINR in their labels
_RINGS = (0.4, 0.7, 1.0)  # around a jammer, sizes of the largest
_RING_LIFT_M = 0.1  # off the map on the ground
_RING_SIZES = (0.02, 0.12)  # of the largest at the ends of the range of powers, sizes of the scene


def scene_size_m(scenario: Scenario) -> float:
    """Return the larger side of the ground that the points take up with their margin, metres.

    Args:
        scenario: the scene.
    """
    low, high = ground_m(scenario)
    return float(np.max(high - low))


def ground_m(scenario: Scenario) -> tuple[FloatArray, FloatArray]:
    """Return the low and the high corner, each (2,) in metres, of the ground that is drawn.

    Args:
        scenario: the scene.
    """
    return map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))


def grid_m(scenario: Scenario) -> tuple[FloatArray, FloatArray, float]:
    """Return the low and the high corner, each (2,), of the grid on the ground, and its step, metres.

    Args:
        scenario: the scene.
    """
    low, high = ground_m(scenario)
    step_m = float(np.diff(round_steps(0.0, float(np.max(high - low)), 12))[0])
    return step_m * np.floor(low / step_m), step_m * np.ceil(high / step_m), step_m


def axis_texts(scenario: Scenario) -> list[tuple[str, float, float]]:
    """Return the numbers and the titles beside the grid: each text, and its east and north, metres.

    Args:
        scenario: the scene.
    """
    (west, south), (east, north), step_m = grid_m(scenario)
    ways = [np.arange(low, high + 0.5 * step_m, step_m) for low, high in ((west, east), (south, north))]
    every = max(1, (max(map(len, ways)) + 2) // 4)
    titles = [
        ("east (m)", 0.5 * (west + east), south - 1.05 * step_m),
        ("north (m)", east + 1.3 * step_m, 0.5 * (south + north)),
    ]
    below = [(f"{x:g}", float(x), south - 0.45 * step_m) for x in ways[0][::every]]
    beside = [(f"{y:g}", east + 0.45 * step_m, float(y)) for y in ways[1][::every]]
    return [*titles, *below, *beside]


class Ground:
    """What a scenario states, drawn: grid, points, arrows on one of them, airspace, zones, fence, keep-outs.

    Args:
        scene: the page's scene.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points are not dragged.
        look: the page's colours.

    Attributes:
        dragged: the point that is being dragged, whose place the browser sets; or None.
    """

    def __init__(self, scene: SceneApi, on_drag: OnDrag | None, look: Look = LIGHT) -> None:
        self._scene, self._on_drag, self._look = scene, on_drag, look
        self._ground: object = None
        self._points: dict[Key, GroundPoint] = {}
        self._drawn: dict[Key, object] = {}
        self._handles: dict[Key, Any] = {}
        self._rings: dict[Key, Any] = {}
        self._labels: dict[Key, Any] = {}
        self.dragged: Key | None = None

    def show(
        self,
        view: View,
        answer: Answer | None,
        size_m: float,
        *,
        selected: Key | None = None,
        freed: bool = False,
    ) -> None:
        """Draw a view: moves the points that are there, and draws anew what has changed otherwise.

        Args:
            view: the view.
            answer: to the present scene, whose SINRs are in the nodes' labels; None if there is none yet.
            size_m: of the scene, from which the sizes of what is drawn follow.
            selected: the point that has arrows to drag it by, or None.
            freed: whether it can be dragged off its altitude.
        """
        points = self._points = dict(view.points())
        # in whole steps, so that few steps of a drag change them
        corners_m = tuple(np.ravel(grid_m(view.scenario)[:2]).tolist())
        ground = (size_m, view.scenario.airspace, tuple(points), corners_m)
        if ground != self._ground:
            self._ground = ground
            for part in ("/ground", "/airspace"):
                self._scene.remove_by_name(part)
            self._draw_grid(view.scenario)
            self._draw_airspace(view.scenario)
        for gone in self._handles.keys() - points.keys():
            self._remove(gone)
            del self._handles[gone], self._drawn[gone]
        keep_out_m = view.scenario.airspace.keep_out_m
        for key, point in points.items():
            look = (point.name, getattr(point, "uncertainty_m", None), keep_out_m, size_m)
            drawn = (look, freed if key == selected else None)
            if drawn != self._drawn.get(key):
                self._drawn[key] = drawn
                self._handles[key] = self._handle(key, size_m, drawn[1])
                self._draw_point(key, size_m, keep_out_m if key == selected else 0.0)
            handle = self._handles[key]
            if key != self.dragged:
                handle.position = point.position_m
            self._label(key, point, view, answer)
            if key in self._rings:
                self._show_rings(key, view, size_m)

    def _label(self, key: Key, point: GroundPoint, view: View, answer: Answer | None) -> None:
        """Write a point's name over it, and a node's SINR."""
        text, is_worst = point.name, False
        if answer is not None and key[0] == "nodes":
            nodes, worst = len(view.scenario.nodes), answer.worst_nodes
            is_worst = point.name in worst
            if is_worst or nodes <= _CROWD:
                text += f" {signed(answer.result.links[key[1]].sinr_db)} dB"
            if is_worst and len(worst) < nodes:
                text += ", worst"
        scale = 1.1 if is_worst or key[0] == "jammers" else 0.9
        put(self._labels[key], text=text, font_screen_scale=scale)

    def _show_rings(self, key: Key, view: View, size_m: float) -> None:
        """Put a jammer's rings on the ground, the larger the more power it has over the nodes."""
        rings, radius_m = self._rings[key], 0.0
        powers_w = view.scenario.jammer_powers_w
        if view.power_db is not None and powers_w[key[1]] > 0.0:
            power_db = view.power_db + to_db(powers_w[key[1]] / powers_w.max())
            radius_m = size_m * float(np.interp(power_db, POWER_DB, _RING_SIZES))
        put(rings, visible=radius_m > 0.0, scale=radius_m or 1.0)
        rings.position = 0.0, 0.0, _RING_LIFT_M - self._points[key].position_m[2]

    def _draw_point(self, key: Key, size_m: float, keep_out_m: float) -> None:
        name, colour, point = _name(key), self._look.kinds[key[0]], self._points[key]
        mark = MARKS[key[0]].placed(0.022 * size_m)
        add_mesh(self._scene, f"{name}/mark", mark, colour, flat_shading=True)
        self._labels[key] = add_label(self._scene, f"{name}/label", "", (0.0, 0.0, 0.062 * size_m))
        if keep_out_m > 0.0:  # wires: what is see-through below the map would be hidden by it
            keep_out = ellipsoid_mesh(keep_out_m * np.eye(3), 6, 10)
            add_mesh(self._scene, f"{name}/keep-out", keep_out, self._look.wire, wireframe=True)
        if isinstance(point, Jammer | Eavesdropper) and point.uncertainty_reach_m > 0.0:
            near = ellipsoid_mesh(point.uncertainty_matrix_m, 10, 16)
            add_mesh(self._scene, f"{name}/uncertainty", near, colour, wireframe=True)
        if key[0] == "jammers":
            rings = np.concatenate([radius * _circle() for radius in _RINGS])
            self._rings[key] = add_lines(self._scene, f"{name}/rings", rings, colour, 2.0)

    def _handle(self, key: Key, size_m: float, freed: bool | None) -> Any:
        """Return the frame of a point, in place of the one before; with arrows unless freed is None."""
        self._remove(key)
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

    def _remove(self, key: Key) -> None:
        """Take a point with all that is drawn of it out of the scene."""
        self._scene.remove_by_name(_name(key))
        self._rings.pop(key, None)
        self._labels.pop(key, None)

    def _draw_grid(self, scenario: Scenario) -> None:
        low, high, step_m = grid_m(scenario)
        east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
        lines = [[[x, low[1], 0.0], [x, high[1], 0.0]] for x in east]
        lines += [[[low[0], y, 0.0], [high[0], y, 0.0]] for y in north]
        add_lines(self._scene, "/ground/grid", lines, self._look.grid, 1.2)
        for i, (text, x, y) in enumerate(axis_texts(scenario)):
            name, place_m = f"/ground/tick-{i}", (x, y, 0.0)
            text = text.replace("-", MINUS)
            add_label(self._scene, name, text, place_m, 0.8, "center-center")

    def _draw_airspace(self, scenario: Scenario) -> None:
        airspace = scenario.airspace
        low, high, _ = grid_m(scenario)
        west, south = np.maximum(low, airspace.lower_m[:2])
        east, north = np.minimum(high, airspace.upper_m[:2])
        outline = np.array([[west, south], [east, south], [east, north], [west, north]])
        if airspace.geofence_m is not None:
            outline = airspace.geofence_outline_m
        floor_m, ceiling_m = float(airspace.lower_m[2]), float(airspace.upper_m[2])
        edges = prism_edges(outline, floor_m, ceiling_m)
        add_lines(self._scene, "/airspace/edges", edges, self._look.airspace, 1.4)
        colour = self._look.zone
        for i, zone in enumerate(airspace.no_fly):
            low_m, high_m = max(0.0, zone.floor_m), max(0.0, zone.floor_m, min(ceiling_m, zone.ceiling_m))
            outline = zone_outline_m(zone)
            floor = prism_mesh(outline, low_m, low_m)
            top = (*floor.vertices[:, :2].mean(axis=0), high_m)
            add_mesh(self._scene, f"/airspace/zone-{i}", floor, colour, opacity=0.25)
            edges = prism_edges(outline, low_m, high_m)
            add_lines(self._scene, f"/airspace/zone-edges-{i}", edges, colour, 1.8)
            add_label(self._scene, f"/airspace/zone-label-{i}", f"no-fly {zone.name}", top)


def _circle() -> FloatArray:
    """Return a circle of size one on the ground as segments, (n, 2, 3)."""
    azimuth = np.linspace(0.0, math.tau, 49)
    circle = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
    return np.stack([circle[:-1], circle[1:]], axis=1)


def _name(key: Key) -> str:
    kind, index = key
    return f"/points/{kind}-{index}"
