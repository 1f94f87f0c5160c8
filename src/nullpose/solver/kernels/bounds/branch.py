"""Branch and bound: boxes of positions, and where multipliers alone cannot decide, cells of axes.

Depth first at one fixed level: a node is excluded (see ``exclusion`` and ``curved``), or its box is halved,
or, where the gap between the dual and what one axis reaches outweighs the size of the box, it is split into
cells of axes.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.problem.records import AFFINE_AXIS, BAND_AXIS, FREE_AXIS, Axes
from nullpose.solver.kernels.bounds.curved import curved_multipliers, excludes_curved, fill_jet, impact
from nullpose.solver.kernels.bounds.enclosure import JET, LEAST, axis_clearance
from nullpose.solver.kernels.bounds.exclusion import excludes, has_horizontal_axes, out_of_reach, will_fail
from nullpose.solver.kernels.bounds.expansion import best_frame, frame_at, min_square
from nullpose.solver.kernels.bounds.multipliers import free_multipliers
from nullpose.solver.kernels.bounds.node import (
    AFFINE,
    ANCHOR,
    BALL,
    BAND,
    CELL,
    CENTRE,
    COLUMNS,
    COUNT,
    FACE,
    HALF,
    INDEX,
    KIND,
    LEVEL,
    OFF_BAND,
    TOUCH,
    WEIGHT,
    is_off_band,
    longest_side,
    split_across,
    split_axis,
    split_position,
)
from nullpose.solver.kernels.bounds.records import Goal, Workspace
from nullpose.solver.kernels.bounds.sight import hidden_nowhere, in_sight
from nullpose.solver.kernels.bounds.signed_sum import fill_sum, touch
from nullpose.solver.kernels.bounds.tilt import priced, takes_tilt
from nullpose.solver.kernels.compiler.jit import (
    heap_kernel,
    inner_heap_kernel,
    inner_kernel,
    rare_kernel,
    small_kernel,
)
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int, zeroed
from nullpose.solver.kernels.linear_algebra.links import log_objective, most_heard, pair_log
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import corner_of, fill_affine, norm, store
from nullpose.solver.kernels.search.domain import contains

DONE, LIMIT, FULL, STUCK = 0, 1, 2, 5  # why a run over a stack ended; or BETTER
EXCLUDED, BY_POSITION, BY_AXIS, BETTER, FORESEEN = 0, 1, 2, 3, 4  # what becomes of a node

_HALVINGS = 3

_COARSENESS = 5.0  # how far a duality gap must outweigh a box's size before axes are split
_OF_MEANS = 0.1  # of that, for means: with 1 random fields took three times as long
_FINEST = 0.05  # side of a cell, over a box's size, below which smaller cells tell nothing more
_FAINT = 1e-6  # what multipliers leave over that is too little for smaller boxes to be sure to exclude
_CLOSE = 2.0  # boxes nearer to a point than so many of their radii are split unseen
_CLEAR = 2.0  # an affine axis must be this much longer than its change in the box
_BEATS = 1e-9
_APART_M = 1e-3
_POINT_M = 1e-7  # half diagonal of boxes that wait until no other is left: on a border they may have no end


@small_kernel
def examine(family, domain, axis_field, goal, seen, row, workspace, axis):
    """Return (what becomes of a node, the side to split, whether multipliers were sought).

    Fills the node's kind, its multipliers, and an axis if it beats the best.
    """
    side = longest_side(row)
    kind = out_of_reach(family, domain, row)
    if kind >= 0:
        row[KIND] = kind
        return EXCLUDED, side, 0
    half = row[HALF:LEVEL]
    radius = norm(half)
    nearest = math.inf
    for j in range(family.points_m.shape[0]):
        nearest = min(nearest, min_square(family.points_m, j, row[CENTRE:HALF], half))
    nearest = math.sqrt(nearest)
    if not nearest > _CLOSE * radius:
        return BY_POSITION, side, 0
    if axis_field.kind == AFFINE_AXIS:
        length, change = axis_clearance(axis_field, row[CENTRE:HALF], half)
        if length > _CLEAR * change:  # where it may vanish any axis is allowed for
            return examine_affine(family, domain, axis_field, goal, seen, row, workspace, axis)
    if axis_field.kind >= BAND_AXIS and is_off_band(axis_field.offset, row):
        row[KIND] = OFF_BAND
        return EXCLUDED, side, 0
    coarseness = _COARSENESS * radius / nearest
    verdict, sought = examine_free(family, domain, axis_field, goal, seen, row, coarseness, workspace, axis)
    return verdict, side, sought


@inner_kernel
def is_wide(row, least):
    """Check whether the longer side of a box's cell of axes is longer than this."""
    return max(row[CELL + 1] - row[CELL], row[CELL + 3] - row[CELL + 2]) > least


@inner_kernel
def same_multipliers(row, other):
    """Check whether two rows have the same multipliers."""
    same = row[COUNT] == other[COUNT] and row[BAND] == other[BAND]
    for s in range(TOUCH, BALL):
        same = same and row[s] == other[s]
    for s in range(int(row[COUNT])):
        same = same and row[INDEX + s] == other[INDEX + s] and row[WEIGHT + s] == other[WEIGHT + s]
    return same


@small_kernel
def beats_from(whole, domain, row, value, best, workspace, axis):
    """Check whether an axis that reaches a value at a box's centre beats the best there; fill the place.

    With several denominators that value is not the ratio itself. Among buildings it is the one with the
    lines of sight of the box, which may be had at one of its corners only.
    """
    centre, logs = row[CENTRE:HALF], (workspace.log_denominators, workspace.values)
    copy_into(centre, workspace.place)
    shadows = whole.shadow_sides.shape[0] > 0
    best *= 1.0 + _BEATS
    if not (whole.denominator_isotropic.shape[0] > 1 or shadows) or not value > 0.0:
        return value > best
    if shadows and not value > best:
        return False
    if math.exp(log_objective(whole, centre, axis, logs[0], logs[1])) > best:
        return True
    half = scratch(3)
    for i in range(3):  # many times what is between a shadow and a pose that is sure to be out of it
        half[i] = max(row[HALF + i], _APART_M)
    for corner in range(8 if shadows else 0):
        store(corner_of(centre, half, corner), workspace.place)
        value = math.exp(log_objective(whole, workspace.place, axis, logs[0], logs[1]))
        if value > best and contains(domain, workspace.place):
            return True
    return False


@inner_kernel
def examine_free(whole, domain, axis_field, goal, seen, row, coarseness, workspace, axis):
    """Examine a box whose axis is free; return the verdict and how often multipliers were sought."""
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    basis, family = scratch(3, 3), in_sight(whole, domain, seen, row, workspace)
    is_free, is_band = axis_field.kind != AFFINE_AXIS, axis_field.kind >= BAND_AXIS
    if not is_free:  # an affine axis that may vanish in the box
        axis_field = Axes(np.int64(FREE_AXIS), axis_field.offset, axis_field.matrix)
    if workspace.tilt[3] > 0.0:
        row[LEVEL] = workspace.tilt[3]
    fill_sum(family, row, workspace.sums)
    kind, anchor = best_frame(family, has_horizontal_axes(axis_field), row, workspace.sums)
    frame = frame_at(family, kind, anchor, centre, half, basis)
    row[KIND], row[ANCHOR] = kind, anchor
    workspace.expanded_side[:] = 0.0
    primal, reached, followed = math.inf, 0.0, False
    for attempt in range(3):  # the row's multipliers, the incumbent's, and those that are sought
        if attempt == 1:
            if row[FACE] >= 0.0 or same_multipliers(row, goal.multipliers):
                continue
            copy_into(goal.multipliers[BAND:BALL], row[BAND:BALL])
        if attempt == 2:
            primal, reached, followed = free_multipliers(
                family, axis_field, basis, row, coarseness, workspace, axis
            )
            can_beat = is_free and followed and contains(domain, centre)
            if can_beat and beats_from(whole, domain, row, reached * row[LEVEL], goal.best, workspace, axis):
                return BETTER, 1
            if primal == math.inf:  # no axis was met that is inside both cell and band
                return (BY_AXIS if is_free and is_wide(row, coarseness) else BY_POSITION), 1
            if not primal < 1.0:
                break
        if excludes(family, domain, axis_field, frame, row, workspace):
            return EXCLUDED, 1 if attempt == 2 else 0
    # Where multipliers exclude the centre, most often they exclude the halves of the box soon, and axes need
    # not be split. With several denominators that takes long, unless they do so by more than the box's size;
    # for a mean of many ratios, too, whose gaps are small but wide.
    is_mean = family.shares.shape[0] > 0
    spare = max(1.0, goal.spare) if is_mean or family.denominator_isotropic.shape[0] > 1 else goal.spare
    wide = coarseness * (_OF_MEANS if is_mean else 1.0)
    split_axes = followed and primal - reached > wide and primal > 1.0 - max(_FAINT, spare * coarseness)
    # two forms have no duality gap (Brickman), unless a cell or a band is in force
    split_axes = split_axes and (family.numerator_isotropic.shape[0] > 2 or row[FACE] >= 0.0 or is_band)
    split_axes = split_axes or coarseness == 0.0  # one position has no halves
    if split_axes and is_free and (row[FACE] < 0.0 or is_wide(row, _FINEST * coarseness)):
        return BY_AXIS, 1
    if primal >= 1.0:
        workspace.rest[0] = math.inf
    return FORESEEN, 1


@small_kernel
def lone_ratio(family, row, workspace):
    """Check whether one ratio is too weak all over the box, whatever the axis; if so it is the row's."""
    for k in range(family.numerator_weight.shape[0]):
        j, g = family.numerator_point[k], family.denominator_of[k]
        square = min_square(family.points_m, j, row[CENTRE:HALF], row[HALF:LEVEL])
        least = family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            least += family.denominator_weight[e] * workspace.jets[family.denominator_point[e], LEAST]
        if most_heard(family, k, square) < row[LEVEL] * least * (1.0 - 1e-13):
            row[COUNT], row[INDEX], row[WEIGHT] = 1.0, k, 1.0
            return True
    return False


@rare_kernel
def misses_one(family, axis_field, row, workspace, axis):
    """Fill the axis at a box's centre; check whether it misses a requirement, which is the row's then."""
    fill_affine(axis_field.offset, axis_field.matrix, row[CENTRE:HALF], axis)
    lowest = 1.0
    if family.requirements.shape[0] > 0:
        log_objective(family, row[CENTRE:HALF], axis, workspace.log_denominators, workspace.values)
    for k in range(family.requirements.shape[0]):
        met = math.exp(workspace.values[k]) / max(family.requirements[k], 1e-290)
        if met < lowest:
            lowest = met
            row[COUNT], row[INDEX], row[WEIGHT] = 1.0, k, 1.0 / family.requirements[k]
    row[TOUCH:BALL] = 0.0
    return lowest < 1.0


@rare_kernel
def worst_pair(family, axis_field, row, workspace, axis):
    """Fill the axis at a box's centre; its worst pair is the row's, by the tangent there."""
    fill_affine(axis_field.offset, axis_field.matrix, row[CENTRE:HALF], axis)
    least = log_objective(family, row[CENTRE:HALF], axis, workspace.log_denominators, workspace.values)
    for q in range(family.pairs.shape[0]):
        if pair_log(family, q, workspace.values) <= least:
            row[COUNT], row[INDEX], row[WEIGHT] = 1.0, q, 1.0
    touch(row, axis)


@rare_kernel
def tangents_exclude(family, domain, axis_field, goal, row, workspace, axis, total):
    """Check whether tangents of a mean, or of pairs, exclude a box: those at the axis of its centre."""
    if family.pairs.shape[0] > 0:
        worst_pair(family, axis_field, row, workspace, axis)
        if excludes_curved(family, domain, axis_field, row, workspace, total):
            return True
        copy_into(goal.multipliers[COUNT:TOUCH], row[COUNT:TOUCH])
        return excludes_curved(family, domain, axis_field, row, workspace, total)
    missed = misses_one(family, axis_field, row, workspace, axis)
    if missed and excludes_curved(family, domain, axis_field, row, workspace, total):
        return True
    copy_into(goal.multipliers[COUNT:TOUCH], row[COUNT:TOUCH])  # those of requirements
    touch(row, axis)
    excluded = excludes_curved(family, domain, axis_field, row, workspace, total)
    if row[COUNT] > 0.0 and not excluded:
        row[COUNT] = 0.0
        return excludes_curved(family, domain, axis_field, row, workspace, total)
    return excluded


@rare_kernel
def examine_affine(whole, domain, axis_field, goal, seen, row, workspace, axis):
    """Return (what becomes of a node, the side to split, 1) where the position gives the axis."""
    half, family = row[HALF:LEVEL], in_sight(whole, domain, seen, row, workspace)
    total, reached = scratch(JET), math.inf
    workspace.expanded_side[:] = 0.0
    for j in family.denominator_point:
        fill_jet(family, j, False, axis_field, row, workspace)
    row[KIND] = AFFINE
    has_tangents = family.shares.shape[0] + family.pairs.shape[0] > 0
    if has_tangents and tangents_exclude(family, domain, axis_field, goal, row, workspace, axis, total):
        return EXCLUDED, 0, 0
    if not has_tangents:
        if lone_ratio(family, row, workspace):
            return EXCLUDED, 0, 0
        for attempt in range(2):  # the row's multipliers, then the incumbent's
            if attempt == 1:
                copy_into(goal.multipliers[COUNT:BALL], row[COUNT:BALL])
            if excludes_curved(family, domain, axis_field, row, workspace, total):
                return EXCLUDED, 0, 0
        reached = curved_multipliers(family, axis_field, row, workspace)
    if reached * row[LEVEL] > goal.best * (1.0 + _BEATS) and contains(domain, row[CENTRE:HALF]):
        fill_affine(axis_field.offset, axis_field.matrix, row[CENTRE:HALF], axis)
        copy_into(row[CENTRE:HALF], workspace.place)
        logs = workspace.log_denominators, workspace.values
        if math.exp(log_objective(whole, workspace.place, axis, logs[0], logs[1])) > goal.best * (
            1.0 + _BEATS
        ):
            return BETTER, 0, 1
    if not has_tangents and excludes_curved(family, domain, axis_field, row, workspace, total):
        return EXCLUDED, 0, 1
    return BY_POSITION, impact(total, half), 1


@inner_heap_kernel
def workspace_of(family):
    """Return scratch space for a family."""
    ratios, groups = family.numerator_isotropic.shape[0], family.denominator_isotropic.shape[0]
    points = family.points_m.shape[0]
    return Workspace(
        np.empty(ratios + 4), np.empty(ratios), np.empty((ratios, 3)),
        np.empty(points), np.empty(points), np.empty((points, 6)), np.empty((points, 3, 6)),
        np.empty((points, 2)), np.empty((points, JET)), np.empty((groups, 6)), np.empty(groups),
        np.empty(6), np.empty((3, 6)), np.empty(6), np.empty(ratios),
        np.empty(family.denominator_weight.shape[0]), np.empty((0, 5)), np.empty(3),
        np.zeros(4),
    )  # fmt: skip


@inner_kernel
def split_foreseen(row, side, forecast, is_horizontal, stack, top):
    """Push the parts of a box; halves of which it is foreseen that they fail are halved again unseen."""
    halvings, place = scratch_int(9), top
    top = split_position(row, side, stack, top)
    halvings[0] = halvings[1] = 1
    first = place
    while place < top:
        done = halvings[place - first]
        if done < _HALVINGS and will_fail(forecast, row, stack[place], is_horizontal):
            halve(stack, place, top)
            halvings[place - first] = halvings[top - first] = done + 1
            top += 1
        else:
            place += 1
    return top


@inner_kernel
def halve(stack, place, top):
    """Halve a box of the stack across its longest side: one half in its place, the other on the top."""
    side = longest_side(stack[place])
    split_across(stack[place], CENTRE + side, HALF + side, stack[place], stack[top])


@heap_kernel
def branch(
    family, domain, axis_field, level, run_goal, stack, top, leaves, filled, most, better_p, better_u
):  # fmt: skip
    """Work off the stack at one level until it is empty or a limit is met.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        level: the ratio to exclude.
        run_goal: what the run is after.
        stack: (s, COLUMNS) boxes still to do.
        top: how many there are.
        leaves: (l, COLUMNS) output, excluded boxes.
        filled: how many leaves there are already.
        most: boxes to work off at most; of a run of one the parts are halves.
        better_p: output, (3,): position of a pose that beats the incumbent, or of the last box at the limit.
        better_u: output, (3,): its axis; zero if there is none, or the position is not allowed.

    Returns:
        (code, top, filled, boxes worked off, boxes in which new multipliers were sought).
    """
    workspace, row, axis = workspace_of(family), scratch(COLUMNS), zeroed(3)
    boxes = sought = aside = 0
    goal = run_goal
    has_shadows, tilt = family.shadow_sides.shape[0] > 0, scratch(4)
    if run_goal.price.shape[0] > 0 and takes_tilt(family, axis_field):
        tilt = workspace.tilt
    while top > aside or (top > 0 and not has_shadows):
        if boxes >= most:
            copy_into(row[CENTRE:HALF], better_p)
            for m in range(3):
                better_u[m] = axis[m] if contains(domain, better_p) else 0.0
            return LIMIT, top, filled, boxes, sought
        if top + 9 > stack.shape[0] or filled >= leaves.shape[0]:
            return FULL, top, filled, boxes, sought
        boxes, top, is_last = boxes + 1, top - 1, top == aside
        aside = min(aside, top)
        copy_into(stack[top], row)
        row[LEVEL] = level
        if run_goal.price.shape[0] > 0:
            best = priced(level, run_goal.best, run_goal.price, row, tilt)
            goal = Goal(best, run_goal.multipliers, run_goal.spare, run_goal.price)
        seen, hidden, verdict = -1, 0, EXCLUDED
        while True:  # as it is; then, where some interferers are never hidden together, with each in sight
            found, side, new = examine(family, domain, axis_field, goal, seen, row, workspace, axis)
            sought += new
            if seen < 0:
                verdict = found
                if has_shadows and found != EXCLUDED and found != BETTER:
                    hidden = hidden_nowhere(family, domain, row)
            if hidden == 0 or (seen >= 0 and found != EXCLUDED):
                if seen >= 0 and found == EXCLUDED:
                    verdict = EXCLUDED
                break
            entry = 0
            while not hidden >> entry & 1:
                entry += 1
            hidden &= hidden - 1
            seen = family.denominator_point[entry]
        if verdict == EXCLUDED:
            copy_into(row, leaves[filled])
            filled += 1
        elif verdict == BETTER:
            copy_into(workspace.place, better_p)
            copy_into(axis, better_u)
            return BETTER, top + 1, filled, boxes, sought
        elif verdict == BY_AXIS:
            top = split_axis(row, has_horizontal_axes(axis_field), stack, top)
        elif norm(row[HALF:LEVEL]) < _POINT_M and not is_last:
            copy_into(stack[aside], stack[top])
            copy_into(row, stack[aside])
            aside, top = aside + 1, top + 1
        elif verdict == FORESEEN and most > 1:
            top = split_foreseen(row, side, workspace, has_horizontal_axes(axis_field), stack, top)
        else:
            top = split_position(row, side, stack, top)
    return (DONE if top == 0 else STUCK), top, filled, boxes, sought
