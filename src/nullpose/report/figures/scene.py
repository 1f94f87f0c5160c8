"""A scene in 3-D: its points with their names, its fence and zones, and a vehicle."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.ticker import FixedLocator, MaxNLocator
from numpy.typing import ArrayLike

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.bodies import draw_set, draw_zone, set_box_m
from nullpose.report.figures.labels import Label, place_labels
from nullpose.report.figures.style import GREY
from nullpose.report.geometry import outline_m
from nullpose.scenario import Eavesdropper, Jammer, Node, NoFlyZone, Scenario

# Lengths drawn, as shares of the scene's extent.
_MARGIN = 0.12  # free ground around the scene
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_EDGE = 0.04  # ticks nearer to a corner run into those of the next axis
AXIS = 1.5  # half-length of the antenna axis over the radius of the pattern
DRONE, SURFACE = "#0a3fd6", "#8fb0ff"
FORBIDDEN = "#b36b00"
KINDS = {
    "node": ("#0a6f3c", "s", 3.0),
    "jammer": ("#d40000", "X", 6.0),
    "eavesdropper": ("#9a4fb0", "D", 6.0),
}
"""Colour, marker and drawing order of points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """How a figure looks: its size, its camera, and lengths as shares of the scene's extent.

    Args:
        inches: width of each panel, height of the figure.
        edges: where panels end and begin, as shares of the height.
        elevation_deg: how high the camera stands.
        pattern: radius drawn where the gain is largest; a pattern has no size of its own.
        azimuth_deg: where the camera stands, from x (east) towards y (north).
        zoom: how much of its place a scene fills.
        pad_pt: more room between numbers and names of the level axes, points.
    """

    inches: tuple[float, float]
    edges: tuple[float, float]
    elevation_deg: float
    pattern: float
    azimuth_deg: float = -32.0
    zoom: float = 1.12
    pad_pt: float = 0.0

    @property
    def camera(self) -> FloatArray:
        """Direction towards the camera, shape ``(3,)``."""
        elevation, azimuth = math.radians(self.elevation_deg), math.radians(self.azimuth_deg)
        flat = math.cos(elevation)
        return np.array([flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)])


PANELS = View(inches=(4.6, 3.7), edges=(0.08, 0.98), elevation_deg=20.0, pattern=0.15)
PAIR = View(inches=(4.8, 4.7), edges=(0.10, 0.89), elevation_deg=38.0, pattern=0.11, zoom=1.02)
ALONE = View(inches=(7.0, 5.4), edges=(0.13, 0.97), elevation_deg=38.0, pattern=0.11)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """What a figure has to show, and how.

    Args:
        scenario: the scene.
        poses: one for each panel; all show the same space.
        view: size, camera and lengths.
        uncertain: whether sets are drawn that jammers and eavesdroppers may be anywhere in.
    """

    scenario: Scenario
    poses: tuple[Pose, ...]
    view: View
    uncertain: bool = False

    @property
    def points(self) -> list[tuple[str, Node | Jammer | Eavesdropper]]:
        """All points with their kinds, those that a null is for before the nodes."""
        scene = self.scenario
        kinds: dict[str, Sequence[Node | Jammer | Eavesdropper]]
        kinds = {"jammer": scene.jammers, "eavesdropper": scene.eavesdroppers, "node": scene.nodes}
        return [(kind, point) for kind, points in kinds.items() for point in points]

    @property
    def places_m(self) -> FloatArray:
        """All points and positions, (n, 3), metres."""
        points_m = [point.position_m for _, point in self.points]
        return np.array([*points_m, *(pose.position_m for pose in self.poses)])

    @property
    def extent_m(self) -> float:
        """How wide the scene is, of which all drawn lengths are shares, metres."""
        return max(_LEAST_M, float(np.max(np.ptp(self.places_m[:, :2], axis=0))))

    @property
    def zones(self) -> list[tuple[NoFlyZone | None, FloatArray]]:
        """The fence (None) and the no-fly zones with their corners, those left out that reach far away."""
        airspace, places_m = self.scenario.airspace, self.places_m[:, :2]
        middle_m, far_m = 0.5 * (places_m.min(axis=0) + places_m.max(axis=0)), _FAR * self.extent_m
        outlines: list[tuple[NoFlyZone | None, FloatArray]] = []
        outlines += [(zone, outline_m(zone)) for zone in airspace.no_fly]
        if airspace.geofence_m is not None:
            outlines.append((None, airspace.geofence_outline_m))
        return [each for each in outlines if np.all(np.abs(each[1] - middle_m) <= far_m)]


def draw_line(axes: Any, start: ArrayLike, stop: ArrayLike, **style: Any) -> None:
    """Draw a straight line.

    Args:
        axes: where to draw.
        start: shape ``(3,)``, metres.
        stop: shape ``(3,)``, metres.
        style: of the line.
    """
    axes.plot(*np.stack([start, stop]).T, **style)


def draw_panel(axes: Any, stage: Stage, pose: Pose, draw_vehicle: Callable[[Any, Stage, Pose], None]) -> None:
    """Draw the scene, the vehicle at a pose, and the names of points.

    Args:
        axes: where to draw, three-dimensional, its place in the figure set.
        stage: what is to be seen.
        pose: of the vehicle.
        draw_vehicle: draws it.
    """
    axes.computed_zorder = False
    labels = _draw_scene(axes, stage, pose)
    draw_vehicle(axes, stage, pose)
    place_labels(axes, labels, pose.position_m, stage.view.pattern * stage.extent_m)


def _draw_scene(axes: Any, stage: Stage, pose: Pose) -> list[Label]:
    """Return the names of points and zones, after drawing the scene around a pose, all but the vehicle."""
    _frame(axes, stage)
    position, floor_m = pose.position_m, axes.get_zlim()[0]
    ground = np.array([*position[:2], floor_m])
    draw_line(axes, ground, position, color=GREY, linewidth=1.1, linestyle=":", zorder=6)
    labels = []
    for kind, point in stage.points:
        place, (colour, marker, order) = np.asarray(point.position_m), KINDS[kind]
        axes.scatter(*place, color=colour, marker=marker, s=38, zorder=order, depthshade=False, label=kind)
        around_m = 0.0
        if isinstance(point, Node):
            draw_line(axes, place, position, color=colour, linewidth=0.8, alpha=0.7, zorder=2)
        else:
            look = {
                "linewidth": 1.5,
                "linestyle": (0, (3, 1.5)),
                "zorder": 6.6,
                "label": f"line to the {kind}",
            }
            draw_line(axes, position, place, color=colour, **look)
            draw_line(axes, place, [*place[:2], floor_m], color=colour, linewidth=0.8, linestyle=":")
            around_m = point.uncertainty_reach_m if stage.uncertain else 0.0
            if around_m > 0.0:
                draw_set(axes, point, colour, f"where the {kind} may be")
        labels.append(Label(point.name, place, colour, beside=kind != "node", around_m=around_m))
    for zone, corners_m in stage.zones:
        labels += draw_zone(axes, zone, corners_m, FORBIDDEN)
    return labels


def limits_m(stage: Stage) -> tuple[FloatArray, FloatArray]:
    """Return the low and the high corner of the space drawn, each (3,), metres.

    Args:
        stage: what is to be seen.
    """
    extent_m, points = stage.extent_m, stage.places_m
    hidden = [point for _, point in stage.points if not isinstance(point, Node) and stage.uncertain]
    points = np.vstack([points, *map(set_box_m, hidden)])
    positions = np.array([pose.position_m[:2] for pose in stage.poses])
    around = ((points[:, :2], _MARGIN), (positions, AXIS * stage.view.pattern))  # the latter for the pattern
    flat = [middle + side * reach * extent_m for middle, reach in around for side in (-1.0, 1.0)]
    flat += [corners_m for _, corners_m in stage.zones]
    low, high = np.vstack(flat).min(axis=0), np.vstack(flat).max(axis=0)
    top_m = max(pose.position_m[2] for pose in stage.poses) + 1.3 * stage.view.pattern * extent_m
    low_m = min(0.0, points[:, 2].min())
    return np.append(low, low_m), np.append(high, top_m)


def _frame(axes: Any, stage: Stage) -> None:
    low, high = limits_m(stage)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(tuple(high - low), zoom=stage.view.zoom)  # one metre is as long along every axis
    pad_pt = stage.view.pad_pt
    axes.set_xlabel("x (east)  m", labelpad=pad_pt - 3)
    axes.set_ylabel("y (north)  m", labelpad=pad_pt - 1)
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
