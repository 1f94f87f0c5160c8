"""Local maximum of the smallest ratio, by the epigraph form ``maximise t: f_k(p, u) >= t, p in P``.

A primal-dual interior-point method with exact second derivatives walks to the neighbourhood of a
Karush-Kuhn-Tucker
point; Newton's method on the equations of its active set then lands on it to the last digits. ``f_k`` is the
logarithm of ratio k. Nothing is smoothed: at the end the active ratios are equal, each with its multiplier.

The pose is an affine function of the search variables: a step in position, scaled by the distance to the
nearest
node; for a free axis a step in its tangent plane and a part that turns with the position (see ``turning``),
the axis being renormalised after every step.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import kernel
from nullpose.solve.kernels.links import derivatives, log_ratios, min_log_ratio
from nullpose.solve.kernels.symmetric import cholesky_factor, cholesky_solve, gauss_solve, tangents

__all__ = ["polish"]

_MU_END = 1e-12
_ACTIVE = 1e-5


@kernel
def axis_at(field, offset, matrix, p, u):
    """Overwrite ``u`` with the axis that an affine field gives at p; leave a free axis as it is."""
    if field == 1:
        for i in range(3):
            u[i] = offset[i] + matrix[i, 0] * p[0] + matrix[i, 1] * p[1] + matrix[i, 2] * p[2]


@kernel
def turning(family, p, u):
    """Return the rate, per metre and with its sign, at which the axis should turn with a step in position.

    A straight step ``(dp, -dp / rho)`` keeps an axis that points at the strongest interferer on it exactly,
    where a step in the tangent plane alone leaves it at second order, times that interferer's power.
    """
    points, dpt, dw = family[0], family[7], family[8]
    strongest = 0.0
    rate = 0.0
    for e in range(dw.shape[0]):
        x, y, z = points[dpt[e], 0] - p[0], points[dpt[e], 1] - p[1], points[dpt[e], 2] - p[2]
        rho2 = x * x + y * y + z * z
        if dw[e] / rho2 > strongest:
            strongest = dw[e] / rho2
            along = u[0] * x + u[1] * y + u[2] * z
            rate = math.copysign(1.0 / math.sqrt(rho2), -along)
    return rate


@kernel
def chart(field, matrix, rate, u, free, length, jacobian):
    """Fill the Jacobian (6, n) of (p, u) in the search variables; return n."""
    jacobian[:, :] = 0.0
    n = 0
    for i in range(3):
        if free[i]:
            jacobian[i, n] = length
            if field == 1:
                for m in range(3):
                    jacobian[3 + m, n] = length * matrix[m, i]
            else:
                jacobian[3 + i, n] = length * rate
            n += 1
    if field == 0:
        a, b = np.empty(3), np.empty(3)
        tangents(u, a, b)
        for i in range(3):
            jacobian[3 + i, n] = a[i]
            jacobian[3 + i, n + 1] = b[i]
        n += 2
    return n


@kernel
def domain_slacks(p, low, high, keep_points, keep_radius, out):
    """Fill the slacks of the position's constraints: low faces, high faces, keep-out balls (as squares)."""
    for i in range(3):
        out[i] = p[i] - low[i]
        out[3 + i] = high[i] - p[i]
    for q in range(keep_points.shape[0]):
        d = 0.0
        for i in range(3):
            d += (p[i] - keep_points[q, i]) ** 2
        out[6 + q] = d - keep_radius * keep_radius


@kernel
def best_level(f, mu):
    """Return the t that maximises ``t + mu sum log(f_k - t)``: Newton's method from below, monotone."""
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
        step = (1.0 - total) / slope  # concave and decreasing in t: iterates stay below the root's right
        if step > 0.0:
            step = min(step, 0.5 * (smallest - t))
        t += step
        if abs(step) <= 1e-12 * (smallest - t):
            break
    return t


@kernel
def barrier_value(f, t, slacks, used, mu):
    """Return ``t + mu (sum log(f_k - t) + sum log slack)``, minus infinity outside."""
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
def move(field, offset, matrix, p, u, jacobian, n, step, scale, new_p, new_u):
    """Fill the pose reached by ``scale * step`` in the search variables."""
    for i in range(3):
        new_p[i] = p[i]
        new_u[i] = u[i]
        for m in range(n):
            new_p[i] += scale * jacobian[i, m] * step[m]
            if field == 0:
                new_u[i] += scale * jacobian[3 + i, m] * step[m]
    if field == 0:
        norm = math.sqrt(new_u[0] ** 2 + new_u[1] ** 2 + new_u[2] ** 2)
        for i in range(3):
            new_u[i] /= norm
    else:
        axis_at(field, offset, matrix, new_p, new_u)


@kernel
def reduce_hessian(hess, jacobian, n, out):
    """Fill ``J^T H J`` for the (6, n) Jacobian."""
    half = np.zeros((6, 5))
    for i in range(6):
        for m in range(n):
            s = 0.0
            for k in range(6):
                s += hess[i, k] * jacobian[k, m]
            half[i, m] = s
    for a in range(n):
        for b in range(n):
            s = 0.0
            for i in range(6):
                s += jacobian[i, a] * half[i, b]
            out[a, b] = s


@kernel
def polish(family, domain, axis_field, p, u, mu_start, max_steps):
    """Improve a pose in place to a local maximum; return its smallest log ratio and the steps taken.

    Args:
        family: arrays of the family.
        domain: (low (3,), high (3,), keep-out points (q, 3), keep-out radius).
        axis_field: (0 free, 1 affine; offset (3,); matrix (3, 3)).
        p: position, (3,), updated; must lie in the domain.
        u: unit axis, (3,), updated; ignored on entry when the field is affine.
        mu_start: first barrier weight, in units of the log ratio.
        max_steps: limit on interior-point steps.
    """
    low, high, keep_points, keep_radius = domain
    field, offset, matrix = axis_field
    ratios = family[1].shape[0]
    groups = family[5].shape[0]
    sides = 6 + keep_points.shape[0]
    free = np.empty(3, np.bool_)
    used = np.ones(sides, np.bool_)
    for i in range(3):
        width = high[i] - low[i]
        free[i] = width > 1e-9
        if free[i]:
            margin = min(1e-2, 1e-3 * width)
            p[i] = min(max(p[i], low[i] + margin), high[i] - margin)
        else:
            p[i] = low[i]
        used[i] = free[i] and low[i] > -math.inf
        used[3 + i] = free[i] and high[i] < math.inf
    axis_at(field, offset, matrix, p, u)
    f = np.empty(ratios)
    logs = np.empty(groups)
    slacks = np.empty(sides)
    domain_slacks(p, low, high, keep_points, keep_radius, slacks)
    best = min_log_ratio(family, p, u, logs, f)
    for q in range(keep_points.shape[0]):
        if not slacks[6 + q] > 0.0:
            return -math.inf, 0
    if not best > -math.inf:
        return best, 0
    best_p, best_u = p.copy(), u.copy()
    grads = np.empty((ratios, 6))
    hess = np.empty((6, 6))
    work = np.empty((groups, 50))
    jacobian = np.empty((6, 5))
    reduced = np.empty((ratios, 5))
    rows = np.empty((sides, 5))
    h = np.empty((5, 5))
    system = np.empty((6, 6))
    factor = np.empty((6, 6))
    rhs = np.empty(6)
    z = np.empty(ratios)
    zs = np.zeros(sides)
    new_p, new_u, new_f, new_slacks = np.empty(3), np.empty(3), np.empty(ratios), np.empty(sides)
    mu = mu_start
    t = best_level(f, mu)
    for k in range(ratios):
        z[k] = mu / (f[k] - t)
    for c in range(sides):
        if used[c]:
            zs[c] = mu / slacks[c]
    steps = 0
    n = 0
    length = 1.0
    stalled = 0
    while steps < max_steps:
        steps += 1
        nearest = math.inf
        for k in range(ratios):
            j = family[3][k]
            d = 0.0
            for i in range(3):
                d += (family[0][j, i] - p[i]) ** 2
            nearest = min(nearest, d)
        length = math.sqrt(nearest)
        n = chart(field, matrix, turning(family, p, u), u, free, length, jacobian)
        derivatives(family, p, u, z, f, grads, hess, work)
        reduce_hessian(hess, jacobian, n, h)
        for k in range(ratios):
            for m in range(n):
                s = 0.0
                for i in range(6):
                    s += grads[k, i] * jacobian[i, m]
                reduced[k, m] = s
        for c in range(sides):
            if not used[c]:
                continue
            for m in range(n):
                if c < 6:
                    rows[c, m] = jacobian[c, m] if c < 3 else -jacobian[c - 3, m]
                else:
                    s = 0.0
                    for i in range(3):
                        s += 2.0 * (p[i] - keep_points[c - 6, i]) * jacobian[i, m]
                        for j in range(n):
                            h[m, j] += 2.0 * zs[c] * jacobian[i, m] * jacobian[i, j]
                    rows[c, m] = s
        # residual of the barrier problem at this mu decides whether to lower it
        error = 0.0
        for m in range(n):
            s = 0.0
            for k in range(ratios):
                s += z[k] * reduced[k, m]
            for c in range(sides):
                if used[c]:
                    s += zs[c] * rows[c, m]
            error = max(error, abs(s))
        for k in range(ratios):
            error = max(error, abs(z[k] * (f[k] - t) - mu))
        for c in range(sides):
            if used[c]:
                error = max(error, abs(zs[c] * slacks[c] - mu))
        if error <= 10.0 * mu or stalled >= 2:
            if mu <= _MU_END or stalled >= 6:
                break
            mu = max(_MU_END, min(0.1 * mu, mu**1.5))
            t = best_level(f, mu)
        for i in range(n + 1):
            rhs[i] = 0.0
            for j in range(n + 1):
                system[i, j] = -h[i, j] if (i < n and j < n) else 0.0
        rhs[n] = 1.0
        for k in range(ratios):
            gap = f[k] - t
            s = z[k] / gap
            for a in range(n):
                rhs[a] += mu / gap * reduced[k, a]
                for b in range(n):
                    system[a, b] += s * reduced[k, a] * reduced[k, b]
                system[a, n] -= s * reduced[k, a]
                system[n, a] -= s * reduced[k, a]
            system[n, n] += s
            rhs[n] -= mu / gap
        for c in range(sides):
            if used[c]:
                s = zs[c] / slacks[c]
                for a in range(n):
                    rhs[a] += mu / slacks[c] * rows[c, a]
                    for b in range(n):
                        system[a, b] += s * rows[c, a] * rows[c, b]
        shift = 0.0
        while True:
            for i in range(n + 1):
                for j in range(n + 1):
                    factor[i, j] = system[i, j]
                if i < n:  # each variable in its own curvature: across the null it is vast
                    factor[i, i] += shift * (1.0 + abs(h[i, i]))
            if cholesky_factor(factor, n + 1):
                break
            shift = max(1e-4, 8.0 * shift)
            if shift > 1e12:
                return best, steps
        cholesky_solve(factor, n + 1, rhs)
        largest = 0.0
        for m in range(n):
            largest = max(largest, abs(rhs[m]))
        scale = min(1.0, 0.7 / largest) if largest > 0.0 else 1.0
        # stay strictly inside the flat constraints
        for c in range(6):
            if used[c]:
                s = 0.0
                for m in range(n):
                    s += rows[c, m] * rhs[m]
                if s < 0.0:
                    scale = min(scale, -0.995 * slacks[c] / s)
        here = barrier_value(f, t, slacks, used, mu)
        slope = 0.0
        for m in range(n):
            s = 0.0
            for k in range(ratios):
                s += mu / (f[k] - t) * reduced[k, m]
            for c in range(sides):
                if used[c]:
                    s += mu / slacks[c] * rows[c, m]
            slope += s * rhs[m]
        accepted = False
        dual_scale = scale
        for _ in range(30):
            move(field, offset, matrix, p, u, jacobian, n, rhs, scale, new_p, new_u)
            log_ratios(family, new_p, new_u, logs, new_f)
            domain_slacks(new_p, low, high, keep_points, keep_radius, new_slacks)
            new_t = best_level(new_f, mu)
            there = barrier_value(new_f, new_t, new_slacks, used, mu)
            if there >= here + 1e-4 * scale * slope - 1e-15 * (1.0 + abs(here)):
                accepted = True
                break
            scale *= 0.5
        if not accepted:
            stalled += 3
            continue
        stalled = stalled + 1 if scale * largest < 1e-13 else 0
        # dual step, then kept within a wide corridor around mu / slack
        for k in range(ratios):
            gap = f[k] - t
            s = -rhs[n]
            for m in range(n):
                s += reduced[k, m] * rhs[m]
            z[k] += dual_scale * (mu / gap - z[k] - z[k] / gap * s)
        for c in range(sides):
            if used[c]:
                s = 0.0
                for m in range(n):
                    s += rows[c, m] * rhs[m]
                zs[c] += dual_scale * (mu / slacks[c] - zs[c] - zs[c] / slacks[c] * s)
        for i in range(3):
            p[i], u[i] = new_p[i], new_u[i]
        t = new_t
        smallest = math.inf
        for k in range(ratios):
            f[k] = new_f[k]
            smallest = min(smallest, f[k])
            ideal = mu / (f[k] - t)
            z[k] = min(max(z[k], 1e-2 * ideal), 1e2 * ideal)
        for c in range(sides):
            slacks[c] = new_slacks[c]
            if used[c]:
                ideal = mu / slacks[c]
                zs[c] = min(max(zs[c], 1e-2 * ideal), 1e2 * ideal)
        if smallest > best:
            best = smallest
            for i in range(3):
                best_p[i], best_u[i] = p[i], u[i]
    best = land(family, domain, axis_field, p, u, z, zs, used, free, length, best, best_p, best_u)
    for i in range(3):
        p[i], u[i] = best_p[i], best_u[i]
    return best, steps


@kernel
def land(family, domain, axis_field, p, u, z, zs, used, free, length, best, best_p, best_u):
    """Solve the equations of the active set from the interior point's end; keep the result if it is better.

    Unknowns: free search variables, level t, multipliers of the active ratios. Faces with a positive
    multiplier are met exactly. Active keep-out balls are left to the interior-point method.
    """
    low, high, keep_points, keep_radius = domain
    field, offset, matrix = axis_field
    ratios = family[1].shape[0]
    held = free.copy()
    q, v = p.copy(), u.copy()
    for i in range(3):
        if used[i] and zs[i] * length > _ACTIVE:
            held[i], q[i] = False, low[i]
        if used[3 + i] and zs[3 + i] * length > _ACTIVE:
            held[i], q[i] = False, high[i]
    for c in range(keep_points.shape[0]):
        if zs[6 + c] * length * length > _ACTIVE:
            return best
    active = np.empty(ratios, np.int64)
    count = 0
    for k in range(ratios):
        if z[k] > _ACTIVE:
            active[count] = k
            count += 1
    if count == 0 or count > 6:
        return best
    multipliers = np.zeros(ratios)
    total = 0.0
    for a in range(count):
        total += z[active[a]]
    for a in range(count):
        multipliers[active[a]] = z[active[a]] / total
    axis_at(field, offset, matrix, q, v)
    groups = family[5].shape[0]
    f = np.empty(ratios)
    logs = np.empty(groups)
    grads = np.empty((ratios, 6))
    hess = np.empty((6, 6))
    work = np.empty((groups, 50))
    jacobian = np.empty((6, 5))
    h = np.empty((5, 5))
    system = np.empty((12, 12))
    rhs = np.empty(12)
    slacks = np.empty(6 + keep_points.shape[0])
    new_q, new_v = np.empty(3), np.empty(3)
    t = best
    for _ in range(6):
        n = chart(field, matrix, turning(family, q, v), v, held, length, jacobian)
        derivatives(family, q, v, multipliers, f, grads, hess, work)
        reduce_hessian(hess, jacobian, n, h)
        size = n + 1 + count
        system[:size, :size] = 0.0
        for a in range(n):
            for b in range(n):
                system[a, b] = h[a, b]
            rhs[a] = 0.0
        for c in range(count):
            k = active[c]
            for m in range(n):
                s = 0.0
                for i in range(6):
                    s += grads[k, i] * jacobian[i, m]
                system[m, n + 1 + c] = s
                system[n + 1 + c, m] = s
                rhs[m] -= multipliers[k] * s
            system[n, n + 1 + c] = -1.0
            system[n + 1 + c, n] = -1.0
            rhs[n + 1 + c] = t - f[k]
        rhs[n] = 0.0
        if not gauss_solve(system, rhs, size):
            return best
        for m in range(n):
            if abs(rhs[m]) > 0.1:
                return best
        move(field, offset, matrix, q, v, jacobian, n, rhs, 1.0, new_q, new_v)
        for i in range(3):
            q[i], v[i] = new_q[i], new_v[i]
        t += rhs[n]
        for c in range(count):
            multipliers[active[c]] = max(0.0, multipliers[active[c]] + rhs[n + 1 + c])
        smallest = min_log_ratio(family, q, v, logs, f)
        domain_slacks(q, low, high, keep_points, keep_radius, slacks)
        inside = True
        for c in range(slacks.shape[0]):
            inside = inside and slacks[c] >= 0.0
        if inside and smallest > best:
            best = smallest
            for i in range(3):
                best_p[i], best_u[i] = q[i], v[i]
    return best
