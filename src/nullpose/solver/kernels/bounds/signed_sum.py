"""The signed sum of links that a row's multipliers make: ``c_0 |u|^2 + sum_j c_j x_j``, ``x_j`` being link j.

The multipliers ``lambda`` exclude every position and axis of a box where ``sum_k lambda_k (N_k - t D_k)`` is
negative: a pose there has a ratio below the level t. Nothing beyond this file needs to know which ratio a
link is of.
"""

from __future__ import annotations

from nullpose.solver.kernels.bounds.node import COUNT, INDEX, LEVEL, WEIGHT
from nullpose.solver.kernels.compiler.jit import inner_kernel, small_kernel
from nullpose.solver.kernels.linear_algebra.channel import most_excess


@inner_kernel
def add_ratio(family, k, level, weight, sums):
    """Add ``weight (N_k - t D_k)`` to the coefficients of the links; return what the identity gets, twice.

    As it is, and the sum of its parts without their signs, to which rounding is relative.
    """
    g = family.denominator_of[k]
    above, below = weight * family.numerator_isotropic[k], weight * level * family.denominator_isotropic[g]
    sums[family.numerator_point[k]] += weight * family.numerator_weight[k]
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        sums[family.denominator_point[e]] -= weight * level * family.denominator_weight[e]
    return above - below, above + below


@inner_kernel
def fill_sum(family, row, sums):
    """Fill the coefficients of a row's sum, one for each point; return that of the identity and its parts."""
    identity = size = 0.0
    sums[:] = 0.0
    for s in range(int(row[COUNT])):
        net, parts = add_ratio(family, int(row[INDEX + s]), row[LEVEL], row[WEIGHT + s], sums)
        identity, size = identity + net, size + parts
    return identity, size


@small_kernel
def most_heard(family, k, square):
    """Return the most that numerator k is over ``|u|^2`` beyond a distance whose square is given."""
    j = family.numerator_point[k]
    most = family.numerator_weight[k] * most_excess(family.channels, j, square) / square
    return family.numerator_isotropic[k] + most
