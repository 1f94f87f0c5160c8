"""Leaves of an axis that the position gives: a weighted sum that stays negative all over the box.

Each link is ``f = |u x r|^2 / (|u|^2 |r|^4)`` with ``u = o + M p`` and ``r = q - p``, a quotient of
polynomials. Value and gradient are taken at the centre, the Hessian over the whole box, all in interval
arithmetic; the maximum of the quadratic is bounded by its dual (see "The certificate explained").
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.forms import (
    COLUMN,
    COUNTED,
    PLACE,
    ROW,
    adjugate,
    definite,
    matrices,
    outer,
    squares,
)
from nullpose.certificate.interval import Interval, dot, swapped
from nullpose.certificate.mixes import group_shares, mix_slots
from nullpose.family import AxisField, Family

__all__ = ["affine_holds", "link_jet"]

_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)
_UNIT = Interval(np.eye(3)[:, :, None])
_SAME = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])[:, None]  # the identity as a form
_AFTER, _LAST = [1, 2, 0], [2, 0, 1]

Jet: TypeAlias = tuple[Interval, Interval, Interval, Interval]


@dataclass(frozen=True, slots=True, eq=False)
class _Link:
    """What a link is made of, at or over positions; components, then derivatives, along the first axes.

    Args:
        axis: (3, b) u.
        matrix: (3, 3, 1) M, its derivative.
        way: (3, b) r, whose derivative is -I.
        cross: (3, b) u x r.
        slopes: (3, 3, b) its derivatives.
        bend: (3, 6, 1) its second ones, which are constant.
    """

    axis: Interval
    matrix: Interval
    way: Interval
    cross: Interval
    slopes: Interval
    bend: Interval

    @property
    def square(self) -> Interval:
        """``n = |u x r|^2``."""
        return self.cross.squared().total()

    @property
    def weight(self) -> Interval:
        """``b s^2`` with ``b = |u|^2`` and ``s = |r|^2``."""
        return self.axis.squared().total() * self.way.squared().total().squared()

    def value(self) -> Interval:
        """Return ``n / (b s^2)``, (b,)."""
        return self.square / self.weight

    def rates(self) -> tuple[Interval, Interval, Interval]:
        """Return the derivatives of n, those of b over b, and those of s over s, (3, b) each."""
        of_axis = dot(self.matrix, self.axis[:, None]) * 2.0 / self.axis.squared().total()
        of_way = self.way * -2.0 / self.way.squared().total()
        return dot(self.slopes, self.cross[:, None]) * 2.0, of_axis, of_way

    def gradient(self) -> Interval:
        """Return the first derivatives of ``n / (b s^2)``, (3, b)."""
        dn, beta, sigma = self.rates()
        return (dn - self.square * (beta + sigma * 2.0)) / self.weight

    def hessian(self) -> Interval:
        """Return the second ones, (6, b): with w = 1 / (b s^2), ``w (n'' + n' l + l' n + n q)``."""
        dn, beta, sigma = self.rates()
        fall = -(beta + sigma * 2.0)  # l, the derivatives of log w
        bent = swapped(squares(swapped(self.slopes))).total() + dot(self.bend, self.cross[:, None])
        gram = dot(self.matrix[:, ROW], self.matrix[:, COLUMN]) * 2.0
        q = (squares(beta) + outer(beta, sigma)) * 2.0 + squares(sigma) * 6.0
        q = q - gram / self.axis.squared().total() - 4.0 * _SAME / self.way.squared().total()
        return (bent * 2.0 + outer(dn, fall) + self.square * q) / self.weight


def link_jet(field: AxisField, boxes: Boxes, points: FloatArray) -> Jet:
    """Return a link's value and gradient at the centres, its Hessian and its value over the boxes.

    Args:
        field: the axis field.
        boxes: b of them.
        points: (b, 3) the ground point of each.
    """
    at = _link(field, Interval(boxes.centre.T), points)
    over = _over(at, _link(field, boxes.hull, points), Interval(boxes.half.T))
    value, isotropic = over.value(), 1.0 / over.way.squared().total()
    # sin^2 <= 1, and never below zero
    ranged = Interval(np.maximum(value.low, 0.0), np.fmin(value.high, isotropic.high))
    return at.value(), at.gradient(), over.hessian(), ranged


def _cross(x: Interval, y: Interval) -> Interval:
    return x[_AFTER] * y[_LAST] - x[_LAST] * y[_AFTER]


def _link(field: AxisField, p: Interval, points: FloatArray) -> _Link:
    matrix = Interval(field.matrix[:, :, None])
    u = dot(Interval(field.matrix.T[:, :, None]), p[:, None]) + field.offset[:, None]
    r = Interval(points.T) - p
    slopes = _cross(matrix, r[:, None]) - _cross(u[:, None], _UNIT)
    bend = -(_cross(matrix[:, ROW], _UNIT[:, COLUMN]) + _cross(matrix[:, COLUMN], _UNIT[:, ROW]))
    return _Link(u, matrix, r, _cross(u, r), slopes, bend)


def _over(at: _Link, over: _Link, half: Interval) -> _Link:
    """Return a link's pieces over the boxes: u x r is quadratic, its expansion at the centre exact."""
    bend = np.moveaxis(at.bend.magnitude()[:, PLACE], 2, 0)
    swing = dot(Interval(bend), half[:, None, None]).high
    steep = Interval(at.slopes.magnitude()) + Interval(swing) * 0.5
    reach = dot(swapped(steep), half[:, None]).high
    slopes, cross = at.slopes + Interval(-swing, swing), at.cross + Interval(-reach, reach)
    return replace(over, slopes=slopes, cross=cross)


def affine_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes their leaf's multipliers exclude under the axis field.

    Args:
        family: the ratios.
        field: the axis field.
        leaves: of the boxes, with multipliers and level.
        boxes: to be tested.
    """
    ratio, weight = mix_slots(leaves)
    value = Interval(np.zeros(len(boxes)))
    terms = []
    for k, w in zip(ratio, weight, strict=True):
        value = value + Interval(w) * family.numerator_isotropic[k]
        terms.append((family.numerator_point[k], Interval(w) * family.numerator_weight[k]))
    for g, share in enumerate(group_shares(family, ratio, weight)):
        level = share * leaves.level
        value = value - level * family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            point = np.full(len(boxes), family.denominator_point[e])
            terms.append((point, -(level * family.denominator_weight[e])))
    jets = [(scale, link_jet(field, boxes, family.points_m[point])) for point, scale in terms]
    zero = Interval(np.zeros((6, len(boxes))))
    starts = (value, zero[:3], zero, value)
    value, slopes, hessian, ranged = (
        sum((scale * jet[i] for scale, jet in jets), start) for i, start in enumerate(starts)
    )

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        here, steep, bent = value[rows], slopes[:, rows], hessian[:, rows]
        for nu, bound in constraints:
            here, steep = here + bound.value * nu, steep + bound.slopes * nu
            bent = bent + (2.0 * nu * bound.bend)[ROW] * _SAME
        return _quadratic_negative(boxes.half[rows].T, here, steep, bent)

    holds = (ranged.high < 0.0) | negative_where_allowed(family, leaves, boxes, test, slopes.middle)
    return np.asarray(np.any(weight > 0.0, axis=0) & holds)


def _quadratic_negative(half: FloatArray, value: Interval, slopes: Interval, hessian: Interval) -> np.ndarray:
    """Return where ``f + g.x + x^T H x / 2`` is negative for all ``|x_i| <= h_i`` and every H in bounds.

    The radius of H is paid for in full; then any mu with A = diag(mu) - H positive definite and
    ``f + sum(mu) / 2 + g^T A^-1 g / 2 < 0`` is a proof. Which mu is a guess, and may be a poor one.
    """
    g = slopes * half
    scaled = hessian * (Interval(half)[ROW] * half[COLUMN])
    middle = scaled.middle()
    rest = value + (Interval(scaled.radius().T * (0.5 * COUNTED)).T).total()
    full = matrices(np.where(np.isfinite(middle), middle, 0.0))
    diagonal = np.diagonal(full, axis1=1, axis2=2)
    lean = (diagonal - np.abs(diagonal) + np.abs(full).sum(axis=2)).T
    values, vectors = np.linalg.eigh(full)
    convex = np.abs(np.einsum("bik,bk,bjk->bij", vectors, np.maximum(values, 0.0), vectors)).sum(axis=2).T
    steep, tiny = g.magnitude(), 1e-7 * np.abs(rest.high)
    holds = _dual_negative(rest, g, middle, steep + np.maximum(lean, 0.0) + tiny)
    for share in _SHARES:
        holds |= _dual_negative(rest, g, middle, share * steep + convex + tiny)
    return holds


def _dual_negative(rest: Interval, g: Interval, middle: FloatArray, mu: FloatArray) -> np.ndarray:
    a = Interval(mu[ROW] * _SAME) - middle
    _, positive, det = definite(a)
    form = (squares(g) * adjugate(a) * COUNTED[:, None]).total()
    bound = (rest + Interval(mu).total() * 0.5) * det + form * 0.5
    return np.asarray(positive & (bound.high < 0.0))
