"""A link under an affine axis field over a box of positions: value, gradient, and bounds on the Hessian.

With ``u = o + M p`` and ``r = q - p`` the link is ``f = n / (|u|^2 |r|^4)``, ``n = |u x r|^2 + l (u.r)^2``
with the antenna's leak l being the sum of the squares of the entries of ``u x r`` and of ``sqrt(l) u.r``: a
quotient of polynomials, whose second derivatives are bounded by interval arithmetic. Hessians are kept as
(xx, yy, zz, xy, xz, yz).
"""

from __future__ import annotations

import math

from nullpose.solve.kernels.forms import entry
from nullpose.solve.kernels.jit import inner_kernel, kernel
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import copy_into, copy_table

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
def enclose_entries(count, half, c, dc, hc, boxed):
    """Fill bounds on each entry and on its gradient over the box; return n at the centre, and its bounds."""
    n_low = n_high = n = 0.0
    for m in range(count):
        swing = 0.0
        for i in range(3):
            bend = 0.0
            for k in range(3):
                bend += abs(hc[m, i, k]) * half[k]
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
def of_gradients(i, k, dn, beta, sigma):
    """Return bounds on ``n_i l_k + l_i n_k`` and on q without its share of the second derivatives (lemma 3).

    ``l = -beta - 2 sigma`` is the gradient of the logarithm of w, and ``q`` is ``2 beta beta^T + 2 (beta
    sigma^T + sigma beta^T) + 6 sigma sigma^T``.
    """
    beta_i, beta_k, sigma_i, sigma_k = bounds(beta, i), bounds(beta, k), bounds(sigma, i), bounds(sigma, k)
    fall_i = (-beta_i[1] - 2.0 * sigma_i[1], -beta_i[0] - 2.0 * sigma_i[0])
    fall_k = (-beta_k[1] - 2.0 * sigma_k[1], -beta_k[0] - 2.0 * sigma_k[0])
    one, other = product(bounds(dn, i), fall_k), product(bounds(dn, k), fall_i)
    bb = square(beta_i) if i == k else product(beta_i, beta_k)
    ss = square(sigma_i) if i == k else product(sigma_i, sigma_k)
    bs, sb = product(beta_i, sigma_k), product(sigma_i, beta_k)
    low = 2.0 * (bb[0] + bs[0] + sb[0]) + 6.0 * ss[0]
    high = 2.0 * (bb[1] + bs[1] + sb[1]) + 6.0 * ss[1]
    return one[0] + other[0], one[1] + other[1], low, high


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
    dc, hc = scratch(4, 3), scratch(4, 3, 3)
    for i in range(3):
        r[i] = family.points_m[j, i] - centre[i]
    count = entries(family.leak, offset, matrix, r, centre, u, c, dc, hc)
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
    n, n_low, n_high = enclose_entries(count, half, c, dc, hc, boxed)
    w = 1.0 / (b * s * s)
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
        jet[1 + i] = w * (slope - n * (db / b - 4.0 * r[i] / s))
        dn[i, 0], dn[i, 1] = low, high
        sigma[i, 0], sigma[i, 1] = relative_slopes(s, -2.0 * r[i], 2.0 * half[i], s_low, s_high)
        beta[i, 0], beta[i, 1] = relative_slopes(b, db, swing, b_low, b_high)
    w_range = (1.0 / (b_high * s_high * s_high), 1.0 / (b_low * s_low * s_low))
    jet[16], jet[17] = n_low * w_range[0], min(n_high * w_range[1], 1.0 / s_low)
    for e in range(6):
        i, k = entry(e)
        first_low, first_high, low, high = of_gradients(i, k, dn, beta, sigma)
        gram = 0.0
        for m in range(count):
            left, right = bounds(boxed[m], 1 + i), bounds(boxed[m], 1 + k)
            x, y = product(left, right) if i != k else square(left)
            first_low, first_high = first_low + 2.0 * x, first_high + 2.0 * y
            bent = 2.0 * hc[m, i, k]
            x, y = bent * boxed[m, 0, 0], bent * boxed[m, 0, 1]
            first_low, first_high = first_low + min(x, y), first_high + max(x, y)
        for m in range(3):
            gram += 2.0 * matrix[m, i] * matrix[m, k]
        low -= gram / (b_low if gram > 0.0 else b_high)
        high -= gram / (b_high if gram > 0.0 else b_low)
        if i == k:
            low, high = low - 4.0 / s_low, high - 4.0 / s_high
        x, y = product((n_low, n_high), (low, high))
        low, high = product(w_range, (first_low + x, first_high + y))
        jet[4 + e], jet[10 + e] = 0.5 * (low + high), 0.5 * (high - low)
