"""Poses of an antenna with a pattern: their ratios, and the slopes of these."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel, kernel
from nullpose.solver.kernels.linear_algebra.channel import excess_at
from nullpose.solver.kernels.linear_algebra.forms import in_frame
from nullpose.solver.kernels.linear_algebra.harmonics import gain_at
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    cross,
    dot,
    minus,
    norm,
    row,
    scaled,
    store,
    unit,
)
from nullpose.solver.kernels.search.domain import contains

_STEP = 1e-6  # of differences, radians
_LEAST = -1e3  # logarithm that counts for a ratio of zero


@inner_kernel
def quotient(family, k, above, below):
    """Return ratio k's numerator and denominator from each point's gain over squared distance in either."""
    g = family.denominator_of[k]
    total = family.denominator_isotropic[g]
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        total += family.denominator_weight[e] * below[family.denominator_point[e]]
    return family.numerator_isotropic[k] + family.numerator_weight[k] * above[
        family.numerator_point[k]
    ], total


@kernel
def fill_log_ratios(family, pattern, position, rotation, links, out):
    """Fill the logarithm of every ratio at a pose, minus infinity where there is none; return the least.

    Args:
        family: the ratios.
        pattern: the antenna's arrays.
        position: (3,) metres.
        rotation: (3, 3) to the world from the antenna's axes.
        links: (m,) scratch.
        out: output, (ratios,).
    """
    for j in range(family.points_m.shape[0]):
        r = minus(row(family.points_m, j), position)
        x, y, z = unit(in_frame(rotation, r))
        links[j] = excess_at(family, j, position) * gain_at(pattern, x, y, z) / dot(r, r)
    least = math.inf
    for k in range(family.numerator_point.shape[0]):
        above, below = quotient(family, k, links, links)
        out[k] = math.log(above / below) if above > 0.0 else -math.inf
        least = min(least, out[k])
    return least


@inner_kernel
def turned_by(rotation, w, out):
    """Fill a rotation times that by a small rotation vector (Rodrigues)."""
    angle = norm(w)
    s, c = 1.0, 0.5
    if angle > 1e-9:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    for i in range(3):
        first = cross(row(rotation, i), w)  # a row times the matrix of the vector
        store(along(along(row(rotation, i), s, first), c, cross(first, w)), out[i])


@inner_kernel
def tilt_of(reach, vertical):
    """Return the tilt of an attitude, radians, which is negative from the mount's angle inwards if it spins.

    And the axis that a turn about adds to it, of any length.

    Args:
        reach: which attitudes there are.
        vertical: the vertical in the antenna's axes.
    """
    upright, mount = (reach.up[0], reach.up[1], reach.up[2]), 0.0
    if reach.spins:
        upright, mount = (0.0, 0.0, -1.0 if reach.even and vertical[2] < 0.0 else 1.0), reach.mount_rad
    about = cross(vertical, upright)
    return math.atan2(norm(about), dot(vertical, upright)) - mount, about


@kernel
def bring_within_reach(reach, rotation):
    """Turn an attitude to the nearest that the airframe reaches, in place.

    Args:
        reach: which attitudes there are.
        rotation: (3, 3) to the world from the antenna's axes.
    """
    tilt, about = tilt_of(reach, row(rotation, 2))
    turn = min(max(tilt, -reach.tilt_max_rad), reach.tilt_max_rad) - tilt
    if turn != 0.0:
        turned_by(rotation, scaled(turn, unit(about)) if norm(about) > 0.0 else (0.0, turn, 0.0), rotation)


@heap_kernel
def judge(family, domain, pattern, states, out):
    """Fill the smallest log ratio of many states, (n, 12), minus infinity where a position is not allowed."""
    links, logs = np.empty(len(family.points_m)), np.empty(len(family.numerator_point))
    for i in range(len(states)):
        out[i] = -math.inf
        if contains(domain, states[i]):
            rotation = states[i, 3:].reshape(3, 3)
            out[i] = fill_log_ratios(family, pattern, states[i], rotation, links, logs)


@kernel
def move(reach, state, step, unit_m, position, rotation):
    """Fill the position and the rotation that a step, (6,), leads to from a state, (12,)."""
    for i in range(3):
        position[i] = state[i] + unit_m * step[i]
    turned_by(state[3:].reshape(3, 3), (step[3], step[4], step[5]), rotation)
    bring_within_reach(reach, rotation)


@heap_kernel
def fill_slopes(family, pattern, reach, state, step, unit_m, logs, slopes):
    """Fill the log ratios of a state moved by a step, none too small, and their slopes by differences.

    Args:
        family: the ratios.
        pattern: the antenna's arrays.
        reach: which attitudes there are.
        state: (12,) position and rotation.
        step: (6,) from there.
        unit_m: metres of a step that count as much as a radian.
        logs: output, (ratios,).
        slopes: output, (ratios, 6).
    """
    links, near, p, r = np.empty(len(family.points_m)), step.copy(), np.empty(3), np.empty((3, 3))
    for i in range(6):
        for side in (-1.0, 1.0):
            near[i] = step[i] + side * _STEP
            move(reach, state, near, unit_m, p, r)
            fill_log_ratios(family, pattern, p, r, links, logs)
            for k in range(len(logs)):
                before = 0.0 if side < 0.0 else slopes[k, i]
                slopes[k, i] = before + side * max(logs[k], _LEAST) / (2.0 * _STEP)
        near[i] = step[i]
    move(reach, state, step, unit_m, p, r)
    fill_log_ratios(family, pattern, p, r, links, logs)
