"""Multipliers of pairs: those that make a sum of tangents as negative as they can.

``max over U psd, tr U = 1, of min_q phi_q(<E_q, U>) - <B_q, U>`` is concave in U. Its multipliers, with the
tangents at its maximum, make the sum of lowest largest eigenvalue, as those of
:mod:`nullpose.solver.kernels.linear_algebra.dual` do for forms.
"""

from __future__ import annotations

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.barrier import add_constraints
from nullpose.solver.kernels.linear_algebra.dual import add_log_det, feasible_step, fill_slopes
from nullpose.solver.kernels.linear_algebra.links import pair_tangent
from nullpose.solver.kernels.linear_algebra.symmetric import (
    cholesky_factor,
    cholesky_solve,
    copy_into,
    form_product,
    inner,
    smallest_of,
)

_MOST_STEPS = 80
_BACKTRACKS = 40
_FIRST = 0.1  # barrier weight, in units of what the nodes' denominators are at the start
_SHORTER = 0.6
_SHRINK = 0.03  # of it from one centre to the next


@inner_kernel
def fill_pairs(family, level, jammed, heard, sizes, matrix, values, rates, bends):
    """Fill the pairs' values at a matrix, over their sizes, their slopes, and how far they bend."""
    along = scratch(6)
    for q in range(sizes.shape[0]):
        e = form_product(jammed[q], matrix)
        constant, slope, bend = pair_tangent(family, q, level, e)
        for m in range(6):
            along[m] = (slope * jammed[q, m] - heard[q, m]) / sizes[q]
        fill_slopes(along, rates[q])
        values[q] = (constant + slope * e - form_product(heard[q], matrix)) / sizes[q]
        bends[q] = bend / sizes[q]


@heap_kernel
def pair_multipliers(family, level, forms, sides, jammed, heard, gap, start, multipliers, matrix):
    """Fill the multipliers of pairs, which sum to one, and of the ``sides`` constraints before them.

    Args:
        family: with its pairs.
        level: the quotient that is of interest, 1 or more.
        forms: (sides, 6) or more, constraints ``<Q, U> >= 0``.
        sides: how many those are.
        jammed: (pairs, 6) the denominators of the pairs' eavesdroppers.
        heard: (pairs, 6) those of their nodes.
        gap: relative accuracy, in units of the denominators at the start.
        start: (6,) positive definite matrix of unit trace that meets the constraints strictly.
        multipliers: output, (sides + pairs,).
        matrix: output, (6,): the primal matrix U.
    """
    pairs = family.pairs.shape[0]
    total = sides + pairs
    rates, values, slacks, changes = np.zeros((total, 6)), np.empty(total), np.empty(total), np.zeros(total)
    duals, bends, sizes, along = np.empty(total), np.empty(pairs), np.empty(pairs), np.empty((pairs, 6))
    system, gradient, direction, trial = scratch(6, 6), scratch(6), scratch(6), scratch(6)
    copy_into(start, matrix)
    for q in range(pairs):
        sizes[q] = form_product(heard[q], start)
        fill_slopes(jammed[q], along[q])
    for k in range(sides):
        fill_slopes(forms[k], rates[k])
        values[k] = form_product(forms[k], matrix)
    rates[sides:, 5] = -1.0
    fill_pairs(family, level, jammed, heard, sizes, matrix, values[sides:], rates[sides:], bends)
    mu, end = _FIRST, gap / (total + 3)
    s = smallest_of(values[sides:]) - mu * pairs
    for _ in range(_MOST_STEPS):
        system[:, :], gradient[:] = 0.0, 0.0
        gradient[5] = 1.0
        for k in range(total):
            slacks[k] = values[k] + s * rates[k, 5]
            duals[k] = mu / slacks[k]
        add_constraints(slacks, duals, rates, np.int64(6), mu, system, gradient)
        for q in range(pairs):
            for i in range(5):
                for j in range(i + 1):
                    system[i, j] += duals[sides + q] * bends[q] * along[q, i] * along[q, j]
        add_log_det(matrix, mu, system, gradient)
        if not cholesky_factor(system, np.int64(6)):
            break
        copy_into(gradient, direction)
        cholesky_solve(system, np.int64(6), direction)
        for k in range(total):
            changes[k] = inner(rates[k], direction, 6)
        is_centred = inner(gradient, direction, 6) <= mu
        if is_centred and mu <= end:
            break
        step = feasible_step(matrix, slacks, changes, direction, trial)
        if not step > 0.0:
            break
        for _ in range(_BACKTRACKS):  # what a pair loses by its bend, the rates do not foresee
            fill_pairs(family, level, jammed, heard, sizes, trial, values[sides:], rates[sides:], bends)
            if smallest_of(values[sides:]) > s + step * direction[5]:
                break
            step *= _SHORTER
            for m in range(6):
                trial[m] = matrix[m] + _SHORTER * (trial[m] - matrix[m])
        copy_into(trial, matrix)
        s += step * direction[5]
        for k in range(sides):
            values[k] += step * changes[k]
        if is_centred:
            mu = max(_SHRINK * mu, 0.999 * end)
    weight = 1e-290
    for k in range(total):  # to first order in the last step: the slacks alone are far less accurate
        multipliers[k] = max(0.0, 1.0 - changes[k] / slacks[k]) / slacks[k]
        if k >= sides:
            multipliers[k] /= sizes[k - sides]
            weight += multipliers[k]
    for k in range(total):
        multipliers[k] /= weight
