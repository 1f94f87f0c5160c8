"""The barrier problem behind the polish: ``maximise t + mu (sum log(f_k - t) + sum log s_c)``."""

from __future__ import annotations

import math

from nullpose.solve.kernels.jit import heap_kernel, inner_kernel, kernel
from nullpose.solve.kernels.symmetric import cholesky_factor, cholesky_solve

__all__ = ["barrier_value", "bent_step", "best_level", "newton_step", "residual", "update_duals"]


@kernel
def best_level(f, mu):
    """Return the t that maximises ``t + mu sum log(f_k - t)``, by Newton's method."""
    count = f.shape[0]
    smallest = f[0]
    for k in range(1, count):
        smallest = min(smallest, f[k])
    t = smallest - mu * count
    for _ in range(50):
        total = 0.0
        slope = 0.0
        for k in range(count):
            w = mu / (f[k] - t)
            total += w
            slope += w / (f[k] - t)
        step = (1.0 - total) / slope
        if step > 0.0:
            step = min(step, 0.5 * (smallest - t))
        t += step
        if abs(step) <= 1e-12 * (smallest - t):
            break
    return t


@kernel
def barrier_value(f, t, slacks, used, mu):
    """Return the barrier's value, minus infinity outside."""
    value = t
    for k in range(f.shape[0]):
        gap = f[k] - t
        if not gap > 0.0:
            return -math.inf
        value += mu * math.log(gap)
    for c in range(slacks.shape[0]):
        if used[c]:
            if not slacks[c] > 0.0:
                return -math.inf
            value += mu * math.log(slacks[c])
    return value


@kernel
def residual(f, t, slacks, used, z, zs, slopes, rows, n, mu):
    """Return the largest violation of the barrier problem's stationarity and complementarity."""
    error = 0.0
    for m in range(n):
        s = 0.0
        for k in range(f.shape[0]):
            s += z[k] * slopes[k, m]
        for c in range(slacks.shape[0]):
            if used[c]:
                s += zs[c] * rows[c, m]
        error = max(error, abs(s))
    for k in range(f.shape[0]):
        error = max(error, abs(z[k] * (f[k] - t) - mu))
    for c in range(slacks.shape[0]):
        if used[c]:
            error = max(error, abs(zs[c] * slacks[c] - mu))
    return error


@heap_kernel
def newton_step(f, t, slacks, used, z, zs, slopes, rows, h, n, mu, system, factor, step):
    """Fill the primal-dual Newton step in the n variables and t; return the barrier's slope along it, or NaN.

    The Hessian is shifted, each variable in its own curvature (across the null it is vast), until the system
    is positive definite, so that the step climbs.
    """
    for i in range(n + 1):
        step[i] = 0.0
        for j in range(n + 1):
            system[i, j] = -h[i, j] if (i < n and j < n) else 0.0
    for k in range(f.shape[0]):
        gap = f[k] - t
        s = z[k] / gap
        for a in range(n):
            step[a] += mu / gap * slopes[k, a]
            for b in range(n):
                system[a, b] += s * slopes[k, a] * slopes[k, b]
            system[a, n] -= s * slopes[k, a]
            system[n, a] -= s * slopes[k, a]
        system[n, n] += s
        step[n] -= mu / gap
    for c in range(slacks.shape[0]):
        if used[c]:
            s = zs[c] / slacks[c]
            for a in range(n):
                step[a] += mu / slacks[c] * rows[c, a]
                for b in range(n):
                    system[a, b] += s * rows[c, a] * rows[c, b]
    slope = 0.0
    gradient = step.copy()
    step[n] += 1.0
    shift = 0.0
    while True:
        for i in range(n + 1):
            for j in range(n + 1):
                factor[i, j] = system[i, j]
            if i < n:
                factor[i, i] += shift * (1.0 + abs(h[i, i]))
        if cholesky_factor(factor, n + 1):
            break
        shift = max(1e-4, 8.0 * shift)
        if shift > 1e12:
            return math.nan
    cholesky_solve(factor, n + 1, step)
    for m in range(n):
        slope += gradient[m] * step[m]
    return slope


@inner_kernel
def bent_step(f, t, new_f, slopes, z, factor, n, scale, step, out):
    """Fill a step that allows for the curvature met: Newton's, with the linearisation's errors put in.

    A ridge of equal ratios is curved, and a straight step leaves it; the ratios at its end tell by how much.
    """
    for i in range(n + 1):
        out[i] = 0.0
    for k in range(f.shape[0]):
        predicted = f[k]
        for m in range(n):
            predicted += scale * slopes[k, m] * step[m]
        pull = z[k] / (f[k] - t) * (predicted - new_f[k])
        for m in range(n):
            out[m] += pull * slopes[k, m]
        out[n] -= pull
    cholesky_solve(factor, n + 1, out)
    for i in range(n + 1):
        out[i] += scale * step[i]


@inner_kernel
def update_duals(gaps, values, rates, used, step, n, scale, mu, duals):
    """Take a dual step: ``z += scale (mu / gap - z - z / gap * (a . step))`` for each constraint in use.

    ``rates`` holds the constraints' gradients; ``values`` their slacks after the primal step, around whose
    ideal ``mu / value`` the multipliers are kept within a wide corridor.
    """
    for k in range(gaps.shape[0]):
        if not used[k]:
            continue
        s = 0.0
        for m in range(n):
            s += rates[k, m] * step[m]
        moved = duals[k] + scale * (mu / gaps[k] - duals[k] - duals[k] / gaps[k] * s)
        ideal = mu / values[k]
        duals[k] = min(max(moved, 1e-2 * ideal), 1e2 * ideal)
