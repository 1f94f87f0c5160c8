"""The test of a free axis where points have dipoles: link vectors over a box, to the second order.

A point with a dipole along v has the form ``a a^T`` with ``a = (|r|^2 v - (v.r) r) / |r|^3``, and an isotropic
one the sum of three such forms, of three v across each other. Vectors are expanded in place of forms: value,
first and second derivative at the box's centre, and a bound on the third over the box. The coordinates u' of
the axis, ``u = L(p) u'``, may turn with the direction of one point's null: with ``L = I - a0 w^T``, ``w = (a - a0)
/ (a.a0)``, the form of a dipole stays ``a0 a0^T`` all over the box; with ``L = I + z d0^T``, ``z = d / (d.d0) -
d0``, an isotropic point has no term along d0. Proofs: "The certificate explained", "Dipoles on the ground".
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.solve.kernels.denominators import ROUNDING, group_weight
from nullpose.solve.kernels.expansion import min_square
from nullpose.solve.kernels.forms import add_point, entry, in_frame
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.links import has_dipole
from nullpose.solve.kernels.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solve.kernels.records import TOWARDS_POINT, WORLD, Frame
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import add_square, top_eigenvector
from nullpose.solve.kernels.vectors import dot, row

SLOPE, BEND, THIRD = 1.1548, 3.0, 9.89  # of a link vector, times powers of the distance: lemma 5
_BENT = 8.67  # of its square's second derivative
_TURN = 2.31  # of the direction to a point: 6 cos^2 sin, rounded up
_UPRIGHT = 0.4  # of the anchor's vector, along its value at the centre, that must be left all over the box
_MOST_ETA = 0.25
_SHARE = 0.1

FloatArray = NDArray[np.float64]


class Shear(NamedTuple):
    """Coordinates of the axis that turn with a point: ``L = I + E``, E being ``still w^T`` or ``w still^T``.

    Args:
        kind: WORLD, where E is zero, or TOWARDS_POINT.
        is_dipole: whether the point has one; E is ``still w^T`` then.
        still: (3,) minus a0, or d0.
        first: (3, 3) the derivatives of w along the world's axes, at the centre.
        second: (6, 3) its second derivatives.
        most: (4,) bounds on w and on its first three derivatives along any unit direction, in the box.
    """

    kind: int
    is_dipole: bool
    still: FloatArray
    first: FloatArray
    second: FloatArray
    most: FloatArray


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


@inner_kernel
def size_of(vectors):
    """Return the root of the sum of the squares of a symmetric table of vectors, (3, 3) or (6, 3)."""
    total = 0.0
    for s in range(vectors.shape[0]):
        v = row(vectors, s)
        total += (2.0 if s >= 3 else 1.0) * dot(v, v)
    return math.sqrt(total)


@inner_kernel
def reach_along(vectors, v, half):
    """Return how far the products of v with derivatives reach over a box."""
    total = 0.0
    for i in range(3):
        total += abs(dot(row(vectors, i), v)) * half[i]
    return total


@inner_kernel
def dipole_shear(family, j, centre, half, frame, shear):
    """Fill the shear of a point with a dipole; return whether its vector keeps its direction well enough."""
    r, v, a = scratch(3), scratch(3), scratch(3)
    point = family.points_m[j]
    r[0], r[1], r[2] = in_frame(
        frame.basis, (point[0] - centre[0], point[1] - centre[1], point[2] - centre[2])
    )
    v[0], v[1], v[2] = in_frame(frame.basis, family.ground_axes[j])
    first, second, most = shear.first, shear.second, shear.most
    vector_jet(r, v, frame.basis, a, first, second)
    least = math.sqrt(min_square(family.points_m, j, centre, half))
    diagonal = math.sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2])
    square, length = dot(a, a), math.sqrt(dot(a, a))
    a3 = THIRD / least**4
    a2 = min(BEND / least**3, size_of(second) + a3 * diagonal)
    a1 = min(SLOPE / least**2, size_of(first) + a2 * diagonal)
    bend = 0.5 * a2 * diagonal * diagonal
    y = square - reach_along(first, a, half) - length * bend
    if not y > _UPRIGHT * square:
        return False
    g = bend
    for i in range(3):
        g += half[i] * math.sqrt(dot(row(first, i), row(first, i)))
    # derivatives of 1 / y
    i1 = length * a1 / (y * y)
    i2 = length * a2 / (y * y) + 2.0 * (length * a1) ** 2 / y**3
    i3 = length * a3 / (y * y) + 6.0 * length * length * a1 * a2 / y**3 + 6.0 * (length * a1) ** 3 / y**4
    most[0] = g / y
    most[1] = a1 / y + g * i1
    most[2] = a2 / y + 2.0 * a1 * i1 + g * i2
    most[3] = a3 / y + 3.0 * a2 * i1 + 3.0 * a1 * i2 + g * i3
    for s in range(6):
        i, k = entry(s)
        one, other = dot(row(first, i), a), dot(row(first, k), a)
        for m in range(3):
            second[s, m] = (second[s, m] - (first[i, m] * other + first[k, m] * one) / square) / square
    for i in range(3):
        shear.still[i] = -a[i]
        for m in range(3):
            first[i, m] /= square
    return True


@inner_kernel
def direction_shear(frame, centre, half, shear):
    """Fill the shear of an isotropic point, the third axis of the frame; return whether it may be used."""
    basis, first, second, most = frame.basis, shear.first, shear.second, shear.most
    y = frame.radius_m
    for i in range(3):
        y -= abs(basis[i, 2]) * half[i]
    if not y > _UPRIGHT * frame.radius_m:
        return False
    diagonal = math.sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]) / y
    most[0] = diagonal
    most[1] = math.sqrt(1.0 + diagonal * diagonal) / y
    most[2] = (1.0 + 2.0 * diagonal) / (y * y)
    most[3] = (_TURN + 6.0 * diagonal) / (y * y * y)
    for i in range(3):
        shear.still[i] = 1.0 if i == 2 else 0.0
        for m in range(3):
            first[i, m] = -basis[i, m] / frame.radius_m if m < 2 else 0.0
    for s in range(6):
        i, k = entry(s)
        for m in range(3):
            bent = basis[i, m] * basis[k, 2] + basis[k, m] * basis[i, 2]
            second[s, m] = -bent / (frame.radius_m * frame.radius_m) if m < 2 else 0.0
    return True


@inner_kernel
def shear_at(family, frame, centre, half, shear):
    """Fill the shear of a frame; return it, or none if the anchor's direction changes too much in the box."""
    if frame.kind == WORLD:
        return shear
    j = frame.anchor
    has = has_dipole(family, j)
    if has:
        fine = dipole_shear(family, j, centre, half, frame, shear)
    else:
        fine = direction_shear(frame, centre, half, shear)
    kind = TOWARDS_POINT if fine else WORLD
    return Shear(np.int64(kind), has, shear.still, shear.first, shear.second, shear.most)


@inner_kernel
def add_shear(shear, value, first, second):
    """Turn a link vector's jet into that of ``L^T a``."""
    if shear.kind == WORLD:
        return
    still = shear.still
    if shear.is_dipole:
        whole = dot(value, still)
        for s in range(6):
            i, k = entry(s)
            one, other = dot(row(first, i), still), dot(row(first, k), still)
            for m in range(3):
                second[s, m] += one * shear.first[k, m] + other * shear.first[i, m]
                second[s, m] += whole * shear.second[s, m]
        for i in range(3):
            for m in range(3):
                first[i, m] += whole * shear.first[i, m]
        return
    for s in range(6):
        i, k = entry(s)
        more = dot(row(first, i), row(shear.first, k)) + dot(row(first, k), row(shear.first, i))
        more += dot(value, row(shear.second, s))
        for m in range(3):
            second[s, m] += more * still[m]
    for i in range(3):
        more = dot(value, row(shear.first, i))
        for m in range(3):
            first[i, m] += more * still[m]


@inner_kernel
def third_of(shear, least):
    """Return a bound on the third derivative of ``L^T a`` in the box."""
    i1 = 1.0 / least
    i2 = i1 * i1
    third = THIRD * i2 * i2
    if shear.kind == WORLD:
        return third
    most, size = shear.most, math.sqrt(dot(shear.still, shear.still))
    more = THIRD * i2 * i2 * most[0] + 3.0 * BEND * i2 * i1 * most[1]
    more += 3.0 * SLOPE * i2 * most[2] + i1 * most[3]
    return third + size * more


@inner_kernel
def add_parts(parts, count, weights, scale, out):
    """Add a form that is no less than the square of a sum of products with vectors, each of any sign.

    ``(sum_s |u.d_s|)^2 <= (sum_s c_s) (sum_s (u.d_s)^2 / c_s)`` for any positive c.
    """
    total = 0.0
    for s in range(count):
        total += weights[s]
    for s in range(count):
        if weights[s] > 0.0:
            add_square(scale * total / weights[s], parts[s], out)
    return total


@inner_kernel
def add_vector(shear, v, half, third, sign, scale, jet, matrix, slopes, rest):
    """Add ``scale (u.c)^2`` of a link vector c, from above (sign 1) or minus it from below (-1).

    Args:
        shear: of the frame.
        v: (3,) the axis at which the bound is to be sharp.
        half: the box's half sides.
        third: a bound on the third derivative of c.
        sign: 1 or -1.
        scale: positive.
        jet: the vector's value, first and second derivatives.
        matrix: (6,) output, the form at the centre.
        slopes: (3, 6) output.
        rest: (6,) output, what may come to it in the box.
    """
    value, first, second = jet
    parts, weights = scratch(7, 3), scratch(7)
    diagonal = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
    ball = third * diagonal * math.sqrt(diagonal) / 6.0
    tiny = 1e-3 * ball + 1e-290
    total = ball
    for s in range(6):
        i, k = entry(s)
        factor = 0.25 * half[i] * half[i] if i == k else half[i] * half[k]
        for m in range(3):
            parts[s, m] = factor * second[s, m]
            if i == k:
                value[m] += parts[s, m]
        size = math.sqrt(dot(row(parts, s), row(parts, s)))
        weights[s] = abs(dot(row(parts, s), v)) + 1e-2 * size + tiny
        total += weights[s]
    ahead = abs(dot(value, v))
    eta = min(_MOST_ETA, max(1e-12, total / max(ahead, 1e-300)))
    near = scale * (1.0 + sign * eta)
    add_square(sign * near, value, matrix)
    for i in range(3):
        for s in range(6):
            a, b = entry(s)
            slopes[i, s] += sign * near * (first[i, a] * value[b] + first[i, b] * value[a])
    far = scale * (1.0 + 1.0 / eta if sign > 0.0 else 1.0 / eta)
    for s in range(6):
        add_square(far * total / weights[s], parts[s], rest)
    for m in range(3):
        rest[m] += far * total * ball
    if sign > 0.0:  # the square of what is linear
        total = 0.0
        for i in range(3):
            d = row(first, i)
            weights[i] = half[i] * (abs(dot(d, v)) + 1e-2 * math.sqrt(dot(d, d))) + 1e-290
            total += weights[i]
        for i in range(3):
            add_square(near * total * half[i] * half[i] / weights[i], first[i], rest)
    size = dot(value, value)
    for m in range(3):
        rest[m] += ROUNDING * scale * size


@inner_kernel
def add_leak(family, j, shear, frame, centre, half, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times what leaks to a point, ``leak g I``, g being its gain over ``|r|^2``."""
    r, v, a = scratch(3), scratch(3), scratch(3)
    first, second = scratch(3, 3), scratch(6, 3)
    point = family.points_m[j]
    r[0], r[1], r[2] = in_frame(
        frame.basis, (point[0] - centre[0], point[1] - centre[1], point[2] - centre[2])
    )
    least = math.sqrt(min_square(family.points_m, j, centre, half))
    has = has_dipole(family, j)
    if has:
        v[0], v[1], v[2] = in_frame(frame.basis, family.ground_axes[j])
        vector_jet(r, v, frame.basis, a, first, second)
        gain = dot(a, a)
    else:
        gain = 1.0 / dot(r, r)
    weight = sign * scale * family.leak
    square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
    if has and sign < 0.0 and shear.kind == WORLD:  # beside the dipole's own null, as in ``sharpen``
        bound = size_of(second) + THIRD / least**4 * math.sqrt(square)
        bend = 0.5 * square * min(BEND / least**3, bound)
        eta = bend / math.sqrt(max(gain, 1e-300))
        if eta < 0.5 and eta * gain + bend * bend / eta < 0.5 * square * _BENT / least**4:
            for m in range(3):
                matrix[m] += (1.0 - eta) * weight * gain
                rest[m] += abs(weight) * (bend * bend / eta + ROUNDING * gain)
                for i in range(3):
                    slopes[i, m] += 2.0 * (1.0 - eta) * weight * dot(a, row(first, i))
            return
    for i in range(3):
        change = 2.0 * dot(a, row(first, i)) if has else 2.0 * gain * gain * dot(r, row(frame.basis, i))
        for m in range(3):
            slopes[i, m] += weight * change
    add_identity_slopes(shear, weight * gain, slopes)
    e0 = e1 = e2 = 0.0
    if shear.kind != WORLD:
        size = math.sqrt(dot(shear.still, shear.still))
        e0, e1, e2 = size * shear.most[0], size * shear.most[1], size * shear.most[2]
    i2 = 1.0 / (least * least)
    most = 1.0 / least
    if has:
        reach = 0.5 * square * BEND * i2 / least
        for i in range(3):
            reach += half[i] * math.sqrt(dot(row(first, i), row(first, i)))
        most = min(most, math.sqrt(gain) + reach)
    bent = 2.0 * (SLOPE * SLOPE * i2 * i2 + most * BEND * i2 / least) * (1.0 + e0) ** 2
    bent += 8.0 * most * SLOPE * i2 * e1 * (1.0 + e0)
    bent += 2.0 * most * most * (e2 * (1.0 + e0) + e1 * e1)
    for m in range(3):
        matrix[m] += weight * gain
        rest[m] += abs(weight) * (0.5 * square * bent + ROUNDING * gain)


@inner_kernel
def add_identity_slopes(shear, weight, slopes):
    """Add ``weight`` times the slopes of ``L^T L``."""
    if shear.kind == WORLD:
        return
    for i in range(3):
        for s in range(6):
            a, b = entry(s)
            w = shear.still[a] * shear.first[i, b] + shear.still[b] * shear.first[i, a]
            slopes[i, s] += weight * w


@inner_kernel
def add_identity(shear, half, weight, jamming, v, matrix, slopes, rest):
    """Add ``weight L^T L``, from above; the anchor's ``jamming`` is what its form has where it is not zero."""
    for m in range(3):
        matrix[m] += weight
    add_identity_slopes(shear, weight, slopes)
    if shear.kind == WORLD:
        return
    square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
    size = math.sqrt(dot(shear.still, shear.still))
    if weight > 0.0:
        for m in range(3):
            rest[m] += weight * (size * shear.most[0]) ** 2
    # twice the product of the part along the anchor's form with the other one
    bend = abs(weight) * size * 0.5 * square * shear.most[2]
    upright, level = v[2] * v[2], v[0] * v[0] + v[1] * v[1]
    seen, unseen = (upright, 1.0) if shear.is_dipole else (level, upright)
    eta = min(max(bend, _SHARE * jamming), bend * math.sqrt(unseen / max(seen, 1e-300)))
    eta = max(eta, 1e-3 * bend)
    if bend > 0.0:
        for m in range(3):
            along = (m == 2) == shear.is_dipole
            rest[m] += eta if along else 0.0
            rest[m] += bend * bend / eta if (shear.is_dipole or m == 2) else 0.0


@inner_kernel
def add_constant(shear, half, weight, q, matrix, slopes, rest):
    """Add ``weight L^T Q L`` of a constant form, from above."""
    for s in range(6):
        matrix[s] += weight * q[s]
    size = math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + 2.0 * (q[3] ** 2 + q[4] ** 2 + q[5] ** 2))
    if shear.kind != WORLD:
        still = shear.still
        for i in range(3):
            one, other = scratch(3), scratch(3)  # E = one other^T
            for m in range(3):
                one[m] = still[m] if shear.is_dipole else shear.first[i, m]
                other[m] = shear.first[i, m] if shear.is_dipole else still[m]
            x = q[0] * one[0] + q[3] * one[1] + q[4] * one[2]
            y = q[3] * one[0] + q[1] * one[1] + q[5] * one[2]
            z = q[4] * one[0] + q[5] * one[1] + q[2] * one[2]
            turned = (x, y, z)
            for s in range(6):
                a, b = entry(s)
                slopes[i, s] += weight * (turned[a] * other[b] + turned[b] * other[a])
        square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
        length = math.sqrt(dot(still, still))
        bend = length * shear.most[2] * square + (length * shear.most[0]) ** 2
        for m in range(3):
            rest[m] += abs(weight) * size * bend
    for m in range(3):
        rest[m] += 4.0 * ROUNDING * abs(weight)


@inner_kernel
def add_link(family, j, shear, frame, centre, half, v, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times the form of a point, expanded over the box."""
    if family.leak > 0.0:
        add_leak(family, j, shear, frame, centre, half, sign, scale, matrix, slopes, rest)
    scale *= 1.0 - family.leak
    if sign < 0.0 and shear.kind != WORLD and j == frame.anchor:
        add_anchor(family, shear, frame, centre, half, scale, matrix, slopes, rest)
        return
    r, w = scratch(3), scratch(3)
    value, first, second = scratch(3), scratch(3, 3), scratch(6, 3)
    point = family.points_m[j]
    r[0], r[1], r[2] = in_frame(
        frame.basis, (point[0] - centre[0], point[1] - centre[1], point[2] - centre[2])
    )
    third = third_of(shear, math.sqrt(min_square(family.points_m, j, centre, half)))
    has = has_dipole(family, j)
    for m in range(1 if has else 3):
        if has:
            w[0], w[1], w[2] = in_frame(frame.basis, family.ground_axes[j])
        else:
            w[0], w[1], w[2] = 0.0, 0.0, 0.0
            w[m] = 1.0
        vector_jet(r, w, frame.basis, value, first, second)
        add_shear(shear, value, first, second)
        add_vector(shear, v, half, third, sign, scale, (value, first, second), matrix, slopes, rest)


@inner_kernel
def add_anchor(family, shear, frame, centre, half, scale, matrix, slopes, rest):
    """Add minus the form of the point that the shear turns with, from above."""
    if shear.is_dipole:
        matrix[2] -= scale * dot(shear.still, shear.still) * (1.0 - ROUNDING)
        return
    i2 = 1.0 / (frame.radius_m * frame.radius_m)
    square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
    beyond = 1.0 / min_square(family.points_m, frame.anchor, centre, half) ** 2
    for m in range(2):
        matrix[m] -= scale * i2
        rest[m] += scale * (2.0 * square * beyond + ROUNDING * i2)
        for i in range(3):
            slopes[i, m] -= scale * 2.0 * frame.basis[i, 2] * i2 / frame.radius_m


@inner_kernel
def identity_weight(family, row):
    """Return the multiple of the identity in a row's sum."""
    total = 0.0
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        less = row[LEVEL] * family.denominator_isotropic[family.denominator_of[k]]
        total += row[WEIGHT + s] * (family.numerator_isotropic[k] - less)
    return total


@inner_kernel
def centre_form(family, frame, row, matrix):
    """Add a row's sum at its box's centre; return the anchor's strength in it."""
    centre, jamming = row[CENTRE:HALF], 0.0
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        strength = row[WEIGHT + s] * family.numerator_weight[k]
        add_point(family, family.numerator_point[k], centre, frame.basis, strength, 0.0, matrix)
        weight = group_weight(family, row, s) * row[LEVEL]
        g = family.denominator_of[k]
        for e in (
            range(family.denominator_start[g], family.denominator_start[g + 1]) if weight > 0.0 else range(0)
        ):
            j, scale = family.denominator_point[e], weight * family.denominator_weight[e]
            add_point(family, j, centre, frame.basis, -scale, 0.0, matrix)
            jamming += scale if j == frame.anchor else 0.0
    identity = identity_weight(family, row)
    for m in range(3):
        matrix[m] += identity
    return jamming * (1.0 - family.leak)


@inner_kernel
def add_links(family, shear, frame, row, v, jamming, matrix, slopes, rest):
    """Add a row's sum over its box from above: its value at the centre, its slopes and what may come to it."""
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    if shear.kind != WORLD:
        jamming *= dot(shear.still, shear.still) if shear.is_dipole else 1.0 / frame.radius_m**2
    add_identity(shear, half, identity_weight(family, row), jamming, v, matrix, slopes, rest)
    for m in range(3):
        rest[m] += ROUNDING * row[LEVEL]
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        strength = row[WEIGHT + s] * family.numerator_weight[k]
        j = family.numerator_point[k]
        add_link(family, j, shear, frame, centre, half, v, 1.0, strength, matrix, slopes, rest)
        weight = group_weight(family, row, s) * row[LEVEL]
        g = family.denominator_of[k]
        for e in (
            range(family.denominator_start[g], family.denominator_start[g + 1]) if weight > 0.0 else range(0)
        ):
            j, scale = family.denominator_point[e], weight * family.denominator_weight[e]
            add_link(family, j, shear, frame, centre, half, v, -1.0, scale, matrix, slopes, rest)
