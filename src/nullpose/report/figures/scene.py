"""A scene in 3-D: its points with their names, its fence, zones and sets, and a vehicle."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import ArrayLike

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.buildings import draw_bodies, walls_m
from nullpose.report.figures.names import write_name
from nullpose.report.figures.pattern import ball_rings
from nullpose.report.figures.stage import Stage, limits_m
from nullpose.report.figures.style import FORBIDDEN, GREY, INK, MARKS, NULL, Look
from nullpose.scenario import Eavesdropper, Jammer, NoFlyZone, Terminal

_EDGE = 0.04  # ticks nearer to a corner run into those of the next axis
_MERIDIANS, _PARALLELS, _STEPS = 8, 3, 6  # lines of a set from pole to pole, around them, points between two

NULL_LINE: Look = {
    "color": NULL,
    "linewidth": 1.8,
    "path_effects": [withStroke(linewidth=2.6, foreground=INK)],
}
"""How the direction of the null is drawn: its rim is seen on any ground."""


def draw_line(axes: Axes3D, start: ArrayLike, stop: ArrayLike, **style: object) -> None:
    """Draw a straight line between two points, each of shape ``(3,)``, metres."""
    axes.plot(*np.stack([start, stop]).T, **style)


def draw_panel(
    axes: Axes3D, stage: Stage, pose: Pose, draw_vehicle: Callable[[Axes3D, Stage, Pose], None]
) -> None:
    """Draw the scene, the vehicle at a pose, and the names of points in axes whose place is set."""
    axes.computed_zorder = False
    _frame(axes, stage)
    position, floor_m = pose.position_m, axes.get_zlim()[0]
    draw_line(axes, [*position[:2], floor_m], position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    for kind, point in stage.points:
        place, (colour, marker) = np.asarray(point.position_m), MARKS[kind]
        line: Look = {"color": colour, "label": kind}
        mark: Look = line | {"marker": marker, "s": 18 if stage.view.is_small else 38}
        axes.scatter(*place, zorder=3.0 if kind == "node" else 6.0, depthshade=False, **mark)
        if isinstance(point, Terminal):
            draw_line(axes, place, position, linewidth=0.8, alpha=0.7, zorder=2, **line)
        else:
            draw_line(axes, position, place, linewidth=1.5, linestyle=(0, (3, 1.5)), zorder=6.6, **line)
            draw_line(axes, place, [*place[:2], floor_m], color=colour, linewidth=0.8, linestyle=":")
            if stage.uncertain and point.uncertainty_reach_m > 0.0:
                draw_set(axes, point, colour, f"where the {kind} may be")
        if not stage.view.is_small:  # the plan beside it has the names
            write_name(axes, point.name, place)
    draw_bodies(axes, stage.scenario)
    for zone, corners_m in stage.zones:
        _draw_zone(axes, zone, corners_m, is_named=not stage.view.is_small)
    draw_vehicle(axes, stage, pose)


def _frame(axes: Axes3D, stage: Stage) -> None:
    """Set limits, names and ticks of the axes, and the camera."""
    low, high = limits_m(stage)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=stage.view.zoom)  # one metre is as long along every axis
    looks = (("East x (m)", -3.0, 5, _EDGE), ("North y (m)", -1.0, 7, _EDGE), ("Up z (m)", -8.0, 3, 0.0))
    for axis, (name, pad, most, edge), start, stop in zip(
        axes._axis_map.values(), looks, low, high, strict=True
    ):
        ticks = MaxNLocator(most, steps=(1, 2, 5, 10)).tick_values(start, stop)
        edge_m = edge * (stop - start)
        axis.set_ticks([tick for tick in ticks if start + edge_m <= tick <= stop - edge_m])
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
        if stage.view.is_small:  # the plan beside it has the others
            axis.set_ticklabels([])
        else:
            axis.set_label_text(name)
            axis.labelpad = pad
    axes.tick_params(pad=-2, labelsize="small")
    axes.view_init(elev=stage.view.elevation_deg, azim=stage.view.azimuth_deg)


def _draw_zone(axes: Axes3D, zone: NoFlyZone | None, corners_m: FloatArray, *, is_named: bool) -> None:
    """Draw a zone as a body that can be seen through, or the geofence (None) as a line on the ground."""
    bottom_m, top_m = axes.get_zlim()
    ring = np.vstack([corners_m, corners_m[:1]])
    if zone is None:
        axes.plot(*ring.T, bottom_m, color=GREY, linewidth=1.2, linestyle=(0, (6, 2)), label="geofence")
        return
    low_m, high_m = max(zone.floor_m, bottom_m), min(zone.ceiling_m, top_m)
    if not high_m > low_m:
        return
    flat = [np.insert(ring, 2, z, axis=1) for z in (low_m, high_m)]
    for faces, edge in ((walls_m(ring, low_m, high_m), "none"), (flat, FORBIDDEN)):
        look: Look = {"facecolor": (FORBIDDEN, 0.10), "edgecolor": edge, "label": "no-fly zone"}
        axes.add_collection3d(Poly3DCollection(faces, linewidth=0.8, zorder=1.0, **look))
    if is_named:
        write_name(axes, zone.name, np.append(corners_m.mean(axis=0), high_m), is_area=True)


def draw_set(axes: Axes3D, point: Jammer | Eavesdropper, colour: str, label: str) -> None:
    """Draw wires on the surface ``{position + A x : |x| = 1}`` of the set that a point may be anywhere in."""
    ball, _ = ball_rings((_PARALLELS + 1) * _STEPS + 1, np.linspace(0.0, math.tau, _MERIDIANS * _STEPS + 1))
    away_m = np.tensordot(point.uncertainty_matrix_m, ball, 1)
    look = {"color": colour, "linewidth": 0.6, "alpha": 0.75, "zorder": 5.5, "label": label}
    axes.plot_wireframe(*(away_m.T + point.position_m).T, rstride=_STEPS, cstride=_STEPS, **look)
