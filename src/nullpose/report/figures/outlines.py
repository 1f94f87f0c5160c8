"""Fences and no-fly zones in 3-D."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.report.figures.labels import Label
from nullpose.scenario import Airspace, NoFlyZone

__all__ = ["Outline", "draw_outlines", "outline_labels", "outlines_of"]

_ROUND = 48  # sides of the polygon that a cylinder is drawn as
_FENCE = "#6b6b6b"


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """A fence or a zone as it is drawn: an upright prism.

    Args:
        name: the zone's name; empty for the fence.
        vertices_m: seen from above, shape ``(n, 2)``, metres.
        floor_m: its lower end, metres; minus infinity for none.
        ceiling_m: its upper end, metres; infinity for none.
    """

    name: str
    vertices_m: FloatArray
    floor_m: float
    ceiling_m: float


def outlines_of(airspace: Airspace, points_m: FloatArray, far_m: float) -> tuple[Outline, ...]:
    """Return the fence and the zones of an airspace, those left out that reach far beyond the scene.

    Args:
        airspace: where the vehicle may be.
        points_m: what the scene consists of, shape ``(n, 3)``, metres.
        far_m: distance from the scene's middle beyond which nothing is drawn, metres.
    """
    middle_m = 0.5 * (points_m.min(axis=0) + points_m.max(axis=0))[:2]
    outlines = [
        Outline(zone.name, _vertices_m(zone), zone.floor_m, zone.ceiling_m) for zone in airspace.no_fly
    ]
    if airspace.geofence_m is not None:
        outlines.insert(0, Outline("", airspace.geofence_outline_m, -math.inf, math.inf))
    return tuple(one for one in outlines if np.abs(one.vertices_m - middle_m).max() <= far_m)


def _vertices_m(zone: NoFlyZone) -> FloatArray:
    if zone.centre_m is None or zone.radius_m is None:
        return zone.outline_m
    around = np.linspace(0.0, math.tau, _ROUND, endpoint=False)
    return np.asarray(zone.centre_m + zone.radius_m * np.stack([np.cos(around), np.sin(around)], axis=-1))


def draw_outlines(axes: Any, outlines: Sequence[Outline], colour: str) -> None:
    """Draw zones as bodies that can be seen through, and the fence as a line on the ground.

    Args:
        axes: where to draw, its limits set; what reaches beyond them ends there.
        outlines: fence and zones.
        colour: of the zones.
    """
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    bottom, top = axes.get_zlim()
    for outline in outlines:
        ring = np.vstack([outline.vertices_m, outline.vertices_m[:1]])
        if not outline.name:
            height = np.full(len(ring), bottom)
            axes.plot(*ring.T, height, color=_FENCE, linewidth=1.2, linestyle=(0, (6, 2)), label="geofence")
            continue
        low, high = _heights_m(outline, bottom, top)
        if not high > low:
            continue
        lower = np.column_stack([outline.vertices_m, np.full(len(outline.vertices_m), low)])
        upper = np.column_stack([outline.vertices_m, np.full(len(outline.vertices_m), high)])
        after = np.roll(np.arange(len(lower)), -1)
        walls = np.stack([lower, lower[after], upper[after], upper], axis=1)
        for faces in (walls, [lower], [upper]):
            axes.add_collection3d(
                Poly3DCollection(faces, facecolor=colour, alpha=0.10, linewidth=0.0, zorder=1.0)
            )
        for ends in (lower, upper):
            axes.plot(*np.vstack([ends, ends[:1]]).T, color=colour, linewidth=0.8, zorder=1.2)
    if any(outline.name for outline in outlines):
        axes.plot([], [], [], color=colour, linewidth=0.8, label="no-fly zone")


def outline_labels(axes: Any, outlines: Sequence[Outline], colour: str) -> list[Label]:
    """Return the names of the zones that are drawn, on their upper ends.

    Args:
        axes: with its limits set.
        outlines: fence and zones.
        colour: of the zones.
    """
    labels = []
    for outline in outlines:
        low, high = _heights_m(outline, *axes.get_zlim())
        if outline.name and high > low:
            middle = np.append(outline.vertices_m.mean(axis=0), high)
            labels.append(Label(outline.name, middle, colour, on=True, size_pt=8.0))
    return labels


def _heights_m(outline: Outline, bottom_m: float, top_m: float) -> tuple[float, float]:
    """Return where a zone begins and ends within the heights drawn."""
    return max(outline.floor_m, bottom_m), min(outline.ceiling_m, top_m)
