"""Poses in 3-D with the pattern: of one result, at several jamming levels, under errors, of an array."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.physics.array import element_positions
from nullpose.physics.types import FloatArray
from nullpose.report.figures.panels import draw_panels
from nullpose.report.figures.pattern import beam_surface_m, draw_surface, pattern_surface_m
from nullpose.report.figures.scene import (
    ALONE,
    AXIS,
    DRONE,
    PAIR,
    PANELS,
    SURFACE,
    Stage,
    draw_line,
)
from nullpose.report.figures.style import INK
from nullpose.report.geometry import null_angle_rad
from nullpose.report.numbers import MINUS, with_unit
from nullpose.report.sensitivity import sensitivity_caption
from nullpose.report.words import error_words
from nullpose.scenario import Eavesdropper, Jammer, Scenario
from nullpose.solver import Objective, Result
from nullpose.solver.array import ArrayDetails
from nullpose.solver.robust import RobustDetails
from nullpose.study import SweepRow

_LETTERS = 100  # in a line of a title
_CUT_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_SURFACE = "radiation pattern, near side cut away"
_WHOLE = "radiation pattern"

# Lengths drawn, as shares of the scene's extent.
_ARRAY = 0.10  # from the middle to the outermost element
_UPRIGHT = 0.018  # half of an element
_HEADING = _BEAM = 0.20  # the heading's arrow, and the beam where the gain is largest
_ELSEWHERE_DEG = ALONE.azimuth_deg + 27.0  # where the camera stands if the array would be seen end on


def draw_poses(scenario: Scenario, rows: Sequence[SweepRow]) -> Figure:
    """Return the figure of several best poses side by side, one panel each.

    Args:
        scenario: the scene, with one jammer or more.
        rows: the poses to draw, each at its own jamming level.
    """
    titles = [f"$P_M/P$ = {row.value:g}\n{_words(scenario, row.objective, row.pose)}" for row in rows]
    stage = Stage(scenario=scenario, poses=tuple(row.pose for row in rows), view=PANELS)
    return draw_panels(stage, draw_dipole, surface=_SURFACE, titles=titles)


def draw_result(result: Result, width: str | None = None) -> Figure:
    """Return the figure of one result: of a dipole's pose, of an array, or of a robust pose.

    Args:
        result: of any kind.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    drawings = {RobustDetails: draw_robust, ArrayDetails: draw_array}
    return drawings.get(type(result.details), draw_pose)(result, width)


def draw_pose(solution: Result, width: str | None = None) -> Figure:
    """Return the figure of one solution: the scene, its fence and its no-fly zones, the pose and its pattern.

    Args:
        solution: what was found.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    scenario, pose = solution.scenario, solution.pose
    words = "; ".join(
        filter(None, (_words(scenario, solution.objective, pose), sensitivity_caption(solution)))
    )
    words = textwrap.fill(words, _LETTERS)
    stage = Stage(scenario=scenario, poses=(pose,), view=ALONE)
    is_pattern = not scenario.antenna_record.is_quadratic
    look: dict[str, Any] = {"surface": _WHOLE if is_pattern else _SURFACE, "plan": True, "width": width}
    return draw_panels(stage, draw_dipole, head=f"{scenario.name}\n{words}", **look)


def draw_robust(solution: Result, width: str | None = None) -> Figure:
    """Return the figure of a robust solution: its pose, and beside it the one that is best without errors.

    Both panels show the same space, with the sets that jammers and eavesdroppers may be anywhere in.

    Args:
        solution: what was found.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    scenario, quantity = solution.scenario, Quantity.of(solution.scenario)
    both = {"robust pose": solution.details.robust, "best pose without errors": solution.details.nominal}
    titles = []
    for name, one in both.items():
        guaranteed = with_unit(quantity.in_unit(one.guaranteed), quantity)
        stated = with_unit(quantity.in_unit(one.nominal), quantity)
        titles.append(f"{name}\n{guaranteed} guaranteed, {stated} without errors")
    errors = f"{quantity.smallest}; errors: {error_words(scenario)}"
    head = f"{scenario.name}\n{textwrap.shorten(errors, _LETTERS, placeholder=' ...')}"
    stage = Stage(
        scenario=scenario, poses=tuple(one.pose for one in both.values()), view=PAIR, uncertain=True
    )
    return draw_panels(stage, draw_dipole, surface=_SURFACE, head=head, titles=titles, width=width)


def _words(scenario: Scenario, objective: Objective, pose: Pose) -> str:
    """Return the value at a pose, and how far a dipole's null is off the jammers, or the eavesdroppers."""
    quantity = objective.quantity
    points: tuple[Jammer | Eavesdropper, ...] = scenario.eavesdroppers or scenario.jammers
    angles_deg = [math.degrees(null_angle_rad(pose, point.position_m)) for point in points]
    nulls = [f"{angle:.1f}° off {point.name}" for angle, point in zip(angles_deg, points, strict=True)]
    value = f"{quantity.smallest} {with_unit(quantity.in_unit(objective.value), quantity)}"
    is_dipole = scenario.antenna_record.is_quadratic
    return f"{value}, null {', '.join(nulls)}" if nulls and is_dipole else value


def draw_dipole(axes: Any, stage: Stage, pose: Pose) -> None:
    """Draw the axis, and the doughnut with its near side cut away, so that the null can be seen.

    Args:
        axes: where to draw, three-dimensional.
        stage: what is to be seen.
        pose: of the drone.
    """
    radius_m, position = stage.view.pattern * stage.extent_m, pose.position_m
    reach = AXIS * radius_m * pose.antenna_axis
    antenna = stage.scenario.antenna_record
    named = "antenna's z axis" if not antenna.is_quadratic else "antenna axis (null)"
    look = {"linewidth": 1.8, "zorder": 6.5, "label": named}
    draw_line(axes, position - reach, position + reach, color=DRONE, **look)
    around = np.linspace(0.5 * _CUT_RAD, math.tau - 0.5 * _CUT_RAD, 49)
    surface = pattern_surface_m(antenna, pose, radius_m, around, stage.view.camera)
    draw_surface(axes, surface, SURFACE, (surface[:, :, 0], surface[:, :, -1]), DRONE)
    axes.scatter(*position, color=DRONE, s=26, zorder=7, depthshade=False, label="drone")


def draw_array(solution: Result, width: str | None = None) -> Figure:
    """Return the figure of an array: the scene, its elements not to scale, its heading and its beam.

    Digital combining has a beam for each node; the one drawn is that of the node with the smallest value.

    Args:
        solution: what was found.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    array, quantity, yaw_rad = solution.details, solution.objective.quantity, solution.pose.yaw_rad
    elements = element_positions(array.elements, array.layout, array.spacing_wavelengths, yaw_rad)
    weights = array.weights[[link.node for link in solution.links].index(solution.binding_node)]
    azimuth_deg = ALONE.azimuth_deg
    if array.layout == "linear":  # seen more from the side
        places = (azimuth_deg, _ELSEWHERE_DEG)
        azimuth_deg = max(places, key=lambda deg: abs(math.sin(yaw_rad - math.radians(deg))))
    value = with_unit(quantity.in_unit(solution.objective.value), quantity)
    yaw = f"yaw {math.degrees(yaw_rad):.1f}°".replace("-", MINUS)
    view = replace(ALONE, azimuth_deg=azimuth_deg, pattern=_BEAM)
    return draw_panels(
        Stage(scenario=solution.scenario, poses=(solution.pose,), view=view),
        lambda axes, stage, pose: _draw_array(axes, stage, pose, elements, weights),
        surface=f"gain of the beam for {solution.binding_node}, horizontal cut as a line",
        head=f"{solution.scenario.name}\n{solution.label}: {quantity.smallest} {value}, {yaw}; "
        f"{sensitivity_caption(solution)}",
        plan=True,
        width=width,
    )


def _draw_array(
    axes: Any, stage: Stage, pose: Pose, elements: FloatArray, weights: NDArray[np.complex128]
) -> None:
    """Draw an array's beam with its horizontal cut, its heading, and its elements as upright lines."""
    extent_m, position = stage.extent_m, pose.position_m
    surface = beam_surface_m(position, elements, weights, _BEAM * extent_m)
    draw_surface(axes, surface, SURFACE, [surface[:, surface.shape[1] // 2]], DRONE)
    ahead = _HEADING * extent_m * np.array([math.cos(pose.yaw_rad), math.sin(pose.yaw_rad), 0.0])
    look = {"linewidth": 1.2, "arrow_length_ratio": 0.16, "zorder": 7.1, "label": "heading (yaw)"}
    axes.quiver(*position, *ahead, color=INK, **look)
    reach = max(float(np.linalg.norm(elements, axis=1).max()), 1e-9)
    places = position + _ARRAY * extent_m / reach * elements
    up = np.array([0.0, 0.0, _UPRIGHT * extent_m])
    for place in places:
        draw_line(axes, place - up, place + up, color=DRONE, linewidth=1.4, zorder=7.2)
    dots = {"edgecolors": "white", "linewidths": 0.5, "s": 22, "zorder": 7.3, "depthshade": False}
    axes.scatter(*places.T, color=DRONE, label="elements, not to scale", **dots)
