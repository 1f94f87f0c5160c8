"""The sum of a free axis' test where points have dipoles: squares of link vectors, from above, over a box.

Proofs: "The certificate explained", "Dipoles on the ground".
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.constants import (
    ROUNDING,
    VECTOR_BEND,
    VECTOR_SLOPE,
    VECTOR_SQUARE_BEND,
    VECTOR_THIRD,
)
from nullpose.solver.kernels.bounds.expansion import min_square
from nullpose.solver.kernels.bounds.link_field import excess_end
from nullpose.solver.kernels.bounds.link_vectors import add_shear, size_of, third_of
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.bounds.records import WORLD
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import add_point, in_frame
from nullpose.solver.kernels.linear_algebra.links import isotropic_share, vector_jet
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_identity,
    add_scaled,
    add_square,
    entry,
    form_product,
    matrix_of,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot, minus, norm, row, store

_MOST_ETA = 0.25
_THIRD_AXIS = (0.0, 0.0, 1.0)  # of a frame
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
    diagonal = dot(half, half)
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
        weights[s] = abs(dot(parts[s], v)) + 1e-2 * norm(parts[s]) + tiny
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
    add_identity(far * total * ball, rest)
    if sign > 0.0:  # the square of what is linear
        total = 0.0
        for i in range(3):
            weights[i] = half[i] * (abs(dot(first[i], v)) + 1e-2 * norm(first[i])) + 1e-290
            total += weights[i]
        for i in range(3):
            add_square(near * total * half[i] * half[i] / weights[i], first[i], rest)
    add_identity(ROUNDING * scale * dot(value, value), rest)


@inner_kernel
def add_leak(family, j, has, shear, frame, centre, half, sign, scale, matrix, slopes, rest):
    """Add ``sign * scale`` times what leaks to a point, ``leak g I``, g being its gain over ``|r|^2``.

    It is that of its dipole if ``has`` says so, or of an isotropic point.
    """
    r, v, a, first, second = scratch(3), scratch(3), scratch(3), scratch(3, 3), scratch(6, 3)
    basis = family.turn[j] if family.turn.shape[0] > 0 else frame.basis
    store(in_frame(basis, minus(row(family.points_m, j), centre)), r)
    least = math.sqrt(min_square(family.points_m, j, centre, half))
    if has:
        store(in_frame(basis, family.ground_axes[j]), v)
        vector_jet(r, v, basis, a, first, second)
        gain = dot(a, a)
    else:
        gain = 1.0 / dot(r, r)
    weight = sign * scale * family.leak
    square = dot(half, half)
    if has and sign < 0.0 and shear.kind == WORLD:  # beside the dipole's own null, as in ``sharpen``
        bound = size_of(second) + VECTOR_THIRD / least**4 * math.sqrt(square)
        bend = 0.5 * square * min(VECTOR_BEND / least**3, bound)
        eta = bend / math.sqrt(max(gain, 1e-300))
        if eta < 0.5 and eta * gain + bend * bend / eta < 0.5 * square * VECTOR_SQUARE_BEND / least**4:
            add_identity((1.0 - eta) * weight * gain, matrix)
            add_identity(abs(weight) * (bend * bend / eta + ROUNDING * gain), rest)
            for i in range(3):
                add_identity(2.0 * (1.0 - eta) * weight * dot(a, first[i]), slopes[i])
            return
    for i in range(3):
        change = 2.0 * dot(a, first[i]) if has else 2.0 * gain * gain * dot(r, basis[i])
        add_identity(weight * change, slopes[i])
    add_turned_slopes(shear, weight * gain, slopes)
    e0, e1, e2 = shear.most[0], shear.most[1], shear.most[2]
    i2 = 1.0 / (least * least)
    most = 1.0 / least
    if has:
        reach = 0.5 * square * VECTOR_BEND * i2 / least
        for i in range(3):
            reach += half[i] * norm(first[i])
        most = min(most, math.sqrt(gain) + reach)
    bent = 2.0 * (VECTOR_SLOPE * VECTOR_SLOPE * i2 * i2 + most * VECTOR_BEND * i2 / least) * (1.0 + e0) ** 2
    bent += 8.0 * most * VECTOR_SLOPE * i2 * e1 * (1.0 + e0)
    bent += 2.0 * most * most * (e2 * (1.0 + e0) + e1 * e1)
    add_identity(weight * gain, matrix)
    add_identity(abs(weight) * (0.5 * square * bent + ROUNDING * gain), rest)


@inner_kernel
def add_turned_slopes(shear, weight, slopes):
    """Add ``weight`` times the slopes of ``L^T L``."""
    if shear.kind == WORLD:
        return
    for i in range(3):
        x, y, z = row(shear.first, i)
        slopes[i, 2] += 2.0 * weight * z
        slopes[i, 4] += weight * x
        slopes[i, 5] += weight * y


@inner_kernel
def add_turned_identity(shear, half, weight, jamming, v, matrix, slopes, rest):
    """Add ``weight L^T L``, from above; ``jamming`` is the anchor's form where that is not zero."""
    add_identity(weight, matrix)
    add_turned_slopes(shear, weight, slopes)
    if shear.kind == WORLD:
        return
    add_identity(max(0.0, weight) * shear.most[0] ** 2, rest)
    # twice the product of the part along the anchor's form with the other one
    bend = abs(weight) * 0.5 * dot(half, half) * shear.most[2]
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
    add_scaled(weight, q, matrix)
    if shear.kind != WORLD:
        turned = scratch(3, 3)
        matrix_of(q, turned)
        for i in range(3):
            w = row(shear.first, i)
            left, right = (_THIRD_AXIS, w) if shear.is_dipole else (w, _THIRD_AXIS)  # E is their product
            seen = dot(turned[0], left), dot(turned[1], left), dot(turned[2], left)
            for s in range(6):
                a, b = entry(s)
                slopes[i, s] += weight * (seen[a] * right[b] + seen[b] * right[a])
        bend = shear.most[2] * dot(half, half) + shear.most[0] ** 2
        add_identity(abs(weight) * math.sqrt(form_product(q, q)) * bend, rest)
    add_identity(4.0 * ROUNDING * abs(weight), rest)


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
    r, w, value, first, second = scratch(3), scratch(3), scratch(3), scratch(3, 3), scratch(6, 3)
    basis = family.turn[j] if family.turn.shape[0] > 0 else frame.basis
    store(in_frame(basis, minus(row(family.points_m, j), centre)), r)
    third = third_of(shear, math.sqrt(min_square(family.points_m, j, centre, half)))
    for m in range(1 if has else 3):
        if has:
            store(in_frame(basis, family.ground_axes[j]), w)
        else:
            w[:] = 0.0
            w[m] = 1.0
        vector_jet(r, w, basis, value, first, second)
        add_shear(shear, value, first, second)
        add_vector(shear, v, half, third, sign, scale, (value, first, second), matrix, slopes, rest)


@inner_kernel
def add_anchor(family, shear, frame, centre, half, scale, matrix, slopes, rest):
    """Add minus the form of the point that the shear turns with, from above."""
    if shear.is_dipole:
        matrix[2] -= scale * shear.square * (1.0 - ROUNDING)
        return
    i2, square = shear.square, dot(half, half)
    beyond = 1.0 / min_square(family.points_m, frame.anchor, centre, half) ** 2
    for m in range(2):
        matrix[m] -= scale * i2
        rest[m] += scale * (2.0 * square * beyond + ROUNDING * i2)
        for i in range(3):
            slopes[i, m] -= scale * 2.0 * frame.basis[i, 2] * i2 / frame.radius_m


@inner_kernel
def centre_form(family, frame, row, identity, sums, matrix):
    """Add a row's sum at its box's centre."""
    add_identity(identity, matrix)
    for j in range(sums.shape[0]):
        if sums[j] != 0.0:
            add_point(family, j, row[CENTRE:HALF], frame.basis, sums[j], 0.0, matrix)


@inner_kernel
def add_links(family, shear, frame, row, identity, sums, v, matrix, slopes, rest):
    """Add a row's sum over its box from above: value at the centre, slopes, and what may come to them."""
    centre, half, jamming = row[CENTRE:HALF], row[HALF:LEVEL], 0.0
    for j in range(sums.shape[0]):
        if sums[j] != 0.0:
            sign = math.copysign(1.0, sums[j])
            strength = abs(sums[j]) * excess_end(family, j, sign > 0.0, centre, half)
            if sign < 0.0 and j == frame.anchor:
                jamming = (1.0 - family.leak) * strength * shear.square
            add_link(family, j, shear, frame, centre, half, v, sign, strength, matrix, slopes, rest)
    add_turned_identity(shear, half, identity, jamming, v, matrix, slopes, rest)
