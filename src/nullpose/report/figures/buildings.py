"""Buildings: from above, with where they block the line of sight, and in 3-D."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from nullpose.physics.types import FloatArray
from nullpose.report.figures.stage import Stage
from nullpose.report.figures.style import GREY, MARKS, Look
from nullpose.report.geometry import shadow_outlines_m
from nullpose.scenario import Scenario

_ROOF, _WALL, _EDGE = "#d4d4d4", "#b4b4b4", "#858585"


def draw_outlines(axes: Axes, scenario: Scenario, *, is_filled: bool) -> None:
    """Draw the outlines of buildings and their courtyards from above."""
    look: Look = {"facecolor": _ROOF, "edgecolor": GREY}
    if not is_filled:  # apart from contours, on any colour
        look = {"fill": False, "path_effects": [withStroke(linewidth=2.0, foreground="white")]}
    rings: list[FloatArray] = []
    for each in scenario.buildings:
        rings += [each.outline_m, *(yard[::-1] for yard in each.courtyard_outlines_m)]  # holes run backwards
    _add(axes, rings, linewidth=0.7, zorder=1.2, label="building", **look)


def draw_shadows(axes: Axes, stage: Stage, altitude_m: float, frame_m: FloatArray) -> None:
    """Draw where the line of sight to each point is blocked at an altitude, within a frame, (2, 2), metres.

    It is filled for nodes, the darker the more are blocked, and hatched for all others.
    """
    for kind, point in stage.points:
        colour = MARKS[kind][0]
        hatched: Look = {"facecolor": "none", "hatch": "////", "alpha": 0.5}
        look = {"facecolor": colour, "alpha": 0.14} if kind == "node" else hatched
        outlines = shadow_outlines_m(stage.scenario, point, altitude_m, frame_m)
        _add(axes, outlines, edgecolor=colour, linewidth=0.0, label=f"{kind} blocked", **look)


def _add(axes: Axes, rings: Iterable[FloatArray], **look: object) -> None:
    """Draw polygons as one, of which overlaps are drawn once."""
    if paths := [Path(np.vstack([ring, ring[:1]]), closed=True) for ring in rings]:
        axes.add_patch(PathPatch(Path.make_compound_path(*paths), **look))


def walls_m(ring_m: FloatArray, low_m: float, high_m: float) -> FloatArray:
    """Stand walls on a closed ring, (n + 1, 2): the corners of each, (n, 4, 3), metres."""
    lower, upper = (np.insert(ring_m, 2, z, axis=1) for z in (low_m, high_m))
    return np.stack([lower[:-1], lower[1:], upper[1:], upper[:-1]], axis=1)


def draw_bodies(axes: Axes3D, scenario: Scenario) -> None:
    """Draw buildings in axes with limits, which cut them."""
    (west, east), (south, north), (bottom_m, top_m) = axes.get_xlim(), axes.get_ylim(), axes.get_zlim()
    walls, roofs = [], []
    for each in scenario.buildings:
        low_m, high_m = max(each.floor_m, bottom_m), min(each.heights_m[1], top_m)
        whole = shapely.Polygon(each.outline_m, each.courtyard_outlines_m)
        for part in shapely.get_parts(shapely.clip_by_rect(whole, west, south, east, north)):
            for ring in map(shapely.get_coordinates, (part.exterior, *part.interiors)):
                walls += list(walls_m(ring, low_m, high_m))
            flat = shapely.constrained_delaunay_triangles(part).geoms if part.interiors else [part]
            roofs += [np.insert(shapely.get_coordinates(face), 2, high_m, axis=1) for face in flat]
    if walls:
        colours = [_WALL] * len(walls) + [_ROOF] * len(roofs)
        edges = [_EDGE] * len(walls) + ["none"] * len(roofs)
        look: Look = {"facecolors": colours, "edgecolors": edges, "linewidth": 0.4, "alpha": 0.85}
        axes.add_collection3d(Poly3DCollection(walls + roofs, zorder=1.0, label="building", **look))
