"""Buildings from above, with where they block the line of sight."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from nullpose.physics.types import FloatArray
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.style import GREY, MARKS, Look
from nullpose.report.geometry import shadow_outlines_m
from nullpose.scenario import Scenario

_ROOF = "#d4d4d4"


def draw_outlines(axes: Axes, scenario: Scenario, *, is_filled: bool) -> None:
    """Draw the outlines of buildings and their courtyards from above."""
    look: Look = {"facecolor": _ROOF, "edgecolor": GREY}
    if not is_filled:  # apart from contours, on any colour
        look = {"fill": False, "path_effects": [withStroke(linewidth=2.0, foreground="white")]}
    rings = [
        ring
        for each in scenario.buildings
        for ring in (
            each.outline_m,
            *(yard[::-1] for yard in each.courtyard_outlines_m),
        )  # holes run backwards
    ]
    _add(axes, rings, linewidth=0.7, zorder=1.2, label="building", **look)


def draw_shadows(axes: Axes, scene: PlanScene, altitude_m: float, frame_m: FloatArray) -> None:
    """Draw where the line of sight to each point is blocked at an altitude, within a frame, (2, 2), metres.

    It is filled for nodes, the darker the more are blocked, and hatched for all others.
    """
    for kind, point in scene.points:
        colour = MARKS[kind][0]
        hatched: Look = {"facecolor": "none", "hatch": "////", "alpha": 0.5}
        look = {"facecolor": colour, "alpha": 0.14} if kind == "node" else hatched
        outlines = shadow_outlines_m(scene.scenario, point, altitude_m, frame_m)
        _add(axes, outlines, edgecolor=colour, linewidth=0.0, label=f"{kind} blocked", **look)


def _add(axes: Axes, rings: Iterable[FloatArray], **look: object) -> None:
    """Draw polygons as one, of which overlaps are drawn once."""
    if paths := [Path(np.vstack([ring, ring[:1]]), closed=True) for ring in rings]:
        axes.add_patch(PathPatch(Path.make_compound_path(*paths), **look))
