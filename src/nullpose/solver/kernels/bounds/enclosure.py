"""A link under an affine axis field over a box of positions: value, gradient, and bounds on the Hessian.

With ``u = o + M p`` and ``r = q - p`` the link is ``f = n / (|u|^2 |r|^4)``, ``n = |u x r|^2 + l (u.r)^2``
with the antenna's leak l being the sum of the squares of the entries of ``u x r`` and of ``sqrt(l) u.r``: a
quotient of polynomials, whose second derivatives are bounded by interval arithmetic. That with a dipole along
v is ``B^2 / (|u|^2 |r|^6)``, ``B = (u x r).(v x r)``, and what leaks. Hessians are kept as
(xx, yy, zz, xy, xz, yz).
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.channel.model import EXPONENT, REFERENCE_M
from nullpose.solver.kernels.bounds.excess import EXCESS, fill_excess, quotient
from nullpose.solver.kernels.bounds.link_field import product, square, total
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.links import isotropic_share
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into, copy_table, entry
from nullpose.solver.kernels.linear_algebra.vectors import cross, dot, fill_affine, minus, norm, row, store

JET = 18  # columns of a jet: the value, and from so many on
SLOPE, BEND, RADIUS, LEAST, MOST = 1, 4, 10, 16, 17  # gradient, Hessian's middle and radius, and bounds


@inner_kernel
def bounds(table, i):
    """Return the bounds in row i of a table."""
    return table[i, 0], table[i, 1]


@inner_kernel
def fill_swing(matrix, half, swing):
    """Fill how far each entry of ``M p`` can be from that at the centre of a box."""
    for m in range(3):
        swing[m] = 0.0
        for i in range(3):
            swing[m] += abs(matrix[m, i]) * half[i]


@kernel
def axis_clearance(axis_field, centre, half):
    """Return the axis field's length at the centre, and by how much it can change in the box."""
    u, swing = scratch(3), scratch(3)
    fill_affine(axis_field.offset, axis_field.matrix, centre, u)
    fill_swing(axis_field.matrix, half, swing)
    return norm(u), norm(swing)


@inner_kernel
def entries(leak, matrix, r, u, c, dc, hc):
    """Fill the entries whose squares make n, their gradients and constant Hessians.

    Returns how many entries there are: the fourth is ``sqrt(leak) u.r``.
    """
    hc[:, :, :] = 0.0
    for m in range(3):
        a, b = (m + 1) % 3, (m + 2) % 3
        c[m] = u[a] * r[b] - u[b] * r[a]
        for i in range(3):
            dc[m, i] = matrix[a, i] * r[b] - matrix[b, i] * r[a]
        dc[m, b] -= u[a]
        dc[m, a] += u[b]
        for i in range(3):
            hc[m, i, b] -= matrix[a, i]
            hc[m, b, i] -= matrix[a, i]
            hc[m, i, a] += matrix[b, i]
            hc[m, a, i] += matrix[b, i]
    if not leak > 0.0:
        return 3
    root = math.sqrt(leak)
    c[3] = root * dot(u, r)
    for i in range(3):
        dc[3, i] = root * (matrix[0, i] * r[0] + matrix[1, i] * r[1] + matrix[2, i] * r[2] - u[i])
        for j in range(3):
            hc[3, i, j] = -root * (matrix[i, j] + matrix[j, i])
    return 4


@inner_kernel
def enclose_entries(count, half, c, dc, hc, hr, boxed):
    """Fill bounds on each entry and on its gradient over the box; return n at the centre, and its bounds."""
    n_low = n_high = n = 0.0
    for m in range(count):
        swing = 0.0
        for i in range(3):
            bend = 0.0
            for k in range(3):
                bend += (abs(hc[m, i, k]) + hr[m, i, k]) * half[k]
            boxed[m, 1 + i, 0], boxed[m, 1 + i, 1] = dc[m, i] - bend, dc[m, i] + bend
            swing += (abs(dc[m, i]) + 0.5 * bend) * half[i]
        boxed[m, 0, 0], boxed[m, 0, 1] = c[m] - swing, c[m] + swing
        low, high = square(bounds(boxed[m], 0))
        n, n_low, n_high = n + c[m] * c[m], n_low + low, n_high + high
    return n, n_low, n_high


@inner_kernel
def square_range_about(v, swing):
    """Return bounds on the squared length of a vector, each entry of which swings so far."""
    least = most = 0.0
    for m in range(3):
        low, high = square((v[m] - swing[m], v[m] + swing[m]))
        least, most = least + low, most + high
    return least, most


@inner_kernel
def weight_of(excess, b, s, power):
    """Return ``1 / (b s^power)``; without a channel the power is 2 or 3."""
    if excess.shape[0] == 0:
        return 1.0 / (b * s * s * (s if power == 3.0 else 1.0))
    return 1.0 / (b * s**power)


@inner_kernel
def bend_of_squares(count, i, k, hc, hr, boxed):
    """Return bounds on a second derivative of the sum of the squares of entries."""
    total_low = total_high = 0.0
    for m in range(count):
        left, right = bounds(boxed[m], 1 + i), bounds(boxed[m], 1 + k)
        x, y = product(left, right) if i != k else square(left)
        total_low, total_high = total_low + 2.0 * x, total_high + 2.0 * y
        bent = (2.0 * (hc[m, i, k] - hr[m, i, k]), 2.0 * (hc[m, i, k] + hr[m, i, k]))
        x, y = product(bent, bounds(boxed[m], 0))
        total_low, total_high = total_low + x, total_high + y
    return total_low, total_high


@inner_kernel
def turned_field(axis_field, turn, j, offset, matrix):
    """Fill the offset and the matrix of the axis that point j sees."""
    if turn.shape[0] == 0:
        copy_into(axis_field.offset, offset)
        copy_table(axis_field.matrix, matrix)
        return
    offset[:], matrix[:, :] = 0.0, 0.0
    for i in range(3):
        for a in range(3):
            offset[i] += turn[j, i, a] * axis_field.offset[a]
            for k in range(3):
                matrix[i, k] += turn[j, i, a] * axis_field.matrix[a, k]


@inner_kernel
def of_gradients(i, k, power, excess, dn, beta, sigma):
    """Return bounds on ``n_i l_k + l_i n_k`` and on q without its share of the second derivatives (lemma 3).

    ``l = -beta - power sigma`` is the gradient of the logarithm of w, and ``q`` is ``2 beta beta^T + power
    (beta sigma^T + sigma beta^T) + power (power + 1) sigma sigma^T``. An excess gain of relative slopes g
    adds g to the first and ``g l^T + l g^T`` to the second.
    """
    beta_i, beta_k, sigma_i, sigma_k = bounds(beta, i), bounds(beta, k), bounds(sigma, i), bounds(sigma, k)
    fall_i = (-beta_i[1] - power * sigma_i[1], -beta_i[0] - power * sigma_i[0])
    fall_k = (-beta_k[1] - power * sigma_k[1], -beta_k[0] - power * sigma_k[0])
    more = 0.0, 0.0
    if excess.shape[0] > 0:
        gain_i, gain_k = (excess[1 + i, 1], excess[1 + i, 2]), (excess[1 + k, 1], excess[1 + k, 2])
        more = total(product(gain_i, fall_k), product(fall_i, gain_k))
        fall_i, fall_k = total(fall_i, gain_i), total(fall_k, gain_k)
    left, right = product(bounds(dn, i), fall_k), product(bounds(dn, k), fall_i)
    bb = square(beta_i) if i == k else product(beta_i, beta_k)
    ss = square(sigma_i) if i == k else product(sigma_i, sigma_k)
    bs, sb = product(beta_i, sigma_k), product(sigma_i, beta_k)
    low = 2.0 * bb[0] + power * (bs[0] + sb[0] + (power + 1.0) * ss[0])
    high = 2.0 * bb[1] + power * (bs[1] + sb[1] + (power + 1.0) * ss[1])
    return left[0] + right[0], left[1] + right[1], low + more[0], high + more[1]


@inner_kernel
def dipole_entry(matrix, r, v, half, u, c, dc, hc, hr):
    """Fill ``B = (u.v) |r|^2 - (u.r) (v.r)``, its gradient and its Hessian.

    The last with a radius over the box: B is of the third degree in the position.
    """
    uv, ur, vr, s = dot(u, v), dot(u, r), dot(v, r), dot(r, r)
    slope, ahead, swing = scratch(3), scratch(3), scratch(3)  # of u.v and of u.r; how far the latter moves
    uv_swing = vr_swing = 0.0
    for i in range(3):
        slope[i], ahead[i], swing[i] = 0.0, -u[i], 0.0
        for m in range(3):
            slope[i] += matrix[m, i] * v[m]
            ahead[i] += matrix[m, i] * r[m]
            swing[i] += abs(matrix[m, i] + matrix[i, m]) * half[m]
        uv_swing += abs(slope[i]) * half[i]
        vr_swing += abs(v[i]) * half[i]
    c[0] = dot(cross(u, r), cross(v, r))
    for i in range(3):
        dc[0, i] = slope[i] * s - 2.0 * uv * r[i] - ahead[i] * vr + ur * v[i]
        for k in range(3):
            both = matrix[i, k] + matrix[k, i]
            hc[0, i, k] = both * vr - 2.0 * (slope[i] * r[k] + slope[k] * r[i])
            hc[0, i, k] += ahead[i] * v[k] + ahead[k] * v[i]
            hr[0, i, k] = abs(both) * vr_swing + 2.0 * (abs(slope[i]) * half[k] + abs(slope[k]) * half[i])
            hr[0, i, k] += swing[i] * abs(v[k]) + swing[k] * abs(v[i])
        hc[0, i, i] += 2.0 * uv
        hr[0, i, i] += 2.0 * uv_swing


@kernel
def link_jet(family, j, is_above, axis_field, centre, half, jet):
    """Fill the jet of point j over a box that it is outside of; the axis field vanishes nowhere in it.

    It is to bound the link from above or from below, as ``is_above`` says.
    """
    rows, more, scale = scratch(EXCESS, 3), 0.0, 1.0
    excess = rows[:0]  # none without a channel
    if family.channels.shape[0] > 0:
        channel, to_point = family.channels[j], minus(row(family.points_m, j), centre)
        fill_excess(channel, to_point, is_above, family.points_m[j], centre, half, rows)
        excess, e = rows, channel[EXPONENT]
        more, scale = -0.5 * e, channel[REFERENCE_M] ** -e
    offset, matrix = scratch(3), scratch(3, 3)
    turned_field(axis_field, family.turn, j, offset, matrix)
    r, u, c = scratch(3), scratch(3), scratch(4)
    dc, hc, hr = scratch(4, 3), scratch(4, 3, 3), zeroed(4, 3, 3)
    store(minus(row(family.points_m, j), centre), r)
    fill_affine(offset, matrix, centre, u)
    share = isotropic_share(family.ground_leaks, j)
    if share > 0.0:
        count = entries(family.leak, matrix, r, u, c, dc, hc)
        quotient_jet(matrix, r, u, half, count, 2.0 + more, excess, c, dc, hc, hr, jet)
    if share < 1.0:
        of_dipole, leaking, still, leak = scratch(JET), zeroed(JET), zeroed(3, 3), family.leak
        v = family.ground_axes[j]
        dipole_entry(matrix, r, v, half, u, c, dc, hc, hr)
        quotient_jet(matrix, r, u, half, np.int64(1), 3.0 + more, excess, c, dc, hc, hr, of_dipole)
        if leak > 0.0:  # what leaks is the dipole's own gain, as that of an axis along it
            entries(0.0, still, r, v, c, dc, hc)
            hr[:, :, :] = 0.0
            quotient_jet(still, r, v, half, np.int64(3), 2.0 + more, excess, c, dc, hc, hr, leaking)
        for m in range(JET):
            dipole = (1.0 - leak) * of_dipole[m] + leak * leaking[m]
            jet[m] = (share * jet[m] if share > 0.0 else 0.0) + (1.0 - share) * dipole
    if scale != 1.0:
        for m in range(JET):
            jet[m] *= scale


@inner_kernel
def quotient_jet(matrix, r, u, half, count, power, excess, c, dc, hc, hr, jet):
    """Fill the jet of ``n / (|u|^2 s^power)``, ``s = |r|^2``, n being the sum of the squares of entries.

    At the centre stand r, u with its derivative (that of r is -I), and so many entries c with their gradients
    dc and Hessians hc, which may be off by hr in the box. An excess gain (:mod:`.excess`) multiplies it all.
    """
    # |r|^2 and |u|^2, at the centre and over the box, and their gradients over themselves
    s, b, swing = dot(r, r), dot(u, u), scratch(3)
    fill_swing(matrix, half, swing)
    s_range, b_range = square_range_about(r, half), square_range_about(u, swing)
    sigma, beta, dn, boxed = scratch(3, 2), scratch(3, 2), scratch(3, 2), scratch(4, 4, 2)
    n, n_low, n_high = enclose_entries(count, half, c, dc, hc, hr, boxed)
    w = weight_of(excess, b, s, power)
    jet[0] = n * w
    for i in range(3):
        db = change = slope = low = high = 0.0
        for m in range(count):
            slope += 2.0 * c[m] * dc[m, i]
            x, y = product(bounds(boxed[m], 0), bounds(boxed[m], 1 + i))
            low, high = low + 2.0 * x, high + 2.0 * y
        for m in range(3):
            db += 2.0 * matrix[m, i] * u[m]
            for k in range(3):
                change += 2.0 * abs(matrix[m, i] * matrix[m, k]) * half[k]
        jet[SLOPE + i] = w * (slope - n * (db / b - 2.0 * power * r[i] / s))
        dn[i, 0], dn[i, 1] = low, high
        ends = -2.0 * (r[i] + half[i]), -2.0 * (r[i] - half[i])
        sigma[i, 0], sigma[i, 1] = quotient(ends, s_range)
        beta[i, 0], beta[i, 1] = quotient((db - change, db + change), b_range)
    w_low = weight_of(excess, b_range[1], s_range[1], power)
    w_high = weight_of(excess, b_range[0], s_range[0], power)
    if excess.shape[0] > 0:
        for i in range(3):
            jet[SLOPE + i] = excess[0, 0] * (jet[SLOPE + i] + jet[0] * excess[1 + i, 0])
        jet[0] *= excess[0, 0]
        w_low, w_high = w_low * excess[0, 1], w_high * excess[0, 2]
    jet[LEAST], jet[MOST] = n_low * w_low, n_high * w_high
    if excess.shape[0] == 0:
        jet[MOST] = min(jet[MOST], 1.0 / s_range[0])
    for e in range(6):
        i, k = entry(e)
        first_low, first_high, low, high = of_gradients(i, k, power, excess, dn, beta, sigma)
        x, y = bend_of_squares(count, i, k, hc, hr, boxed)
        first_low, first_high = first_low + x, first_high + y
        gram = 0.0
        for m in range(3):
            gram += 2.0 * matrix[m, i] * matrix[m, k]
        low -= gram / b_range[0 if gram > 0.0 else 1]
        high -= gram / b_range[1 if gram > 0.0 else 0]
        if i == k:
            low, high = low - 2.0 * power / s_range[0], high - 2.0 * power / s_range[1]
        if excess.shape[0] > 0:
            low, high = low + excess[4 + e, 1], high + excess[4 + e, 2]
        x, y = product((n_low, n_high), (low, high))
        low, high = product((w_low, w_high), (first_low + x, first_high + y))
        jet[BEND + e], jet[RADIUS + e] = 0.5 * (low + high), 0.5 * (high - low)
