"""What is extended in a scene: fences, no-fly zones, and the sets that points may be anywhere in."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from nullpose.physics.types import FloatArray
from nullpose.report.figures.labels import Label
from nullpose.report.figures.style import GREY
from nullpose.scenario import Eavesdropper, Jammer, NoFlyZone

_MERIDIANS, _PARALLELS, _STEPS = 8, 3, 6  # lines of a set from pole to pole, around them, points between two


def draw_zone(axes: Any, zone: NoFlyZone | None, corners_m: FloatArray, colour: str) -> list[Label]:
    """Return a zone's name on its upper end, after drawing it as a body that can be seen through.

    Args:
        axes: where to draw, its limits set; what reaches beyond them ends there.
        zone: any; nothing is drawn of one that lies above or below the limits. None: the geofence, which has
            no name and is a line on the ground.
        corners_m: seen from above, shape ``(n, 2)``, metres.
        colour: of the zone.
    """
    bottom_m, top_m = axes.get_zlim()
    if zone is None:
        ring = np.vstack([corners_m, corners_m[:1]])
        axes.plot(*ring.T, bottom_m, color=GREY, linewidth=1.2, linestyle=(0, (6, 2)), label="geofence")
        return []
    low_m, high_m = max(zone.floor_m, bottom_m), min(zone.ceiling_m, top_m)
    if not high_m > low_m:
        return []
    lower, upper = (np.column_stack([corners_m, np.full(len(corners_m), z)]) for z in (low_m, high_m))
    walls = np.stack([lower, np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0), upper], axis=1)
    for faces, edge in ((walls, "none"), ([lower, upper], colour)):
        look = {"facecolor": (colour, 0.10), "edgecolor": edge, "linewidth": 0.8, "zorder": 1.0}
        axes.add_collection3d(Poly3DCollection(faces, **look))
    axes.plot([], [], [], color=colour, linewidth=0.8, label="no-fly zone")
    return [Label(zone.name, np.append(corners_m.mean(axis=0), high_m), colour, on=True)]


def set_box_m(point: Jammer | Eavesdropper) -> FloatArray:
    """Return the corners of the box around the set that a point may be anywhere in, ``(2, 3)``, metres.

    Args:
        point: with its uncertainty.
    """
    half_m = np.linalg.norm(point.uncertainty_matrix_m, axis=1)
    return np.asarray(np.asarray(point.position_m) + np.stack([-half_m, half_m]))


def draw_set(axes: Any, point: Jammer | Eavesdropper, colour: str, label: str) -> None:
    """Draw wires on the surface ``{position + A x : |x| = 1}`` of the set that a point may be anywhere in.

    Args:
        axes: where to draw.
        point: with its uncertainty.
        colour: of its kind.
        label: for the legend.
    """
    around, down = np.meshgrid(
        np.linspace(0.0, math.tau, _MERIDIANS * _STEPS + 1),
        np.linspace(0.0, math.pi, (_PARALLELS + 1) * _STEPS + 1),
    )
    ball = np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=-1)
    surface_m = np.asarray(point.position_m) + ball @ point.uncertainty_matrix_m.T
    look = {"color": colour, "linewidth": 0.6, "alpha": 0.75, "zorder": 5.5, "label": label}
    axes.plot_wireframe(*np.moveaxis(surface_m, -1, 0), rstride=_STEPS, cstride=_STEPS, **look)
