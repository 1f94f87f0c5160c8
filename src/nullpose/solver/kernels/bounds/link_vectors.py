"""Link vectors over a box, to the second order, in coordinates of the axis that may turn.

A point with a dipole along v has the form ``a a^T`` with ``a = (|r|^2 v - (v.r) r) / |r|^3``, and an
isotropic one the sum of three such forms, of three v across each other. Vectors are expanded in place of
forms: value, first and second derivative at the box's centre, and a bound on the third over the box. The
coordinates u' of the axis, ``u = L(p) u'``, may turn with the direction of one point's null. With ``L = I -
a0 w^T``, ``w = (a - a0) / (a.a0)``, the form of a dipole stays ``a0 a0^T`` all over the box; with ``L = I + w
d0^T``, ``w = d / (d.d0) - d0``, an isotropic point has no term along d0. Proofs: "The certificate explained",
"Dipoles on the ground".
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.solver.kernels.bounds.constants import DIRECTION_THIRD, VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.solver.kernels.bounds.expansion import min_square
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import entry, in_frame
from nullpose.solver.kernels.linear_algebra.links import isotropic_share
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled
from nullpose.solver.kernels.linear_algebra.vectors import dot, minus, norm, row, store

_UPRIGHT = 0.4  # of the anchor's vector along its value at the centre: what must be left all over the box

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
        total += (2.0 if s >= 3 else 1.0) * dot(vectors[s], vectors[s])
    return math.sqrt(total)


@inner_kernel
def reach_along(vectors, v, half):
    """Bound the products of v with derivatives over a box."""
    total = 0.0
    for i in range(3):
        total += abs(dot(vectors[i], v)) * half[i]
    return total


@inner_kernel
def dipole_shear(family, j, centre, half, frame, shear):
    """Fill the shear of a point with a dipole; return whether its vector keeps its direction well enough."""
    r, v, a = scratch(3), scratch(3), scratch(3)
    store(in_frame(frame.basis, minus(row(family.points_m, j), centre)), r)
    store(in_frame(frame.basis, family.ground_axes[j]), v)
    first, second, most = shear.first, shear.second, shear.most
    vector_jet(r, v, frame.basis, a, first, second)
    least = math.sqrt(min_square(family.points_m, j, centre, half))
    diagonal = norm(half)
    square, length = dot(a, a), norm(a)
    a3 = VECTOR_THIRD / least**4
    a2 = min(VECTOR_BEND / least**3, size_of(second) + a3 * diagonal)
    a1 = min(VECTOR_SLOPE / least**2, size_of(first) + a2 * diagonal)
    bend = 0.5 * a2 * diagonal * diagonal
    y = square - reach_along(first, a, half) - length * bend
    if not y > _UPRIGHT * square:
        return False
    g = bend
    for i in range(3):
        g += half[i] * norm(first[i])
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
        by_i, by_k = dot(first[i], a), dot(first[k], a)
        for m in range(3):
            second[s, m] = (second[s, m] - (first[i, m] * by_k + first[k, m] * by_i) / square) / square
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
    diagonal = norm(half) / y
    most[0] = diagonal
    most[1] = math.sqrt(1.0 + diagonal * diagonal) / y
    most[2] = (1.0 + 2.0 * diagonal) / (y * y)
    most[3] = (DIRECTION_THIRD + 6.0 * diagonal) / (y * y * y)
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
    has = isotropic_share(family.ground_leaks, j) < 1.0
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
            by_i, by_k = dot(first[i], still), dot(first[k], still)
            for m in range(3):
                more = by_i * shear.first[k, m] + by_k * shear.first[i, m]
                second[s, m] += more + whole * shear.second[s, m]
        for i in range(3):
            add_scaled(whole, shear.first[i], first[i])
        return
    for s in range(6):
        i, k = entry(s)
        more = dot(first[i], shear.first[k]) + dot(first[k], shear.first[i])
        more += dot(value, shear.second[s])
        add_scaled(more, still, second[s])
    for i in range(3):
        add_scaled(dot(value, shear.first[i]), still, first[i])


@inner_kernel
def third_of(shear, least):
    """Return a bound on the third derivative of ``L^T a`` in the box."""
    i1 = 1.0 / least
    i2 = i1 * i1
    third = VECTOR_THIRD * i2 * i2
    if shear.kind == WORLD:
        return third
    most, size = shear.most, norm(shear.still)
    more = VECTOR_THIRD * i2 * i2 * most[0] + 3.0 * VECTOR_BEND * i2 * i1 * most[1]
    more += 3.0 * VECTOR_SLOPE * i2 * most[2] + i1 * most[3]
    return third + size * more
