"""A scenario in the scene of one page: grid, points, airspace, zones, buildings and their shadows."""

from __future__ import annotations

import math
from functools import lru_cache
from math import sqrt

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.report.geometry import outline_m as zone_outline_m, shadow_outlines_m
from nullpose.report.numbers import MINUS
from nullpose.scenario import Building, Eavesdropper, GroundPoint, Jammer, Scenario
from nullpose.studio.answer import Answer, signed
from nullpose.studio.drawing import (
    MARKS,
    Shape,
    Shapes,
    frame,
    label,
    level_mesh,
    lines,
    merged,
    mesh,
    prism_edges,
    prism_mesh,
    sphere_mesh,
)
from nullpose.studio.look import Look, Rgb, round_steps
from nullpose.studio.state import KINDS, POWER_DB, Key, State
from nullpose.study.value_map import map_extent_m

CROWD = 4  # with more nodes than this only the worst, the selected and the point pointed at have labels
_LABELS = ((0.0, 0.0, 0.062), "bottom-center"), ((0.0, 0.035, 0.0), "center-left")
"""Where a point has its name, sizes of the scene; a jammer's is beside it, clear of nodes' above."""
_RINGS = np.array([0.4, 0.7, 1.0])  # around a jammer, sizes of the largest
_RING_LIFT_M = 0.1  # off the map on the ground
_RING_SIZES = (0.02, 0.12)  # of the largest at the ends of the range of powers, sizes of the scene
_CROSS = np.array([[[-1, 0, 0], [1, 0, 0]], [[0, -1, 0], [0, 1, 0]]])


def scene_size_m(scenario: Scenario) -> float:
    """Return the larger side of the ground that the points take up with their margin, metres."""
    return float(np.max(np.ptp(map_extent_m(scenario, scenario.node_positions_m.mean(axis=0)), axis=0)))


def grid_m(scenario: Scenario) -> tuple[FloatArray, FloatArray, float]:
    """Return the low and the high corner, each (2,), of the grid on the ground, and its step, metres."""
    low, high = map_extent_m(scenario, scenario.node_positions_m.mean(axis=0))
    step_m = float(np.diff(round_steps(0.0, float(np.max(high - low)), 12))[0])
    return step_m * np.floor(low / step_m), step_m * np.ceil(high / step_m), step_m


def airspace_outline_m(scenario: Scenario) -> FloatArray:
    """Return the corners, (n, 2), of the fence that is drawn, or of the airspace over the grid, metres."""
    if scenario.airspace.geofence_m is not None:
        return scenario.airspace.geofence_outline_m
    return np.asarray(shapely.get_coordinates(shapely.box(*flight_box_m(scenario).ravel()))[:-1])


def flight_box_m(scenario: Scenario) -> FloatArray:
    """Return the low and the high corner, (2, 2), of the airspace that is drawn, metres."""
    (low, high, _), airspace = grid_m(scenario), scenario.airspace
    return np.stack([np.maximum(low, airspace.lower_m[:2]), np.minimum(high, airspace.upper_m[:2])])


def ground_shapes(state: State, size_m: float, look: Look) -> Shapes:
    """Draw a scene: grid, airspace, buildings and points, and what is fenced in or measured by now.

    Args:
        state: of the page.
        size_m: of the scene, from which the sizes of what is drawn follow.
        look: the page's colours.
    """
    shapes = _grid(state.scenario, look) | _airspace(state.scenario, look)
    shapes |= _buildings(state.scenario.buildings, look.colours["building"])
    for key, point in state.points():
        shapes |= _point(key, point, state, size_m, look)
    if state.corners_m:
        corners = np.insert(np.array(state.corners_m), 2, 0.003 * size_m, axis=1)
        first = corners[0] + 0.012 * size_m * _CROSS
        sides = np.stack([corners[:-1], corners[1:]], axis=1)
        shapes["/sketch"] = lines(np.concatenate([first, sides]), look.colours["sketch"], 4.0)
        for i, (start, end) in enumerate(sides):
            shapes[f"/sketch/side-{i}"] = label(
                f"{np.linalg.norm(end - start):.1f} m", 0.5 * (start + end), 0.9, "center-center"
            )
    return shapes


def _point(key: Key, point: GroundPoint, state: State, size_m: float, look: Look) -> Shapes:
    kind, is_selected = key[0], key == state.selected
    name, colour = f"/points/{kind}-{key[1]}", look.colours[kind]
    keep_out_m = state.scenario.airspace.keep_out_m
    text, is_large = _label(key, point, state)
    shapes = {
        name: frame(point.position_m),
        f"{name}/mark": mesh(MARKS[kind], colour, flat_shading=True, scale=0.022 * size_m)._replace(key=key),
    }
    if text:
        at, anchor = _LABELS[kind == "jammers"]
        shapes[f"{name}/label"] = label(text, size_m * np.array(at), 1.1 if is_large else 0.9, anchor)
    if is_selected or key == state.pointed:
        halo = np.add(_circle(0.03 * size_m), [0.0, 0.0, 0.01 * size_m])
        shapes[f"{name}/halo"] = lines(halo, look.colours["outline"], 5.0 if is_selected else 2.5)
    if keep_out_m > 0.0 and is_selected:  # wires: what is see-through below the map would be hidden by it
        shapes[f"{name}/keep-out"] = mesh(
            sphere_mesh(6, 10), look.colours["wire"], wireframe=True, scale=keep_out_m
        )
    if isinstance(point, Jammer | Eavesdropper) and point.uncertainty_reach_m > 0.0:
        shapes[f"{name}/uncertainty"] = mesh(
            sphere_mesh(10, 16), colour, wireframe=True, scale=point.uncertainty_reach_m
        )
    if kind == "jammers" and (radius_m := _ring_radius_m(key, state, size_m)) > 0.0:
        rings = _circle(radius_m) * _RINGS[:, None, None, None]
        rings[..., 2] = _RING_LIFT_M - point.position_m[2]
        shapes[f"{name}/rings"] = lines(rings.reshape(-1, 2, 3), colour, 2.0)
    return shapes


def _circle(radius_m: float) -> FloatArray:
    azimuth = np.linspace(0.0, math.tau, 49)
    circle = radius_m * np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
    return np.stack([circle[:-1], circle[1:]], axis=1)


def _ring_radius_m(key: Key, state: State, size_m: float) -> float:
    """Return the radius of a jammer's largest ring: the larger the more power it has over the nodes."""
    powers_w = state.scenario.jammer_powers_w
    if state.power_db is None or powers_w[key[1]] <= 0.0:
        return 0.0
    return size_m * float(
        np.interp(state.power_db + to_db(powers_w[key[1]] / powers_w.max()), POWER_DB, _RING_SIZES)
    )


def ticks_m(scenario: Scenario) -> list[tuple[str, float, float]]:
    """Return the numbers at the grid and the names of its axes, each with its place, metres."""
    low, high, step_m = grid_m(scenario)
    middle, near_m, far_m = 0.5 * (low + high), 0.45 * step_m, 1.2 * step_m
    east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
    every = max(1, (max(len(east), len(north)) + 2) // 4)
    return [
        ("east (m)", middle[0], low[1] - far_m),
        ("north (m)", high[0] + far_m, middle[1]),
        *((f"{x:g}", x, low[1] - near_m) for x in east[::every]),
        *(
            (f"{y:g}", high[0] + near_m, y) for y in north[::every][1:]
        ),  # the first would touch the last of the others
    ]


def _grid(scenario: Scenario, look: Look) -> Shapes:
    low, high, step_m = grid_m(scenario)
    east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low, high, strict=True))
    segments = [
        *([[x, low[1], 0.0], [x, high[1], 0.0]] for x in east),
        *([[low[0], y, 0.0], [high[0], y, 0.0]] for y in north),
    ]
    return {
        f"/ground/tick-{i}": label(text.replace("-", MINUS), (x, y, 0.0), 0.8, "center-center")
        for i, (text, x, y) in enumerate(ticks_m(scenario))
    } | {"/ground/grid": lines(segments, look.colours["grid"], 1.2)}


def _airspace(scenario: Scenario, look: Look) -> Shapes:
    airspace, outline = scenario.airspace, airspace_outline_m(scenario)
    floor_m, ceiling_m = float(airspace.lower_m[2]), float(airspace.upper_m[2])
    shapes = {
        "/airspace/edges": lines(prism_edges(outline, floor_m, ceiling_m), look.colours["airspace"], 1.4)
    }
    for i, zone in enumerate(airspace.no_fly):
        low_m, high_m = max(0.0, zone.floor_m), max(0.0, zone.floor_m, min(ceiling_m, zone.ceiling_m))
        outline, name, colour = zone_outline_m(zone), f"/airspace/zone-{i}", look.colours["zone"]
        shapes |= {
            f"{name}/floor": mesh(
                level_mesh(shapely.Polygon(outline), low_m), colour, opacity=0.25, side="double"
            ),
            f"{name}/edges": lines(prism_edges(outline, low_m, high_m), colour, 1.8),
            f"{name}/label": label(f"no-fly {zone.name}", (*outline.mean(axis=0), high_m)),
        }
    return shapes


@lru_cache(4)
def _buildings(buildings: tuple[Building, ...], colour: Rgb) -> Shapes:
    """Draw all buildings as one, at their highest."""
    solids, edges = [], []
    for each in buildings:
        ends = max(0.0, each.floor_m), max(0.0, each.heights_m[1])
        solids.append(prism_mesh(shapely.Polygon(each.outline_m, each.courtyard_outlines_m), *ends))
        edges += [prism_edges(ring, *ends) for ring in (each.outline_m, *each.courtyard_outlines_m)]
    if not solids:
        return {}
    return {
        "/buildings/bodies": mesh(merged(solids), colour, opacity=0.45, side="double", flat_shading=True),
        "/buildings/edges": lines(np.concatenate(edges), colour, 1.4),
    }


def _label(key: Key, point: GroundPoint, state: State) -> tuple[str, bool]:
    """Return a point's name, for a node with its SINR, and whether it is written large."""
    answer = state.current(state.case) if key[0] == "nodes" else None
    nodes, worst = len(state.scenario.nodes), frozenset() if answer is None else answer.worst_nodes
    is_roomy, is_worst = nodes <= CROWD, point.name in worst
    if not (is_roomy or is_worst or key in (state.selected, state.pointed)):
        return "", False
    sinr = "" if answer is None else f" {signed(answer.result.links[key[1]].sinr_db)} dB"
    note = ", worst" if is_roomy and is_worst and len(worst) < nodes else ""
    return f"{point.name}{sinr}{note}", is_roomy and (is_worst or key[0] == "jammers")


_OPACITY = 0.1  # of one node's: the darker, the more are blocked
_LIFT = 2e-4  # of each above the one before, sizes of the scene: what lies in one plane flickers
_HATCH = 0.03  # from one line to the next, sizes of the scene


def shadow_shapes(state: State, size_m: float, look: Look) -> Shapes:
    """Draw where each point is out of the drone's sight: filled for nodes, hatched for all others.

    Args:
        state: of the page.
        size_m: of the scene, from which the hatching follows.
        look: the page's colours.
    """
    # sources and zones have no link with it
    answer = state.shadowing
    return (
        {}
        if answer is None
        else _shapes(answer, size_m, tuple((kind, look.colours[kind]) for kind in KINDS[:-2]))
    )


@lru_cache(4)
def _shapes(answer: Answer, size_m: float, kinds: tuple[tuple[str, Rgb], ...]) -> Shapes:
    scenario, altitude_m = answer.result.scenario, float(answer.result.pose.position_m[2])
    shapes, box_m = {"/shadows": frame((0.0, 0.0, altitude_m))}, flight_box_m(scenario)
    hatching = _hatching(box_m, _HATCH * size_m)
    for kind, colour in kinds:
        for index, point in enumerate(getattr(scenario, kind)):
            pieces = [
                shapely.Polygon(outline_m)
                for outline_m in shadow_outlines_m(scenario, point, altitude_m, box_m)
            ]
            area = shapely.union_all([piece for piece in pieces if piece.area > 0.0])  # a corner may be left
            strings = area & hatching
            if not point.is_interferer and area.area > 0.0:
                shapes[f"/shadows/{kind}-{index}"] = _filled(
                    area, colour, _LIFT * size_m * len(shapes), np.column_stack([box_m, [0.0, 2.0 * size_m]])
                )
            elif strings.length > 0.0:
                shapes[f"/shadows/{kind}-{index}"] = _hatched(strings, colour)
    return shapes


def _filled(area: BaseGeometry, colour: Rgb, lift_m: float, ends_m: NDArray[np.float64]) -> Shape:
    """Fill an area; ends, (2, 3), are of the space in whose middle the browser takes it to be.

    By its middle it sorts what is see-through: high up the area is drawn after the buildings, which it would
    hide otherwise, and areas in one middle in the order in which they lie.
    """
    surface = level_mesh(area)
    surface = surface._replace(vertices=np.vstack([surface.vertices, ends_m]))
    return mesh(surface, colour, opacity=_OPACITY, side="double", position=np.array([0.0, 0.0, lift_m]))


def _hatched(strings: BaseGeometry, colour: Rgb) -> Shape:
    parts = [shapely.get_coordinates(part) for part in shapely.get_parts(strings)]
    segments = np.stack([part[[0, -1]] for part in parts if len(part) > 1])  # a corner is touched in a point
    return lines(np.insert(segments, 2, 0.0, axis=-1), colour, 1.0)


def _hatching(box_m: NDArray[np.float64], apart_m: float) -> BaseGeometry:
    """Cover a box with lines towards the north-east."""
    (west, south), (east, north) = box_m
    starts = np.arange(west - (north - south), east, sqrt(2.0) * apart_m)
    return shapely.MultiLineString([[(x, south), (x + north - south, north)] for x in starts])
