"""Vectors of three numbers as tuples: they need no memory, and formulas read as they do on paper."""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import small_kernel


@small_kernel
def row(matrix, i):
    """Return row i of an (n, 3) array."""
    return matrix[i, 0], matrix[i, 1], matrix[i, 2]


@small_kernel
def rows(matrix):
    """Return the rows of an array (3, 3)."""
    return row(matrix, 0), row(matrix, 1), row(matrix, 2)


@small_kernel
def store(a, out):
    """Fill an array (3,)."""
    out[0], out[1], out[2] = a


@small_kernel
def dot(a, b):
    """Return ``a . b``."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@small_kernel
def norm(a):
    """Return ``|a|``."""
    return math.sqrt(dot(a, a))


@small_kernel
def scaled(s, a):
    """Return ``s a``."""
    return s * a[0], s * a[1], s * a[2]


@small_kernel
def over(a, s):
    """Return ``a / s``."""
    return a[0] / s, a[1] / s, a[2] / s


@small_kernel
def minus(a, b):
    """Return ``a - b``."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@small_kernel
def along(a, s, b):
    """Return ``a + s b``."""
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


@small_kernel
def times(a, b):
    """Return the products of the components."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]


@small_kernel
def cross(a, b):
    """Return ``a x b``."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@small_kernel
def unit(a):
    """Return ``a / |a|``."""
    return over(a, norm(a))


@small_kernel
def perpendicular(a):
    """Return a vector across a, not much shorter."""
    x, y, z = abs(a[0]), abs(a[1]), abs(a[2])
    if x <= y and x <= z:
        return 0.0, a[2], -a[1]
    if y <= z:
        return -a[2], 0.0, a[0]
    return a[1], -a[0], 0.0


@small_kernel
def components(frame, a):
    """Return the components of a along three unit vectors."""
    return dot(frame[0], a), dot(frame[1], a), dot(frame[2], a)


@small_kernel
def combination(frame, a):
    """Return the vector with such components along three vectors."""
    return along(along(scaled(a[0], frame[0]), a[1], frame[1]), a[2], frame[2])


@small_kernel
def signs(corner):
    """Return on which sides of three coordinates a corner of a box lies."""
    return 1.0 if corner & 1 else -1.0, 1.0 if corner & 2 else -1.0, 1.0 if corner & 4 else -1.0


@small_kernel
def corner_of(centre, half, corner):
    """Return a corner of a box."""
    x, y, z = signs(corner)
    return centre[0] + x * half[0], centre[1] + y * half[1], centre[2] + z * half[2]


@small_kernel
def square_range(point, centre, half, axes):
    """Bound the squared distances from a point to a box along the first axes: the least and the largest."""
    least = most = 0.0
    for i in range(axes):
        away = abs(point[i] - centre[i])
        least += max(0.0, away - half[i]) ** 2
        most += (away + half[i]) ** 2
    return least, most


@small_kernel
def fill_affine(offset, matrix, p, out):
    """Fill ``o + M p``."""
    for m in range(3):
        out[m] = offset[m] + matrix[m, 0] * p[0] + matrix[m, 1] * p[1] + matrix[m, 2] * p[2]
