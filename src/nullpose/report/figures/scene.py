"""A scene in 3-D: its points with their names, its fence, zones and sets, and a vehicle."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation
from matplotlib.ticker import FixedLocator, MaxNLocator, NullFormatter
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import ArrayLike

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.buildings import draw_bodies
from nullpose.report.figures.stage import Stage, limits_m
from nullpose.report.figures.style import FORBIDDEN, GREY, INK, MARKS, NULL, Look
from nullpose.scenario import Eavesdropper, Jammer, Node, NoFlyZone

_EDGE = 0.04  # ticks nearer to a corner run into those of the next axis
_MERIDIANS, _PARALLELS, _STEPS = 8, 3, 6  # lines of a set from pole to pole, around them, points between two

NULL_LINE: Look = {
    "color": NULL,
    "linewidth": 1.8,
    "path_effects": [withStroke(linewidth=2.6, foreground=INK)],
}
"""How the direction of the null is drawn: its rim is seen on any ground."""

_SIDES = tuple(
    (far * x, far * y, across, up)
    for far in (6.0, 11.0)
    for x, y, across, up in (
        (0.0, 1.0, "center", "bottom"),
        (1.0, 0.0, "left", "center"),
        (-1.0, 0.0, "right", "center"),
        (0.0, -1.0, "center", "top"),
        (0.8, 0.8, "left", "bottom"),
        (-0.8, 0.8, "right", "bottom"),
        (0.8, -0.8, "left", "top"),
        (-0.8, -0.8, "right", "top"),
    )
)
"""Where a name may stand: how far from its point, in points, and by which part of it it is held."""
_ON = (0.0, 0.0, "center", "center")


def write_name(
    axes: Axes | Axes3D, name: str, point_m: FloatArray, *, is_bold: bool = False, is_area: bool = False
) -> None:
    """Write a name at its point as it is, no part of it a formula, for ``place_names`` to move.

    Args:
        axes: in 3-D or seen from above, with its view set.
        name: of the point or the area.
        point_m: shape ``(2,)`` or ``(3,)``, metres.
        is_bold: whether it is that of the worst node.
        is_area: whether it may stand on its point; it is slanted.
    """
    x, y = float(point_m[0]), float(point_m[1])
    if isinstance(axes, Axes3D):
        x, y, _ = proj3d.proj_transform(*point_m, axes.get_proj())
    look: Look = {"fontsize": rcParams["xtick.labelsize"], "color": INK, "zorder": 8}
    look |= {"fontweight": "bold" if is_bold else "normal", "fontstyle": "italic" if is_area else "normal"}
    look |= {"textcoords": "offset points", "annotation_clip": False, "parse_math": False}
    halo = [withStroke(linewidth=2.0, foreground="white")]
    axes.annotate(name, (x, y), xytext=(0.0, 0.0), ha="center", va="center", path_effects=halo, **look)


def place_names(axes: Axes | Axes3D) -> None:
    """Move each name to a side where it is in the frame, over nothing else and nearest its own point."""
    frame = axes.figure.bbox if isinstance(axes, Axes3D) else axes.bbox
    half = 3.0 * axes.figure.dpi / 72.0
    names = [text for text in axes.texts if isinstance(text, Annotation)]
    areas = [name for name in names if name.get_fontstyle() == "italic"]
    points = [name for name in names if name not in areas]
    marks = [np.asarray(each.get_offsets()) for each in axes.collections if isinstance(each, PathCollection)]
    places = axes.transData.transform(np.vstack([*marks, *([name.xy] for name in points)]))
    taken = [Bbox([at - half, at + half]) for at in places]
    for name in points + areas:
        sides = (_ON, *_SIDES) if name in areas else _SIDES
        point = axes.transData.transform(name.xy)
        costs = []
        for side in sides:
            box = _put(name, side)
            is_outside = not (frame.contains(*box.min) and frame.contains(*box.max))
            is_strange = name in points and min(_distance(box, at) for at in places) < _distance(box, point)
            costs.append(100 * is_outside + is_strange + sum(box.overlaps(other) for other in taken))
        taken.append(_put(name, sides[int(np.argmin(costs))]))


def lay_out(figure: Figure) -> None:
    """Place names in the frames that the layout leaves, which depends on them: twice."""
    for _ in range(2):
        figure.draw_without_rendering()
        for axes in figure.axes:
            place_names(axes)


def _put(text: Annotation, side: tuple[float, float, str, str]) -> Bbox:
    """Put a name at a side of its point; return the box of its letters."""
    text.set(position=side[:2], ha=side[2], va=side[3])
    return text.get_window_extent().shrunk(0.96, 0.7)


def _distance(box: Bbox, at: FloatArray) -> float:
    return float(np.linalg.norm(np.maximum(np.maximum(box.min - at, at - box.max), 0.0)))


def draw_line(axes: Axes3D, start: ArrayLike, stop: ArrayLike, **style: object) -> None:
    """Draw a straight line between two points, each of shape ``(3,)``, metres."""
    axes.plot(*np.stack([start, stop]).T, **style)


def draw_panel(
    axes: Axes3D, stage: Stage, pose: Pose, draw_vehicle: Callable[[Axes3D, Stage, Pose], None]
) -> None:
    """Draw the scene, the vehicle at a pose, and the names of points in axes whose place is set."""
    axes.computed_zorder = False
    _frame(axes, stage)
    is_small = stage.view.is_small
    position, floor_m = pose.position_m, axes.get_zlim()[0]
    ground = np.array([*position[:2], floor_m])
    draw_line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    for kind, point in stage.points:
        place, (colour, marker) = np.asarray(point.position_m), MARKS[kind]
        order = 3.0 if kind == "node" else 6.0
        axes.scatter(
            *place,
            color=colour,
            marker=marker,
            s=18 if is_small else 38,
            zorder=order,
            depthshade=False,
            label=kind,
        )
        if isinstance(point, Node):
            draw_line(axes, place, position, color=colour, linewidth=0.8, alpha=0.7, zorder=2)
        else:
            line = {"linewidth": 1.5, "linestyle": (0, (3, 1.5)), "zorder": 6.6}
            draw_line(axes, position, place, color=colour, **line)
            draw_line(axes, place, [*place[:2], floor_m], color=colour, linewidth=0.8, linestyle=":")
            if stage.uncertain and point.uncertainty_reach_m > 0.0:
                draw_set(axes, point, colour, f"where the {kind} may be")
        if not is_small:  # the plan beside it has the names
            write_name(axes, point.name, place)
    draw_bodies(axes, stage.scenario)
    for zone, corners_m in stage.zones:
        _draw_zone(axes, zone, corners_m, is_named=not is_small)
    draw_vehicle(axes, stage, pose)
    place_names(axes)


def _frame(axes: Axes3D, stage: Stage) -> None:
    """Set limits, names and ticks of the axes, and the camera."""
    low, high = limits_m(stage)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=stage.view.zoom)  # one metre is as long along every axis
    is_small = stage.view.is_small
    if is_small:
        axes.text2D(1.12, 0.1, "Up z (m)", transform=axes.transAxes, ha="right", fontsize="small")
    else:
        axes.set_zlabel("Up z (m)", labelpad=-8)
        axes.set_xlabel("East x (m)", labelpad=-3)
        axes.set_ylabel("North y (m)", labelpad=-1)
    axes.tick_params(pad=-4 if is_small else -2, labelsize="small")
    sides = ((axes.xaxis, 5), (axes.yaxis, 7), (axes.zaxis, 2 if is_small else 3))
    for index, (axis, most) in enumerate(sides):
        ticks = MaxNLocator(most, steps=(1, 2, 5, 10)).tick_values(low[index], high[index])
        edge = _EDGE * (high[index] - low[index]) if index < 2 else 0.0
        inside = [tick for tick in ticks if low[index] + edge <= tick <= high[index] - edge]
        axis.set_major_locator(FixedLocator(inside))
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
        if is_small and index < 2:
            axis.set_major_formatter(NullFormatter())
    axes.view_init(elev=stage.view.elevation_deg, azim=stage.view.azimuth_deg)


def _draw_zone(axes: Axes3D, zone: NoFlyZone | None, corners_m: FloatArray, *, is_named: bool) -> None:
    """Draw a zone as a body that can be seen through, or the geofence (None) as a line on the ground."""
    bottom_m, top_m = axes.get_zlim()
    if zone is None:
        ring = np.vstack([corners_m, corners_m[:1]])
        axes.plot(*ring.T, bottom_m, color=GREY, linewidth=1.2, linestyle=(0, (6, 2)), label="geofence")
        return
    low_m, high_m = max(zone.floor_m, bottom_m), min(zone.ceiling_m, top_m)
    if not high_m > low_m:
        return
    lower, upper = (np.column_stack([corners_m, np.full(len(corners_m), z)]) for z in (low_m, high_m))
    walls = np.stack([lower, np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0), upper], axis=1)
    for faces, edge in ((walls, "none"), ([lower, upper], FORBIDDEN)):
        look = {"facecolor": (FORBIDDEN, 0.10), "edgecolor": edge, "linewidth": 0.8, "zorder": 1.0}
        axes.add_collection3d(Poly3DCollection(faces, **look))
    axes.plot([], [], [], color=FORBIDDEN, linewidth=0.8, label="no-fly zone")
    if is_named:
        write_name(axes, zone.name, np.append(corners_m.mean(axis=0), high_m), is_area=True)


def draw_set(axes: Axes3D, point: Jammer | Eavesdropper, colour: str, label: str) -> None:
    """Draw wires on the surface ``{position + A x : |x| = 1}`` of the set that a point may be anywhere in."""
    around, down = np.meshgrid(
        np.linspace(0.0, math.tau, _MERIDIANS * _STEPS + 1),
        np.linspace(0.0, math.pi, (_PARALLELS + 1) * _STEPS + 1),
    )
    ball = np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=-1)
    surface_m = np.asarray(point.position_m) + ball @ point.uncertainty_matrix_m.T
    look = {"color": colour, "linewidth": 0.6, "alpha": 0.75, "zorder": 5.5, "label": label}
    axes.plot_wireframe(*np.moveaxis(surface_m, -1, 0), rstride=_STEPS, cstride=_STEPS, **look)
