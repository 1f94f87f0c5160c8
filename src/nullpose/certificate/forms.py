"""Symmetric forms of three coordinates as six numbers each, along the first axis of an array."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.interval import FloatArray, Interval, stack

IDENTITY = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
ROW, COLUMN = np.array([0, 1, 2, 0, 0, 1]), np.array([0, 1, 2, 1, 2, 2])
"""Row and column of each of the six."""

# Where among the six a row and a column are.
PLACE = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])

# How often each of the six is in the matrix.
COUNTED = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


def squares(x: Interval) -> Interval:
    """Return ``x x^T`` of vectors along the first axis; what is squared is never below zero."""
    return stack([x[i].squared() if i == j else x[i] * x[j] for i, j in zip(ROW, COLUMN, strict=True)])


def outer(x: Interval, y: Interval) -> Interval:
    """Return ``x y^T + y x^T`` of vectors along the first axis."""
    return x[ROW] * y[COLUMN] + x[COLUMN] * y[ROW]


def matrices(form: FloatArray) -> FloatArray:
    """Return forms, (6, b), as matrices, (b, 3, 3)."""
    return np.moveaxis(form[PLACE], -1, 0)


def quadratic(form: FloatArray, vector: FloatArray) -> FloatArray:
    """Return ``v^T Q v``; both have their components along the first axis."""
    counted = (form.T * COUNTED).T
    return np.asarray(np.sum(counted * vector[ROW] * vector[COLUMN], axis=0))


def adjugate(a: Interval) -> Interval:
    """Return the adjugates of forms, (6, b): inverses times determinants."""
    diagonal = [a[1] * a[2] - a[5].squared(), a[0] * a[2] - a[4].squared(), a[0] * a[1] - a[3].squared()]
    rest = [a[4] * a[5] - a[2] * a[3], a[3] * a[5] - a[1] * a[4], a[3] * a[4] - a[0] * a[5]]
    return stack(diagonal + rest)


def definite(a: Interval) -> tuple[np.ndarray, np.ndarray, Interval]:
    """Return whether leading blocks of two and of three rows are positive definite for certain, and det.

    Args:
        a: the forms, (6, b).
    """
    minor = a[0] * a[1] - a[3].squared()
    det = a[2] * minor - a[0] * a[5].squared() - a[1] * a[4].squared() + a[3] * a[4] * a[5] * 2.0
    block = (a[0].low > 0.0) & (minor.low > 0.0)
    return block, block & (det.low > 0.0), det
