"""The sum of a free axis' test where points have dipoles: squares of link vectors, from above, over a box.

Proofs: "The certificate explained", "Dipoles on the ground".
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.constants import (
    ROUNDING,
    VECTOR_BEND,
    VECTOR_SLOPE,
    VECTOR_SQUARE_BEND,
    VECTOR_THIRD,
)
from nullpose.solver.kernels.denominators import group_weight
from nullpose.solver.kernels.expansion import min_square
from nullpose.solver.kernels.forms import add_point, entry, in_frame
from nullpose.solver.kernels.jit import inner_kernel
from nullpose.solver.kernels.link_vectors import (
    add_shear,
    size_of,
    third_of,
    vector_jet,
)
from nullpose.solver.kernels.links import isotropic_share
from nullpose.solver.kernels.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solver.kernels.records import WORLD
from nullpose.solver.kernels.scratch import scratch
from nullpose.solver.kernels.symmetric import add_square, copy_table
from nullpose.solver.kernels.vectors import dot, row

_MOST_ETA = 0.25
_SHARE = 0.1  # of the anchor's form that may be given up where the axis hardly sees it


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
def fill_basis(family, frame, j, basis):
    """Fill the frame in which point j is seen: its own where points are turned, which is at rest only."""
    if family.turn.shape[0] > 0:
        copy_table(family.turn[j], basis)
    else:
        copy_table(frame.basis, basis)


@inner_kernel
def add_leak(family, j, has, shear, frame, centre, half, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times what leaks to a point, ``leak g I``, g being its gain over ``|r|^2``.

    It is that of its dipole if ``has`` says so, or of an isotropic point.
    """
    r, v, a, basis = scratch(3), scratch(3), scratch(3), scratch(3, 3)
    fill_basis(family, frame, j, basis)
    first, second = scratch(3, 3), scratch(6, 3)
    point = family.points_m[j]
    r[0], r[1], r[2] = in_frame(basis, (point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]))
    least = math.sqrt(min_square(family.points_m, j, centre, half))
    if has:
        v[0], v[1], v[2] = in_frame(basis, family.ground_axes[j])
        vector_jet(r, v, basis, a, first, second)
        gain = dot(a, a)
    else:
        gain = 1.0 / dot(r, r)
    weight = sign * scale * family.leak
    square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
    if has and sign < 0.0 and shear.kind == WORLD:  # beside the dipole's own null, as in ``sharpen``
        bound = size_of(second) + VECTOR_THIRD / least**4 * math.sqrt(square)
        bend = 0.5 * square * min(VECTOR_BEND / least**3, bound)
        eta = bend / math.sqrt(max(gain, 1e-300))
        if eta < 0.5 and eta * gain + bend * bend / eta < 0.5 * square * VECTOR_SQUARE_BEND / least**4:
            for m in range(3):
                matrix[m] += (1.0 - eta) * weight * gain
                rest[m] += abs(weight) * (bend * bend / eta + ROUNDING * gain)
                for i in range(3):
                    slopes[i, m] += 2.0 * (1.0 - eta) * weight * dot(a, row(first, i))
            return
    for i in range(3):
        change = 2.0 * dot(a, row(first, i)) if has else 2.0 * gain * gain * dot(r, row(basis, i))
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
        reach = 0.5 * square * VECTOR_BEND * i2 / least
        for i in range(3):
            reach += half[i] * math.sqrt(dot(row(first, i), row(first, i)))
        most = min(most, math.sqrt(gain) + reach)
    bent = 2.0 * (VECTOR_SLOPE * VECTOR_SLOPE * i2 * i2 + most * VECTOR_BEND * i2 / least) * (1.0 + e0) ** 2
    bent += 8.0 * most * VECTOR_SLOPE * i2 * e1 * (1.0 + e0)
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
    """Add ``weight L^T L``, from above; ``jamming`` is the anchor's form where that is not zero."""
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
            left, right = scratch(3), scratch(3)  # E = left right^T
            for m in range(3):
                left[m] = still[m] if shear.is_dipole else shear.first[i, m]
                right[m] = shear.first[i, m] if shear.is_dipole else still[m]
            x = q[0] * left[0] + q[3] * left[1] + q[4] * left[2]
            y = q[3] * left[0] + q[1] * left[1] + q[5] * left[2]
            z = q[4] * left[0] + q[5] * left[1] + q[2] * left[2]
            turned = (x, y, z)
            for s in range(6):
                a, b = entry(s)
                slopes[i, s] += weight * (turned[a] * right[b] + turned[b] * right[a])
        square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2]
        length = math.sqrt(dot(still, still))
        bend = length * shear.most[2] * square + (length * shear.most[0]) ** 2
        for m in range(3):
            rest[m] += abs(weight) * size * bend
    for m in range(3):
        rest[m] += 4.0 * ROUNDING * abs(weight)


@inner_kernel
def add_link(family, j, shear, frame, centre, half, v, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times the form of a point, expanded over the box, in its two parts."""
    share = isotropic_share(family.ground_leaks, j)
    for has in (False, True):
        part = scale * (1.0 - share if has else share)
        if part > 0.0:
            add_part(family, j, has, shear, frame, centre, half, v, sign, part, matrix, slopes, rest)


@inner_kernel
def add_part(family, j, has, shear, frame, centre, half, v, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times the form of point j's dipole if ``has`` says so, or of an isotropic one."""
    if family.leak > 0.0:
        add_leak(family, j, has, shear, frame, centre, half, sign, scale, matrix, slopes, rest)
    scale *= 1.0 - family.leak
    if sign < 0.0 and shear.kind != WORLD and j == frame.anchor and has == shear.is_dipole:
        add_anchor(family, shear, frame, centre, half, scale, matrix, slopes, rest)
        return
    r, w, basis = scratch(3), scratch(3), scratch(3, 3)
    fill_basis(family, frame, j, basis)
    value, first, second = scratch(3), scratch(3, 3), scratch(6, 3)
    point = family.points_m[j]
    r[0], r[1], r[2] = in_frame(basis, (point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]))
    third = third_of(shear, math.sqrt(min_square(family.points_m, j, centre, half)))
    for m in range(1 if has else 3):
        if has:
            w[0], w[1], w[2] = in_frame(basis, family.ground_axes[j])
        else:
            w[0], w[1], w[2] = 0.0, 0.0, 0.0
            w[m] = 1.0
        vector_jet(r, w, basis, value, first, second)
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
    """Add a row's sum over its box from above: value at the centre, slopes, and what may come to them."""
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
