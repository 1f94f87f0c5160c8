"""Branch and bound over positions and attitudes for an antenna with any pattern."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.array_branch import is_forbidden
from nullpose.solver.kernels.attitude import ANCHOR, CHART, HALF, WARM
from nullpose.solver.kernels.branch import BETTER, DONE, FULL, LIMIT
from nullpose.solver.kernels.domain import contains
from nullpose.solver.kernels.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.pattern_bound import (
    excluded_by_sum,
    expand,
    fill_constants,
    fill_points,
    middle,
    square_range,
    weak_ratio,
)
from nullpose.solver.kernels.pattern_search import bring_within_reach, fill_log_ratios, tilt_of
from nullpose.solver.kernels.symmetric import copy_into
from nullpose.solver.kernels.vectors import row as row_of

_ROUNDING_RAD = 1e-9  # radians


class Space(NamedTuple):
    """Where the kernels of one thread write."""

    caps: FloatArray
    wide: FloatArray
    value: FloatArray
    slope: FloatArray
    bend: FloatArray
    frame: FloatArray
    firsts: FloatArray
    seconds: FloatArray
    pull: FloatArray
    stiff: FloatArray
    f: FloatArray
    rest: FloatArray
    by_l: FloatArray
    best: FloatArray
    score: FloatArray
    at: FloatArray
    factor: FloatArray
    parts: FloatArray
    sum_slope: FloatArray
    sum_bend: FloatArray
    one_sided: FloatArray


@inner_kernel
def choose(family, row, space, multipliers):
    """Return the coordinate to split: the one that adds most to the bound."""
    anchor = int(row[ANCHOR])
    near, far = square_range(family.points_m[anchor], row)
    length = math.sqrt(0.5 * (near + far))
    total = 0.0
    for i in range(6):
        total += row[HALF + i] * (2.0 / length if i < 3 else 1.0)
    rest = 0.0
    for k in range(multipliers.shape[0]):
        rest += multipliers[k] * space.rest[k]
    most, axis = -1.0, 0
    for i in range(6):
        rate = row[HALF + i] * (2.0 / length if i < 3 else 1.0)
        score = rate if not math.isfinite(rest) else space.score[i] + 3.0 * rest * rate / total
        if score > most:
            most, axis = score, i
    return axis


@inner_kernel
def kept(keep, row, by, leaves, filled):
    """Keep an excluded cell if that is asked for; return how many leaves there are then.

    Args:
        keep: whether it is.
        row: the cell.
        by: the ratio that excludes it alone, -1 for none, or, for several, how many ratios there are.
        leaves: output.
        filled: how many there are.
    """
    if not keep:
        return filled
    copy_into(row, leaves[filled])
    if by < row.shape[0] - WARM:
        for k in range(row.shape[0] - WARM):
            leaves[filled, WARM + k] = 1.0 if k == by else 0.0
    return filled + 1


@heap_kernel
def branch_pattern(
    family, domain, pattern, reach, level, floor, keep, stack, top, leaves, filled, budget, position, rotation
):
    """Work off cells; return why it ended, how many are left, ``filled``, how many were examined, and 0.

    Args:
        family: the ratios.
        domain: box, keep-out balls and forbidden pieces.
        pattern: the antenna's arrays.
        reach: which attitudes there are.
        level: no pose of an excluded cell has its smallest ratio above this.
        floor: an allowed middle above this is a better pose, at the nearest attitude that is reached, and
            ends the call.
        stack: (size, columns) cells.
        top: how many of them there are.
        keep: whether excluded cells become leaves.
        leaves: (l, columns) output, excluded cells with the multipliers that do so in place of those to begin
            with; all zero where no pose of the cell is allowed.
        filled: how many leaves there are.
        budget: cells to examine at most.
        position: output, (3,): that of the better pose.
        rotation: output, (3, 3): its rotation to the world from the antenna's axes.
    """
    m, n = family.points_m.shape[0], family.numerator_point.shape[0]
    space = Space(
        np.empty(5),
        np.empty((m, 3)),
        np.empty(m),
        np.empty((m, 6)),
        np.empty((m, 6, 6)),
        np.empty((18, 3)),
        np.empty((6, 3)),
        np.empty((6, 6, 3)),
        np.empty(3),
        np.empty((3, 3)),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty(6),
        np.empty(6),
        np.empty(m),
        np.empty(m),
        np.empty(6),
        np.empty((6, 6)),
        np.ones(m),
    )
    for k in range(n):
        for e in range(family.denominator_point.shape[0]):
            if family.denominator_point[e] == family.numerator_point[k]:
                space.one_sided[family.numerator_point[k]] = 0.0
    multipliers, row = np.empty(n), np.empty(stack.shape[1])
    done = 0
    while top > 0:
        if done >= budget:
            return LIMIT, top, filled, done, 0
        if top + 2 > stack.shape[0] or (keep and filled >= leaves.shape[0]):
            return FULL, top, filled, done, 0
        top -= 1
        done += 1
        row[:] = stack[top]
        if is_forbidden(domain, (row[0], row[1], row[2]), (row[6], row[7], row[8])):
            filled = kept(keep, row, -1, leaves, filled)
            continue
        turning = fill_points(family, pattern, row, space)
        tilt, _ = tilt_of(reach, row_of(space.frame, (2 - int(row[CHART])) % 3))
        weak = weak_ratio(family, level, space)
        if weak >= 0 or abs(tilt) - turning > reach.tilt_max_rad + _ROUNDING_RAD:
            filled = kept(keep, row, weak, leaves, filled)
            continue
        multipliers[:] = row[WARM : WARM + n]
        value, promising = middle(family, pattern, level, row, space)
        if value > floor and contains(domain, row[:3]):
            first = int(row[CHART])
            for i in range(3):
                position[i] = row[i]
                for k in range(3):
                    rotation[(first + i) % 3, k] = space.frame[i, k]
            bring_within_reach(reach, rotation)
            nearest = fill_log_ratios(family, pattern, position, rotation, space.parts, space.by_l)
            if math.exp(nearest) > floor:
                stack[top] = row
                return BETTER, top + 1, filled, done, 0
        if promising:
            expand(family, pattern, row, space)
            fill_constants(family, level, space)
            if excluded_by_sum(family, level, row, multipliers, space):
                row[WARM : WARM + n] = multipliers
                filled = kept(keep, row, n, leaves, filled)
                continue
        else:
            space.rest[:] = math.inf
        axis = choose(family, row, space, multipliers)
        row[HALF + axis] *= 0.5
        row[WARM : WARM + n] = multipliers
        before = row[axis]
        for side in (-1.0, 1.0):
            row[axis] = before + side * row[HALF + axis]
            stack[top] = row
            top += 1
    return DONE, top, filled, done, 0
