"""The signed sum of links that a row's multipliers make: ``c_0 |u|^2 + sum_j c_j x_j``, ``x_j`` being link j.

The multipliers ``lambda`` exclude every position and axis of a box where ``sum_k lambda_k (N_k - t D_k)`` is
negative: a pose there has a ratio below the level t. For the mean ``prod_k X_k^p_k`` of ``X_k = a + N_k / D``
that is so where ``sum_k q_k (a D + N_k) - t prod_k (q_k / p_k)^p_k D`` is, for any positive q: the weighted
arithmetic mean of the ``q_k X_k / p_k`` is no less than the geometric one. ``q_k = p_k / X_k`` at what the
row's form receives is the tangent there. Where ratio k of a mean must be r_k or more, ``nu_k (N_k - r_k D)``
comes on top, for any ``nu_k >= 0``; without a form it stands alone. Of pairs the sums are tangents,
``sum_q lambda_q (phi(e0) - phi'(e0) e0 + phi'(e0) e - b)`` (see ``pair_tangent``), for any ``e0 > 0``: that
of the row's form. Nothing beyond this file needs to know
which ratio a link is of.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.bounds.node import BALL, CENTRE, COUNT, HALF, INDEX, LEVEL, TOUCH, WEIGHT
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel, kernel, rare_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.forms import add_point
from nullpose.solver.kernels.linear_algebra.links import log_most_pair, log_most_share, pair_tangent
from nullpose.solver.kernels.linear_algebra.symmetric import add_square, fill_identity, form_product
from nullpose.solver.kernels.linear_algebra.vectors import dot, square_range


@inner_kernel
def add_group(family, g, weight, sums):
    """Add a multiple of a denominator to the coefficients of the links; return what the identity gets."""
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        sums[family.denominator_point[e]] += weight * family.denominator_weight[e]
    return weight * family.denominator_isotropic[g]


@inner_kernel
def add_ratio(family, k, level, weight, sums):
    """Add ``weight (N_k - t D_k)`` to the coefficients of the links; return what the identity gets, twice.

    As it is, and the sum of its parts without their signs, to which rounding is relative.
    """
    g = family.denominator_of[k]
    above, below = weight * family.numerator_isotropic[k], -add_group(family, g, -weight * level, sums)
    sums[family.numerator_point[k]] += weight * family.numerator_weight[k]
    return above - below, above + below


@inner_kernel
def fill_sum(family, row, sums):
    """Fill the coefficients of a row's sum, one for each point; return that of the identity and its parts."""
    identity = size = 0.0
    sums[:] = 0.0
    is_mean = family.shares.shape[0] > 0
    if family.pairs.shape[0] > 0:
        return add_pairs(family, row, sums)
    if is_mean:
        identity, size = fill_mean(family, row, sums)
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        level = family.requirements[k] if is_mean else row[LEVEL]
        net, parts = add_ratio(family, k, level, row[WEIGHT + s], sums)
        identity, size = identity + net, size + parts
    return identity, size


@kernel
def touch(row, axis):
    """Take the tangents of a row's mean, or of its pairs, at an axis, of any length."""
    row[TOUCH:BALL] = 0.0
    add_square(1.0 / dot(axis, axis), axis, row[TOUCH:BALL])


@inner_kernel
def link_to_form(family, j, row):
    """Evaluate the link of point j to a row's form at the box's centre, ``<M_j, U>``."""
    world, form = scratch(3, 3), zeroed(6)
    fill_identity(world)
    add_point(family, j, row[CENTRE:HALF], world, 1.0, 0.0, form)
    return form_product(form, row[TOUCH:BALL])


@rare_kernel
def touched(family, q, row):
    """Evaluate what the eavesdropper of a pair receives at the box's centre, by a row's form."""
    total, g = 0.0, family.denominator_of[family.pairs[q, 1]]
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        total += family.denominator_weight[e] * link_to_form(family, family.denominator_point[e], row)
    return family.denominator_isotropic[g] + total / (row[TOUCH] + row[TOUCH + 1] + row[TOUCH + 2])


@rare_kernel
def add_pairs(family, row, sums):
    """Add the tangents of a row's pairs to the coefficients; return those of the identity and its parts."""
    identity = size = 0.0
    for s in range(int(row[COUNT])):
        q, weight = int(row[INDEX + s]), row[WEIGHT + s]
        node, eavesdropper = family.pairs[q, 0], family.pairs[q, 1]
        constant, slope = pair_tangent(family, q, row[LEVEL], touched(family, q, row))
        above = weight * constant
        above += add_group(family, family.denominator_of[eavesdropper], weight * slope, sums)
        below = -add_group(family, family.denominator_of[node], -weight, sums)
        identity, size = identity + above - below, size + above + below
    return identity, size


@rare_kernel
def fill_mean(family, row, sums):
    """Do what ``fill_sum`` does for a mean of ratios, requirements left aside."""
    trace = row[TOUCH] + row[TOUCH + 1] + row[TOUCH + 2]
    below, identity, weights, log_mean = trace * family.denominator_isotropic[0], 0.0, 0.0, 0.0
    if not trace > 0.0:
        return 0.0, 0.0
    for e in range(family.denominator_weight.shape[0]):
        below += family.denominator_weight[e] * link_to_form(family, family.denominator_point[e], row)
    for k in range(family.shares.shape[0]):
        j, isotropic = family.numerator_point[k], family.numerator_isotropic[k]
        ratio = (isotropic * trace + family.numerator_weight[k] * link_to_form(family, j, row)) / below
        x = max(family.offset + ratio, 1e-290)
        q = family.shares[k] / x
        sums[j] += q * family.numerator_weight[k]
        identity, weights = identity + q * isotropic, weights + q
        log_mean += family.shares[k] * math.log(x)
    level = row[LEVEL] * math.exp(-log_mean) - family.offset * weights
    for e in range(family.denominator_weight.shape[0]):
        sums[family.denominator_point[e]] -= level * family.denominator_weight[e]
    level *= family.denominator_isotropic[0]
    return identity - level, identity + abs(level)


@heap_kernel
def fill_tangents(family, rows, tangents):
    """Fill the multipliers q of a mean's ratios that the rows of leaves stand for, (l, ratios)."""
    sums = np.empty(family.points_m.shape[0])
    for i in range(rows.shape[0]):
        sums[:] = 0.0
        fill_mean(family, rows[i], sums)
        for k in range(family.shares.shape[0]):
            tangents[i, k] = sums[family.numerator_point[k]] / family.numerator_weight[k]


@heap_kernel
def fill_touched(family, rows, tangents):
    """Fill what the eavesdroppers of pairs receive where the sums of leaves touch, (l, pairs)."""
    for i in range(rows.shape[0]):
        has_form = rows[i, TOUCH] + rows[i, TOUCH + 1] + rows[i, TOUCH + 2] > 0.0
        for q in range(family.pairs.shape[0] if has_form else 0):
            tangents[i, q] = touched(family, q, rows[i])


@rare_kernel
def unreachable_pair(family, level, centre, half):
    """Find a pair that is below a level all over a box, as distances alone show; -1 if there is none."""
    for q in range(family.pairs.shape[0]):
        m = family.pairs[q, 1]
        square, _ = square_range(family.points_m[family.numerator_point[m]], centre, half, 3)
        if log_most_pair(family, q, square) < math.log(level) - 1e-12:
            return q
    return -1


@rare_kernel
def log_most_mean(family, centre, half):
    """Bound the logarithm of a mean in a box, as distances alone show."""
    total = 0.0
    for k in range(family.shares.shape[0]):
        square, _ = square_range(family.points_m[family.numerator_point[k]], centre, half, 3)
        total += log_most_share(family, k, square)
    return total + 1e-12 * (1.0 + abs(total))
