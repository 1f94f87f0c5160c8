"""Symmetric forms of three coordinates, six numbers each along the first axis, and their definiteness."""

from __future__ import annotations

from itertools import product

import numpy as np

from nullpose.certificate.interval import Interval, dot, stack
from nullpose.certificate.taylor import pairs
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray

IDENTITY = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
IDENTITIES = IDENTITY[:, None]
"""The same for any number of boxes."""
ROW, COLUMN, PLACE = pairs(3)
"""Row and column of each of the six, and, (3, 3), where among the six a row and a column are."""

NEXT, LAST = [1, 2, 0], [2, 0, 1]
"""The two axes other than each."""

# How often each of the six is in the matrix.
COUNTED = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


def squares(x: Interval) -> Interval:
    """Return ``x x^T`` of vectors along the first axis; what is squared is never below zero."""
    products = x[ROW] * x[COLUMN]
    return Interval(np.concatenate([np.maximum(products.low[:3], 0.0), products.low[3:]]), products.high)


def outer(x: Interval, y: Interval) -> Interval:
    """Return ``x y^T + y x^T`` of vectors along the first axis."""
    return x[ROW] * y[COLUMN] + x[COLUMN] * y[ROW]


def matrices(form: FloatArray) -> FloatArray:
    """Return forms, (6, b), as matrices, (b, 3, 3)."""
    return np.moveaxis(form[PLACE], -1, 0)


def quadratic(form: FloatArray, vector: FloatArray) -> FloatArray:
    """Return ``v^T Q v``; both have their components along the first axis."""
    return np.asarray(np.sum((form.T * COUNTED).T * vector[ROW] * vector[COLUMN], axis=0))


def adjugate(a: Interval) -> Interval:
    """Return the adjugates of forms, (6, b): inverses times determinants."""
    diagonal = [a[1] * a[2] - a[5].squared(), a[0] * a[2] - a[4].squared(), a[0] * a[1] - a[3].squared()]
    rest = [a[4] * a[5] - a[2] * a[3], a[3] * a[5] - a[1] * a[4], a[3] * a[4] - a[0] * a[5]]
    return stack(diagonal + rest)


def definite(a: Interval) -> tuple[np.ndarray, np.ndarray, Interval]:
    """Check leading blocks of two and of three rows for being positive definite; and the determinants.

    Args:
        a: the forms, (6, b).
    """
    minor = a[0] * a[1] - a[3].squared()
    det = a[2] * minor - a[0] * a[5].squared() - a[1] * a[4].squared() + a[3] * a[4] * a[5] * 2.0
    block = (a[0].low > 0.0) & (minor.low > 0.0)
    return block, block & (det.low > 0.0), det


def congruence(q: Interval, basis: Interval) -> tuple[Interval, Interval]:
    """Return ``basis^T Q basis`` of forms, (6, b), and ``Q basis``, (3, 3, b)."""
    half = dot(q[PLACE][:, :, None], basis[:, None])
    return dot(basis[:, ROW], half[:, COLUMN]), half


def gram(basis: Interval) -> Interval:
    """Return ``basis^T basis``, (6, b)."""
    return dot(basis[:, ROW], basis[:, COLUMN])


def linear(value: Interval, slopes: Interval) -> Interval:
    """Join matrices Q, (n, b), and Q_i, (n, 3, b), to ``Q + sum_i x_i Q_i``, (n, 4, b).

    x is the step from a box's centre. Sums and multiples are those of the four matrices.
    """
    sides = ((value.low, slopes.low), (value.high, slopes.high))
    return Interval(*(np.concatenate([each[:, None], steep], axis=1) for each, steep in sides))


def negative(total: Interval, half: FloatArray, horizontal: np.ndarray) -> np.ndarray:
    """Check which matrices are negative definite at all eight corners of their box, and so all over it.

    This is the test of a box.

    Args:
        total: (6, 4, b) matrices that are linear in the step from the centre.
        half: (3, b) the boxes' half sides.
        horizontal: (b,) whether the horizontal plane is all that counts.
    """
    ahead = total[:, 1:] * half
    corners = product(*((ahead[:, i], -ahead[:, i]) for i in range(3)))
    every = [negative_definite(total[:, 0] + x + y + z, horizontal) for x, y, z in corners]
    return np.asarray(np.all(every, axis=0))


def negative_definite(a: Interval, horizontal: np.ndarray | bool = False) -> np.ndarray:
    """Check which forms, (6, b), are negative definite for certain.

    Args:
        a: the forms.
        horizontal: where the first two coordinates are all that counts.
    """
    block, whole, _ = definite(-a)
    holds = np.where(horizontal, block, whole)
    left = np.flatnonzero(~holds & np.logical_not(horizontal) & np.all(np.isfinite(a.low + a.high), axis=0))
    if len(left):
        holds[left] = _dominant(-a[:, left])
    return np.asarray(holds)


def _dominant(a: Interval) -> np.ndarray:
    """Check which forms, (6, b), are positive definite for certain, seen along their own axes.

    Where two eigenvalues are small, their product is lost in the determinant's rounding. In the basis of the
    eigenvectors, about, a matrix is all but diagonal: definite, if each entry of the diagonal is larger than
    the sum of the others in its row.
    """
    axes = Interval(np.moveaxis(np.linalg.eigh(matrices(a.middle()))[1], 0, -1))
    holds = np.ones(a.low.shape[1], dtype=bool)
    # the axes themselves must span the space: their products are those of an orthonormal basis, about
    for form in (congruence(a, axes)[0], gram(axes)):
        off = form.magnitude()[PLACE]
        rest = Interval(off[NEXT, range(3)]) + off[LAST, range(3)]
        holds &= np.all(form.low[:3] > rest.high, axis=0)
    return holds


def cell_ends(cell: IntArray, side: int) -> tuple[FloatArray, FloatArray]:
    """Place the ends of one side of each cell, (b,) each; exact, as dyadic numbers of few bits.

    Args:
        cell: (b, 5) as in :class:`Leaves`.
        side: 0 or 1.
    """
    width: FloatArray = np.ldexp(2.0, -cell[:, 1 + 2 * side])
    low: FloatArray = -1.0 + cell[:, 2 + 2 * side] * width
    return low, low + width


def cell_axes(cell: IntArray) -> Interval:
    """Enclose the axes of each cell, (3, b), of which the face's coordinate is 1.

    Args:
        cell: (b, 5) as in :class:`Leaves`, each on a face.
    """
    ones, place = np.ones(len(cell)), (np.arange(3)[:, None] - cell[:, 0]) % 3
    ends = zip((ones, ones), *(cell_ends(cell, side) for side in range(2)), strict=True)
    return Interval(*(np.take_along_axis(np.stack(end), place, axis=0) for end in ends))


def side_form(cell: IntArray, side: int) -> Interval:
    """Build the form ``(v - low a)(high a - v)`` of one side of each cell, (6, b), not negative inside.

    Args:
        cell: (b, 5) as in :class:`Leaves`, each on a face.
        side: 0 or 1.
    """
    low, high = cell_ends(cell, side)
    a, v = (np.eye(3)[:, (cell[:, 0] + ahead) % 3] for ahead in (0, 1 + side))
    return outer(Interval(v - low * a), Interval(high * a - v)) * 0.5


def top_vectors(form: Interval, horizontal: np.ndarray | None = None) -> FloatArray:
    """Find about the vectors of the largest eigenvalues of forms, (6, b), as (3, b).

    Args:
        form: the forms.
        horizontal: (b,) whether the horizontal plane is all that counts.
    """
    full = matrices(form.middle())
    if horizontal is not None:
        full[horizontal, 2, :] = full[horizontal, :, 2] = 0.0
        full[horizontal, 2, 2] = -np.linalg.norm(full[horizontal], axis=(1, 2)) - 1.0
    full[~np.all(np.isfinite(full), axis=(1, 2))] = 0.0
    return np.asarray(np.linalg.eigh(full)[1][:, :, -1].T)
