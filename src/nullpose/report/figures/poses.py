"""The best pose at several jamming levels, in 3-D, with the antenna's radiation pattern."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import GREY, house_style
from nullpose.report.geometry import null_angle_rad
from nullpose.scenario import Scenario
from nullpose.study import SweepRow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_poses", "pattern_surface_m"]

_PATTERN_M = 7.5  # drawn radius where the gain is 1; the pattern has no size of its own
_AXIS_M = 11.0  # drawn half-length of the antenna axis
_CUT_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_ELEVATION_DEG, _AZIMUTH_DEG = 20.0, -32.0  # where the camera looks from
_MARGIN_M = 6.0  # free ground around the scene
_NODE, _JAMMER, _DRONE, _AXIS = "#0a6f3c", "#d40000", "#0a3fd6", "#0a3fd6"
_PATTERN = "#8fb0ff"

_TO_CAMERA = np.array(
    [
        math.cos(math.radians(_ELEVATION_DEG)) * math.cos(math.radians(_AZIMUTH_DEG)),
        math.cos(math.radians(_ELEVATION_DEG)) * math.sin(math.radians(_AZIMUTH_DEG)),
        math.sin(math.radians(_ELEVATION_DEG)),
    ]
)


def pattern_surface_m(pose: Pose, radius_m: float, around_rad: FloatArray) -> FloatArray:
    """Return points on the dipole's radiation pattern drawn around a pose, a doughnut about its axis.

    In each direction the distance from the drone is ``radius_m * sin^2(gamma)`` (paper eq. 1.2).

    Args:
        pose: where the drone is and how it is turned.
        radius_m: distance drawn where the gain is 1, metres.
        around_rad: the turns about the axis to draw, shape ``(m,)``, radians; 0 faces the camera.

    Returns:
        Array of shape ``(3, n, m)``, world frame, metres.
    """
    axis = pose.antenna_axis
    facing = _TO_CAMERA - axis * (_TO_CAMERA @ axis)
    facing = facing / np.linalg.norm(facing)
    frame = np.stack([facing, np.cross(axis, facing), axis])
    gamma, around = np.meshgrid(np.linspace(0.0, math.pi, 61), around_rad, indexing="ij")
    local = np.stack([np.sin(gamma) * np.cos(around), np.sin(gamma) * np.sin(around), np.cos(gamma)])
    points = np.einsum("kij,kc->cij", radius_m * np.sin(gamma) ** 2 * local, frame)
    return np.asarray(points + pose.position_m[:, None, None])


def draw_poses(scenario: Scenario, rows: Sequence[SweepRow]) -> Figure:
    """Return the figure of several best poses side by side, one panel each.

    Args:
        scenario: the scene, with one jammer or more; the null line goes to the first.
        rows: the poses to draw, each at its own jamming level.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    with house_style():
        figure = Figure(figsize=(4.6 * len(rows), 3.7))
        for index, row in enumerate(rows):
            axes: Any = figure.add_subplot(1, len(rows), index + 1, projection="3d", computed_zorder=False)
            _draw_panel(axes, scenario, row)
        figure.subplots_adjust(left=0.016, right=0.962, bottom=0.08, top=0.98, wspace=0.06)
        handles, _ = figure.axes[0].get_legend_handles_labels()
        handles.append(Patch(color=_PATTERN, alpha=0.8, label="radiation pattern, near side cut away"))
        figure.legend(
            handles=handles, loc="lower center", ncols=len(handles), frameon=False, handlelength=2.6
        )
    return figure


def _draw_panel(axes: Any, scenario: Scenario, row: SweepRow) -> None:
    pose = row.pose
    jammer = scenario.jammer_positions_m[0]
    position = pose.position_m
    _frame_scene(axes, scenario, position)
    _ground_points(axes, scenario)
    for node in scenario.node_positions_m:
        _line(axes, node, position, color=_NODE, linewidth=0.8, alpha=0.7, zorder=2)
    ground = np.array([position[0], position[1], 0.0])
    _line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    axes.scatter(*ground, color=GREY, marker="+", s=30, zorder=2)
    _line(
        axes, position, jammer, color=_JAMMER, linewidth=1.5, linestyle=(0, (3, 1.5)), zorder=6.6,
        label="line to the jammer",
    )  # fmt: skip
    ends = np.stack([position - _AXIS_M * pose.antenna_axis, position + _AXIS_M * pose.antenna_axis])
    axes.plot(*ends.T, color=_AXIS, linewidth=1.8, zorder=6.5, label="antenna axis (null)")
    _draw_pattern(axes, pose)
    axes.scatter(*position, color=_DRONE, s=26, zorder=7, depthshade=False, label="drone")
    angle_deg = math.degrees(null_angle_rad(pose, jammer))
    axes.set_title(
        f"$P_M/P$ = {row.value:g}\n"
        f"smallest SINR {row.min_sinr_db:.2f} dB, null {angle_deg:.1f}° off the jammer",
        fontsize=10,
        y=0.96,
    )


def _draw_pattern(axes: Any, pose: Pose) -> None:
    """Draw the doughnut with its near side cut away, so that the null on its axis can be seen."""
    half = 0.5 * _CUT_RAD
    around = np.linspace(half, math.tau - half, 49)
    surface = pattern_surface_m(pose, _PATTERN_M, around)
    axes.plot_surface(
        *surface,
        color=_PATTERN,
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


def _ground_points(axes: Any, scenario: Scenario) -> None:
    nodes, jammers = scenario.node_positions_m, scenario.jammer_positions_m
    axes.scatter(*nodes.T, color=_NODE, marker="s", s=34, zorder=3, depthshade=False, label="node")
    axes.scatter(*jammers.T, color=_JAMMER, marker="X", s=46, zorder=6, depthshade=False, label="jammer")
    for name, point in [*zip(scenario.node_names, nodes, strict=True)]:
        axes.text(*(point + np.array([0.0, 0.0, 2.2])), name, color=_NODE, ha="center", fontsize=9, zorder=8)
    for name, point in zip(scenario.jammer_names, jammers, strict=True):
        axes.text(
            *(point + np.array([3.0, 0.0, -3.5])), name, color=_JAMMER, ha="center", fontsize=9, zorder=8
        )
        _line(axes, point, point * np.array([1.0, 1.0, 0.0]), color=_JAMMER, linewidth=0.8, linestyle=":")


def _frame_scene(axes: Any, scenario: Scenario, position: FloatArray) -> None:
    from matplotlib.ticker import MaxNLocator

    points = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m, position])
    low, high = points.min(axis=0) - _MARGIN_M, points.max(axis=0) + _MARGIN_M
    for side in (0, 1):  # room for the pattern, whatever the scene's extent
        low[side] = min(low[side], position[side] - _AXIS_M)
        high[side] = max(high[side], position[side] + _AXIS_M)
    low[2], high[2] = min(0.0, float(points[:, 2].min())), float(position[2]) + 1.3 * _PATTERN_M
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=1.13)  # one metre is as long along every axis
    axes.set_xlabel("x (east)  m", labelpad=-3)
    axes.set_ylabel("y (north)  m", labelpad=-1)
    axes.set_zlabel("z (up)  m", labelpad=-8)
    axes.tick_params(pad=-2, labelsize=7.5)
    for axis, ticks in ((axes.xaxis, 4), (axes.yaxis, 6), (axes.zaxis, 3)):
        axis.set_major_locator(MaxNLocator(ticks, steps=(1, 2, 5, 10)))
    axes.view_init(elev=_ELEVATION_DEG, azim=_AZIMUTH_DEG)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
