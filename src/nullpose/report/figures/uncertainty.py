"""The sets that jammers and eavesdroppers may be anywhere in, as wires."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.scenario import Eavesdropper, Jammer

__all__ = ["draw_uncertainty", "reach_of", "wires_m"]

_MERIDIANS, _PARALLELS, _STEPS = (
    4,
    3,
    49,
)  # whole circles through the poles, circles about them, points of each


def wires_m(point: Jammer | Eavesdropper) -> FloatArray:
    """Return closed lines on the surface ``{position + A x : |x| = 1}`` of a point's set.

    Args:
        point: with its uncertainty.

    Returns:
        Array of shape ``(n, m, 3)``, metres.
    """
    turn = np.linspace(0.0, math.tau, _STEPS)
    cosine, sine = np.cos(turn), np.sin(turn)
    circles = [
        np.stack([sine * math.cos(at), sine * math.sin(at), cosine], axis=-1)
        for at in math.pi * np.arange(_MERIDIANS) / _MERIDIANS
    ]
    for at in math.pi * np.arange(1, _PARALLELS + 1) / (_PARALLELS + 1):
        circle = [math.sin(at) * cosine, math.sin(at) * sine, np.full(_STEPS, math.cos(at))]
        circles.append(np.stack(circle, axis=-1))
    return np.asarray(np.asarray(point.position_m) + np.stack(circles) @ point.uncertainty_matrix_m.T)


def reach_of(point: Jammer | Eavesdropper) -> FloatArray:
    """Return the corners of the box around a point's set, shape ``(2, 3)``, metres.

    Args:
        point: with its uncertainty.
    """
    half_m = np.linalg.norm(point.uncertainty_matrix_m, axis=1)
    return np.asarray(np.asarray(point.position_m) + np.stack([-half_m, half_m]))


def draw_uncertainty(
    axes: Any, points: Sequence[Jammer] | Sequence[Eavesdropper], colour: str, label: str
) -> None:
    """Draw the set of each point that has one.

    Args:
        axes: where to draw.
        points: jammers or eavesdroppers.
        colour: of their kind.
        label: for the legend.
    """
    for point in points:
        if point.uncertainty_reach_m > 0.0:
            for wire in wires_m(point):
                axes.plot(*wire.T, color=colour, linewidth=0.6, alpha=0.75, zorder=5.5, label=label)
