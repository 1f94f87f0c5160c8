"""A vehicle's antenna in 3-D: its pattern with the null, and where nodes, jammers and eavesdroppers are."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.patheffects import withStroke
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import NDArray

from nullpose.antenna import Antenna
from nullpose.antenna.harmonics import directions
from nullpose.physics import Pose
from nullpose.physics.array import placed_elements
from nullpose.physics.types import FloatArray
from nullpose.report.figures.pattern import beam_surface, draw_surface, pattern_surface
from nullpose.report.figures.stage import Stage
from nullpose.report.figures.style import DRONE, INK, MARKS, NULL, Look

NULL_LINE: Look = {
    "color": NULL,
    "linewidth": 1.8,
    "path_effects": [withStroke(linewidth=2.6, foreground=INK)],
}
"""How the direction of the null is drawn: its rim is seen on any ground."""

_OPEN_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_VIEW_DEG = 35.0, (-70.0, -110.0, -40.0, -140.0)  # its elevation, and azimuths: south of the drone
_ARRAY_VIEW_DEG = 60.0, (-90.0,)  # a beam is seen best from above
_RIM: Look = {"edgecolors": "white", "linewidths": 0.5, "s": 30, "depthshade": False}
# Lengths drawn, over the radius of the pattern.
_AXIS, _NODES, _OTHERS, _HEADING = 1.2, 1.2, 1.4, 1.2  # from the drone
_ARRAY = 0.5  # from the middle to the outermost element


def draw_inset(axes: Axes3D, stage: Stage, pose: Pose) -> None:
    """Draw the antenna at a pose around the drone, and lines towards all points, shorter ones to nodes.

    Args:
        axes: in 3-D, where the drone is at 0 and the largest gain is 1 away from it.
        stage: what is to be seen; all its poses are seen from one side.
        pose: of the drone.
    """
    axes.computed_zorder = False
    elevation_deg, azimuths_deg = _VIEW_DEG if stage.beam is None else _ARRAY_VIEW_DEG
    cameras = directions(np.array([90.0 - elevation_deg]), np.array(azimuths_deg))[0]
    seen = np.linalg.norm(np.cross([pose.antenna_axis for pose in stage.poses], cameras[:, None]), axis=-1)
    best = int(np.argmax(seen.min(axis=1)))  # where the axes are seen best
    for kind, point in stage.points:
        away, (colour, marker) = np.asarray(point.position_m) - pose.position_m, MARKS[kind]
        end, order = _OTHERS * away / max(float(np.linalg.norm(away)), 1e-9), 6.8
        line: Look = {"linewidth": 1.2, "linestyle": (0, (3, 1.5))}
        if kind == "node":  # pale if it is behind
            end, order = _NODES / _OTHERS * end, 6.6
            line = {"linewidth": 0.8, "alpha": 1.0 if end @ cameras[best] > 0.0 else 0.4}
        axes.plot(*np.outer(end, (0.0, 1.0)), color=colour, zorder=order, label=kind, **line)
        axes.scatter(*end, marker=marker, color=colour, zorder=order, **_RIM)
    if stage.beam is None:
        _draw_antenna(axes, stage.scenario.antenna_record, pose, cameras[best])
    else:
        _draw_array(axes, placed_elements(stage.scenario, pose), stage.beam[1], pose.yaw_rad)
    axes.set(xlim=(-1.0, 1.0), ylim=(-1.0, 1.0), zlim=(-1.0, 1.0), proj_type="ortho")
    axes.set_box_aspect((1.0, 1.0, 1.0), zoom=1.05)
    axes.view_init(elev=elevation_deg, azim=azimuths_deg[best])
    axes.set_axis_off()


def _draw_antenna(axes: Axes3D, antenna: Antenna, pose: Pose, camera: FloatArray) -> None:
    """Draw the axis, and the pattern with its near side cut away, so that the null can be seen."""
    label = "antenna axis (null)" if antenna.is_quadratic else "antenna's z axis"
    axes.plot(*np.outer(pose.antenna_axis, (-_AXIS, _AXIS)), label=label, zorder=6.5, **NULL_LINE)
    surface = pattern_surface(antenna, pose, camera, _OPEN_RAD)
    draw_surface(axes, surface, (surface[:, :, 0], surface[:, :, -1]))
    axes.scatter(0.0, 0.0, 0.0, color=DRONE, s=26, zorder=7.0, depthshade=False)


def _draw_array(axes: Axes3D, elements: FloatArray, weights: NDArray[np.complex128], yaw_rad: float) -> None:
    """Draw an array's beam with its horizontal cut, its heading and its elements."""
    surface = beam_surface(elements, weights)
    draw_surface(axes, surface, [surface[:, surface.shape[1] // 2]])
    ahead = _HEADING * np.array([math.cos(yaw_rad), math.sin(yaw_rad), 0.0])
    axes.quiver(
        *(0.0, 0.0, 0.0, *ahead),
        color=INK,
        linewidth=1.2,
        arrow_length_ratio=0.16,
        zorder=7.1,
        label="heading (yaw)",
    )
    places = _ARRAY / max(float(np.linalg.norm(elements, axis=1).max()), 1e-9) * elements
    axes.scatter(*places.T, color=DRONE, label="elements, not to scale", zorder=7.3, **_RIM | {"s": 22})
