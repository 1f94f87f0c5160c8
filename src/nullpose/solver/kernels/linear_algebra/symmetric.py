"""Small dense algebra: vectors, symmetric 3x3 forms as (xx, yy, zz, xy, xz, yz), systems of a dozen rows."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.vectors import cross, dot, perpendicular, store, unit

_SWEEPS = 30
PLACE = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])  # where an entry of the matrix stands in the form


@inner_kernel
def entry(k):
    """Return the row and the column of number k of a form."""
    if k < 3:
        return k, k
    return (0 if k < 5 else 1), (1 if k == 3 else 2)


@inner_kernel
def copy_into(source, target):
    """Overwrite a vector with another."""
    for i in range(source.shape[0]):
        target[i] = source[i]


@inner_kernel
def copy_table(source, target):
    """Overwrite a table with another."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            target[i, j] = source[i, j]


@inner_kernel
def add_scaled(factor, source, target):
    """Add a multiple of a vector to another."""
    for i in range(source.shape[0]):
        target[i] += factor * source[i]


@inner_kernel
def add_identity(factor, form):
    """Add a multiple of the identity to a form."""
    for i in range(3):
        form[i] += factor


@inner_kernel
def fill_identity(matrix):
    """Fill the unit matrix of three rows."""
    for i in range(3):
        for j in range(3):
            matrix[i, j] = 1.0 if i == j else 0.0


@inner_kernel
def smallest_of(values):
    """Return the smallest of some numbers."""
    smallest = values[0]
    for i in range(1, values.shape[0]):
        smallest = min(smallest, values[i])
    return smallest


@inner_kernel
def inner(x, y, n):
    """Return the sum of the first n products."""
    total = 0.0
    for i in range(n):
        total += x[i] * y[i]
    return total


@inner_kernel
def squared_distance(p, q):
    """Return ``|p - q|^2`` of vectors of three."""
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2


@inner_kernel
def normalise(v):
    """Bring a vector of three to unit length."""
    store(unit(v), v)


@kernel
def tangents(u, a, b):
    """Fill two unit vectors that make an orthogonal frame with the unit vector ``u``."""
    store(unit(perpendicular(u)), a)
    store(cross(u, a), b)


@inner_kernel
def matrix_of(form, matrix):
    """Fill the 3x3 matrix of a form."""
    for i in range(3):
        for j in range(3):
            matrix[i, j] = form[PLACE[i, j]]


@inner_kernel
def form_product(a, b):
    """Return the trace of the product of two forms."""
    return dot(a, b) + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])


@inner_kernel
def add_square(factor, v, form):
    """Add a multiple of ``v v^T`` to a form."""
    for i in range(3):
        for j in range(i, 3):
            form[PLACE[i, j]] += factor * v[i] * v[j]


@inner_kernel
def adjugate(a, out):
    """Fill the adjugate of a form; return the determinant, by which it must be divided for the inverse."""
    out[0] = a[1] * a[2] - a[5] * a[5]
    out[1] = a[0] * a[2] - a[4] * a[4]
    out[2] = a[0] * a[1] - a[3] * a[3]
    out[3] = a[4] * a[5] - a[3] * a[2]
    out[4] = a[3] * a[5] - a[4] * a[1]
    out[5] = a[3] * a[4] - a[0] * a[5]
    return a[0] * out[0] + a[3] * out[3] + a[4] * out[4]


@kernel
def largest_eigenvalue(a):
    """Return the largest eigenvalue of a form, in closed form, and how far apart the three are."""
    mean = (a[0] + a[1] + a[2]) / 3.0
    off = a[3] * a[3] + a[4] * a[4] + a[5] * a[5]
    x, y, z = a[0] - mean, a[1] - mean, a[2] - mean
    spread = math.sqrt((x * x + y * y + z * z + 2.0 * off) / 6.0)
    if spread == 0.0:
        return mean, spread
    det = x * (y * z - a[5] * a[5]) - a[3] * (a[3] * z - a[5] * a[4]) + a[4] * (a[3] * a[5] - y * a[4])
    cosine = max(-1.0, min(1.0, det / (2.0 * spread * spread * spread)))
    return mean + 2.0 * spread * math.cos(math.acos(cosine) / 3.0), spread


@inner_kernel
def longest_row(a, v):
    """Fill the row of a semidefinite form that has the largest entry on the diagonal: the longest, nearly."""
    lead = 0
    for i in range(1, 3):
        if abs(a[i]) > abs(a[lead]):
            lead = i
    for i in range(3):
        v[i] = a[PLACE[lead, i]]


@kernel
def top_eigenvector(a, v):
    """Fill the eigenvector of the largest eigenvalue of a form; return that eigenvalue (closed form)."""
    top, spread = largest_eigenvalue(a)
    v[0], v[1], v[2] = 0.0, 0.0, 1.0
    if spread == 0.0:
        return top
    shifted, other = scratch(6), scratch(6)
    copy_into(a, shifted)
    for i in range(3):
        shifted[i] -= top
    adjugate(shifted, other)  # v v^T, up to a factor
    longest_row(other, v)
    if not dot(v, v) > 1e-12 * spread**4:  # a double eigenvalue: any vector across the one row will do
        longest_row(shifted, other[:3])
        normalise(other[:3])
        tangents(other[:3], v, shifted)
    normalise(v)
    return top


@inner_kernel
def rotated(x, y, c, s):
    """Return a pair of numbers rotated by an angle of which cosine and sine are given."""
    return c * x - s * y, s * x + c * y


@kernel
def eigen3(matrix, values, vectors):
    """Fill the eigenvalues, descending, and the eigenvectors (columns) of a symmetric 3x3 matrix.

    Cyclic Jacobi: slower than the closed form and accurate where that one is not, at close eigenvalues.
    """
    a = scratch(3, 3)
    copy_table(matrix, a)
    fill_identity(vectors)
    for _ in range(_SWEEPS):
        off = a[0, 1] ** 2 + a[0, 2] ** 2 + a[1, 2] ** 2
        if off <= 1e-36 * (a[0, 0] ** 2 + a[1, 1] ** 2 + a[2, 2] ** 2) or off == 0.0:
            break
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if a[p, q] == 0.0:
                continue
            theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
            t = math.copysign(1.0, theta) / (abs(theta) + math.sqrt(theta * theta + 1.0))
            c = 1.0 / math.sqrt(t * t + 1.0)
            for k in range(3):
                a[k, p], a[k, q] = rotated(a[k, p], a[k, q], c, t * c)
            for k in range(3):
                a[p, k], a[q, k] = rotated(a[p, k], a[q, k], c, t * c)
                vectors[k, p], vectors[k, q] = rotated(vectors[k, p], vectors[k, q], c, t * c)
    for i in range(3):
        values[i] = a[i, i]
    for i, j in ((0, 1), (1, 2), (0, 1)):
        if values[j] > values[i]:
            values[i], values[j] = values[j], values[i]
            for k in range(3):
                vectors[k, i], vectors[k, j] = vectors[k, j], vectors[k, i]


@kernel
def cholesky_factor(a, n):
    """Overwrite the lower triangle of ``a[:n, :n]`` with its Cholesky factor; return whether it exists."""
    for j in range(n):
        d = a[j, j] - inner(a[j], a[j], j)
        if not d > 0.0:
            return False
        a[j, j] = math.sqrt(d)
        for i in range(j + 1, n):
            a[i, j] = (a[i, j] - inner(a[i], a[j], j)) / a[j, j]
    return True


@kernel
def cholesky_solve(factor, n, x):
    """Overwrite ``x[:n]`` with the solution of ``L L^T y = x``."""
    for i in range(n):
        x[i] = (x[i] - inner(factor[i], x, i)) / factor[i, i]
    for i in range(n - 1, -1, -1):
        x[i] /= factor[i, i]
        for k in range(i):
            x[k] -= factor[i, k] * x[i]


@kernel
def gauss_solve(a, b, n):
    """Overwrite ``b[:n]`` with the solution of ``a y = b`` (partial pivoting); return False if singular."""
    scale = 0.0
    for i in range(n):
        for j in range(n):
            scale = max(scale, abs(a[i, j]))
    for j in range(n):
        pivot = j
        for i in range(j + 1, n):
            if abs(a[i, j]) > abs(a[pivot, j]):
                pivot = i
        if not abs(a[pivot, j]) > 1e-13 * scale:
            return False
        if pivot != j:
            for k in range(j, n):
                a[j, k], a[pivot, k] = a[pivot, k], a[j, k]
            b[j], b[pivot] = b[pivot], b[j]
        for i in range(j + 1, n):
            factor = a[i, j] / a[j, j]
            for k in range(j, n):
                a[i, k] -= factor * a[j, k]
            b[i] -= factor * b[j]
    for i in range(n - 1, -1, -1):
        b[i] = (b[i] - inner(a[i, i + 1 : n], b[i + 1 : n], n - 1 - i)) / a[i, i]
    return math.isfinite(inner(b, b, n))
