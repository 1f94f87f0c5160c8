"""A scene in 3-D: its points with their names, its fence and zones, the space that they are drawn in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.labels import Label, place_labels
from nullpose.report.figures.outlines import Outline, draw_outlines, outline_labels, outlines_of
from nullpose.report.figures.style import GREY
from nullpose.report.figures.uncertainty import draw_uncertainty, reach_of
from nullpose.scenario import Eavesdropper, Jammer, Scenario

__all__ = [
    "ALONE",
    "DRONE",
    "NODE",
    "PAIR",
    "PANELS",
    "SURFACE",
    "Stage",
    "View",
    "draw_line",
    "draw_names",
    "draw_scene",
]

# Lengths drawn, as shares of the scene's extent.
_MARGIN = 0.12  # free ground around the scene
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_EDGE = 0.04  # ticks nearer to a corner run into those of the next axis
NODE, DRONE, SURFACE = "#0a6f3c", "#0a3fd6", "#8fb0ff"
_JAMMER, _EAVESDROPPER, _FORBIDDEN = "#d40000", "#9a4fb0", "#b36b00"


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """How a figure looks: its size, its camera, and lengths as shares of the scene's extent.

    Args:
        width_inch: of each panel.
        height_inch: of the figure.
        bottom: where panels end, as a share of the height.
        top: where they begin.
        columns: of the legend.
        elevation_deg: how high the camera stands.
        azimuth_deg: where it stands, from x (east) towards y (north).
        zoom: how much of its place a scene fills.
        pattern: radius drawn where the gain is largest; a pattern has no size of its own.
        axis: half-length of the antenna axis.
        between: room between panels, as a share of their width.
    """

    width_inch: float
    height_inch: float
    bottom: float
    top: float
    columns: int
    elevation_deg: float
    zoom: float
    pattern: float
    axis: float
    between: float = 0.06
    azimuth_deg: float = -32.0


PANELS = View(
    width_inch=4.6,
    height_inch=3.7,
    bottom=0.08,
    top=0.98,
    columns=6,
    elevation_deg=20.0,
    zoom=1.13,
    pattern=0.15,
    axis=0.22,
)
PAIR = View(
    width_inch=4.8,
    height_inch=4.7,
    bottom=0.10,
    top=0.89,
    columns=4,
    elevation_deg=38.0,
    zoom=1.05,
    pattern=0.11,
    axis=0.17,
    between=0.10,
)
ALONE = View(
    width_inch=7.0,
    height_inch=5.4,
    bottom=0.13,
    top=0.97,
    columns=3,
    elevation_deg=38.0,
    zoom=1.17,
    pattern=0.11,
    axis=0.17,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """What a panel has to show, and how.

    Args:
        scenario: the scene.
        poses: those that there must be room for.
        view: size, camera and lengths.
        uncertain: whether sets are drawn that jammers and eavesdroppers may be anywhere in.
    """

    scenario: Scenario
    poses: tuple[Pose, ...]
    view: View
    uncertain: bool = False

    @property
    def points_m(self) -> FloatArray:
        """All ground points and positions, (n, 3), metres."""
        scenario = self.scenario
        groups = (scenario.node_positions_m, scenario.jammer_positions_m, scenario.eavesdropper_positions_m)
        return np.vstack([*groups, *(pose.position_m for pose in self.poses)])

    @property
    def extent_m(self) -> float:
        """How wide the scene is, of which all drawn lengths are shares, metres."""
        return max(_LEAST_M, float(np.max(np.ptp(self.points_m[:, :2], axis=0))))

    @property
    def outlines(self) -> tuple[Outline, ...]:
        """Its fence and its no-fly zones."""
        return outlines_of(self.scenario.airspace, self.points_m, _FAR * self.extent_m)

    @property
    def hidden(self) -> tuple[tuple[str, str, tuple[Jammer, ...] | tuple[Eavesdropper, ...]], ...]:
        """The kinds of points that a null is for: name, colour and points."""
        return (
            ("jammer", _JAMMER, self.scenario.jammers),
            ("eavesdropper", _EAVESDROPPER, self.scenario.eavesdroppers),
        )


def draw_scene(axes: Any, stage: Stage, pose: Pose) -> None:
    """Draw the scene around a pose: points, zones, links and lines, all but the vehicle itself.

    Args:
        axes: where to draw.
        stage: what there is.
        pose: the one that links lead to.
    """
    _frame(axes, stage)
    draw_outlines(axes, stage.outlines, _FORBIDDEN)
    _draw_points(axes, stage)
    position = pose.position_m
    for node in stage.scenario.node_positions_m:
        draw_line(axes, node, position, color=NODE, linewidth=0.8, alpha=0.7, zorder=2)
    floor = axes.get_zlim()[0]
    ground = np.array([position[0], position[1], floor])
    draw_line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    axes.scatter(*ground, color=GREY, marker="+", s=30, zorder=2)
    for name, colour, points in stage.hidden:
        for point in points:
            place = np.asarray(point.position_m)
            draw_line(
                axes, position, place, color=colour, linewidth=1.5, linestyle=(0, (3, 1.5)), zorder=6.6,
                label=f"line to the {name}",
            )  # fmt: skip
            foot = np.array([place[0], place[1], floor])
            draw_line(axes, place, foot, color=colour, linewidth=0.8, linestyle=":")
        if stage.uncertain:
            draw_uncertainty(axes, points, colour, f"where the {name} may be")


def draw_line(axes: Any, start: FloatArray, stop: FloatArray, **style: Any) -> None:
    """Draw a straight line.

    Args:
        axes: where to draw.
        start: shape ``(3,)``, metres.
        stop: shape ``(3,)``, metres.
        style: of the line.
    """
    axes.plot(*np.stack([start, stop]).T, **style)


def draw_names(axes: Any, stage: Stage, pose: Pose, radius_m: float) -> None:
    """Write the names of points and zones where they cover nothing; last, when the axes have their place.

    Args:
        axes: with the scene drawn.
        stage: what there is.
        pose: the one drawn.
        radius_m: of its pattern, which is kept free, metres.
    """
    scenario = stage.scenario
    labels = [
        Label(
            point.name,
            np.asarray(point.position_m),
            colour,
            beside=True,
            around_m=point.uncertainty_reach_m if stage.uncertain else 0.0,
        )
        for _, colour, points in stage.hidden
        for point in points
    ]
    labels += [
        Label(name, point, NODE)
        for name, point in zip(scenario.node_names, scenario.node_positions_m, strict=True)
    ]
    labels += outline_labels(axes, stage.outlines, _FORBIDDEN)
    place_labels(axes, labels, pose.position_m, radius_m)


def _draw_points(axes: Any, stage: Stage) -> None:
    scenario = stage.scenario
    kinds = (
        ("node", NODE, "s", 3.0, scenario.node_positions_m),
        ("jammer", _JAMMER, "X", 6.0, scenario.jammer_positions_m),
        ("eavesdropper", _EAVESDROPPER, "D", 6.0, scenario.eavesdropper_positions_m),
    )
    for label, colour, marker, order, points in kinds:
        if len(points):
            axes.scatter(
                *points.T, color=colour, marker=marker, s=38, zorder=order, depthshade=False, label=label
            )


def _limits(stage: Stage) -> tuple[FloatArray, FloatArray]:
    """Return the corners of the space drawn, metres."""
    view, extent_m = stage.view, stage.extent_m
    points = stage.points_m
    if stage.uncertain:
        sets = [reach_of(point) for _, _, points in stage.hidden for point in points]
        points = np.vstack([points, *sets])
    low, high = points.min(axis=0) - _MARGIN * extent_m, points.max(axis=0) + _MARGIN * extent_m
    positions = np.stack([pose.position_m for pose in stage.poses])
    for side in (0, 1):  # room for the pattern, whatever the scene's extent
        low[side] = min(low[side], positions[:, side].min() - view.axis * extent_m)
        high[side] = max(high[side], positions[:, side].max() + view.axis * extent_m)
        for outline in stage.outlines:
            low[side] = min(low[side], outline.vertices_m[:, side].min())
            high[side] = max(high[side], outline.vertices_m[:, side].max())
    low[2] = min(0.0, float(points[:, 2].min()))
    high[2] = float(positions[:, 2].max()) + 1.3 * view.pattern * extent_m
    return low, high


def _frame(axes: Any, stage: Stage) -> None:
    from matplotlib.ticker import FixedLocator, MaxNLocator

    low, high = _limits(stage)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=stage.view.zoom)  # one metre is as long along every axis
    axes.set_xlabel("x (east)  m", labelpad=-3)
    axes.set_ylabel("y (north)  m", labelpad=-1)
    axes.set_zlabel("z (up)  m", labelpad=-8)
    axes.tick_params(pad=-2, labelsize=7.5)
    sides = ((axes.xaxis, 5), (axes.yaxis, 7), (axes.zaxis, 3))
    for index, (axis, most) in enumerate(sides):
        ticks = MaxNLocator(most, steps=(1, 2, 5, 10)).tick_values(low[index], high[index])
        edge = _EDGE * (high[index] - low[index]) if index < 2 else 0.0
        inside = [tick for tick in ticks if low[index] + edge <= tick <= high[index] - edge]
        axis.set_major_locator(FixedLocator(inside))
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
    axes.view_init(elev=stage.view.elevation_deg, azim=stage.view.azimuth_deg)
