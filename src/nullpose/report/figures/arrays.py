"""An array in its scene: where the vehicle hovers, how it is turned, and where its beam looks."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.array import element_positions
from nullpose.report.figures.pattern import beam_surface_m, draw_beam
from nullpose.report.figures.poses import draw_stages, escaped, plain_name
from nullpose.report.figures.scene import (
    ALONE,
    DRONE,
    SURFACE,
    Stage,
    View,
    draw_line,
)
from nullpose.report.figures.style import INK
from nullpose.report.numbers import MINUS
from nullpose.solve import ArraySolution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_array"]

# Lengths drawn, as shares of the scene's extent.
_ARRAY = 0.10  # from the middle to the outermost element
_UPRIGHT = 0.018  # half of an element
_HEADING = 0.20
_BEAM = 0.20  # where the gain is largest
_ELSEWHERE_DEG = ALONE.azimuth_deg + 27.0  # where the camera stands if the array would be seen end on


def draw_array(solution: ArraySolution) -> Figure:
    """Return the figure of an array: the scene, its elements larger than life, its heading and its beam.

    Digital combining has a beam for each node; the one drawn is that of the node with the smallest value.

    Args:
        solution: what was found.
    """

    def vehicle(axes: Any, stage: Stage, _: Pose) -> None:
        _draw_vehicle(axes, stage, solution)

    stage = Stage(scenario=solution.scenario, poses=(solution.pose,), view=_view(solution))
    words = _beam_words(solution)
    return draw_stages(
        [stage], [solution.pose], [], _title(solution), vehicle=vehicle, radius=_BEAM, surface=words
    )


def _view(solution: ArraySolution) -> View:
    """Return the camera, for a row of elements the one that sees it more from the side."""
    if solution.layout != "linear":
        return ALONE

    def across(azimuth_deg: float) -> float:
        return abs(math.sin(solution.yaw_rad - math.radians(azimuth_deg)))

    return replace(ALONE, azimuth_deg=max(ALONE.azimuth_deg, _ELSEWHERE_DEG, key=across))


def _title(solution: ArraySolution) -> str:
    objective = solution.objective
    value = f"{objective.quantity.smallest} {objective.value_db:.2f} dB"
    yaw = f"yaw {math.degrees(solution.yaw_rad):.1f}°"
    words = f"{solution.label}: {value}, {yaw}".replace("-", MINUS)
    return f"{plain_name(solution.scenario)}\n{words}".strip()


def _beam_words(solution: ArraySolution) -> str:
    if solution.combining == "analogue":
        return "gain of the beam, level cut as a line"
    return f"gain of the beam for {escaped(solution.binding_node)}, level cut as a line"


def _draw_vehicle(axes: Any, stage: Stage, solution: ArraySolution) -> None:
    extent_m, position = stage.extent_m, solution.position_m
    elements = element_positions(
        solution.elements, solution.layout, solution.spacing_wavelengths, solution.yaw_rad
    )
    weights = solution.weights
    if solution.combining == "digital":
        names = [link.node for link in solution.links]
        weights = weights[names.index(solution.binding_node)]
    draw_beam(axes, beam_surface_m(position, elements, weights, _BEAM * extent_m), SURFACE, DRONE)
    ahead = np.array([math.cos(solution.yaw_rad), math.sin(solution.yaw_rad), 0.0])
    axes.quiver(
        *position, *(_HEADING * extent_m * ahead), color=INK, linewidth=1.2, arrow_length_ratio=0.16,
        zorder=7.1, label="heading (yaw)",
    )  # fmt: skip
    reach = max(float(np.linalg.norm(elements, axis=1).max()), 1e-9)
    places = position + _ARRAY * extent_m / reach * elements
    up = np.array([0.0, 0.0, _UPRIGHT * extent_m])
    for place in places:
        draw_line(axes, place - up, place + up, color=DRONE, linewidth=1.4, zorder=7.2)
    axes.scatter(
        *places.T,
        color=DRONE,
        edgecolors="white",
        linewidths=0.5,
        s=22,
        zorder=7.3,
        depthshade=False,
        label="elements, larger than life",
    )
