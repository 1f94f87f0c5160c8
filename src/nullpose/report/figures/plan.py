"""A scene from above: its points with their names, fence and zones, the drone and its antenna's axis."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.patches import Polygon

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.figures.labels import Label, place_labels
from nullpose.report.figures.scene import AXIS, DRONE, FORBIDDEN, KINDS, Stage, limits_m
from nullpose.report.figures.style import GREY
from nullpose.scenario import Node


def draw_plan(axes: Any, stage: Stage, pose: Pose, box_m: FloatArray | None = None) -> None:
    """Draw a scene from above, one metre being as long to the east as to the north.

    The antenna's axis is drawn as it is seen from there: short if it is upright.

    Args:
        axes: where to draw, two-dimensional.
        stage: what is to be seen.
        pose: of the drone.
        box_m: low and high corner of what is shown, (2, 2), metres; the whole stage if left out.
    """
    low, high = np.stack(limits_m(stage))[:, :2] if box_m is None else box_m
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x (east)  m", ylabel="y (north)  m")
    axes.set_aspect("equal")
    labels = []
    for zone, corners_m in stage.zones:
        look: dict[str, Any] = {"facecolor": "none", "edgecolor": GREY, "label": "geofence"}
        look["linestyle"] = "--"
        if zone is not None:
            look = {"facecolor": (FORBIDDEN, 0.12), "edgecolor": FORBIDDEN, "label": "no-fly zone"}
            labels.append(Label(zone.name, np.append(corners_m.mean(axis=0), 0.0), FORBIDDEN, on=True))
        axes.add_patch(Polygon(corners_m, linewidth=0.8, zorder=1.0, **look))
    x, y = pose.position_m[:2]
    rim = {"edgecolors": "white", "linewidths": 0.5}
    for kind, point in stage.points:
        place, (colour, marker, order) = np.asarray(point.position_m), KINDS[kind]
        link: dict[str, Any] = {"color": colour, "linewidth": 0.8, "zorder": 1.5}
        if not isinstance(point, Node):
            link = {"color": colour, "linewidth": 1.2, "linestyle": (0, (3, 1.5)), "zorder": 1.6}
        axes.plot([x, place[0]], [y, place[1]], **link)
        axes.scatter(*place[:2], color=colour, marker=marker, s=30, zorder=order, **rim, label=kind)
        labels.append(Label(point.name, place, colour, beside=kind != "node"))
    radius_m = stage.view.pattern * stage.extent_m
    reach = AXIS * radius_m * pose.antenna_axis[:2]
    ends = np.stack([pose.position_m[:2] - reach, pose.position_m[:2] + reach])
    axes.plot(*ends.T, color=DRONE, linewidth=1.8, zorder=6.5)
    axes.scatter(x, y, color=DRONE, s=30, zorder=7, **rim, label="drone")
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    inner = 0.05 * (high - low)  # the name of a zone is wide
    labels = [one for one in labels if np.all(np.abs(one.point_m[:2] - middle) <= half - inner * one.on)]
    place_labels(axes, labels, pose.position_m, 0.3 * radius_m)
