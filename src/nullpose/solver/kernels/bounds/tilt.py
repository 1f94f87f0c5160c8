"""A price of positions in the test of a box: numerators times ``e^(a . x)``, x being a step from its centre.

Where ``log(b + ratio) + a . (p - q)`` is maximised, the level L excludes a box if for all its positions
``sum_k lambda_k (N_k e^(a . x) - t D_k) < 0`` with ``t = e^(L - a . (c - q)) - b e^y``. The number ``y``, the
sum of ``|a_i| h_i``, is the most that the price offers on the way from the centre c to a corner. Since

    ``e^(a . x) <= 1 + a . x + y^2 e^y / 2``   and   ``|e^(a . x) - 1| <= e^y - 1``,

a sum ``N + N'.x + R`` of numerators times it is at most ``N + (N' + a N) . x`` and a rest: ``y^2 e^y / 2 N``,
``(e^y - 1) |N'.x|`` and ``e^y R``. The denominators stay as they are: beside an interferer their slopes are
large.
"""

from __future__ import annotations

import math

from nullpose.problem.records import AFFINE_AXIS
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, form_product

_FAINTEST = 1e-290  # a level that nothing is below


@rare_kernel
def takes_tilt(family, axis_field):
    """Check whether the test can price positions: no link is in a numerator and in a denominator."""
    alone = axis_field.kind != AFFINE_AXIS and family.shares.shape[0] + family.pairs.shape[0] == 0
    alone = alone and family.ground_axes.shape[0] == 0
    for k in range(family.numerator_weight.shape[0]):
        alone = alone and family.numerator_isotropic[k] == 0.0
        for j in family.denominator_point:
            alone = alone and family.numerator_point[k] != j
    return alone


@inner_kernel
def most_offered(tilt, half):
    """Return the most that a price offers on the way from a box's centre."""
    return abs(tilt[0]) * half[0] + abs(tilt[1]) * half[1] + abs(tilt[2]) * half[2]


@rare_kernel
def priced(level, best, price, row, tilt):
    """Fill the tilt, and the level at a box's centre; return the best there, as a ratio.

    The row's level is one that no position of the box needs.
    """
    offered, offset, most = 0.0, price[6], most_offered(price, row[HALF:LEVEL])
    for i in range(3):
        offered += price[i] * (row[CENTRE + i] - price[3 + i])
        tilt[i] = price[i]
    needed = (offset + level) * math.exp(-offered)
    tilt[3] = max(needed - offset * math.exp(most), _FAINTEST)
    row[LEVEL] = max(needed * math.exp(-most) - offset, _FAINTEST)
    return max((offset + best) * math.exp(-offered) - offset, _FAINTEST)


@rare_kernel
def tilt_sum(workspace, half, slopes, rest, left):
    """Tilt the slopes of a sum by its numerators'; fill the rest's form, and return the rest of the rest.

    What is left out of the numerators' expansions, ``left``, counts once already.
    """
    tilt, value, change = workspace.tilt, zeroed(6), scratch(6)
    most, spread = most_offered(tilt, half), 0.0
    for i in range(3):
        change[:] = 0.0
        for j in range(workspace.sums.shape[0]):
            if workspace.sums[j] > 0.0:
                add_scaled(workspace.sums[j], workspace.form_slopes[j, i], change)
        spread += half[i] * math.sqrt(form_product(change, change))
    for j in range(workspace.sums.shape[0]):
        if workspace.sums[j] > 0.0:
            add_scaled(workspace.sums[j], workspace.forms[j], value)
    for i in range(3):
        add_scaled(tilt[i], value, slopes[i])
    add_scaled(0.5 * most * most * math.exp(most), value, rest)
    return math.expm1(most) * (left + spread)
