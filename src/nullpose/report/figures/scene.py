"""A scene in 3-D: its points with their names, its fence and zones, a vehicle, and the panels of a figure."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.bodies import draw_fence, draw_set, draw_zone, set_box_m
from nullpose.report.figures.labels import Label, place_labels
from nullpose.report.figures.style import GREY, house_style
from nullpose.report.geometry import outline_m
from nullpose.scenario import Eavesdropper, Jammer, Node, NoFlyZone, Scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["ALONE", "DRONE", "PAIR", "PANELS", "SURFACE", "Stage", "View", "draw_line", "draw_panels"]

# Lengths drawn, as shares of the scene's extent.
_MARGIN = 0.12  # free ground around the scene
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_EDGE = 0.04  # ticks nearer to a corner run into those of the next axis
_AXIS = 1.5  # half-length of the antenna axis over the radius of the pattern
DRONE, SURFACE = "#0a3fd6", "#8fb0ff"
_NODE, _JAMMER, _EAVESDROPPER, _FORBIDDEN = "#0a6f3c", "#d40000", "#9a4fb0", "#b36b00"


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """How a figure looks: its size, its camera, and lengths as shares of the scene's extent.

    Args:
        inches: width of each panel, height of the figure.
        edges: where panels end and begin, as shares of the height.
        columns: of the legend.
        elevation_deg: how high the camera stands.
        zoom: how much of its place a scene fills.
        pattern: radius drawn where the gain is largest; a pattern has no size of its own.
        azimuth_deg: where the camera stands, from x (east) towards y (north).
    """

    inches: tuple[float, float]
    edges: tuple[float, float]
    columns: int
    elevation_deg: float
    zoom: float
    pattern: float
    azimuth_deg: float = -32.0

    @property
    def camera(self) -> FloatArray:
        """Direction towards the camera, shape ``(3,)``."""
        elevation, azimuth = math.radians(self.elevation_deg), math.radians(self.azimuth_deg)
        flat = math.cos(elevation)
        return np.array([flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)])


PANELS = View(inches=(4.6, 3.7), edges=(0.08, 0.98), columns=6, elevation_deg=20.0, zoom=1.13, pattern=0.15)
PAIR = View(inches=(4.8, 4.7), edges=(0.10, 0.89), columns=4, elevation_deg=38.0, zoom=1.05, pattern=0.11)
ALONE = View(inches=(7.0, 5.4), edges=(0.13, 0.97), columns=3, elevation_deg=38.0, zoom=1.17, pattern=0.11)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """What a figure has to show, and how.

    Args:
        scenario: the scene.
        poses: those that there must be room for in each panel.
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
    def zones(self) -> tuple[NoFlyZone, ...]:
        """The no-fly zones, those left out that reach far beyond the scene."""
        return tuple(zone for zone in self.scenario.airspace.no_fly if self.is_near(outline_m(zone)))

    @property
    def fence_m(self) -> FloatArray:
        """The corners of the geofence, (n, 2), metres; none without one, or if it reaches far away."""
        corners_m = self.scenario.airspace.geofence_outline_m
        return corners_m if self.is_near(corners_m) else corners_m[:0]

    def is_near(self, corners_m: FloatArray) -> bool:
        """Return whether an outline keeps to the surroundings of the scene.

        Args:
            corners_m: seen from above, shape ``(n, 2)``, metres.
        """
        middle_m = 0.5 * (self.points_m.min(axis=0) + self.points_m.max(axis=0))[:2]
        return bool(np.all(np.abs(corners_m - middle_m) <= _FAR * self.extent_m))

    @property
    def hidden(self) -> Iterator[tuple[str, str, Jammer | Eavesdropper]]:
        """The points that a null is for: kind, colour and point."""
        yield from (("jammer", _JAMMER, point) for point in self.scenario.jammers)
        yield from (("eavesdropper", _EAVESDROPPER, point) for point in self.scenario.eavesdroppers)


def draw_panels(
    stages: Sequence[Stage],
    poses: Sequence[Pose],
    draw_vehicle: Callable[[Any, Stage, Pose], None],
    *,
    surface: str,
    head: str = "",
    titles: Sequence[str] = (),
) -> Figure:
    """Return a figure with a panel for each pose: the scene, the vehicle, and the names of points.

    Args:
        stages: what each panel has to show; all have the same view.
        poses: one for each panel.
        draw_vehicle: draws the vehicle at a pose.
        surface: what its pattern is called in the legend.
        head: title of the figure; empty for none.
        titles: of the panels; none for no titles.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    view = stages[0].view
    with house_style():
        figure = Figure(figsize=(view.inches[0] * len(poses), view.inches[1]))
        figure.subplots_adjust(left=0.016, right=0.962, bottom=view.edges[0], top=view.edges[1], wspace=0.08)
        for index, (stage, pose) in enumerate(zip(stages, poses, strict=True)):
            axes: Any = figure.add_subplot(1, len(poses), index + 1, projection="3d", computed_zorder=False)
            labels = _draw_scene(axes, stage, pose)
            draw_vehicle(axes, stage, pose)
            place_labels(axes, labels, pose.position_m, view.pattern * stage.extent_m)
            axes.set_title(titles[index] if titles else "", fontsize=10, y=0.96)
        figure.suptitle(head, fontsize=10, parse_math=False)
        handles, names = figure.axes[0].get_legend_handles_labels()
        once = dict(zip(names, handles, strict=True)) | {surface: Patch(color=SURFACE, alpha=0.8)}
        columns = min(len(once), view.columns)
        legend = figure.legend(
            once.values(), once.keys(), loc="lower center", ncols=columns, frameon=False, handlelength=2.6
        )
        for text in legend.get_texts():
            text.set_parse_math(False)
    return figure


def draw_line(axes: Any, start: FloatArray, stop: FloatArray, **style: Any) -> None:
    """Draw a straight line.

    Args:
        axes: where to draw.
        start: shape ``(3,)``, metres.
        stop: shape ``(3,)``, metres.
        style: of the line.
    """
    axes.plot(*np.stack([start, stop]).T, **style)


def _draw_scene(axes: Any, stage: Stage, pose: Pose) -> list[Label]:
    """Return the names of points and zones, after drawing the scene around a pose, all but the vehicle."""
    _frame(axes, stage)
    position, floor_m = pose.position_m, axes.get_zlim()[0]
    ground = np.array([position[0], position[1], floor_m])
    draw_line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    axes.scatter(*ground, color=GREY, marker="+", s=30, zorder=2)
    if len(stage.fence_m):
        draw_fence(axes, stage.fence_m)
    nodes = [_draw_point(axes, node, "node", _NODE, "s", 3.0) for node in stage.scenario.nodes]
    for node_m in stage.scenario.node_positions_m:
        draw_line(axes, node_m, position, color=_NODE, linewidth=0.8, alpha=0.7, zorder=2)
    labels = []
    for name, colour, point in stage.hidden:
        around_m = point.uncertainty_reach_m if stage.uncertain else 0.0
        labels.append(_draw_point(axes, point, name, colour, "X" if name == "jammer" else "D", 6.0, around_m))
        place = labels[-1].point_m
        null = {"linewidth": 1.5, "linestyle": (0, (3, 1.5)), "zorder": 6.6, "label": f"line to the {name}"}
        draw_line(axes, position, place, color=colour, **null)
        draw_line(axes, place, np.array([*place[:2], floor_m]), color=colour, linewidth=0.8, linestyle=":")
        if stage.uncertain:
            draw_set(axes, point, colour, f"where the {name} may be")
    return [*labels, *nodes, *(label for zone in stage.zones for label in draw_zone(axes, zone, _FORBIDDEN))]


def _draw_point(
    axes: Any,
    point: Node | Jammer | Eavesdropper,
    kind: str,
    colour: str,
    marker: str,
    order: float,
    around_m: float = 0.0,
) -> Label:
    """Return a point's name after drawing its marker."""
    place = np.asarray(point.position_m)
    axes.scatter(*place, color=colour, marker=marker, s=38, zorder=order, depthshade=False, label=kind)
    return Label(point.name, place, colour, beside=kind != "node", around_m=around_m)


def _limits(stage: Stage) -> tuple[FloatArray, FloatArray]:
    """Return the corners of the space drawn, metres."""
    view, extent_m, points = stage.view, stage.extent_m, stage.points_m
    if stage.uncertain:
        points = np.vstack([points, *(set_box_m(point) for _, _, point in stage.hidden)])
    positions = np.stack([pose.position_m for pose in stage.poses])
    reach_m = _AXIS * view.pattern * extent_m  # room for the pattern, whatever the scene's extent
    outlines = [stage.fence_m, *map(outline_m, stage.zones)]
    flat = [points[:, :2] - _MARGIN * extent_m, points[:, :2] + _MARGIN * extent_m]
    flat += [positions[:, :2] - reach_m, positions[:, :2] + reach_m, *outlines]
    low, high = np.vstack(flat).min(axis=0), np.vstack(flat).max(axis=0)
    top_m = float(positions[:, 2].max()) + 1.3 * view.pattern * extent_m
    return np.append(low, min(0.0, points[:, 2].min())), np.append(high, top_m)


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
