"""A scene from above, alone or on a map of values: points, zones, buildings and their shadows, the drone."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from scipy.ndimage import distance_transform_edt

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.names import place_names, write_name
from nullpose.report.figures.plan_scene import PlanScene, set_outline_m
from nullpose.report.figures.style import DRONE, FORBIDDEN, GREY, INK, MARKS, NULL, Look, house_figure, inches
from nullpose.report.geometry import outline_m, shadow_outlines_m
from nullpose.report.numbers import MINUS, capitalised
from nullpose.scenario import Scenario, Terminal
from nullpose.solver import Result
from nullpose.study import Field

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


_MOST_SPAN, _LEAST_SPAN = 30.0, 1.0  # of the colours: what is farther below the best is as dark as it gets
_LEVELS, _FREE = 8, 0.03  # of a map's contours; kept free around their numbers, of its longer side
_FAR_M = 1e7  # of an airspace without an end
_BESIDE_INCH, _BELOW_INCH = 1.6, 1.0  # for labels and the colour bar
_TALLEST_INCH = 8.0
_SLIM = 0.75  # least width of a plan over its height
NULL_LINE: Look = {  # its rim is seen on any ground
    "color": NULL,
    "linewidth": 1.8,
    "path_effects": [withStroke(linewidth=2.6, foreground=INK)],
}


def draw_plan(axes: Axes, scene: PlanScene, pose: Pose, box_m: FloatArray | None = None) -> None:
    """Draw a scene from above, one metre being as long to the east as to the north.

    The antenna's axis is drawn as it is seen from there, short if it is upright; of an array the heading.

    Args:
        axes: where to draw, two-dimensional.
        scene: what is to be seen.
        pose: of the drone.
        box_m: low and high corner of what is shown, (2, 2), metres; the whole scene if left out.
    """
    low, high = box_m if box_m is not None else scene.box_m if scene.key else filled(axes, scene.box_m)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.set(xlabel="East x (m)", ylabel="North y (m)")
    if box_m is None:  # a map has its own colours
        draw_shadows(axes, scene, float(pose.position_m[2]), np.stack([low, high]))
    draw_areas(axes, scene, is_filled=box_m is None)
    x, y = pose.position_m[:2]
    drone = f"drone {pose.position_m[2]:.3g} m up"
    if not scene.key:
        write_name(axes, drone, pose.position_m)
    rim: Look = {"edgecolors": "white", "linewidths": 0.5, "s": 30}
    for kind, point in scene.points:
        place, (colour, marker) = np.asarray(point.position_m[:2]), MARKS[kind]
        is_node = kind == "node"
        line: Look = {"linewidth": 0.8} if is_node else {"linewidth": 1.2, "linestyle": (0, (3, 1.5))}
        axes.plot([x, place[0]], [y, place[1]], color=colour, zorder=1.5, label=kind, **line)
        axes.scatter(*place, color=colour, marker=marker, zorder=3.0 if is_node else 6.8, label=kind, **rim)
        name = scene.key.get((False, point.name), point.name)
        write_name(
            axes,
            name,
            place,
            number="" if scene.key else scene.numbers.get(point.name, ""),
            is_bold=point.name in scene.worst,
        )
        if scene.uncertain and not isinstance(point, Terminal):
            axes.plot(*set_outline_m(point).T, color=colour, linewidth=0.8, label=f"where the {kind} may be")
    for source in scene.scenario.sources:  # which the drone has no link with
        place, (colour, marker) = np.asarray(source.position_m[:2]), MARKS["source"]
        axes.scatter(*place, color=colour, marker=marker, zorder=3.0, label="source", **rim)
        write_name(axes, source.name, place)
    name = "antenna axis (null)" if scene.scenario.antenna_record.is_quadratic else "antenna's z axis"
    start, ahead, look = -1.0, pose.antenna_axis[:2], NULL_LINE | {"label": name}
    if scene.scenario.array is not None:
        start, ahead = 0.0, np.array([np.cos(pose.yaw_rad), np.sin(pose.yaw_rad)])
        look = {"color": INK, "label": "heading (yaw)"}
    ends = pose.position_m[:2] + scene.axis * scene.extent_m * np.outer((start, 1.0), ahead)
    axes.plot(*ends.T, zorder=6.5, **look)
    axes.scatter(x, y, color=DRONE, zorder=7, label=drone if scene.key else "drone", **rim)


def draw_areas(axes: Axes, scene: PlanScene, *, is_filled: bool = True) -> None:
    """Draw the buildings, the fence and the no-fly zones of a scene, with the names of these."""
    draw_outlines(axes, scene.scenario, is_filled=is_filled)
    for zone, corners_m in scene.zones:
        look: Look = {"edgecolor": GREY, "fill": False, "linestyle": "--", "label": "geofence"}
        if zone is not None:
            look = {"facecolor": (FORBIDDEN, 0.12), "edgecolor": FORBIDDEN, "label": "no-fly zone"}
            name = scene.key.get((True, zone.name), zone.name)
            write_name(axes, name, corners_m.mean(axis=0), is_area=True)
        axes.add_patch(Polygon(corners_m, linewidth=0.8, zorder=1.0, **look))


def filled(axes: Axes, box_m: FloatArray) -> FloatArray:
    """Widen a box, (2, 2), to the shape of the axes, but not too slim."""
    shape = np.array([max(axes.bbox.width, _SLIM * axes.bbox.height), axes.bbox.height])
    half = 0.5 * shape * np.max(np.ptp(box_m, axis=0) / shape)
    return np.stack([box_m.mean(axis=0) - half, box_m.mean(axis=0) + half])


def draw_value_map(result: Result, field: Field, width: str | None = None) -> Figure:
    """Draw the figure of a map.

    Args:
        result: that the map is of.
        field: the map.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    wide = inches((6.0, 0.0), width, 0.0)[0]
    high = min((wide - _BESIDE_INCH) * float(np.divide(*field.values.shape)) + _BELOW_INCH, _TALLEST_INCH)
    with house_figure((wide, high), width) as figure:
        axes = figure.add_subplot()
        draw_field(axes, result, field)
        if width is None:
            head = f"{result.scenario.name}\n{result.label}: {field.title}"
            axes.set_title(head, fontsize=9, parse_math=False, wrap=True)
        place_names(axes)
    return figure


def _open_ground(scenario: Scenario, altitude_m: float) -> shapely.Geometry:
    """Outline where the vehicle may be at an altitude: inside the fence and outside all zones and balls."""
    airspace = scenario.airspace
    low, high = np.clip([airspace.lower_m, airspace.upper_m], -_FAR_M, _FAR_M)
    ground = shapely.box(*low[:2], *high[:2])
    if airspace.geofence_m is not None:
        ground = ground.intersection(shapely.Polygon(airspace.geofence_outline_m))
    up_m = altitude_m - scenario.point_positions_m[:, 2]
    across_m = np.sqrt(np.maximum(airspace.keep_out_m**2 - up_m**2, 0.0))
    closed = [
        *shapely.buffer(shapely.points(scenario.point_positions_m[:, :2]), across_m, quad_segs=24),
        *(
            shapely.Polygon(outline_m(zone))
            for zone in airspace.no_fly
            if zone.floor_m < altitude_m < zone.ceiling_m
        ),
        *(
            shapely.Polygon(each.outline_m, each.courtyard_outlines_m)
            for each in scenario.buildings
            if each.floor_m < altitude_m < each.heights_m[1]
        ),
    ]
    return ground.difference(shapely.union_all(closed))


def draw_field(axes: Axes, result: Result, field: Field) -> None:
    """Draw a map of a result with its colour bar, contours and the scene from above."""
    east, north, values = field.east_m, field.north_m, np.ma.masked_invalid(field.values)
    high = field.best[0]
    lowest = float(np.percentile(values.compressed(), 2.0)) if values.count() else 0.0
    low = min(max(lowest, high - _MOST_SPAN), high - _LEAST_SPAN)
    look: Look = {"cmap": "viridis", "vmin": low, "vmax": high, "shading": "gouraud"}
    spread = values
    if values.count():  # beyond the borders, at which it is cut
        nearest = distance_transform_edt(np.isnan(field.values), return_distances=False, return_indices=True)
        spread = field.values[tuple(nearest)]
    mesh = axes.pcolormesh(east, north, spread, zorder=0.5, rasterized=True, **look)
    levels = MaxNLocator(_LEVELS, steps=[1, 2, 5, 10]).tick_values(low, high)[1:-1]
    white: Look = {"colors": "white", "linewidths": 0.6, "linestyles": "solid", "zorder": 0.8}
    lines = axes.contour(east, north, spread, levels, **white)
    labels = axes.clabel(lines, fontsize=6.5, fmt=lambda level: f"{level:g}".replace("-", MINUS))
    ground = _open_ground(result.scenario, field.altitude_m)
    rings = [ring for part in shapely.get_parts(ground) for ring in (part.exterior, *part.interiors)]
    paths = (Path(shapely.get_coordinates(ring), closed=True) for ring in rings)
    outline = PathPatch(Path.make_compound_path(*paths), transform=axes.transData)
    mesh.set_clip_path(outline)
    lines.set_clip_path(outline)
    free_m = _FREE * max(np.ptp(east), np.ptp(north))  # where a number is in the frame and on open ground
    inner = ground.intersection(shapely.box(east[0], north[0], east[-1], north[-1])).buffer(-free_m)
    for label in labels:
        label.set_visible(bool(shapely.contains_xy(inner, *label.get_position())))
    axes.grid(visible=False)
    box_m = np.array([[east[0], north[0]], [east[-1], north[-1]]])
    draw_plan(axes, PlanScene(scenario=result.scenario, poses=(result.pose,)), result.pose, box_m)
    words = f"{capitalised(result.objective.quantity.smallest)} {field.altitude_m:.3g} m up ({field.unit})"
    bar = axes.inset_axes((1.03, 0.0, 0.045, 1.0))  # as high as the map, whatever its shape
    axes.figure.colorbar(mesh, cax=bar, label=words, extend="min" if values.min() < low else "neither")
