"""The best axis at one position and its multipliers, by Newton's method from multipliers of a neighbour.

The largest eigenvalue of ``sum_k lambda_k A_k`` is convex in the multipliers, and smooth where it is single:
then its second-order model is a quadratic programme in two variables, the step of the axis, with few
constraints active. Where it converges there is no duality gap, and the axis reaches what the multipliers
bound. Where it does not, nothing is lost but a microsecond: an interior point takes over.
"""

from __future__ import annotations

import math

from nullpose.solve.kernels.dual import top_eigenvector
from nullpose.solve.kernels.forms import bilinear
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solve.kernels.scratch import scratch, scratch_int
from nullpose.solve.kernels.symmetric import copy_into, gauss_solve, tangents
from nullpose.solve.kernels.whitened import axis_of, fill_values, ratio_form

__all__ = ["ascend"]

_POOL = 20  # forms at hand: a row's, the constraints', and what turns out to be smaller
_TURNS = 7
_PIVOTS = 12
_ADDED = 3  # forms taken in at a turn
_GOOD_ENOUGH = 0.95  # of the level: multipliers below it may be kept although they are not the best
_OUTSIDE = 1e-6  # how far a constraint may be missed, in units of the denominator


@inner_kernel
def solve_active(active, m, sides, values, slopes, inverse, system, answer):
    """Fill the multipliers of the active forms and, after them, their common value; False if singular.

    The first ``sides`` forms are constraints, whose common value is zero.
    """
    for i in range(m):
        a = active[i]
        x = inverse[0] * slopes[a, 0] + inverse[2] * slopes[a, 1]
        y = inverse[2] * slopes[a, 0] + inverse[1] * slopes[a, 1]
        for j in range(m):
            system[i, j] = x * slopes[active[j], 0] + y * slopes[active[j], 1]
        counts = 0.0 if a < sides else 1.0
        system[i, m], system[m, i] = -counts, counts
        answer[i] = -values[a]
    system[m, m], answer[m] = 0.0, 1.0
    return gauss_solve(system, answer, m + 1)


@inner_kernel
def most_violated(active, m, sides, total, values, slopes, inverse, answer, slack):
    """Return the form that the step of the active ones leaves lowest beneath their value, or -1."""
    x = y = 0.0
    for i in range(m):
        x += answer[i] * slopes[active[i], 0]
        y += answer[i] * slopes[active[i], 1]
    step_x, step_y = inverse[0] * x + inverse[2] * y, inverse[2] * x + inverse[1] * y
    lowest, enter = -slack, -1
    for e in range(total):
        value = values[e] + slopes[e, 0] * step_x + slopes[e, 1] * step_y
        if e >= sides:
            value -= answer[m]
        if value < lowest:
            taken = False
            for i in range(m):
                taken = taken or active[i] == e
            if not taken:
                lowest, enter = value, e
    return enter


@inner_kernel
def exchange(active, enter, sides, values, slopes, inverse, system, answer):
    """Put a form into a full active set for the one that leaves the multipliers least negative."""
    best, leave = -math.inf, -1
    for i in range(3):
        kept, active[i] = active[i], enter
        if solve_active(active, 3, sides, values, slopes, inverse, system, answer):
            least = min(answer[0], min(answer[1], answer[2]))
            if least > best:
                best, leave = least, i
        active[i] = kept
    if leave < 0:
        return False
    active[leave] = enter
    return True


@inner_kernel
def model_optimum(active, m, sides, total, values, slopes, inverse, slack, answer):
    """Return how many forms are active where the model is best, filling them and their multipliers; or 0."""
    system = scratch(4, 4)
    for _ in range(_PIVOTS):
        if not solve_active(active, m, sides, values, slopes, inverse, system, answer):
            return 0
        drop, lowest, counted = -1, -1e-12, 0
        for i in range(m):
            counted += active[i] >= sides
            if answer[i] < lowest:
                lowest, drop = answer[i], i
        if drop >= 0:
            if counted == 1 and active[drop] >= sides:
                return 0
            m -= 1
            active[drop] = active[m]
            continue
        enter = most_violated(active, m, sides, total, values, slopes, inverse, answer, slack)
        if enter < 0:
            return m
        if m < 3:
            active[m] = enter
            m += 1
        elif not exchange(active, enter, sides, values, slopes, inverse, system, answer):
            return 0
    return 0


@inner_kernel
def model(mix, top, v, pool, total, values, slopes, inverse):
    """Fill every form's value and slope at an axis, and the inverse of minus the curvature, if there is."""
    a, b = scratch(3), scratch(3)
    tangents(v, a, b)
    xx = 2.0 * (top - bilinear(mix, a, a))
    yy = 2.0 * (top - bilinear(mix, b, b))
    xy = -2.0 * bilinear(mix, a, b)
    det = xx * yy - xy * xy
    if not det > 1e-12 * xx * yy:
        return False
    inverse[0], inverse[1], inverse[2] = yy / det, xx / det, -xy / det
    for e in range(total):
        values[e] = bilinear(pool[e], v, v)
        slopes[e, 0], slopes[e, 1] = 2.0 * bilinear(pool[e], a, v), 2.0 * bilinear(pool[e], b, v)
    return True


@inner_kernel
def take_in(family, level_axes, basis, row, whitening, below, every, pool, members, sides, total):
    """Add the ratios lowest at the axis, if below a value, to the pool; return how many forms there are."""
    for _ in range(_ADDED):
        lead, lowest = -1, below
        for k in range(every.shape[0]):
            if every[k] < lowest:
                known = False
                for e in range(sides, total):
                    known = known or members[e] == k
                if not known:
                    lead, lowest = k, every[k]
        if lead < 0 or total >= _POOL:
            break
        ratio_form(family, level_axes, basis, row, whitening, lead, pool[total])
        members[total] = lead
        total += 1
    return total


@inner_kernel
def begin(family, level_axes, basis, row, whitening, constraints, sides, weights, pool, members, share):
    """Fill the pool with the constraints and the row's own ratios; return how many forms there are.

    Of a row without multipliers the first ratio is taken: any start will do, but none is no mixture at all.
    """
    total = sides
    for c in range(sides):
        copy_into(constraints[c], pool[c])
        share[c] = weights[c]
    for s in range(int(row[COUNT])):
        members[total] = int(row[INDEX + s])
        ratio_form(family, level_axes, basis, row, whitening, members[total], pool[total])
        share[total] = row[WEIGHT + s]
        total += 1
    if total == sides:
        members[total] = 0
        ratio_form(family, level_axes, basis, row, whitening, 0, pool[total])
        share[total] = 1.0
        total += 1
    return total


@inner_kernel
def mixture(pool, share, total, mix):
    """Fill the weighted sum of the pool's forms."""
    mix[:] = 0.0
    for e in range(total):
        if share[e] != 0.0:
            for m in range(6):
                mix[m] += share[e] * pool[e, m]


@inner_kernel
def largest_shares(share, sides, total, active):
    """Fill the three forms of largest multiplier, a ratio first; return how many there are."""
    m = 0
    for place in range(3):
        lead, largest = -1, 0.0
        for e in range(sides if place == 0 else 0, total):
            taken = False
            for i in range(m):
                taken = taken or active[i] == e
            if share[e] > largest and not taken:
                lead, largest = e, share[e]
        if lead >= 0:
            active[m] = lead
            m += 1
    return m


@inner_kernel
def ascend(
    family, level_axes, basis, row, whitening, constraints, sides, start, tolerance, every, weights, v
):
    """Fill the best multipliers at a box's centre and the axis that they leave; return the dual's value.

    Args:
        family: arrays of the family.
        level_axes: whether only level axes are allowed.
        basis: the frame.
        row: the node, whose multipliers are the start.
        whitening: as ``whiten`` fills it.
        constraints: (c, 6) whitened forms that are to be at least zero.
        sides: how many.
        start: (c,) their multipliers.
        tolerance: of the dual's value, relative to the level.
        every: scratch of one number per ratio.
        weights: output, (ratios + sides,).
        v: output, (3,): the axis in whitened coordinates.

    Returns:
        (largest eigenvalue of the mixture, whether it is within the tolerance of the smallest ratio's form at
        the axis). If not, the eigenvalue is well below the level all the same, or infinity is returned.
    """
    level = row[LEVEL]
    pool, members, share, trial = scratch(_POOL, 6), scratch_int(_POOL), scratch(_POOL), scratch(_POOL)
    values, slopes, inverse, answer = scratch(_POOL), scratch(_POOL, 2), scratch(3), scratch(4)
    mix, axis, active = scratch(6), scratch(3), scratch_int(3)
    total = begin(family, level_axes, basis, row, whitening, constraints, sides, start, pool, members, share)
    before = lowest = math.inf
    kept, kept_v, held = scratch(_POOL), scratch(3), total
    for _ in range(_TURNS):
        mixture(pool, share, total, mix)
        top = top_eigenvector(mix, v)
        if top < lowest:
            lowest, held = top, total
            copy_into(share, kept)
            copy_into(v, kept_v)
        if not top < before:  # a step too long, since the second eigenvalue came near
            for e in range(total):
                share[e] = 0.5 * (share[e] + trial[e])
            continue
        axis_of(basis, whitening[2], v, axis)
        reached = fill_values(family, row[CENTRE:HALF], level, axis, 1.0, every)
        inside = True
        for c in range(sides):
            inside = inside and bilinear(pool[c], v, v) >= -_OUTSIDE
        if inside and top - reached <= tolerance * level:
            weights[:] = 0.0
            for e in range(total):
                weights[every.shape[0] + e if e < sides else members[e]] = share[e]
            return top, True
        known = total
        total = take_in(family, level_axes, basis, row, whitening, top, every, pool, members, sides, total)
        for e in range(known, total):
            share[e] = 0.0
        before = top
        copy_into(share, trial)
        if not model(mix, top, v, pool, total, values, slopes, inverse):
            break
        m = largest_shares(share, sides, total, active)
        if m == 0:
            break
        m = model_optimum(active, m, sides, total, values, slopes, inverse, 0.1 * tolerance * level, answer)
        if m == 0:
            break
        share[:] = 0.0
        for i in range(m):
            share[active[i]] = max(0.0, answer[i])
    if lowest > _GOOD_ENOUGH * level:
        return math.inf, False
    copy_into(kept_v, v)
    weights[:] = 0.0
    for e in range(held):
        weights[every.shape[0] + e if e < sides else members[e]] = kept[e]
    return lowest, False
