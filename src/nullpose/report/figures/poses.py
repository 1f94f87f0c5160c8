"""Poses in 3-D with the antenna's radiation pattern: of one solution, or at several jamming levels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.outlines import Outline, draw_outlines, outlines_of
from nullpose.report.figures.style import GREY, house_style
from nullpose.report.geometry import null_angle_rad
from nullpose.scenario import Scenario
from nullpose.solve import Objective, Solution
from nullpose.study import SweepRow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_pose", "draw_poses", "pattern_surface_m"]

# Lengths drawn, as shares of the scene's extent.
_MARGIN = 0.12  # free ground around the scene
_ABOVE = 0.044  # from a point to its name
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_CUT_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_AZIMUTH_DEG = -32.0  # where the camera looks from
_LOW_DEG, _HIGH_DEG = 20.0, 38.0  # its elevation, for panels and for a figure of one pose
_NODE, _JAMMER, _DRONE = "#0a6f3c", "#d40000", "#0a3fd6"
_EAVESDROPPER, _FORBIDDEN = "#9a4fb0", "#b36b00"
_SURFACE = "#8fb0ff"


@dataclass(frozen=True, slots=True, kw_only=True)
class _View:
    """How a figure looks: its size, its camera, and lengths as shares of the scene's extent."""

    width_inch: float
    height_inch: float
    bottom: float
    top: float
    columns: int
    elevation_deg: float
    zoom: float
    pattern: float  # radius drawn where the gain is 1; the pattern has no size of its own
    axis: float  # half-length of the antenna axis
    aside: tuple[float, float, float]  # from a jammer to its name


_PANELS = _View(
    width_inch=4.6,
    height_inch=3.7,
    bottom=0.08,
    top=0.98,
    columns=6,
    elevation_deg=_LOW_DEG,
    zoom=1.13,
    pattern=0.15,
    axis=0.22,
    aside=(0.06, 0.0, -0.07),
)
_ALONE = _View(
    width_inch=7.0,
    height_inch=5.4,
    bottom=0.13,
    top=0.97,
    columns=3,
    elevation_deg=_HIGH_DEG,
    zoom=1.17,
    pattern=0.11,
    axis=0.17,
    aside=(0.021, 0.034, -0.015),
)


def _to_camera(elevation_deg: float) -> FloatArray:
    elevation, azimuth = math.radians(elevation_deg), math.radians(_AZIMUTH_DEG)
    return np.array(
        [
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        ]
    )


def pattern_surface_m(
    pose: Pose, radius_m: float, around_rad: FloatArray, elevation_deg: float = _LOW_DEG
) -> FloatArray:
    """Return points on the dipole's radiation pattern drawn around a pose, a doughnut about its axis.

    In each direction the distance from the drone is ``radius_m * sin^2(gamma)`` (paper eq. 1.2).

    Args:
        pose: where the drone is and how it is turned.
        radius_m: distance drawn where the gain is 1, metres.
        around_rad: the turns about the axis to draw, shape ``(m,)``, radians; 0 faces the camera.
        elevation_deg: how high the camera stands, degrees.

    Returns:
        Array of shape ``(3, n, m)``, world frame, metres.
    """
    axis = pose.antenna_axis
    camera = _to_camera(elevation_deg)
    facing = camera - axis * (camera @ axis)
    facing = facing / np.linalg.norm(facing)
    frame = np.stack([facing, np.cross(axis, facing), axis])
    gamma, around = np.meshgrid(np.linspace(0.0, math.pi, 61), around_rad, indexing="ij")
    local = np.stack([np.sin(gamma) * np.cos(around), np.sin(gamma) * np.sin(around), np.cos(gamma)])
    points = np.einsum("kij,kc->cij", radius_m * np.sin(gamma) ** 2 * local, frame)
    return np.asarray(points + pose.position_m[:, None, None])


def draw_poses(scenario: Scenario, rows: Sequence[SweepRow]) -> Figure:
    """Return the figure of several best poses side by side, one panel each.

    Args:
        scenario: the scene, with one jammer or more.
        rows: the poses to draw, each at its own jamming level.
    """
    words = [f"{_value_words(row.objective)}, {_angle_words(scenario, row.pose, first=True)}" for row in rows]
    titles = [f"$P_M/P$ = {row.value:g}\n{each}" for row, each in zip(rows, words, strict=True)]
    return _draw(scenario, [row.pose for row in rows], titles, _PANELS)


def draw_pose(solution: Solution) -> Figure:
    """Return the figure of one solution: the scene, its fence and its no-fly zones, the pose and its pattern.

    Args:
        solution: what was found.
    """
    scenario, pose = solution.scenario, solution.pose
    angles = _angle_words(scenario, pose)
    name = scenario.name.replace("$", r"\$")
    title = f"{name}\n{_value_words(solution.objective)}{f', {angles}' if angles else ''}".strip()
    return _draw(scenario, [pose], [title], _ALONE)


def _value_words(objective: Objective) -> str:
    if objective.is_rate:
        return f"{objective.words} {objective.value:.3f} bits/s/Hz"
    return f"{objective.words} {objective.value_db:.2f} dB".replace("-", "\N{MINUS SIGN}")


def _angle_words(scenario: Scenario, pose: Pose, *, first: bool = False) -> str:
    """Return how far the null is off the jammers, or the eavesdroppers; of the first only if asked for."""
    eavesdrop = bool(scenario.eavesdroppers)
    points_m = scenario.eavesdropper_positions_m if eavesdrop else scenario.jammer_positions_m
    names = scenario.eavesdropper_names if eavesdrop else scenario.jammer_names
    kind = "eavesdropper" if eavesdrop else "jammer"
    if not len(points_m):
        return ""
    angles = [f"{math.degrees(null_angle_rad(pose, point)):.1f}°" for point in points_m]
    if first or len(angles) == 1:
        return f"null {angles[0]} off the {kind}"
    return f"null {', '.join(f'{angle} off {name}' for angle, name in zip(angles, names, strict=True))}"


def _draw(scenario: Scenario, poses: Sequence[Pose], titles: Sequence[str], view: _View) -> Figure:
    from matplotlib.figure import Figure

    with house_style():
        figure = Figure(figsize=(view.width_inch * len(poses), view.height_inch))
        for index, (pose, title) in enumerate(zip(poses, titles, strict=True)):
            axes: Any = figure.add_subplot(1, len(poses), index + 1, projection="3d", computed_zorder=False)
            _draw_panel(axes, scenario, pose, view)
            if len(poses) > 1:
                axes.set_title(title, fontsize=10, y=0.96)
        figure.subplots_adjust(left=0.016, right=0.962, bottom=view.bottom, top=view.top, wspace=0.06)
        if len(poses) == 1:
            figure.suptitle(titles[0], fontsize=10)
        handles = _legend(figure.axes[0])
        columns = min(len(handles), view.columns)
        figure.legend(handles=handles, loc="lower center", ncols=columns, frameon=False, handlelength=2.6)
    return figure


def _legend(axes: Any) -> list[Any]:
    from matplotlib.patches import Patch

    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    return [*once.values(), Patch(color=_SURFACE, alpha=0.8, label="radiation pattern, near side cut away")]


def _extent_m(scenario: Scenario, pose: Pose) -> float:
    """Return how wide the scene is, of which all drawn lengths are shares."""
    points = _points_m(scenario, pose)
    return max(_LEAST_M, float(np.max(np.ptp(points[:, :2], axis=0))))


def _points_m(scenario: Scenario, pose: Pose) -> FloatArray:
    groups = (scenario.node_positions_m, scenario.jammer_positions_m, scenario.eavesdropper_positions_m)
    return np.vstack([*groups, pose.position_m])


def _draw_panel(axes: Any, scenario: Scenario, pose: Pose, view: _View) -> None:
    extent_m = _extent_m(scenario, pose)
    position = pose.position_m
    outlines = outlines_of(scenario.airspace, _points_m(scenario, pose), _FAR * extent_m)
    _frame_scene(axes, scenario, pose, view, outlines)
    draw_outlines(axes, outlines, _FORBIDDEN)
    _ground_points(axes, scenario, extent_m, view)
    for node in scenario.node_positions_m:
        _line(axes, node, position, color=_NODE, linewidth=0.8, alpha=0.7, zorder=2)
    ground = np.array([position[0], position[1], axes.get_zlim()[0]])
    _line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    axes.scatter(*ground, color=GREY, marker="+", s=30, zorder=2)
    for name, colour, points in (
        ("jammer", _JAMMER, scenario.jammer_positions_m),
        ("eavesdropper", _EAVESDROPPER, scenario.eavesdropper_positions_m),
    ):
        for point in points:
            _line(
                axes, position, point, color=colour, linewidth=1.5, linestyle=(0, (3, 1.5)), zorder=6.6,
                label=f"line to the {name}",
            )  # fmt: skip
    reach = view.axis * extent_m * pose.antenna_axis
    axes.plot(
        *np.stack([position - reach, position + reach]).T,
        color=_DRONE,
        linewidth=1.8,
        zorder=6.5,
        label="antenna axis (null)",
    )
    _draw_pattern(axes, pose, view.pattern * extent_m, view.elevation_deg)
    axes.scatter(*position, color=_DRONE, s=26, zorder=7, depthshade=False, label="drone")


def _draw_pattern(axes: Any, pose: Pose, radius_m: float, elevation_deg: float) -> None:
    """Draw the doughnut with its near side cut away, so that the null on its axis can be seen."""
    half = 0.5 * _CUT_RAD
    around = np.linspace(half, math.tau - half, 49)
    surface = pattern_surface_m(pose, radius_m, around, elevation_deg)
    axes.plot_surface(
        *surface,
        color=_SURFACE,
        alpha=0.45,
        linewidth=0.0,
        antialiased=False,
        rcount=61,
        ccount=49,
        zorder=5,
    )
    for edge in (surface[:, :, 0], surface[:, :, -1]):
        axes.plot(*edge, color=_DRONE, linewidth=0.9, zorder=6)


def _line(axes: Any, start: FloatArray, stop: FloatArray, **style: Any) -> None:
    axes.plot(*np.stack([start, stop]).T, **style)


def _ground_points(axes: Any, scenario: Scenario, extent_m: float, view: _View) -> None:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=2.0, foreground="white")]
    above = np.array([0.0, 0.0, _ABOVE * extent_m])
    beside = np.array(view.aside) * extent_m
    floor = axes.get_zlim()[0]
    kinds: tuple[tuple[str, str, str, float, tuple[str, ...], FloatArray, FloatArray], ...] = (
        ("node", _NODE, "s", 3.0, scenario.node_names, scenario.node_positions_m, above),
        ("jammer", _JAMMER, "X", 6.0, scenario.jammer_names, scenario.jammer_positions_m, beside),
        (
            "eavesdropper", _EAVESDROPPER, "D", 6.0, scenario.eavesdropper_names,
            scenario.eavesdropper_positions_m, beside,
        ),
    )  # fmt: skip
    for label, colour, marker, order, names, points, offset in kinds:
        if not len(points):
            continue
        axes.scatter(
            *points.T, color=colour, marker=marker, s=38, zorder=order, depthshade=False, label=label
        )
        side = "left" if view is _ALONE and label != "node" else "center"
        for name, point in zip(names, points, strict=True):
            text = name.replace("$", r"\$")
            axes.text(*(point + offset), text, color=colour, ha=side, fontsize=9, zorder=8, path_effects=halo)
            if label != "node":
                foot = np.array([point[0], point[1], floor])
                _line(axes, point, foot, color=colour, linewidth=0.8, linestyle=":")


def _frame_scene(axes: Any, scenario: Scenario, pose: Pose, view: _View, outlines: Sequence[Outline]) -> None:
    from matplotlib.ticker import MaxNLocator

    points, position, extent_m = _points_m(scenario, pose), pose.position_m, _extent_m(scenario, pose)
    low, high = points.min(axis=0) - _MARGIN * extent_m, points.max(axis=0) + _MARGIN * extent_m
    for side in (0, 1):  # room for the pattern, whatever the scene's extent
        low[side] = min(low[side], position[side] - view.axis * extent_m)
        high[side] = max(high[side], position[side] + view.axis * extent_m)
        for outline in outlines:
            low[side] = min(low[side], outline.vertices_m[:, side].min())
            high[side] = max(high[side], outline.vertices_m[:, side].max())
    low[2], high[2] = min(0.0, float(points[:, 2].min())), float(position[2]) + 1.3 * view.pattern * extent_m
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=view.zoom)  # one metre is as long along every axis
    axes.set_xlabel("x (east)  m", labelpad=-3)
    axes.set_ylabel("y (north)  m", labelpad=-1)
    axes.set_zlabel("z (up)  m", labelpad=-8)
    axes.tick_params(pad=-2, labelsize=7.5)
    for axis, ticks in ((axes.xaxis, 4), (axes.yaxis, 6), (axes.zaxis, 3)):
        axis.set_major_locator(MaxNLocator(ticks, steps=(1, 2, 5, 10)))
    axes.view_init(elev=view.elevation_deg, azim=_AZIMUTH_DEG)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
