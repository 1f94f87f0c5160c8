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

from nullpose.solver.kernels.forms import entry
from nullpose.solver.kernels.jit import inner_kernel, kernel
from nullpose.solver.kernels.links import isotropic_share
from nullpose.solver.kernels.scratch import scratch, zeroed
from nullpose.solver.kernels.symmetric import copy_into, copy_table
from nullpose.solver.kernels.vectors import cross, dot

JET = 18  # value, gradient (3), the Hessian's midpoint (6) and radius (6), least and greatest value


@kernel
def product(a, b):
    """Return bounds on the product of two numbers of which bounds are given."""
    w, x, y, z = a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]
    return min(min(w, x), min(y, z)), max(max(w, x), max(y, z))


@kernel
def square(a):
    """Return bounds on the square of a number of which bounds are given."""
    x, y = a[0] * a[0], a[1] * a[1]
    return (0.0 if a[0] < 0.0 < a[1] else min(x, y)), max(x, y)


@inner_kernel
def bounds(table, i):
    """Return the bounds in row i of a table."""
    return table[i, 0], table[i, 1]


@kernel
def axis_clearance(axis_field, centre, half):
    """Return the axis field's length at the centre, and by how much it can change in the box."""
    length = change = 0.0
    for m in range(3):
        u, swing = axis_field.offset[m], 0.0
        for i in range(3):
            u += axis_field.matrix[m, i] * centre[i]
            swing += abs(axis_field.matrix[m, i]) * half[i]
        length += u * u
        change += swing * swing
    return math.sqrt(length), math.sqrt(change)


@inner_kernel
def entries(leak, offset, matrix, r, centre, u, c, dc, hc):
    """Fill the axis at the centre, the entries whose squares make n, their gradients and constant Hessians.

    Returns how many entries there are: the fourth is ``sqrt(leak) u.r``.
    """
    for m in range(3):
        u[m] = offset[m]
        for i in range(3):
            u[m] += matrix[m, i] * centre[i]
    for m in range(3):
        a, b = (m + 1) % 3, (m + 2) % 3
        c[m] = u[a] * r[b] - u[b] * r[a]
        for i in range(3):
            dc[m, i] = matrix[a, i] * r[b] - matrix[b, i] * r[a]
        dc[m, b] -= u[a]
        dc[m, a] += u[b]
        for i in range(3):
            for j in range(3):
                hc[m, i, j] = 0.0
        for i in range(3):
            hc[m, i, b] -= matrix[a, i]
            hc[m, b, i] -= matrix[a, i]
            hc[m, i, a] += matrix[b, i]
            hc[m, a, i] += matrix[b, i]
    if not leak > 0.0:
        return 3
    root = math.sqrt(leak)
    c[3] = root * (u[0] * r[0] + u[1] * r[1] + u[2] * r[2])
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
        low, high = square((boxed[m, 0, 0], boxed[m, 0, 1]))
        n, n_low, n_high = n + c[m] * c[m], n_low + low, n_high + high
    return n, n_low, n_high


@inner_kernel
def relative_slopes(value, slope, swing, low, high):
    """Return bounds on a derivative, ``slope`` give or take ``swing``, over a quantity in [low, high]."""
    bottom, top = slope - swing, slope + swing
    return bottom / (high if bottom > 0.0 else low), top / (low if top > 0.0 else high)


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
def of_gradients(i, k, power, dn, beta, sigma):
    """Return bounds on ``n_i l_k + l_i n_k`` and on q without its share of the second derivatives (lemma 3).

    ``l = -beta - power sigma`` is the gradient of the logarithm of w, and ``q`` is ``2 beta beta^T + power
    (beta sigma^T + sigma beta^T) + power (power + 1) sigma sigma^T``.
    """
    beta_i, beta_k, sigma_i, sigma_k = bounds(beta, i), bounds(beta, k), bounds(sigma, i), bounds(sigma, k)
    fall_i = (-beta_i[1] - power * sigma_i[1], -beta_i[0] - power * sigma_i[0])
    fall_k = (-beta_k[1] - power * sigma_k[1], -beta_k[0] - power * sigma_k[0])
    left, right = product(bounds(dn, i), fall_k), product(bounds(dn, k), fall_i)
    bb = square(beta_i) if i == k else product(beta_i, beta_k)
    ss = square(sigma_i) if i == k else product(sigma_i, sigma_k)
    bs, sb = product(beta_i, sigma_k), product(sigma_i, beta_k)
    low = 2.0 * bb[0] + power * (bs[0] + sb[0] + (power + 1.0) * ss[0])
    high = 2.0 * bb[1] + power * (bs[1] + sb[1] + (power + 1.0) * ss[1])
    return left[0] + right[0], left[1] + right[1], low, high


@inner_kernel
def dipole_entry(offset, matrix, r, v, half, centre, u, c, dc, hc, hr):
    """Fill the axis at the centre, and ``B = (u.v) |r|^2 - (u.r) (v.r)``, its gradient and its Hessian.

    The last with a radius over the box: B is of the third degree in the position.
    """
    for m in range(3):
        u[m] = offset[m]
        for i in range(3):
            u[m] += matrix[m, i] * centre[i]
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
def link_jet(family, j, axis_field, centre, half, jet):
    """Fill the jet of point j: value and gradient at the centre, midpoint and radius of the Hessian, bounds.

    Args:
        family: with its points.
        j: which of them.
        axis_field: (1, offset, matrix); not zero in the box.
        centre: (3,) the box's centre.
        half: (3,) its half sides; the point is outside the box.
        jet: output, (JET,).
    """
    offset, matrix = scratch(3), scratch(3, 3)
    turned_field(axis_field, family.turn, j, offset, matrix)
    r, u, c = scratch(3), scratch(3), scratch(4)
    dc, hc, hr = scratch(4, 3), scratch(4, 3, 3), zeroed(4, 3, 3)
    for i in range(3):
        r[i] = family.points_m[j, i] - centre[i]
    share, axes = isotropic_share(family.ground_leaks, j), family.ground_axes
    if share > 0.0:
        count = entries(family.leak, offset, matrix, r, centre, u, c, dc, hc)
        quotient_jet(matrix, r, u, half, count, 2.0, c, dc, hc, hr, jet)
    if share < 1.0:
        of_dipole = scratch(JET)
        dipole_jet(family.leak, axes, j, offset, matrix, r, centre, half, u, c, dc, hc, hr, of_dipole)
        for m in range(JET):
            jet[m] = (share * jet[m] if share > 0.0 else 0.0) + (1.0 - share) * of_dipole[m]


@inner_kernel
def dipole_jet(leak, axes, j, offset, matrix, r, centre, half, u, c, dc, hc, hr, jet):
    """Fill the jet of point j, which has a dipole; the arrays from u to hr are room."""
    if axes is not None:
        v = axes[j]
        dipole_entry(offset, matrix, r, v, half, centre, u, c, dc, hc, hr)
        quotient_jet(matrix, r, u, half, np.int64(1), 3.0, c, dc, hc, hr, jet)
        if leak > 0.0:  # what leaks is the dipole's own gain, as that of an axis along it
            leaking, still = scratch(JET), zeroed(3, 3)
            entries(0.0, v, still, r, centre, u, c, dc, hc)
            hr[:, :, :] = 0.0
            quotient_jet(still, r, u, half, np.int64(3), 2.0, c, dc, hc, hr, leaking)
            for m in range(JET):
                jet[m] = (1.0 - leak) * jet[m] + leak * leaking[m]


@inner_kernel
def quotient_jet(matrix, r, u, half, count, power, c, dc, hc, hr, jet):
    """Fill the jet of ``n / (|u|^2 s^power)``, ``s = |r|^2``, n being the sum of the squares of entries.

    Args:
        matrix: (3, 3), the derivative of u; that of r is -I.
        r: (3,) at the centre.
        u: (3,) likewise.
        half: (3,) the box's half sides.
        count: how many entries there are.
        power: 2 or 3.
        c: (4,) the entries at the centre.
        dc: (4, 3) their gradients.
        hc: (4, 3, 3) their Hessians there.
        hr: (4, 3, 3) how far these may be off in the box.
        jet: output, (JET,).
    """
    # |r|^2 and |u|^2, at the centre and over the box, and their gradients over themselves
    s = s_low = s_high = b = b_low = b_high = 0.0
    for m in range(3):
        swing = 0.0
        for i in range(3):
            swing += abs(matrix[m, i]) * half[i]
        low, high = square((r[m] - half[m], r[m] + half[m]))
        s, s_low, s_high = s + r[m] * r[m], s_low + low, s_high + high
        low, high = square((u[m] - swing, u[m] + swing))
        b, b_low, b_high = b + u[m] * u[m], b_low + low, b_high + high
    sigma, beta, dn = scratch(3, 2), scratch(3, 2), scratch(3, 2)
    boxed = scratch(4, 4, 2)
    n, n_low, n_high = enclose_entries(count, half, c, dc, hc, hr, boxed)
    third = power == 3.0
    w = 1.0 / (b * s * s * (s if third else 1.0))
    jet[0] = n * w
    for i in range(3):
        db = swing = slope = low = high = 0.0
        for m in range(count):
            slope += 2.0 * c[m] * dc[m, i]
            x, y = product((boxed[m, 0, 0], boxed[m, 0, 1]), (boxed[m, 1 + i, 0], boxed[m, 1 + i, 1]))
            low, high = low + 2.0 * x, high + 2.0 * y
        for m in range(3):
            db += 2.0 * matrix[m, i] * u[m]
            for k in range(3):
                swing += 2.0 * abs(matrix[m, i] * matrix[m, k]) * half[k]
        jet[1 + i] = w * (slope - n * (db / b - 2.0 * power * r[i] / s))
        dn[i, 0], dn[i, 1] = low, high
        sigma[i, 0], sigma[i, 1] = relative_slopes(s, -2.0 * r[i], 2.0 * half[i], s_low, s_high)
        beta[i, 0], beta[i, 1] = relative_slopes(b, db, swing, b_low, b_high)
    w_range = (
        1.0 / (b_high * s_high * s_high * (s_high if third else 1.0)),
        1.0 / (b_low * s_low * s_low * (s_low if third else 1.0)),
    )
    jet[16], jet[17] = n_low * w_range[0], min(n_high * w_range[1], 1.0 / s_low)
    for e in range(6):
        i, k = entry(e)
        first_low, first_high, low, high = of_gradients(i, k, power, dn, beta, sigma)
        gram = 0.0
        for m in range(count):
            left, right = bounds(boxed[m], 1 + i), bounds(boxed[m], 1 + k)
            x, y = product(left, right) if i != k else square(left)
            first_low, first_high = first_low + 2.0 * x, first_high + 2.0 * y
            bent = (2.0 * (hc[m, i, k] - hr[m, i, k]), 2.0 * (hc[m, i, k] + hr[m, i, k]))
            x, y = product(bent, (boxed[m, 0, 0], boxed[m, 0, 1]))
            first_low, first_high = first_low + x, first_high + y
        for m in range(3):
            gram += 2.0 * matrix[m, i] * matrix[m, k]
        low -= gram / (b_low if gram > 0.0 else b_high)
        high -= gram / (b_high if gram > 0.0 else b_low)
        if i == k:
            low, high = low - 2.0 * power / s_low, high - 2.0 * power / s_high
        x, y = product((n_low, n_high), (low, high))
        low, high = product(w_range, (first_low + x, first_high + y))
        jet[4 + e], jet[10 + e] = 0.5 * (low + high), 0.5 * (high - low)
