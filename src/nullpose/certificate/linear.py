"""Forms that are linear in the step from the centres of boxes, and whether they are negative there."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from nullpose.certificate.certificate import FloatArray, IntArray
from nullpose.certificate.forms import COLUMN, PLACE, ROW, definite, matrices
from nullpose.certificate.interval import Interval, dot

_NEXT, _LAST = [1, 2, 0], [2, 0, 1]


@dataclass(frozen=True, slots=True, eq=False)
class Linear:
    """Symmetric matrices ``Q + sum_i x_i Q_i`` of the step x from a box's centre.

    Args:
        value: (6, b) Q.
        slopes: (6, 3, b) the three Q_i.
    """

    value: Interval
    slopes: Interval

    def __add__(self, other: Linear) -> Linear:
        return Linear(self.value + other.value, self.slopes + other.slopes)

    def plus(self, constant: Interval) -> Linear:
        """Return the matrices with constant ones, (6, b), added."""
        return Linear(self.value + constant, self.slopes)

    def times(self, scale: Interval) -> Linear:
        """Return multiples, one for each box."""
        return Linear(self.value * scale, self.slopes * scale)

    def chosen(self, rows: IntArray) -> Linear:
        """Return those of some boxes."""
        return Linear(self.value[:, rows], self.slopes[:, :, rows])

    def negative(self, half: FloatArray, horizontal: np.ndarray) -> np.ndarray:
        """Return which are negative definite at all eight corners of their box, and so all over it.

        Args:
            half: (3, b) the boxes' half sides.
            horizontal: (b,) whether the horizontal plane is all that counts.
        """
        ahead = self.slopes * half
        holds = np.ones(half.shape[1], dtype=bool)
        for x, y, z in product(*((ahead[:, i], -ahead[:, i]) for i in range(3))):
            holds &= negative_definite(self.value + x + y + z, horizontal)
        return holds


def negative_definite(a: Interval, horizontal: np.ndarray | bool = False) -> np.ndarray:
    """Return which forms, (6, b), are negative definite for certain.

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
    """Return which forms, (6, b), are positive definite for certain, seen along their own axes.

    Where two eigenvalues are small, their product is lost in the determinant's rounding. In the basis of the
    eigenvectors, about, a matrix is all but diagonal: definite, if each entry of the diagonal is larger than
    the sum of the others in its row.
    """
    axes = np.moveaxis(np.linalg.eigh(matrices(a.middle()))[1], 0, -1)
    half = dot(a[PLACE][:, :, None], Interval(axes)[:, None])
    seen = dot(Interval(axes)[:, ROW], half[:, COLUMN])
    # the axes themselves must span the space: their products are those of an orthonormal basis, about
    gram = dot(Interval(axes)[:, ROW], Interval(axes)[:, COLUMN])
    holds = np.ones(axes.shape[-1], dtype=bool)
    for form in (seen, gram):
        off = form.magnitude()[PLACE]
        rest = Interval(off[_NEXT, range(3)]) + off[_LAST, range(3)]
        holds &= np.all(form.low[:3] > rest.high, axis=0)
    return holds
