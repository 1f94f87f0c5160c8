"""The best axis at one position and its multipliers, by Newton's method from multipliers of a neighbour.

The largest eigenvalue of ``sum_k lambda_k A_k`` is convex in the multipliers, and smooth where it is single:
then its second-order model is a quadratic programme in two variables, the step of the axis, with few
constraints active. Where it converges there is no duality gap, and the axis reaches what the multipliers
bound. Where it does not, nothing is lost but a microsecond: an interior point takes over.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.bounds.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solver.kernels.bounds.whitened import axis_of, fill_values, ratio_form
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import bilinear
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_scaled,
    copy_into,
    gauss_solve,
    tangents,
    top_eigenvector,
)

POOL = 36
"""The most forms at hand: constraints, the ratios of a box, and what turns out to be smaller."""
_MOST = 20  # of them in an ascent
_STEPS = 7
_PIVOTS = 12
_ADDED = 3  # forms taken in at a step
_GOOD_ENOUGH = 0.95  # of the level: multipliers below it may be kept although they are not the best
_OUTSIDE = 1e-6  # how far a constraint may be missed, in units of the denominator


class Pool(NamedTuple):
    """The forms at hand, constraints first, and their quadratic model around an axis.

    Args:
        forms: (p, 6).
        members: (p,) the ratio that each one is of.
        shares: (p,) multipliers.
        values: (p,) at the axis.
        slopes: (p, 2) along two tangents.
        inverse: (3,) the inverse of minus the mixture's curvature: xx, yy, xy.
        active: (3,) which forms are.
    """

    forms: FloatArray
    members: NDArray[np.int64]
    shares: FloatArray
    values: FloatArray
    slopes: FloatArray
    inverse: FloatArray
    active: NDArray[np.int64]


@inner_kernel
def holds(members, wanted):
    """Check for a number among several."""
    found = False
    for member in members:
        found = found or member == wanted
    return found


@inner_kernel
def newton_step(inverse, x, y):
    """Return the step of the axis that a slope stands for."""
    return inverse[0] * x + inverse[2] * y, inverse[2] * x + inverse[1] * y


@inner_kernel
def solve_active(pool, m, sides, answer):
    """Fill the multipliers of the active forms and, after them, their common value; False if singular.

    The first ``sides`` forms are constraints, whose common value is zero.
    """
    active, slopes, system = pool.active, pool.slopes, scratch(4, 4)
    for i in range(m):
        a = active[i]
        x, y = newton_step(pool.inverse, slopes[a, 0], slopes[a, 1])
        for j in range(m):
            system[i, j] = x * slopes[active[j], 0] + y * slopes[active[j], 1]
        counts = 0.0 if a < sides else 1.0
        system[i, m], system[m, i] = -counts, counts
        answer[i] = -pool.values[a]
    system[m, m], answer[m] = 0.0, 1.0
    return gauss_solve(system, answer, m + 1)


@inner_kernel
def most_violated(pool, m, sides, total, answer, slack):
    """Return the form that the step of the active ones leaves lowest beneath their value, or -1."""
    x = y = 0.0
    for i in range(m):
        x += answer[i] * pool.slopes[pool.active[i], 0]
        y += answer[i] * pool.slopes[pool.active[i], 1]
    x, y = newton_step(pool.inverse, x, y)
    lowest, enter = -slack, -1
    for e in range(total):
        value = pool.values[e] + pool.slopes[e, 0] * x + pool.slopes[e, 1] * y
        value -= answer[m] if e >= sides else 0.0
        if value < lowest and not holds(pool.active[:m], e):
            lowest, enter = value, e
    return enter


@inner_kernel
def exchange(pool, enter, sides, answer):
    """Put a form into a full active set for the one that leaves the multipliers least negative."""
    active = pool.active
    best, leave = -math.inf, -1
    for i in range(3):
        kept, active[i] = active[i], enter
        if solve_active(pool, np.int64(3), sides, answer):
            least = min(answer[0], min(answer[1], answer[2]))
            if least > best:
                best, leave = least, i
        active[i] = kept
    if leave >= 0:
        active[leave] = enter
    return leave >= 0


@inner_kernel
def model_optimum(pool, m, sides, total, slack, answer):
    """Fill the forms active where the model is best, and their multipliers; return how many, or 0."""
    active = pool.active
    for _ in range(_PIVOTS):
        if not solve_active(pool, m, sides, answer):
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
        enter = most_violated(pool, m, sides, total, answer, slack)
        if enter < 0:
            return m
        if m < 3:
            active[m] = enter
            m += 1
        elif not exchange(pool, enter, sides, answer):
            return 0
    return 0


@inner_kernel
def fill_model(pool, mix, top, v, total):
    """Fill every form's value and slope at an axis, and the inverse of minus the curvature, if there is."""
    a, b = scratch(3), scratch(3)
    tangents(v, a, b)
    xx, yy = 2.0 * (top - bilinear(mix, a, a)), 2.0 * (top - bilinear(mix, b, b))
    xy = -2.0 * bilinear(mix, a, b)
    det = xx * yy - xy * xy
    if not det > 1e-12 * xx * yy:
        return False
    pool.inverse[0], pool.inverse[1], pool.inverse[2] = yy / det, xx / det, -xy / det
    for e in range(total):
        pool.values[e] = bilinear(pool.forms[e], v, v)
        pool.slopes[e, 0] = 2.0 * bilinear(pool.forms[e], a, v)
        pool.slopes[e, 1] = 2.0 * bilinear(pool.forms[e], b, v)
    return True


@inner_kernel
def take_in(family, is_horizontal, basis, row, whitening, ratio, share, pool, total):
    """Add a ratio to the pool; return how many forms there are."""
    ratio_form(family, is_horizontal, basis, row, whitening, ratio, pool.forms[total])
    pool.members[total], pool.shares[total] = ratio, share
    return total + 1


@inner_kernel
def lowest_missing(every, below, pool, sides, total):
    """Return the ratio lowest at the axis, if below a value and not in the pool; or -1."""
    lead, lowest = -1, below
    for k in range(every.shape[0]):
        if every[k] < lowest and not holds(pool.members[sides:total], k):
            lead, lowest = k, every[k]
    return lead


@inner_kernel
def largest_shares(pool, sides, total):
    """Fill the three forms of largest multiplier, a ratio first; return how many there are."""
    m = 0
    for place in range(3):
        lead, largest = -1, 0.0
        for e in range(sides if place == 0 else 0, total):
            if pool.shares[e] > largest and not holds(pool.active[:m], e):
                lead, largest = e, pool.shares[e]
        if lead >= 0:
            pool.active[m] = lead
            m += 1
    return m


@inner_kernel
def put_weights(pool, sides, total, ratios, weights):
    """Fill the multipliers of all ratios, and of the constraints after them."""
    weights[:] = 0.0
    for e in range(total):
        weights[ratios + e if e < sides else pool.members[e]] = pool.shares[e]


@inner_kernel
def ascend(family, is_horizontal, basis, row, whitening, pool, sides, tolerance, every, weights, v):
    """Fill the best multipliers at a box's centre and the axis that they leave; return the dual's value.

    Args:
        family: arrays of the family.
        is_horizontal: whether only horizontal axes are allowed.
        basis: the frame.
        row: the box, whose multipliers are the start; without any the first ratio is.
        whitening: as ``whiten`` fills it.
        pool: its first forms, with their shares, are constraints: forms that are to be at least zero.
        sides: how many those are.
        tolerance: of the dual's value, relative to the level.
        every: scratch of one number per ratio.
        weights: output, (ratios + sides,).
        v: output, (3,): the axis in whitened coordinates.

    Returns:
        (largest eigenvalue of the mixture, whether it is within the tolerance of the smallest ratio's form at
        the axis, how many forms are in the pool). If it is not, the eigenvalue is well below the level all
        the same, or infinity is returned.
    """
    level, ratios = row[LEVEL], every.shape[0]
    shares, trial, answer, mix, axis = pool.shares, scratch(POOL), scratch(4), scratch(6), scratch(3)
    total = sides
    for s in range(max(1, int(row[COUNT]))):
        ratio, share = (int(row[INDEX + s]), row[WEIGHT + s]) if row[COUNT] > 0.0 else (0, 1.0)
        total = take_in(family, is_horizontal, basis, row, whitening, ratio, share, pool, total)
    before = lowest = math.inf
    for _ in range(_STEPS):
        mix[:] = 0.0
        for e in range(total):
            if shares[e] != 0.0:
                add_scaled(shares[e], pool.forms[e], mix)
        top = top_eigenvector(mix, v)
        if top < lowest:
            lowest = top
            put_weights(pool, sides, total, ratios, weights)
        if not top < before:  # a step too long, since the second eigenvalue came near
            for e in range(total):
                shares[e] = 0.5 * (shares[e] + trial[e])
            continue
        axis_of(basis, whitening[2], v, axis)
        reached = fill_values(family, row[CENTRE:HALF], level, axis, 1.0, every)
        inside = True
        for c in range(sides):
            inside = inside and bilinear(pool.forms[c], v, v) >= -_OUTSIDE
        if inside and top - reached <= tolerance * level:
            return top, True, total
        for _ in range(_ADDED):
            ratio = lowest_missing(every, top, pool, sides, total)
            if ratio < 0 or total >= _MOST:
                break
            total = take_in(family, is_horizontal, basis, row, whitening, ratio, 0.0, pool, total)
        before = top
        copy_into(shares, trial)
        if not fill_model(pool, mix, top, v, total):
            break
        m = largest_shares(pool, sides, total)
        m = model_optimum(pool, m, sides, total, 0.1 * tolerance * level, answer) if m > 0 else 0
        if m == 0:
            break
        shares[:] = 0.0
        for i in range(m):
            shares[pool.active[i]] = max(0.0, answer[i])
    return lowest if lowest <= _GOOD_ENOUGH * level else math.inf, False, total
