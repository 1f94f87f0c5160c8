"""Poses of an antenna with a pattern: their ratios, and cells as poses."""

from __future__ import annotations

import math

from nullpose.solve.kernels.attitude import ANCHOR, CHART, fill_frame
from nullpose.solve.kernels.harmonics import gain_at
from nullpose.solve.kernels.jit import kernel
from nullpose.solve.kernels.pattern_bound import way_to


@kernel
def fill_log_ratios(family, pattern, position, rotation, links, out):
    """Fill the logarithm of every ratio at a pose, minus infinity where there is none.

    Args:
        family: the ratios.
        pattern: the antenna's arrays.
        position: (3,) metres.
        rotation: (3, 3) to the world from the antenna's axes.
        links: (m,) scratch.
        out: output, (ratios,).
    """
    for j in range(family.points_m.shape[0]):
        x = family.points_m[j, 0] - position[0]
        y = family.points_m[j, 1] - position[1]
        z = family.points_m[j, 2] - position[2]
        square = x * x + y * y + z * z
        length = math.sqrt(square)
        a = (rotation[0, 0] * x + rotation[1, 0] * y + rotation[2, 0] * z) / length
        b = (rotation[0, 1] * x + rotation[1, 1] * y + rotation[2, 1] * z) / length
        c = (rotation[0, 2] * x + rotation[1, 2] * y + rotation[2, 2] * z) / length
        links[j] = gain_at(pattern, a, b, c) / square
    for k in range(family.numerator_point.shape[0]):
        g = family.denominator_of[k]
        below = family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            below += family.denominator_weight[e] * links[family.denominator_point[e]]
        above = family.numerator_isotropic[k] + family.numerator_weight[k] * links[family.numerator_point[k]]
        out[k] = math.log(above / below) if above > 0.0 else -math.inf


@kernel
def judge(family, pattern, positions, rotations, links, logs, out):
    """Fill the smallest log ratio of many poses, (n, 3) and (n, 3, 3)."""
    for i in range(positions.shape[0]):
        fill_log_ratios(family, pattern, positions[i], rotations[i], links, logs)
        out[i] = math.inf
        for k in range(logs.shape[0]):
            out[i] = min(out[i], logs[k])


@kernel
def rotation_of(family, row, frame, out):
    """Fill the rotation to the world from the antenna's axes at a cell's middle; ``frame`` is scratch."""
    first = int(row[CHART])
    fill_frame(row, way_to(family.points_m, int(row[ANCHOR]), row), frame)
    for i in range(3):
        for k in range(3):
            out[(first + i) % 3, k] = frame[i, k]
