"""Where buildings hide the ground points from the drone, drawn at its altitude as in the plan figure."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from nullpose.report.geometry import shadow_outlines_m
from nullpose.studio.answer import Answer
from nullpose.studio.drawing import Shape, Shapes, frame, lines, mesh
from nullpose.studio.ground import flight_box_m
from nullpose.studio.look import Look, Rgb
from nullpose.studio.meshes import level_mesh
from nullpose.studio.state import KINDS, State

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
