"""The barrier problem behind the polish: ``maximise t + mu sum log g_c``.

The gaps ``g`` are those of the ratios, ``f_k - t``, and after them the slacks of the domain. Their rates are
their slopes in the n search variables and, last, in t. A gap that is infinite is no constraint.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import zeroed
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_scaled,
    cholesky_factor,
    cholesky_solve,
    copy_into,
    copy_table,
    inner,
    smallest_of,
)


@kernel
def best_level(f, mu):
    """Return the t that maximises ``t + mu sum log(f_k - t)``, by Newton's method, which comes from above."""
    smallest = smallest_of(f)
    t = smallest - mu
    for _ in range(50):
        total = slope = 0.0
        for value in f:
            weight = mu / (value - t)
            total += weight
            slope += weight / (value - t)
        step = (total - 1.0) / slope
        t -= step
        if step <= 1e-12 * (smallest - t):
            break
    return t


@kernel
def barrier_value(gaps, t, mu):
    """Return the barrier's value, minus infinity outside."""
    value = t
    for gap in gaps:
        if not gap > 0.0:
            return -math.inf
        if gap < math.inf:
            value += mu * math.log(gap)
    return value


@kernel
def residual(gaps, duals, rates, n, mu):
    """Return the largest violation of the barrier problem's stationarity and complementarity."""
    error = 0.0
    for m in range(n):
        error = max(error, abs(inner(duals, rates[:, m], gaps.shape[0])))
    for c in range(gaps.shape[0]):
        if gaps[c] < math.inf:
            error = max(error, abs(duals[c] * gaps[c] - mu))
    return error


@inner_kernel
def add_constraints(gaps, duals, rates, n, mu, system, gradient):
    """Add the gradient of ``mu sum log g_c`` in n variables, and its primal-dual curvature's lower half."""
    for c in range(gaps.shape[0]):
        if gaps[c] == math.inf:
            continue
        first, second = mu / gaps[c], duals[c] / gaps[c]
        for a in range(n):
            gradient[a] += first * rates[c, a]
            for b in range(a + 1):
                system[a, b] += second * rates[c, a] * rates[c, b]


@kernel
def newton_step(gaps, duals, rates, h, n, mu, factor, step):
    """Fill the primal-dual Newton step in the n variables and t; return the barrier's slope along it, or NaN.

    The Hessian is shifted, each variable in its own curvature (across the null it is vast), until the system
    is positive definite, so that the step climbs.
    """
    system, gradient = zeroed(6, 6), zeroed(6)
    for i in range(n):
        for j in range(n):
            system[i, j] = -h[i, j]
    add_constraints(gaps, duals, rates, n + 1, mu, system, gradient)
    copy_into(gradient, step)
    step[n] += 1.0
    shift = 0.0
    while True:
        copy_table(system, factor)
        for i in range(n):
            factor[i, i] += shift * (1.0 + abs(h[i, i]))
        if cholesky_factor(factor, n + 1):
            break
        shift = max(1e-4, 8.0 * shift)
        if shift > 1e12:
            return math.nan
    cholesky_solve(factor, n + 1, step)
    return inner(gradient, step, n)


@inner_kernel
def bent_step(f, new_f, gaps, duals, rates, factor, n, scale, step, out):
    """Fill a step that allows for the curvature met: Newton's, with the linearisation's errors put in.

    A ridge of equal ratios is curved, and a straight step leaves it; the ratios at its end tell by how much.
    """
    out[:] = 0.0
    for k in range(f.shape[0]):
        missed = f[k] + scale * inner(rates[k], step, n) - new_f[k]
        add_scaled(duals[k] / gaps[k] * missed, rates[k], out)
    cholesky_solve(factor, n + 1, out)
    add_scaled(scale, step, out)


@inner_kernel
def update_duals(gaps, new_gaps, rates, step, n, scale, mu, duals):
    """Take a dual step: ``z += scale (mu / gap - z - z / gap * (rate . step))`` for each constraint.

    Around their ideal after the primal step, ``mu / new_gap``, they are kept within a wide corridor.
    """
    for c in range(gaps.shape[0]):
        gained = duals[c] * (1.0 + inner(rates[c], step, n) / gaps[c])
        ideal = mu / new_gaps[c]
        moved = duals[c] + scale * (mu / gaps[c] - gained)
        duals[c] = min(max(moved, 1e-2 * ideal), 1e2 * ideal)
