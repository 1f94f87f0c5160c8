"""Multipliers that make a weighted sum of forms as negative as they can.

``min over lambda in the simplex of lambda_max(sum_k lambda_k A_k)`` is the dual of
``max over U psd, tr U = 1, of min_k <A_k, U>``, which has six unknowns whatever the number of forms: an
interior-point method there costs a few small products per form and step, and its slacks give the
multipliers. All multipliers give a valid bound; these give nearly the best.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.barrier import add_constraints
from nullpose.solver.kernels.linear_algebra.symmetric import (
    adjugate,
    cholesky_factor,
    cholesky_solve,
    copy_into,
    form_product,
    inner,
    matrix_of,
    smallest_of,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot

_MOST_STEPS = 60
_BACKTRACKS = 40
_FIRST = 0.1  # barrier weight, in units of the level
_SHRINK = 0.03  # of it from one centre to the next
_MARGIN = 0.1  # what more steps can gain, as a share of the distance to where they must come below


@inner_kernel
def positive_definite(u):
    """Check whether a form is positive definite, by its leading minors."""
    minors = scratch(6)
    return adjugate(u, minors) > 0.0 and minors[2] > 0.0 and u[0] > 0.0


@inner_kernel
def fill_slopes(form, slopes):
    """Fill the slopes of ``<A, U>`` in the five unknowns of a matrix of unit trace: xx, yy, xy, xz, yz."""
    slopes[0], slopes[1] = form[0] - form[2], form[1] - form[2]
    for i in range(3):
        slopes[2 + i] = 2.0 * form[3 + i]


@inner_kernel
def add_log_det(matrix, mu, system, gradient):
    """Add the gradient of ``mu log det U`` in the five unknowns, and the lower half of minus its Hessian."""
    form, inverse, p = scratch(6), scratch(3, 3), scratch(5, 3, 3)
    det = adjugate(matrix, form)
    matrix_of(form, inverse)
    for r in range(3):  # the inverse times the derivative of U by each unknown
        x, y, z = inverse[r, 0] / det, inverse[r, 1] / det, inverse[r, 2] / det
        p[0, r, 0], p[0, r, 1], p[0, r, 2] = x, 0.0, -z
        p[1, r, 0], p[1, r, 1], p[1, r, 2] = 0.0, y, -z
        p[2, r, 0], p[2, r, 1], p[2, r, 2] = y, x, 0.0
        p[3, r, 0], p[3, r, 1], p[3, r, 2] = z, 0.0, x
        p[4, r, 0], p[4, r, 1], p[4, r, 2] = 0.0, z, y
    for i in range(5):
        gradient[i] += mu * (p[i, 0, 0] + p[i, 1, 1] + p[i, 2, 2])
        for j in range(i + 1):
            for a in range(3):
                system[i, j] += mu * dot(p[i, a], p[j, :, a])


@inner_kernel
def feasible_step(matrix, slacks, changes, direction, trial):
    """Return the largest tried share of a step that stays inside; fill the matrix there. Zero: none does."""
    step = 1.0
    for k in range(slacks.shape[0]):
        if changes[k] < 0.0:
            step = min(step, -0.95 * slacks[k] / changes[k])
    for _ in range(_BACKTRACKS):
        trial[0], trial[1] = matrix[0] + step * direction[0], matrix[1] + step * direction[1]
        trial[2] = matrix[2] - step * (direction[0] + direction[1])
        for i in range(3):
            trial[3 + i] = matrix[3 + i] + step * direction[2 + i]
        if positive_definite(trial):
            return step
        step *= 0.6
    return 0.0


@inner_kernel
def fill_duals(mu, slacks, changes, multipliers):
    """Fill multipliers to first order in the last step: the slacks alone are far less accurate."""
    for k in range(slacks.shape[0]):
        multipliers[k] = mu * max(0.0, 1.0 - changes[k] / slacks[k]) / slacks[k]


@inner_kernel
def primal_value(values, shares, offset):
    """Return the smallest value, or with shares the logarithm of their mean."""
    if shares.shape[0] == 0:
        return smallest_of(values)
    total = 0.0
    for k in range(shares.shape[0]):
        total += shares[k] * math.log(max(offset + values[k], 1e-290))
    return total


@heap_kernel
def dual_multipliers(forms, sides, total, level, stop, gap, start, multipliers, matrix, shares, offset):
    """Fill the multipliers of forms, which sum to one, and of the ``sides`` constraints before them.

    With shares, ``sum_k share_k log(a + <A_k, U>)`` is maximised in place of the smallest, and stated and
    returned as that number; only the constraints get multipliers, in its units.

    Stops early when the matrix found already has ``min_k <A_k, U> > stop``: no multipliers then bring the
    largest eigenvalue below it. And when the multipliers bring it so far below that better ones gain little.

    Args:
        forms: (total, 6) or more; the first ``sides`` of them are constraints ``<Q, U> >= 0``.
        sides: how many those are.
        total: how many there are with the forms that are maximised over.
        level: the size of the values that are of interest.
        stop: the primal value at which to stop.
        gap: relative accuracy, in units of the level.
        start: (6,) positive definite matrix of unit trace that meets the constraints strictly.
        multipliers: output, (total,) or more.
        matrix: output, (6,): the primal matrix U.
        shares: (total - sides,) of a mean, or (0,).
        offset: a.

    Returns:
        The primal value ``min_k <A_k, U>``.
    """
    is_mean = shares.shape[0] > 0
    rates, values, slacks, changes = np.empty((total, 6)), np.empty(total), np.empty(total), np.zeros(total)
    duals, system, gradient = np.empty(total), scratch(6, 6), scratch(6)
    direction, trial = scratch(6), scratch(6)
    copy_into(start, matrix)
    for k in range(total):
        fill_slopes(forms[k], rates[k])
        rates[k, 5] = 0.0 if k < sides or is_mean else -1.0
        values[k] = form_product(forms[k], matrix)
    smallest = primal_value(values[sides:], shares, offset)
    mu, end = _FIRST * max(abs(level), abs(smallest)), gap * abs(level) / (total + 3)
    s, step = 0.0 if is_mean else smallest - mu * (total - sides), 0.0
    below, has_centre = stop if stop < math.inf else -math.inf, False
    for _ in range(_MOST_STEPS):
        system[:, :], gradient[:] = 0.0, 0.0
        gradient[5], system[5, 5] = (0.0, 1.0) if is_mean else (1.0, 0.0)
        for k in range(total):
            slacks[k] = values[k] + s * rates[k, 5] + (offset if is_mean and k >= sides else 0.0)
            weight = shares[k - sides] if is_mean and k >= sides else mu
            duals[k] = weight / slacks[k]
            at = slice(k, k + 1)
            add_constraints(slacks[at], duals[at], rates[at], np.int64(6), weight, system, gradient)
        add_log_det(matrix, mu, system, gradient)
        if not cholesky_factor(system, np.int64(6)):
            step = 0.0
            break
        copy_into(gradient, direction)
        cholesky_solve(system, np.int64(6), direction)
        for k in range(total):
            changes[k] = inner(rates[k], direction, 6)
        step = feasible_step(matrix, slacks, changes, direction, trial)
        if not step > 0.0:
            break
        copy_into(trial, matrix)
        s += step * direction[5]
        for k in range(total):
            values[k] += step * (changes[k] - rates[k, 5] * direction[5])
        smallest = primal_value(values[sides:], shares, offset)
        is_centred = inner(gradient, direction, 6) <= mu
        if smallest > stop or (is_centred and (mu <= end or mu * total <= _MARGIN * (below - smallest))):
            break
        if is_centred:
            fill_duals(mu, slacks, changes, multipliers)
            mu, has_centre = max(_SHRINK * mu, 0.999 * end), True
    if step > 0.0 or not has_centre:  # else those of the last centre: past it, rounding takes over
        fill_duals(mu, slacks, changes, multipliers)
    weight = 1.0 if is_mean else 0.0
    for k in range(sides, 0 if is_mean else total):
        weight += multipliers[k]
    for k in range(total):
        multipliers[k] /= weight
    return smallest
