"""Where a proof begins: the box that it is about, and what distances alone show."""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.node import CENTRE, FACE, HALF, keep_largest
from nullpose.solver.kernels.bounds.signed_sum import touch
from nullpose.solver.kernels.compiler.jit import kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.links import log_most_pair, log_most_share, most_heard
from nullpose.solver.kernels.search.search import cut_box


@kernel
def reach_by_distance(family, domain):
    """Return a bound from distances alone, and the ratio that it is from: the most distant node's.

    Args:
        family: the ratios; no gain is above 1.
        domain: the positions.
    """
    best, farthest, mean = math.inf, 0, 0.0
    for k in range(family.numerator_weight.shape[0]):
        square = domain.keep_out_m**2
        away = 0.0
        for i in range(3):
            x = family.points_m[family.numerator_point[k], i]
            away += (x - min(max(x, domain.low_m[i]), domain.high_m[i])) ** 2
        away = max(away, square)
        ratio = most_heard(family, k, away) / family.denominator_isotropic[family.denominator_of[k]]
        if family.shares.shape[0] > 0:
            mean += log_most_share(family, k, away)
        for q in range(family.pairs.shape[0]):
            most = math.exp(max(0.0, log_most_pair(family, q, away))) if family.pairs[q, 1] == k else math.inf
            if most < best:
                best, farthest = most, q
        if family.pairs.shape[0] == 0 and ratio < best:
            best, farthest = ratio, k
    if family.shares.shape[0] > 0:
        best, farthest = math.exp(mean), 0
    return best * (1.0 + 1e-9), farthest


@kernel
def fill_root(family, domain, log_value, target, bound, weights, axis, row):
    """Fill the box outside which no pose reaches the incumbent; return a bound on all, and its ratio.

    Args:
        family: the ratios.
        domain: the positions.
        log_value: the logarithm of the incumbent's smallest ratio.
        target: the relative gap that is aimed at.
        bound: known before.
        weights: (ratios,) the incumbent's multipliers, which are used up.
        axis: (3,) the incumbent's.
        row: (COLUMNS,) output, zeros before.

    Returns:
        The lower of the bound known and that from distances alone, and the ratio that the latter is from.
    """
    proved, farthest = reach_by_distance(family, domain)
    proved, level, far = min(proved, bound), log_value, family.offset
    for isotropic in family.numerator_isotropic:
        far = max(far, isotropic)
    if far > 0.0:  # ratios tend to one far away, however little that is: the bound that is stated
        level = min(level + math.log1p(target), math.log(proved))
    # a hair wider than the cut, which is rounded
    level -= 1e-9 if level > 1e-6 or level < 0.0 else 1e-3 * level
    low, high = scratch(3), scratch(3)
    cut_box(family, domain.low_m, domain.high_m, level, low, high)
    keep_largest(weights, weights.shape[0], row, family.shares.shape[0] > 0)
    touch(row, axis)
    for i in range(3):
        top = max(low[i], high[i])  # empty where two ratios are out of reach of each other: any place does
        row[CENTRE + i] = 0.5 * (low[i] + top)
        row[HALF + i] = 0.5 * (top - low[i]) * (1.0 + 1e-12)
    row[FACE] = -1.0
    return proved, farthest
