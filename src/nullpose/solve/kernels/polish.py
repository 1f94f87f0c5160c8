"""Local maximum of the smallest ratio, by the epigraph form ``maximise t: f_k(p, u) >= t, p in P``.

A primal-dual interior-point method with exact second derivatives walks to the neighbourhood of a
Karush-Kuhn-Tucker
point; Newton's method on the equations of its active set then lands on it to the last digits. ``f_k`` is the
logarithm of ratio k. Nothing is smoothed: at the end the active ratios are equal, each with its multiplier.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.family.records import Axes
from nullpose.solve.kernels.barrier import (
    barrier_value,
    bent_step,
    best_level,
    newton_step,
    residual,
    update_duals,
)
from nullpose.solve.kernels.chart import (
    axis_at,
    chart,
    choose_sides,
    clamp_axis,
    domain_slacks,
    move,
    nearest_node,
    reduce_hessian,
    slack_count,
    turning,
)
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel, kernel
from nullpose.solve.kernels.land import land
from nullpose.solve.kernels.links import derivatives, log_ratios, min_log_ratio
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import copy_into

__all__ = ["polish"]

_MU_END = 1e-12
_LONGEST = 0.7
_INSIDE = 0.995
_ATTEMPTS = 31
_BAND_EDGE = 1e-12  # an axis put on the end of a band is off it by rounding


@inner_heap_kernel
def enter(domain, axis_field, p, u, free, used):
    """Move a pose strictly inside its faces and its band; fill which coordinates and slacks are in play."""
    low, high = domain.low_m, domain.high_m
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
    band = used.shape[0] - 2
    for c in range(6, band):
        used[c] = True
    least, greatest = axis_field.offset[0], axis_field.offset[1]
    is_band = axis_field.kind == 2
    used[band] = is_band and least > 0.0
    used[band + 1] = is_band and greatest < 1.0
    if is_band:
        margin = min(1e-3, 1e-2 * (greatest - least))
        inside = Axes(axis_field.kind, axis_field.offset.copy(), axis_field.matrix)
        inside.offset[0] += margin if used[band] else 0.0
        inside.offset[1] -= margin if used[band + 1] else 0.0
        clamp_axis(inside, u)


@inner_kernel
def value_in_domain(family, domain, axis_field, chosen, p, u, slacks, logs, f):
    """Return the smallest log ratio, minus infinity outside the domain; fill the slacks."""
    domain_slacks(p, u, domain, axis_field, chosen, slacks)
    band = slacks.shape[0] - 2
    for c in range(band):
        if slacks[c] < 0.0 or (c >= 6 and slacks[c] == 0.0):
            return -math.inf
    if not min(slacks[band], slacks[band + 1]) >= -_BAND_EDGE:
        return -math.inf
    return min_log_ratio(family, p, u, logs, f)


@kernel
def begin(family, domain, axis_field, p, u, work, best_p, best_u):
    """Move a pose strictly inside; fill the better of it and the start, return both values."""
    free, used, chosen, slacks, logs, f = work
    best = value = -math.inf
    clamp_axis(axis_field, u)
    choose_sides(domain, p, chosen)
    for turn in range(2):  # the start itself is the first incumbent
        if turn == 1:
            enter(domain, axis_field, p, u, free, used)
            choose_sides(domain, p, chosen)
        axis_at(axis_field.kind, axis_field.offset, axis_field.matrix, p, u)
        value = value_in_domain(family, domain, axis_field, chosen, p, u, slacks, logs, f)
        if turn == 0 or value > best:
            best = value
            copy_into(p, best_p)
            copy_into(u, best_u)
    return best, value


@inner_kernel
def linearise(domain, axis_field, chosen, p, u, grads, jacobian, n, z, zs, slopes, rows, h):
    """Fill the slopes of ratios and constraints in the search variables; add the constraints' curvature."""
    keep_points = domain.keep_out_points_m
    after = 6 + keep_points.shape[0]
    for k in range(grads.shape[0]):
        for m in range(n):
            s = 0.0
            for i in range(6):
                s += grads[k, i] * jacobian[i, m]
            slopes[k, m] = s
    for m in range(n):
        for i in range(3):
            rows[i, m], rows[3 + i, m] = jacobian[i, m], -jacobian[i, m]
        for q in range(keep_points.shape[0]):
            s = 0.0
            for i in range(3):
                s += 2.0 * (p[i] - keep_points[q, i]) * jacobian[i, m]
                for j in range(n):
                    h[m, j] += 2.0 * zs[6 + q] * jacobian[i, m] * jacobian[i, j]
            rows[6 + q, m] = s
        for c in range(chosen.shape[0]):
            side = domain.piece_sides[chosen[c]]
            s = 0.0
            for i in range(3 if side[0] == 0.0 else 2):
                s += (side[1 + i] if side[0] == 0.0 else 2.0 * (p[i] - side[1 + i])) * jacobian[i, m]
                if side[0] == 1.0:
                    for j in range(n):
                        h[m, j] += 2.0 * zs[after + c] * jacobian[i, m] * jacobian[i, j]
            rows[after + c, m] = s
    if axis_field.kind == 2:
        bend_band(axis_field.offset, u, jacobian, n, zs, rows, h)
    elif axis_field.kind == 3:  # the cone bends away from the step by u_z e3, in units of the axis's variable
        for k in range(grads.shape[0]):
            h[n - 1, n - 1] += z[k] * grads[k, 5] * u[2]


@inner_kernel
def bend_band(ends, u, jacobian, n, zs, rows, h):
    """Fill the slopes of a band's ends, ``u_z^2 - c |u|^2`` and its like, and add their curvature."""
    for end in range(2):
        c = rows.shape[0] - 2 + end
        sign = 1.0 if end == 0 else -1.0
        for m in range(n):
            s = u[2] * jacobian[5, m]
            for i in range(3):
                s -= ends[end] * u[i] * jacobian[3 + i, m]
            rows[c, m] = 2.0 * sign * s
            for j in range(n):
                s = jacobian[5, m] * jacobian[5, j]
                for i in range(3):
                    s -= ends[end] * jacobian[3 + i, m] * jacobian[3 + i, j]
                h[m, j] += 2.0 * sign * zs[c] * s


@inner_kernel
def longest_scale(rows, slacks, used, step, n, balls):
    """Return the largest share of a step that stays inside the faces, and the step's size."""
    largest = 0.0
    for m in range(n):
        largest = max(largest, abs(step[m]))
    scale = min(1.0, _LONGEST / largest) if largest > 0.0 else 1.0
    for c in range(used.shape[0]):  # not the balls and cylinders, whose slack is not linear
        if used[c] and (c < 6 or c >= balls):
            s = 0.0
            for m in range(n):
                s += rows[c, m] * step[m]
            if s < 0.0:
                scale = min(scale, -_INSIDE * slacks[c] / s)
    return scale, largest


@inner_kernel
def line_search(family, domain, axis_field, here, there, model, way):
    """Return the share of a step that climbs the barrier enough, and the level there; fill the pose reached.

    Before the step is shortened it is bent once, to follow a curved ridge. A share of zero: none climbs.
    """
    p, u, f, t, slacks = here
    new_p, new_u, new_f, new_slacks, logs = there
    jacobian, slopes, rows, used, chosen, z, factor, n, mu = model
    balls = 6 + domain.keep_out_points_m.shape[0]
    step, slope, scale = way
    floor = barrier_value(f, t, slacks, used, mu)
    bent = scratch(6)
    for attempt in range(_ATTEMPTS):
        if attempt == 1:
            bent_step(f, t, new_f, slopes, z, factor, n, scale, step, bent)
            share = longest_scale(rows, slacks, used, bent, n, balls)[0]
            move(axis_field, p, u, jacobian, n, bent, share, new_p, new_u)
        else:
            scale *= 0.5 if attempt > 1 else 1.0
            move(axis_field, p, u, jacobian, n, step, scale, new_p, new_u)
        log_ratios(family, new_p, new_u, logs, new_f)
        domain_slacks(new_p, new_u, domain, axis_field, chosen, new_slacks)
        new_t = best_level(new_f, mu)
        value = barrier_value(new_f, new_t, new_slacks, used, mu)
        if value >= floor + 1e-4 * scale * slope - 1e-15 * (1.0 + abs(floor)):
            return scale, new_t
    return 0.0, t


@heap_kernel
def polish(family, domain, axis_field, p, u, mu_start, max_steps, multipliers):
    """Improve a pose in place to a local maximum; return its smallest log ratio and the steps taken.

    Args:
        family: arrays of the family.
        domain: box, keep-out balls and forbidden pieces, as ``Family.domain`` has them.
        axis_field: kind, offset (3,) and matrix (3, 3), as ``AxisField.arrays`` has them.
        p: position, (3,), updated; must lie in the domain.
        u: unit axis, (3,), updated; ignored on entry when the field is affine.
        mu_start: first barrier weight, in units of the log ratio.
        max_steps: limit on interior-point steps.
        multipliers: output, (ratios,): the ratios' multipliers at the end, which sum to one.
    """
    ratios, groups, sides = (
        family.numerator_isotropic.shape[0],
        family.denominator_isotropic.shape[0],
        slack_count(domain),
    )
    chosen = np.empty(domain.piece_start.shape[0] - 1, np.int64)
    free, used = np.empty(3, np.bool_), np.empty(sides, np.bool_)
    f, logs, slacks = np.empty(ratios), np.empty(groups), np.empty(sides)
    best_p, best_u = scratch(3), scratch(3)
    work = (free, used, chosen, slacks, logs, f)
    best, value = begin(family, domain, axis_field, p, u, work, best_p, best_u)
    for k in range(ratios):
        multipliers[k] = 1.0 / ratios
    if not value > -math.inf:
        copy_into(best_p, p)
        return best, 0
    grads, hess, parts = np.empty((ratios, 6)), scratch(6, 6), np.empty((groups, 50))
    jacobian, h = scratch(6, 5), scratch(5, 5)
    slopes, rows = np.empty((ratios, 6)), np.zeros((sides, 6))
    system, factor, step = scratch(6, 6), scratch(6, 6), scratch(6)
    gaps, new_gaps, every = np.empty(ratios), np.empty(ratios), np.empty(ratios, np.bool_)
    new_p, new_u, new_f, new_slacks = scratch(3), scratch(3), np.empty(ratios), np.empty(sides)
    there = (new_p, new_u, new_f, new_slacks, logs)
    mu = mu_start
    t = best_level(f, mu)
    z, zs = np.empty(ratios), np.zeros(sides)
    for k in range(ratios):
        every[k], z[k] = True, mu / (f[k] - t)
    for c in range(sides):
        if used[c]:
            zs[c] = mu / slacks[c]
    steps = stalled = 0
    length = 1.0
    while steps < max_steps:
        steps += 1
        length = nearest_node(family, p)
        n = chart(axis_field.kind, axis_field.matrix, turning(family, p, u), u, free, length, jacobian)
        derivatives(family, p, u, z, f, grads, hess, parts)
        reduce_hessian(hess, jacobian, n, h)
        linearise(domain, axis_field, chosen, p, u, grads, jacobian, n, z, zs, slopes, rows, h)
        if stalled >= 2 or residual(f, t, slacks, used, z, zs, slopes, rows, n, mu) <= 10.0 * mu:
            if mu <= _MU_END or stalled >= 6:
                break
            mu = max(_MU_END, min(0.1 * mu, mu**1.5))
            t = best_level(f, mu)
        slope = newton_step(f, t, slacks, used, z, zs, slopes, rows, h, n, mu, system, factor, step)
        dual_scale, largest = longest_scale(
            rows, slacks, used, step, n, 6 + domain.keep_out_points_m.shape[0]
        )
        if math.isnan(slope):
            break
        here, way = (p, u, f, t, slacks), (step, slope, dual_scale)
        model = (jacobian, slopes, rows, used, chosen, z, factor, n, mu)
        scale, new_t = line_search(family, domain, axis_field, here, there, model, way)
        if not scale > 0.0:
            stalled += 3
            continue
        stalled = stalled + 1 if scale * largest < 1e-13 else 0
        smallest = new_f[0]
        for k in range(ratios):
            slopes[k, n] = -1.0  # the level is the last variable
            gaps[k], new_gaps[k] = f[k] - t, new_f[k] - new_t
            smallest = min(smallest, new_f[k])
        update_duals(gaps, new_gaps, slopes, every, step, n + 1, dual_scale, mu, z)
        update_duals(slacks, new_slacks, rows, used, step, n, dual_scale, mu, zs)
        t = new_t
        for source, target in ((new_f, f), (new_slacks, slacks), (new_p, p), (new_u, u)):
            copy_into(source, target)
        if smallest > best:
            best = smallest
            copy_into(p, best_p)
            copy_into(u, best_u)
    place, limits = (p, u, z, zs, length), (chosen, used, free)
    best = land(family, domain, axis_field, place, limits, best, (best_p, best_u), multipliers)
    copy_into(best_p, p)
    copy_into(best_u, u)
    return best, steps
