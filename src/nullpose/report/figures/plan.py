"""A scene from above, alone or on a map of values."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.buildings import draw_outlines, draw_shadows
from nullpose.report.figures.scene import NULL_LINE, write_name
from nullpose.report.figures.stage import ALONE, AXIS, Stage, limits_m
from nullpose.report.figures.style import DRONE, FORBIDDEN, GREY, INK, MARKS, Look, house_style, inches
from nullpose.report.numbers import MINUS, capitalised
from nullpose.solver import Result
from nullpose.study import Field

_MOST_SPAN, _LEAST_SPAN = 30.0, 1.0  # of the colours: what is farther below the best is as dark as it gets
_LEVELS = 8
_BESIDE_INCH, _BELOW_INCH = 1.6, 1.0  # for labels and the colour bar
_TALLEST_INCH = 8.0


def draw_plan(axes: Axes, stage: Stage, pose: Pose, box_m: FloatArray | None = None) -> None:
    """Draw a scene from above, one metre being as long to the east as to the north.

    The antenna's axis is drawn as it is seen from there: short if it is upright.

    Args:
        axes: where to draw, two-dimensional.
        stage: what is to be seen.
        pose: of the drone.
        box_m: low and high corner of what is shown, (2, 2), metres; the whole stage if left out.
    """
    low, high = np.stack(limits_m(stage))[:, :2] if box_m is None else box_m
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="East x (m)", ylabel="North y (m)")
    axes.set_aspect("equal")
    if box_m is None:  # a map has its own colours
        draw_shadows(axes, stage, float(pose.position_m[2]), np.stack([low, high]))
    draw_outlines(axes, stage.scenario, is_filled=box_m is None)
    names, zone_names = [], []
    for zone, corners_m in stage.zones:
        look: Look = {"edgecolor": GREY, "fill": False, "linestyle": "--", "label": "geofence"}
        if zone is not None:
            look = {"facecolor": (FORBIDDEN, 0.12), "edgecolor": FORBIDDEN, "label": "no-fly zone"}
            zone_names.append((zone.name, corners_m.mean(axis=0), FORBIDDEN, "on"))
        axes.add_patch(Polygon(corners_m, linewidth=0.8, zorder=1.0, **look))
    x, y = pose.position_m[:2]
    rim: Look = {"edgecolors": "white", "linewidths": 0.5, "s": 30}
    for kind, point in stage.points:
        place, (colour, marker) = np.asarray(point.position_m[:2]), MARKS[kind]
        is_node = kind == "node"
        dashes, width = ("-", 0.8) if is_node else ((0, (3, 1.5)), 1.2)
        axes.plot([x, place[0]], [y, place[1]], color=colour, linestyle=dashes, linewidth=width, zorder=1.5)
        axes.scatter(*place, color=colour, marker=marker, zorder=3.0 if is_node else 6.0, label=kind, **rim)
        names.append((point.name, place, INK, "above" if is_node else "right"))
    radius_m = stage.view.pattern * stage.extent_m
    reach = AXIS * radius_m * pose.antenna_axis[:2]
    ends = np.stack([pose.position_m[:2] - reach, pose.position_m[:2] + reach])
    axes.plot(*ends.T, zorder=6.5, **NULL_LINE)
    axes.scatter(x, y, color=DRONE, zorder=7, label="drone", **rim)
    axes.apply_aspect()
    for name, place, colour, side in names + zone_names:
        inner = 0.05 * (high - low) * (side == "on")  # the name of a zone is wide
        if np.all((place >= low + inner) & (place <= high - inner)):
            write_name(axes, name, place, colour, side)


def draw_value_map(result: Result, field: Field, width: str | None = None) -> Figure:
    """Draw the figure of a map.

    Args:
        result: that the map is of.
        field: the map.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    rows, columns = field.values.shape
    wide = inches((6.0, 0.0), width, 0.0)[0]
    high = min((wide - _BESIDE_INCH) * rows / columns + _BELOW_INCH, _TALLEST_INCH)
    with house_style(width):
        figure = Figure(figsize=(wide, high), layout="constrained")
        axes = figure.add_subplot()
        draw_field(axes, result, field)
        if width is None:
            title = f"{result.scenario.name}\n{result.label}: {field.title}"
            axes.set_title(title, fontsize=9, parse_math=False)
    return figure


def draw_field(axes: Axes, result: Result, field: Field) -> None:
    """Draw a map of a result with its colour bar, contours and the scene from above."""
    east, north, values = field.east_m, field.north_m, np.ma.masked_invalid(field.values)
    high = field.best[0]
    lowest = float(np.percentile(values.compressed(), 2.0)) if values.count() else 0.0
    low = min(max(lowest, high - _MOST_SPAN), high - _LEAST_SPAN)
    look: Look = {"cmap": "viridis", "vmin": low, "vmax": high, "shading": "nearest"}
    mesh = axes.pcolormesh(east, north, values, zorder=0.5, rasterized=True, **look)
    levels = MaxNLocator(_LEVELS, steps=[1, 2, 5, 10]).tick_values(low, high)[1:-1]
    white: Look = {"colors": "white", "linewidths": 0.6, "linestyles": "solid", "zorder": 0.8}
    lines = axes.contour(east, north, values, levels, **white)
    axes.clabel(lines, fontsize=6.5, fmt=lambda level: f"{level:g}".replace("-", MINUS))
    axes.grid(visible=False)
    stage = Stage(scenario=result.scenario, poses=(result.pose,), view=ALONE)
    draw_plan(axes, stage, result.pose, np.array([[east[0], north[0]], [east[-1], north[-1]]]))
    words = f"{capitalised(result.objective.quantity.smallest)} {field.altitude_m:.4g} m up  ({field.unit})"
    beside = axes.inset_axes((1.03, 0.0, 0.045, 1.0))  # as high as the map, whatever its shape
    extend = "min" if float(values.min()) < low else "neither"
    axes.figure.colorbar(mesh, cax=beside, label=words, extend=extend)
