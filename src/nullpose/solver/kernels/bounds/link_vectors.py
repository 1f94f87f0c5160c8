"""Link vectors over a box, to the second order, in coordinates of the axis that may turn.

A point with a dipole along v has the form ``a a^T`` with ``a = (|r|^2 v - (v.r) r) / |r|^3``, and an
isotropic one the sum of three such forms, of three v across each other. Vectors are expanded in place of
forms: value, first and second derivative at the box's centre, and a bound on the third over the box. The
coordinates u' of the axis, ``u = L(p) u'``, may turn with the direction d of one point's null. With ``L = I +
d0 w^T``, ``w = (a0 - a) / (a.d0)``, the form of a dipole stays ``a0 a0^T`` all over the box; with ``L = I + w
d0^T``, ``w = d / (d.d0) - d0``, an isotropic point has no term along d0. Proofs: "The certificate explained",
"Dipoles on the ground".
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.bounds.constants import DIRECTION_THIRD, VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import in_frame
from nullpose.solver.kernels.linear_algebra.links import isotropic_share, vector_jet
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, entry
from nullpose.solver.kernels.linear_algebra.vectors import dot, minus, norm, row, scaled, store

_UPRIGHT = 0.4  # of the anchor's vector along its value at the centre: what must be left all over the box


class Shear(NamedTuple):
    """Coordinates of the axis that turn with a point: ``L = I + E``, E being ``d0 w^T`` or ``w d0^T``.

    d0 is the third axis of the frame, along the point's link vector or on the way to it.

    Args:
        kind: WORLD, where E is zero, or TOWARDS_POINT.
        is_dipole: whether the point has one; E is ``d0 w^T`` then.
        square: the largest eigenvalue of the point's form at the centre.
        first: (3, 3) the derivatives of w along the world's axes, at the centre.
        second: (6, 3) its second derivatives.
        most: (4,) bounds on w and on its first three derivatives along any unit direction, in the box; zero
            where E is.
    """

    kind: int
    is_dipole: bool
    square: float
    first: FloatArray
    second: FloatArray
    most: FloatArray


@inner_kernel
def size_of(vectors):
    """Return the root of the sum of the squares of a symmetric table of vectors, (3, 3) or (6, 3)."""
    total = 0.0
    for s in range(vectors.shape[0]):
        total += (2.0 if s >= 3 else 1.0) * dot(vectors[s], vectors[s])
    return math.sqrt(total)


@inner_kernel
def anchor_vector(family, frame, has, centre, half, first, second):
    """Fill the derivatives of a at the centre; return its length there, and bounds on three in the box.

    That is the link vector of the dipole of the frame's point if ``has`` says so, or the way to it.
    """
    if not has:
        second[:, :] = 0.0
        for i in range(3):
            store(scaled(-1.0, row(frame.basis, i)), first[i])
        return frame.radius_m, 1.0, 0.0, 0.0
    r, v, a, diagonal, least = scratch(3), scratch(3), scratch(3), norm(half), frame.least_radius_m
    store(in_frame(frame.basis, minus(row(family.points_m, frame.anchor), centre)), r)
    store(in_frame(frame.basis, family.ground_axes[frame.anchor]), v)
    vector_jet(r, v, frame.basis, a, first, second)
    third = VECTOR_THIRD / least**4
    bend = min(VECTOR_BEND / least**3, size_of(second) + third * diagonal)
    return norm(a), min(VECTOR_SLOPE / least**2, size_of(first) + bend * diagonal), bend, third


@inner_kernel
def shear_at(family, frame, centre, half, shear):
    """Fill the shear of a frame; return it, or none if the anchor's direction changes too much in the box."""
    if frame.kind == WORLD:
        return shear
    first, second, most, diagonal = shear.first, shear.second, shear.most, norm(half)
    has = isotropic_share(family.ground_leaks, frame.anchor) < 1.0
    length, slope, bend, third = anchor_vector(family, frame, has, centre, half, first, second)
    moved = 0.5 * bend * diagonal * diagonal
    y = length - moved  # a along the third axis, at least
    for i in range(3):
        moved += half[i] * norm(first[i])
        y -= half[i] * abs(first[i, 2])
    fine = y > _UPRIGHT * length
    if fine:
        lean, rate = min(moved, slope * diagonal) / y, slope / y
        of_way = math.hypot(1.0, lean), 1.0, DIRECTION_THIRD
        grown, twice, thrice = (1.0 + lean, 2.0, 6.0) if has else of_way
        most[0], most[1] = lean, grown * rate
        most[2] = grown * bend / y + (twice + 2.0 * lean) * rate**2
        most[3] = grown * (third + 6.0 * bend * rate) / y + (thrice + 6.0 * lean) * rate**3
        sign = (-1.0 if has else 1.0) / length
        for s in range(6):
            i, k = entry(s)
            for m in range(3 if has else 2):  # the way's part along itself is not of the shear
                bent = first[i, m] * first[k, 2] + first[k, m] * first[i, 2]
                second[s, m] = sign * (second[s, m] - bent / length)
        for i in range(3):
            for m in range(3):
                first[i, m] *= sign if has or m < 2 else 0.0
    square = length * length if has else 1.0 / (length * length)
    return Shear(np.int64(TOWARDS_POINT if fine else WORLD), has, square, first, second, most)


@inner_kernel
def add_shear(shear, value, first, second):
    """Turn a link vector's jet into that of ``L^T a``."""
    if shear.kind == WORLD:
        return
    for s in range(6):
        i, k = entry(s)
        if shear.is_dipole:
            for m in range(3):
                second[s, m] += first[i, 2] * shear.first[k, m] + first[k, 2] * shear.first[i, m]
                second[s, m] += value[2] * shear.second[s, m]
        else:
            second[s, 2] += dot(first[i], shear.first[k]) + dot(first[k], shear.first[i])
            second[s, 2] += dot(value, shear.second[s])
    for i in range(3):
        if shear.is_dipole:
            add_scaled(value[2], shear.first[i], first[i])
        else:
            first[i, 2] += dot(value, shear.first[i])


@inner_kernel
def third_of(shear, least):
    """Return a bound on the third derivative of ``L^T a`` in the box."""
    most, i1 = shear.most, 1.0 / least
    i2 = i1 * i1
    third = VECTOR_THIRD * i2 * i2 * (1.0 + most[0]) + 3.0 * VECTOR_BEND * i2 * i1 * most[1]
    return third + 3.0 * VECTOR_SLOPE * i2 * most[2] + i1 * most[3]
