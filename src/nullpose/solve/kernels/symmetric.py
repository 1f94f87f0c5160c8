"""Small dense symmetric matrices: eigenvectors of 3x3 and Cholesky solves of up to a dozen rows."""

from __future__ import annotations

import math

from nullpose.solve.kernels.jit import inner_kernel, kernel
from nullpose.solve.kernels.scratch import scratch

__all__ = [
    "cholesky_factor",
    "cholesky_solve",
    "copy_into",
    "copy_table",
    "eigen3",
    "gauss_solve",
    "tangents",
]

_SWEEPS = 30


@kernel
def eigen3(matrix, values, vectors):
    """Fill the eigenvalues, descending, and the eigenvectors (columns) of a symmetric 3x3 matrix.

    Cyclic Jacobi: slower than the closed form and accurate where that one is not, at close eigenvalues.
    """
    a = scratch(3, 3)
    copy_table(matrix, a)
    for i in range(3):
        for j in range(3):
            vectors[i, j] = 1.0 if i == j else 0.0
    for _ in range(_SWEEPS):
        off = a[0, 1] ** 2 + a[0, 2] ** 2 + a[1, 2] ** 2
        diagonal = a[0, 0] ** 2 + a[1, 1] ** 2 + a[2, 2] ** 2
        if off <= 1e-36 * diagonal or off == 0.0:
            break
        for p in range(2):
            for q in range(p + 1, 3):
                if a[p, q] == 0.0:
                    continue
                theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
                t = 1.0 / (abs(theta) + math.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / math.sqrt(t * t + 1.0)
                s = t * c
                for k in range(3):
                    akp, akq = a[k, p], a[k, q]
                    a[k, p] = c * akp - s * akq
                    a[k, q] = s * akp + c * akq
                for k in range(3):
                    apk, aqk = a[p, k], a[q, k]
                    a[p, k] = c * apk - s * aqk
                    a[q, k] = s * apk + c * aqk
                for k in range(3):
                    vkp, vkq = vectors[k, p], vectors[k, q]
                    vectors[k, p] = c * vkp - s * vkq
                    vectors[k, q] = s * vkp + c * vkq
    for i in range(3):
        values[i] = a[i, i]
    for i in range(2):
        top = i
        for j in range(i + 1, 3):
            if values[j] > values[top]:
                top = j
        if top != i:
            values[i], values[top] = values[top], values[i]
            for k in range(3):
                vectors[k, i], vectors[k, top] = vectors[k, top], vectors[k, i]


@kernel
def cholesky_factor(a, n):
    """Overwrite the lower triangle of ``a[:n, :n]`` with its Cholesky factor; return whether it exists."""
    for j in range(n):
        d = a[j, j]
        for k in range(j):
            d -= a[j, k] * a[j, k]
        if not d > 0.0:
            return False
        d = math.sqrt(d)
        a[j, j] = d
        for i in range(j + 1, n):
            s = a[i, j]
            for k in range(j):
                s -= a[i, k] * a[j, k]
            a[i, j] = s / d
    return True


@kernel
def cholesky_solve(factor, n, x):
    """Overwrite ``x[:n]`` with the solution of ``L L^T y = x``."""
    for i in range(n):
        s = x[i]
        for k in range(i):
            s -= factor[i, k] * x[k]
        x[i] = s / factor[i, i]
    for i in range(n - 1, -1, -1):
        s = x[i]
        for k in range(i + 1, n):
            s -= factor[k, i] * x[k]
        x[i] = s / factor[i, i]


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
            for k in range(n):
                a[j, k], a[pivot, k] = a[pivot, k], a[j, k]
            b[j], b[pivot] = b[pivot], b[j]
        for i in range(j + 1, n):
            m = a[i, j] / a[j, j]
            if m != 0.0:
                for k in range(j, n):
                    a[i, k] -= m * a[j, k]
                b[i] -= m * b[j]
    for i in range(n - 1, -1, -1):
        s = b[i]
        for k in range(i + 1, n):
            s -= a[i, k] * b[k]
        b[i] = s / a[i, i]
    finite = True
    for i in range(n):
        finite = finite and math.isfinite(b[i])
    return finite


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


@kernel
def tangents(u, a, b):
    """Fill two unit vectors that make an orthogonal frame with the unit vector ``u``."""
    least = 0
    for i in range(1, 3):
        if abs(u[i]) < abs(u[least]):
            least = i
    # a = u x e_least, normalised; b = u x a
    i, j = (least + 1) % 3, (least + 2) % 3
    norm = math.sqrt(u[i] * u[i] + u[j] * u[j])
    a[least], a[i], a[j] = 0.0, u[j] / norm, -u[i] / norm
    b[0] = u[1] * a[2] - u[2] * a[1]
    b[1] = u[2] * a[0] - u[0] * a[2]
    b[2] = u[0] * a[1] - u[1] * a[0]
