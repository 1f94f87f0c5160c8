"""Multipliers that make a weighted sum of forms as negative as they can.

``min over lambda in the simplex of lambda_max(sum_k lambda_k A_k)`` is the dual of
``max over U psd, tr U = 1, of min_k <A_k, U>``, which has six unknowns whatever the number of forms: an
interior-point
method there costs a few small products per form and step, and its slacks give the multipliers. Any
multipliers give a valid bound; these give nearly the best.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import heap_kernel, inner_kernel, kernel
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import cholesky_factor, cholesky_solve, copy_into

__all__ = ["dual_multipliers", "positive_definite", "top_eigenvector"]

_R2 = 0.7071067811865476
_R6 = 0.4082482904638631
_MOST_STEPS = 60


@kernel
def top_eigenvector(a, v):
    """Fill the eigenvector of the largest eigenvalue of a form; return that eigenvalue (closed form)."""
    mean = (a[0] + a[1] + a[2]) / 3.0
    x, y, z = a[0] - mean, a[1] - mean, a[2] - mean
    off = a[3] * a[3] + a[4] * a[4] + a[5] * a[5]
    spread = math.sqrt((x * x + y * y + z * z + 2.0 * off) / 6.0)
    v[0], v[1], v[2] = 0.0, 0.0, 1.0
    if spread == 0.0:
        return mean
    det = x * (y * z - a[5] * a[5]) - a[3] * (a[3] * z - a[5] * a[4]) + a[4] * (a[3] * a[5] - y * a[4])
    cosine = max(-1.0, min(1.0, det / (2.0 * spread * spread * spread)))
    top = mean + 2.0 * spread * math.cos(math.acos(cosine) / 3.0)
    x, y, z = a[0] - top, a[1] - top, a[2] - top
    # the null vector of A - top I is the longest cross product of two of its rows
    longest = 0.0
    for k in range(3):
        if k == 0:
            p, q, r = a[3] * a[5] - a[4] * y, a[4] * a[3] - x * a[5], x * y - a[3] * a[3]
        elif k == 1:
            p, q, r = a[3] * z - a[4] * a[5], a[4] * a[4] - x * z, x * a[5] - a[3] * a[4]
        else:
            p, q, r = y * z - a[5] * a[5], a[5] * a[4] - a[3] * z, a[3] * a[5] - y * a[4]
        length = p * p + q * q + r * r
        if length > longest:
            longest = length
            v[0], v[1], v[2] = p, q, r
    if longest > 1e-12 * spread**4:
        norm = math.sqrt(longest)
        for i in range(3):
            v[i] /= norm
        return top
    # a double eigenvalue: A - top I has rank one, and any vector across its longest row will do
    p, q, r = x, a[3], a[4]
    if a[3] * a[3] + y * y + a[5] * a[5] > p * p + q * q + r * r:
        p, q, r = a[3], y, a[5]
    if a[4] * a[4] + a[5] * a[5] + z * z > p * p + q * q + r * r:
        p, q, r = a[4], a[5], z
    if abs(p) <= abs(q):
        v[0], v[1], v[2] = 0.0, r, -q
    else:
        v[0], v[1], v[2] = -r, 0.0, p
    norm = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
    for i in range(3):
        v[i] /= norm
    return top


@kernel
def inverse(u, w):
    """Fill the inverse of a symmetric matrix kept as six numbers; return its determinant."""
    w[0] = u[1] * u[2] - u[5] * u[5]
    w[1] = u[0] * u[2] - u[4] * u[4]
    w[2] = u[0] * u[1] - u[3] * u[3]
    w[3] = u[4] * u[5] - u[3] * u[2]
    w[4] = u[3] * u[5] - u[4] * u[1]
    w[5] = u[3] * u[4] - u[0] * u[5]
    det = u[0] * w[0] + u[3] * w[3] + u[4] * w[4]
    for i in range(6):
        w[i] /= det
    return det


@inner_kernel
def positive_definite(u):
    """Return whether a form is positive definite, by its leading minors."""
    minor = u[0] * u[1] - u[3] * u[3]
    det = u[2] * minor - u[0] * u[5] * u[5] - u[1] * u[4] * u[4] + 2.0 * u[3] * u[4] * u[5]
    return u[0] > 0.0 and minor > 0.0 and det > 0.0


@inner_kernel
def fill_rows(forms, count, matrix, rows, value):
    """Fill each form's coordinates in the trace-free basis, its share in the level, and its value."""
    for k in range(forms.shape[0]):
        a = forms[k]
        rows[k, 0] = (a[0] - a[1]) * _R2
        rows[k, 1] = (a[0] + a[1] - 2.0 * a[2]) * _R6
        rows[k, 2] = 2.0 * a[3] * _R2
        rows[k, 3] = 2.0 * a[4] * _R2
        rows[k, 4] = 2.0 * a[5] * _R2
        rows[k, 5] = -1.0 if k < count else 0.0
        value[k] = a[0] * matrix[0] + a[1] * matrix[1] + a[2] * matrix[2]
        value[k] += 2.0 * (a[3] * matrix[3] + a[4] * matrix[4] + a[5] * matrix[5])


@inner_kernel
def barrier_derivatives(matrix, rows, slacks, mu, grad, hess):
    """Fill the gradient and the lower half of minus the Hessian of ``s + mu (log det U + sum log slack)``."""
    w, p = scratch(6), scratch(5, 3, 3)
    inverse(matrix, w)
    for r in range(3):  # P_i = U^-1 B_i for the five trace-free basis matrices
        w0 = w[0] if r == 0 else (w[3] if r == 1 else w[4])
        w1 = w[3] if r == 0 else (w[1] if r == 1 else w[5])
        w2 = w[4] if r == 0 else (w[5] if r == 1 else w[2])
        p[0, r, 0], p[0, r, 1], p[0, r, 2] = w0 * _R2, -w1 * _R2, 0.0
        p[1, r, 0], p[1, r, 1], p[1, r, 2] = w0 * _R6, w1 * _R6, -2.0 * w2 * _R6
        p[2, r, 0], p[2, r, 1], p[2, r, 2] = w1 * _R2, w0 * _R2, 0.0
        p[3, r, 0], p[3, r, 1], p[3, r, 2] = w2 * _R2, 0.0, w0 * _R2
        p[4, r, 0], p[4, r, 1], p[4, r, 2] = 0.0, w2 * _R2, w1 * _R2
    for i in range(5):
        grad[i] = mu * (p[i, 0, 0] + p[i, 1, 1] + p[i, 2, 2])
        for j in range(i + 1):
            trace = 0.0
            for a in range(3):
                for b in range(3):
                    trace += p[i, a, b] * p[j, b, a]
            hess[i, j] = mu * trace
    for j in range(6):
        hess[5, j] = 0.0
    grad[5] = 1.0
    for k in range(rows.shape[0]):
        first = mu / slacks[k]
        second = first / slacks[k]
        for i in range(6):
            grad[i] += first * rows[k, i]
            for j in range(i + 1):
                hess[i, j] += second * rows[k, i] * rows[k, j]


@inner_kernel
def feasible_step(matrix, slacks, changes, way, trial):
    """Return the largest tried share of a step that stays inside; fill the matrix there. Zero: none does."""
    step = 1.0
    for _ in range(40):
        y0, y1 = step * way[0] * _R2, step * way[1] * _R6
        trial[0] = matrix[0] + y0 + y1
        trial[1] = matrix[1] - y0 + y1
        trial[2] = matrix[2] - 2.0 * y1
        for i in range(3):
            trial[3 + i] = matrix[3 + i] + step * way[2 + i] * _R2
        fits = positive_definite(trial)
        for k in range(slacks.shape[0]):
            fits = fits and step * changes[k] > -0.95 * slacks[k]
        if fits:
            return step
        step *= 0.6
    return 0.0


@heap_kernel
def dual_multipliers(forms, count, sides, level, stop, gap, start, multipliers, matrix):
    """Fill the multipliers of ``count`` forms, summing to one, and of the ``sides`` constraints after them.

    Stops early when the matrix found already has ``min_k <A_k, U> > stop``: no multipliers then bring the
    largest eigenvalue below it.

    Args:
        forms: (count + sides, 6) or more; the ``sides`` are the constraints ``<Q, U> >= 0``.
        count: how many are maximised over.
        sides: how many are constraints.
        level: the size of the values that are of interest.
        stop: the primal value at which to stop.
        gap: relative accuracy, in units of the level.
        start: (6,) positive definite matrix of unit trace that meets the constraints strictly.
        multipliers: output, (count + sides,) or more.
        matrix: output, (6,): the primal matrix U.

    Returns:
        The primal value ``min_k <A_k, U>``.
    """
    total = count + sides
    rows, value, slacks, changes = np.empty((total, 6)), np.empty(total), np.empty(total), np.zeros(total)
    hess, way, grad, trial = scratch(6, 6), scratch(6), scratch(6), scratch(6)
    for i in range(6):
        matrix[i] = start[i]
    fill_rows(forms[:total], count, matrix, rows, value)
    smallest = value[0]
    for k in range(count):
        smallest = min(smallest, value[k])
    mu = 0.3 * max(abs(level), abs(smallest))
    end = gap * abs(level) / (total + 3)
    s = smallest - mu * count
    for _ in range(_MOST_STEPS):
        for k in range(total):
            slacks[k] = value[k] + s * rows[k, 5]
        barrier_derivatives(matrix, rows, slacks, mu, grad, hess)
        if not cholesky_factor(hess, np.int64(6)):
            break
        copy_into(grad, way)
        cholesky_solve(hess, np.int64(6), way)
        decrement = 0.0
        for i in range(6):
            decrement += grad[i] * way[i]
        for k in range(total):
            changes[k] = 0.0
            for i in range(6):
                changes[k] += rows[k, i] * way[i]
        step = feasible_step(matrix, slacks, changes, way, trial)
        if not step > 0.0:
            break
        copy_into(trial, matrix)
        s += step * way[5]
        smallest = math.inf
        for k in range(total):
            value[k] += step * (changes[k] - rows[k, 5] * way[5])
            if k < count:
                smallest = min(smallest, value[k])
        if smallest > stop or (decrement <= 0.3 * mu and mu <= end):
            break
        if decrement <= 0.3 * mu:
            mu = max(0.1 * mu, 0.999 * end)
    weight = 0.0
    for k in range(total):  # to first order in the last step: the slacks alone are far less accurate
        multipliers[k] = max(0.0, 1.0 - changes[k] / slacks[k]) / slacks[k]
        if k < count:
            weight += multipliers[k]
    for k in range(total):
        multipliers[k] /= weight
    return smallest
