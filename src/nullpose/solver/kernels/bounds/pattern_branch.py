"""Branch and bound over positions and attitudes for an antenna with any pattern."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.bounds.attitude import ANCHOR, BAND, CENTRE, CHART, HALF, WARM
from nullpose.solver.kernels.bounds.branch import BETTER, BY_POSITION, DONE, EXCLUDED, FULL, LIMIT
from nullpose.solver.kernels.bounds.node import split_across
from nullpose.solver.kernels.bounds.pattern_bound import (
    expand,
    fill_constants,
    fill_points,
    middle,
    weak_ratio,
)
from nullpose.solver.kernels.bounds.tilt_reach import ROUNDING_RAD, excluded_within_reach, fill_reach
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import row as row_of, square_range, store
from nullpose.solver.kernels.search.domain import contains, forbidding
from nullpose.solver.kernels.search.pattern_search import bring_within_reach, fill_log_ratios, tilt_of


class Space(NamedTuple):
    """Where the kernels of one thread write."""

    wide: FloatArray
    value: FloatArray
    slope: FloatArray
    bend: FloatArray
    frame: FloatArray
    f: FloatArray
    rest: FloatArray
    by_l: FloatArray
    best: FloatArray
    score: FloatArray
    at: FloatArray
    factor: FloatArray
    parts: FloatArray
    one_sided: FloatArray
    is_numerator: FloatArray
    excess: FloatArray
    reach: FloatArray
    kept: FloatArray


@inner_kernel
def choose(family, spins, row, space):
    """Return the coordinate to split: the one that adds most to the bound."""
    anchor, reach = max(0, int(row[ANCHOR])), scratch(6)
    near, far = square_range(family.points_m[anchor], row, row[HALF:], 3)
    length = math.sqrt(0.5 * (near + far))
    for i in range(6):
        reach[i] = row[HALF + i] * (2.0 / length if i < 3 else 1.0)
    if spins:  # beside the anchor a spin moves the axis by little
        reach[5] *= min(1.0, abs(math.sin(row[3])) + row[HALF + 3])
    total = np.sum(reach)
    rest = 0.0
    for k in range(space.rest.shape[0]):
        rest += row[WARM + k] * space.rest[k]
    most, axis = -1.0, 0
    for i in range(6):
        score = reach[i] if not math.isfinite(rest) else space.score[i] + 3.0 * rest * reach[i] / total
        if score > most:
            most, axis = score, i
    return axis


@inner_heap_kernel
def space_of(family):
    """Return scratch space for a family."""
    m, n = family.points_m.shape[0], family.numerator_point.shape[0]
    one_sided, is_numerator = np.ones(m), np.zeros(m)
    for k in range(n):
        is_numerator[family.numerator_point[k]] = 1.0
        for e in range(family.denominator_point.shape[0]):
            if family.denominator_point[e] == family.numerator_point[k]:
                one_sided[family.numerator_point[k]] = 0.0
    return Space(
        np.empty((3, m)), np.empty(m), np.empty((m + 1, 6)), np.empty((m + 1, 6, 6)), np.empty((18, 3)),
        np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(6), np.empty(6), np.empty(m + 1),
        np.empty(m + 1), one_sided, is_numerator, np.empty(m), np.zeros(5), np.empty(n),
    )  # fmt: skip


@inner_kernel
def is_better(family, domain, pattern, reach, floor, row, space, position, rotation):
    """Fill the pose at an allowed middle, brought within reach; check whether it is above the floor."""
    if not contains(domain, row[CENTRE:HALF]):
        return False
    for i in range(3):
        position[i] = row[i]
        store(row_of(space.frame, i), rotation[(int(row[CHART]) + i) % 3])
    bring_within_reach(reach, rotation)
    return math.exp(fill_log_ratios(family, pattern, position, rotation, space.parts, space.by_l)) > floor


@inner_kernel
def examine_cell(family, domain, pattern, reach, level, floor, row, space, position, rotation):
    """Examine a cell: EXCLUDED, BETTER or BY_POSITION; fill its multipliers, zero where it has no pose."""
    if forbidding(domain, row[CENTRE:], row[HALF:]) >= 0:
        row[BAND:] = 0.0
        return EXCLUDED
    turning, rest = fill_points(family, pattern, reach.spins, row, space)
    tilt, _ = tilt_of(reach, row_of(space.frame, (2 - int(row[CHART])) % 3))
    weak = weak_ratio(family, level, space)
    if weak >= 0 or abs(tilt) - turning > reach.tilt_max_rad + ROUNDING_RAD:
        row[BAND:] = 0.0
        if weak >= 0:
            row[WARM + weak] = 1.0
        return EXCLUDED
    value, promising = middle(family, pattern, level, row, space)
    if value > floor and is_better(family, domain, pattern, reach, floor, row, space, position, rotation):
        return BETTER
    if not promising:
        space.rest[:] = math.inf
        return BY_POSITION
    expand(family, pattern, row, space)
    fill_constants(family, level, space)
    fill_reach(row, reach, turning, rest, space)
    return EXCLUDED if excluded_within_reach(family, level, row, space) else BY_POSITION


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
            with, that of the least angle negated; all zero where no pose of the cell is allowed.
        filled: how many leaves there are.
        budget: cells to examine at most.
        position: output, (3,): that of the better pose.
        rotation: output, (3, 3): its rotation to the world from the antenna's axes.
    """
    space, row = space_of(family), np.empty(stack.shape[1])
    done = 0
    while top > 0:
        if done >= budget:
            return LIMIT, top, filled, done, 0
        if top + 2 > stack.shape[0] or (keep and filled >= leaves.shape[0]):
            return FULL, top, filled, done, 0
        done += 1
        top -= 1
        copy_into(stack[top], row)
        verdict = examine_cell(family, domain, pattern, reach, level, floor, row, space, position, rotation)
        if verdict == BETTER:
            return BETTER, top + 1, filled, done, 0
        if verdict == BY_POSITION:
            side = choose(family, reach.spins, row, space)
            split_across(row, side, HALF + side, stack[top], stack[top + 1])
            top += 2
        elif keep:
            copy_into(row, leaves[filled])
            filled += 1
    return DONE, top, filled, done, 0
