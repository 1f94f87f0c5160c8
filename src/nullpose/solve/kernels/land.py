"""The last digits: Newton's method on the equations of the active set."""

from __future__ import annotations

import numpy as np

from nullpose.family.records import Axes
from nullpose.solve.kernels.chart import (
    axis_at,
    chart,
    clamp_axis,
    domain_slacks,
    move,
    reduce_hessian,
    turning,
)
from nullpose.solve.kernels.jit import inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.links import derivatives, min_log_ratio
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import copy_into, gauss_solve

__all__ = ["land"]

_ACTIVE = 1e-5
_MOST_ACTIVE = 6
_STEPS = 6


@inner_kernel
def active_set(domain, z, zs, used, free, length, q, held, active):
    """Put the position on the faces that hold it; fill the free coordinates and active ratios.

    Returns how many are, or 0 if the point is not of a kind to land on: an active keep-out ball or forbidden
    piece, or too many ratios.
    """
    low, high = domain.low_m, domain.high_m
    for i in range(3):
        held[i] = free[i]
        if used[i] and zs[i] * length > _ACTIVE:
            held[i], q[i] = False, low[i]
        if used[3 + i] and zs[3 + i] * length > _ACTIVE:
            held[i], q[i] = False, high[i]
    after = 6 + domain.keep_out_points_m.shape[0]
    for c in range(6, zs.shape[0] - 2):
        if zs[c] * length * (length if c < after else 1.0) > _ACTIVE:
            return 0
    count = 0
    for k in range(z.shape[0]):
        if z[k] > _ACTIVE:
            if count == _MOST_ACTIVE:
                return 0
            active[count] = k
            count += 1
    return count


@inner_heap_kernel
def held_axis(axis_field, zs):
    """Return the axis field, or the cone at the end of a band that holds the axis."""
    ends = axis_field.offset.copy()
    kind = axis_field.kind
    if kind == 2:
        for end in range(2):
            if zs[zs.shape[0] - 2 + end] > _ACTIVE:
                kind, ends[0] = np.int64(3), axis_field.offset[end]
                ends[1] = ends[0]
    return Axes(kind, ends, axis_field.matrix)


@inner_kernel
def fill_equations(f, grads, h, jacobian, active, count, multipliers, t, n, system, rhs):
    """Fill Newton's system: no slope in free variables, multipliers summing to one, ratios at t."""
    size = n + 1 + count
    for a in range(size):
        for b in range(size):
            system[a, b] = 0.0
    for a in range(n):
        for b in range(n):
            system[a, b] = h[a, b]
        rhs[a] = 0.0
    rhs[n] = 0.0
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
    return size


@inner_heap_kernel
def land(family, domain, axis_field, place, limits, best, best_pose, multipliers):
    """Return the best smallest log ratio after solving the equations of the active set.

    Unknowns: free search variables, level t, multipliers of the active ratios. Faces with a positive
    multiplier are met exactly. The multipliers, which sum to one, are filled in either case.
    """
    p, u, z, zs, length = place
    chosen, used, free = limits
    best_p, best_u = best_pose
    ratios = family.numerator_isotropic.shape[0]
    total = 0.0
    for k in range(ratios):
        total += z[k]
    for k in range(ratios):
        multipliers[k] = z[k] / total
    q, v = p.copy(), u.copy()
    held = free.copy()
    active = np.empty(_MOST_ACTIVE, np.int64)
    count = active_set(domain, z, zs, used, free, length, q, held, active)
    if count == 0:
        return best
    weights = np.zeros(ratios)
    for a in range(count):
        weights[active[a]] = multipliers[active[a]]
    axis_field = held_axis(axis_field, zs)
    axis_at(axis_field.kind, axis_field.offset, axis_field.matrix, q, v)
    if axis_field.kind == 3:
        clamp_axis(axis_field, v)
    f, logs = np.empty(ratios), np.empty(family.denominator_isotropic.shape[0])
    grads, hess, h = np.empty((ratios, 6)), scratch(6, 6), scratch(5, 5)
    work = np.empty((family.denominator_isotropic.shape[0], 50))
    jacobian = scratch(6, 5)
    system, rhs = scratch(12, 12), scratch(12)
    slacks = np.empty(zs.shape[0])
    new_q, new_v = scratch(3), scratch(3)
    t = best
    for _ in range(_STEPS):
        n = chart(axis_field.kind, axis_field.matrix, turning(family, q, v), v, held, length, jacobian)
        derivatives(family, q, v, weights, f, grads, hess, work)
        reduce_hessian(hess, jacobian, n, h)
        if axis_field.kind == 3:
            for c in range(count):
                h[n - 1, n - 1] += weights[active[c]] * grads[active[c], 5] * v[2]
        size = fill_equations(f, grads, h, jacobian, active, count, weights, t, n, system, rhs)
        if not gauss_solve(system, rhs, size):
            return best
        for m in range(n):
            if abs(rhs[m]) > 0.1:
                return best
        move(axis_field, q, v, jacobian, n, rhs, 1.0, new_q, new_v)
        copy_into(new_q, q)
        copy_into(new_v, v)
        t += rhs[n]
        for c in range(count):
            weights[active[c]] = max(0.0, weights[active[c]] + rhs[n + 1 + c])
        smallest = min_log_ratio(family, q, v, logs, f)
        domain_slacks(q, v, domain, axis_field, chosen, slacks)
        inside = True
        for c in range(slacks.shape[0]):
            inside = inside and slacks[c] >= 0.0
        if inside and smallest > best:
            best = smallest
            copy_into(q, best_p)
            copy_into(v, best_u)
            copy_into(weights, multipliers)
    return best
