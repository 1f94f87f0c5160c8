"""Ratios of a family at a pose, and their derivatives.

With ``r = q - p`` the link form of a point is ``h(p, u) = (|u x r|^2 + l (u.r)^2) / |r|^4``, l being the
antenna's leak: for a unit axis, gain over ``|r|^2`` (design family (F); paper eqs. 1.2 to 1.4). That of a
point with a dipole along v is ``(1 - l) B^2 / |r|^6 + l |u|^2 |v x r|^2 / |r|^4``, ``B = (u x r).(v x r)``.
Of a dipole with a leak f of its own these are the parts f and ``1 - f``. The excess gain of the point's
channel multiplies all of them.
Ratio k is ``N_k / D_g(k)`` with ``N = n0 |u|^2 + w h`` and ``D = d0 |u|^2 + sum_j b_j h_j``; it does not
depend on the length of ``u``, so an axis that is an affine function of the position needs no normalising and
no second derivative of its own.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.channel import excess_at, excess_jet, most_excess, sight_gain
from nullpose.solver.kernels.linear_algebra.symmetric import (
    PLACE,
    add_scaled,
    entry,
    fill_identity,
    smallest_of,
)
from nullpose.solver.kernels.linear_algebra.vectors import along, cross, dot, minus, row, scaled, store

MISSED = -1e4
"""What is added to the logarithm of the least share that is met of a requirement, where one is missed."""


@inner_kernel
def seen_axis(turn, j, u):
    """Return the axis that point j sees."""
    if turn.shape[0] == 0:
        return u[0], u[1], u[2]
    return dot(turn[j, 0], u), dot(turn[j, 1], u), dot(turn[j, 2], u)


@inner_kernel
def isotropic_share(leaks, j):
    """Return the isotropic part of point j: all of it, or the leak through the null of its dipole."""
    return leaks[j] if leaks.shape[0] > 0 else 1.0


@small_kernel
def strongest_point(family, centre):
    """Return the denominators' point that is received most strongly at the centre, or -1."""
    strongest = 0.0
    anchor = -1
    for e in range(family.denominator_weight.shape[0]):
        j, weight = family.denominator_point[e], family.denominator_weight[e]
        r = minus(row(family.points_m, j), centre)
        received, square = weight * excess_at(family, j, centre), dot(r, r)
        if received > strongest * square:
            strongest, anchor = received / square, j
    return anchor


@rare_kernel
def dipole_link(leak, axes, j, r, u):
    """Return the link of point j, which has a dipole, seen along r."""
    other, square = cross(axes[j], r), dot(r, r)
    both, leaking = dot(cross(u, r), other), leak * dot(u, u) * dot(other, other)
    return ((1.0 - leak) * both * both / square + leaking) / (square * square)


@kernel
def link_form(family, j, p, u):
    """Return the link of point j, without cancellation beside the null."""
    r, seen = minus(row(family.points_m, j), p), seen_axis(family.turn, j, u)
    ahead, side, square = dot(seen, r), cross(seen, r), dot(r, r)
    excess = excess_at(family, j, p)
    link = excess / (square * square)
    link *= dot(side, side) + family.leak * ahead * ahead
    share = isotropic_share(family.ground_leaks, j)
    if share < 1.0:
        of_dipole = dipole_link(family.leak, family.ground_axes, j, r, seen)
        of_dipole *= excess
        return share * link + (1.0 - share) * of_dipole
    return link


@small_kernel
def numerator_at(family, k, p, u):
    """Return ``u^T N_k u`` at position p."""
    uu = dot(u, u)
    link = link_form(family, family.numerator_point[k], p, u)
    return family.numerator_isotropic[k] * uu + family.numerator_weight[k] * link


@small_kernel
def denominator_at(family, g, p, u):
    """Return ``u^T D_g u`` at position p."""
    total = family.denominator_isotropic[g] * dot(u, u)
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        link = link_form(family, family.denominator_point[e], p, u)
        total += family.denominator_weight[e] * link
    return total


@kernel
def log_ratios(family, p, u, log_denominators, out):
    """Fill the logarithm of every ratio at position p and axis u, and those of the denominators."""
    for g in range(log_denominators.shape[0]):
        total = denominator_at(family, g, p, u)
        log_denominators[g] = math.log(total) if total > 0.0 else -math.inf
    for k in range(out.shape[0]):
        value = numerator_at(family, k, p, u)
        log_denominator = log_denominators[family.denominator_of[k]]
        out[k] = (math.log(value) if value > 0.0 else -math.inf) - log_denominator


@inner_kernel
def shifted_log(offset, log):
    """Return ``log(a + x)`` from the logarithm of x, a being 0 or 1."""
    return log if offset == 0.0 else max(0.0, log) + math.log1p(math.exp(-abs(log)))


@small_kernel
def most_heard(family, k, square):
    """Bound numerator k over ``|u|^2`` beyond a distance whose square is given."""
    j = family.numerator_point[k]
    most = family.numerator_weight[k] * most_excess(family.channels, j, square) / square
    return family.numerator_isotropic[k] + most


@inner_kernel
def log_most_share(family, k, square):
    """Bound what ratio k adds to a mean's logarithm beyond a distance whose square is given."""
    log = math.log(most_heard(family, k, square) / family.denominator_isotropic[0])
    return family.shares[k] * shifted_log(family.offset, log)


@inner_kernel
def row_count(family):
    """Count the numbers of which the smallest is taken, or that have multipliers: pairs, or ratios."""
    pairs = family.pairs.shape[0]
    return pairs if pairs > 0 else family.numerator_point.shape[0]


@inner_kernel
def pair_log(family, q, logs):
    """Return the logarithm of a pair's quotient from those of the ratios."""
    return logs[family.pairs[q, 0]] - logs[family.pairs[q, 1]]


@inner_kernel
def pair_signal(family, q, which):
    """Evaluate the signal of a pair's node (0) or eavesdropper (1): its numerator less its denominator."""
    k = family.pairs[q, which]
    return family.numerator_isotropic[k] - family.denominator_isotropic[family.denominator_of[k]]


@inner_kernel
def pair_tangent(family, q, level, e):
    """Return constant and slope of the tangent at e that bounds a pair's node.

    With ``b`` and ``e`` the denominators of node and eavesdropper and ``S_B``, ``S_E`` what their numerators
    have beyond them, the quotient ``(1 + S_B / b) / (1 + S_E / e)`` is t or more exactly where
    ``b <= phi(e) = S_B e / ((t - 1) e + t S_E)``, which is concave for t of 1 or more.
    """
    wanted, overheard = pair_signal(family, q, 0), pair_signal(family, q, 1)
    below = (level - 1.0) * e + level * overheard
    return wanted * (level - 1.0) * (e / below) ** 2, wanted * level * overheard / (below * below)


@inner_kernel
def log_quotient(family, q, b, e):
    """Return the logarithm of a pair's quotient from the denominators of node and eavesdropper."""
    wanted, overheard = pair_signal(family, q, 0), pair_signal(family, q, 1)
    return math.log1p(wanted / b) - math.log1p(overheard / e)


@inner_kernel
def log_most_pair(family, q, square):
    """Bound the logarithm of a pair's quotient where the eavesdropper is beyond a distance, squared.

    No drone jams the node then, and one jams the eavesdropper as much as it can from there.
    """
    overheard, g = pair_signal(family, q, 1), family.denominator_of[family.pairs[q, 0]]
    most = most_heard(family, family.pairs[q, 1], square) - overheard
    return log_quotient(family, q, family.denominator_isotropic[g], most)


@small_kernel
def objective_of(family, logs):
    """Return the logarithm of what is maximised from those of the ratios.

    The smallest, the smallest of pairs, or the mean's; where a requirement is missed, it is below any mean's.
    """
    if family.pairs.shape[0] > 0:
        least = math.inf
        for q in range(family.pairs.shape[0]):
            least = min(least, pair_log(family, q, logs))
        return least
    if family.shares.shape[0] == 0:
        return smallest_of(logs)
    total = missing = 0.0
    for k in range(family.shares.shape[0]):
        total += family.shares[k] * shifted_log(family.offset, logs[k])
    for k in range(family.requirements.shape[0]):
        if family.requirements[k] > 0.0:
            missing = min(missing, logs[k] - math.log(family.requirements[k]))
    return total if missing == 0.0 else MISSED + missing


@kernel
def log_objective(family, p, u, log_denominators, out):
    """Return the logarithm of what every solver here maximises at a pose; fill the ratios'."""
    log_ratios(family, p, u, log_denominators, out)
    return objective_of(family, out)


@small_kernel
def add_form(family, j, weight, p, u, grad, hess, second):
    """Return ``weight * h_j``; add its derivatives in (p, u), by the product rule for the excess gain."""
    g, h, slopes, bends = grad, hess, scratch(6), scratch(3, 3)
    if family.channels.shape[0] > 0:
        g, h = zeroed(6), zeroed(6, 6)
        excess = excess_jet(family.channels[j], minus(row(family.points_m, j), p), slopes, bends)
        weight *= sight_gain(family, j, p) * excess
    value = add_turned_form(family, j, weight, p, u, g, h, second)
    if family.channels.shape[0] > 0:
        add_product(value, slopes, bends, g, h, grad, hess, second)
    return value


@rare_kernel
def add_product(value, slopes, bends, g, h, grad, hess, second):
    """Add the derivatives of an excess gain, relative, times those of a form."""
    for i in range(6):
        grad[i] += g[i] + value * slopes[i]
    if second:
        for i in range(6):
            for k in range(6):
                hess[i, k] += h[i, k] + slopes[i] * g[k] + g[i] * slopes[k]
        for i in range(3):
            add_scaled(value, bends[i], hess[i, :3])


@small_kernel
def add_turned_form(family, j, weight, p, u, grad, hess, second):
    """Do what ``add_form`` does without the excess gain, as ``add_parts`` does for the axis seen."""
    turn = family.turn
    if turn.shape[0] == 0:
        return add_parts(family, j, weight, p, u, grad, hess, second)
    q = turn[j]
    v, g, h = scratch(3), zeroed(6), zeroed(6, 6)
    store(seen_axis(turn, j, u), v)
    value = add_parts(family, j, weight, p, v, g, h, second)
    for i in range(3):
        grad[i] += g[i]
        for a in range(3):
            grad[3 + i] += q[a, i] * g[3 + a]
    if second:
        for i in range(3):
            for k in range(3):
                hess[i, k] += h[i, k]
                for a in range(3):
                    hess[3 + i, k] += q[a, i] * h[3 + a, k]
                    hess[i, 3 + k] += h[i, 3 + a] * q[a, k]
                    for b in range(3):
                        hess[3 + i, 3 + k] += q[a, i] * h[3 + a, 3 + b] * q[b, k]
    return value


@small_kernel
def add_parts(family, j, weight, p, u, grad, hess, second):
    """Do what ``add_seen_form`` does, for an isotropic point, one with a dipole, or a dipole that leaks."""
    value, share = 0.0, isotropic_share(family.ground_leaks, j)
    if share < 1.0:
        of_dipole = (1.0 - share) * weight
        value += add_dipole_form(family, family.ground_axes, j, of_dipole, p, u, grad, hess, second)
    if share > 0.0:
        value += add_seen_form(family, j, share * weight, p, u, grad, hess, second)
    return value


@inner_kernel
def add_seen_form(family, j, weight, p, u, grad, hess, second):
    """Return ``weight * h_j``; add its derivatives in (p, u) to ``grad`` and, if asked for, ``hess``.

    The six variables are p then u. Written with ``A = |u|^2 |r|^2 - (1 - l) (u.r)^2 = |u x r|^2 + l
    (u.r)^2`` and ``h = A |r|^-4``.
    """
    leak = family.leak
    bent = 1.0 - leak
    r, ar, au = scratch(3), scratch(3), scratch(3)
    store(minus(row(family.points_m, j), p), r)
    rho2, c, uu, side = dot(r, r), dot(u, r), dot(u, u), cross(u, r)
    area = dot(side, side) + leak * c * c
    i2 = 1.0 / rho2
    i4 = weight * i2 * i2
    i6 = i4 * i2
    i8 = i6 * i2
    # (u.u) r - c u and (r.r) u - c r are double cross products: no cancellation beside the null
    store(scaled(2.0, along(cross(side, u), leak * c, u)), ar)
    store(scaled(2.0, along(cross(r, side), leak * c, r)), au)
    for i in range(3):
        grad[i] -= ar[i] * i4 - 4.0 * area * i6 * r[i]
        grad[3 + i] += au[i] * i4
    if second:
        for i in range(3):
            for k in range(3):
                same = 1.0 if i == k else 0.0
                hess[i, k] += (
                    2.0 * (uu * same - bent * u[i] * u[k]) * i4
                    - 4.0 * i6 * (ar[i] * r[k] + r[i] * ar[k])
                    + area * (24.0 * i8 * r[i] * r[k] - 4.0 * i6 * same)
                )
                hess[3 + i, 3 + k] += 2.0 * (rho2 * same - bent * r[i] * r[k]) * i4
                mixed = 2.0 * (2.0 * u[i] * r[k] - bent * (r[i] * u[k] + c * same)) * i4
                mixed -= 4.0 * i6 * au[i] * r[k]
                hess[3 + i, k] -= mixed
                hess[k, 3 + i] -= mixed
    return weight * area * i2 * i2


@inner_kernel
def vector_jet(r, v, basis, value, first, second):
    """Fill a link vector and its derivatives by the position, all in the frame's coordinates.

    Args:
        r: to the point, in the frame.
        v: the dipole's axis, in the frame.
        basis: the frame's axes in columns; its rows are the world's axes in the frame.
        value: output, (3,).
        first: output, (3, 3), the derivative along each of the world's axes.
        second: output, (6, 3).
    """
    i2 = 1.0 / dot(r, r)
    i3 = i2 * math.sqrt(i2)
    vr = dot(v, r)
    across, lengthways = scratch(3), scratch(3)
    for m in range(3):
        value[m] = (v[m] - vr * i2 * r[m]) * i3 / i2
    for i in range(3):
        e = row(basis, i)
        lengthways[i], across[i] = dot(r, e), dot(v, e)
        for m in range(3):
            first[i, m] = i3 * (
                v[m] * lengthways[i] + e[m] * vr + r[m] * across[i] - 3.0 * i2 * vr * lengthways[i] * r[m]
            )
    for s in range(6):
        i, j = entry(s)
        e, f = row(basis, i), row(basis, j)
        same = 1.0 if i == j else 0.0
        ri, rj, vi, vj = lengthways[i], lengthways[j], across[i], across[j]
        along_v = 3.0 * i2 * ri * rj - same
        along_e, along_f = 3.0 * i2 * vr * rj - vj, 3.0 * i2 * vr * ri - vi
        along_r = 3.0 * i2 * (vi * rj + vj * ri + vr * same) - 15.0 * i2 * i2 * vr * ri * rj
        for m in range(3):
            second[s, m] = i3 * (along_v * v[m] + along_e * e[m] + along_f * f[m] + along_r * r[m])


@rare_kernel
def add_dipole_form(family, axes, j, weight, p, u, grad, hess, second):
    """Do what ``add_seen_form`` does, for a point with a dipole.

    The form is ``(1 - l) (u.a)^2 + l |u|^2 |a|^2`` with the point's link vector a.
    """
    r, a, slopes, bends = scratch(3), scratch(3), scratch(3, 3), scratch(6, 3)
    world, by = scratch(3, 3), scratch(3)
    fill_identity(world)
    store(minus(row(family.points_m, j), p), r)
    vector_jet(r, axes[j], world, a, slopes, bends)
    # u.a as a product of two cross products: no cancellation beside the null
    b, uu, aa = dot(cross(u, r), cross(axes[j], r)) / dot(r, r) ** 1.5, dot(u, u), dot(a, a)
    kept, leaking = 2.0 * (1.0 - family.leak) * weight, 2.0 * family.leak * weight
    for i in range(3):
        by[i] = dot(u, slopes[i])
        grad[i] += kept * b * by[i] + leaking * uu * dot(a, slopes[i])
        grad[3 + i] += kept * b * a[i] + leaking * aa * u[i]
    if second:
        for i in range(3):
            for k in range(3):
                bend = bends[PLACE[i, k]]
                hess[i, k] += kept * (by[i] * by[k] + b * dot(u, bend))
                hess[i, k] += leaking * uu * (dot(slopes[i], slopes[k]) + dot(a, bend))
                hess[3 + i, 3 + k] += kept * a[i] * a[k] + (leaking * aa if i == k else 0.0)
                mixed = kept * (a[i] * by[k] + b * slopes[k, i])
                mixed += 2.0 * leaking * u[i] * dot(a, slopes[k])
                hess[3 + i, k] += mixed
                hess[k, 3 + i] += mixed
    return 0.5 * (kept * b * b + leaking * uu * aa)


@inner_kernel
def fill_isotropic(isotropic, u, gradient, form):
    """Fill the derivatives of ``isotropic |u|^2`` in (p, u); return it."""
    gradient[:] = 0.0
    form[:, :] = 0.0
    for i in range(3):
        gradient[3 + i] = 2.0 * isotropic * u[i]
        form[3 + i, 3 + i] = 2.0 * isotropic
    return isotropic * dot(u, u)


@inner_kernel
def add_log_bend(factor, value, gradient, form, hess):
    """Add a multiple of the second derivatives of a logarithm, from those of the number."""
    for i in range(6):
        for m in range(6):
            hess[i, m] += factor * (form[i, m] / value - gradient[i] * gradient[m] / (value * value))


@kernel
def derivatives(family, p, u, multipliers, f, grads, hess, work):
    """Fill log ratios ``f``, their gradients (R, 6), and the multiplier-weighted Hessian (6, 6).

    ``work`` is scratch of shape (G, 7) or more: per denominator its value, and the gradient of its logarithm.
    """
    den, dstart = family.denominator_of, family.denominator_start
    gradient, form = scratch(6), scratch(6, 6)
    hess[:, :] = 0.0
    for g in range(family.denominator_isotropic.shape[0]):
        value, multiplier = fill_isotropic(family.denominator_isotropic[g], u, gradient, form), 0.0
        for k in range(f.shape[0]):
            multiplier += multipliers[k] if den[k] == g else 0.0
        for e in range(dstart[g], dstart[g + 1]):
            j, weight = family.denominator_point[e], family.denominator_weight[e]
            value += add_form(family, j, weight, p, u, gradient, form, multiplier != 0.0)
        work[g, 0] = value
        for i in range(6):
            work[g, 1 + i] = gradient[i] / value
        if multiplier != 0.0:
            add_log_bend(-multiplier, value, gradient, form, hess)
    for k in range(f.shape[0]):
        value, below = fill_isotropic(family.numerator_isotropic[k], u, gradient, form), work[den[k]]
        j, weight, second = family.numerator_point[k], family.numerator_weight[k], multipliers[k] != 0.0
        value += add_form(family, j, weight, p, u, gradient, form, second)
        f[k] = math.log(value) - math.log(below[0])
        for i in range(6):
            grads[k, i] = gradient[i] / value - below[1 + i]
        if second:
            add_log_bend(multipliers[k], value, gradient, form, hess)
