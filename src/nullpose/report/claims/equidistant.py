"""The best maximum-gain position among those equally far from both nodes."""

from __future__ import annotations

import numpy as np

from nullpose.physics import maximum_gain_sinr, maximum_gain_sinr_as_printed
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario

__all__ = ["best_equidistant"]

_REACH_M = (
    100.0  # horizontally from the nodes' midpoint; no pose of the paper's scenario worth having is farther
)
_ZOOMS, _SHRINK = 30, 0.4


def best_equidistant(scenario: Scenario, *, as_printed: bool = False) -> tuple[FloatArray, float]:
    """Return the best position on the plane halfway between two nodes, and the smallest SINR there.

    With the dipole broadside to both nodes (paper eq. 3.4), both have the same SINR on that plane, smooth in
    two unknowns (the nodes being equally high): a grid of 0.5 m is refined around its best point.

    Args:
        scenario: two nodes of equal power and height.
        as_printed: use eq. 3.5 to the letter, with the axis not normalised.

    Returns:
        Position, shape ``(3,)``, metres; smallest SINR, a power ratio.
    """
    first, second = scenario.node_positions_m
    along = (second - first) / np.linalg.norm(second - first)
    aside = np.cross(along, [0.0, 0.0, 1.0])
    middle = 0.5 * (first + second)
    low_m, high_m = scenario.airspace.altitude_m
    ratios = maximum_gain_sinr_as_printed if as_printed else maximum_gain_sinr

    def smallest(offset_m: FloatArray, height_m: FloatArray) -> FloatArray:
        position = middle[:2] + offset_m[..., None] * aside[:2]
        return np.asarray(
            ratios(scenario, np.concatenate([position, height_m[..., None]], axis=-1)).min(axis=-1)
        )

    offsets = np.linspace(-_REACH_M, _REACH_M, 401)
    heights = np.linspace(low_m, high_m, 45)
    half_offset, half_height = 1.0, 1.0  # m, searched on either side of the best point so far
    for _ in range(_ZOOMS):
        grid = np.meshgrid(offsets, heights, indexing="ij")
        values = smallest(*grid)
        i, j = np.unravel_index(int(np.argmax(values)), values.shape)
        offset, height, best = float(offsets[i]), float(heights[j]), float(values[i, j])
        offsets = np.linspace(offset - half_offset, offset + half_offset, 9)
        heights = np.clip(np.linspace(height - half_height, height + half_height, 9), low_m, high_m)
        half_offset, half_height = _SHRINK * half_offset, _SHRINK * half_height
    return np.array([*(middle[:2] + offset * aside[:2]), height]), best
