"""Leaves of an axis that the position gives: a weighted sum that stays negative all over the box.

Each link is ``f = |u x r|^2 / (|u|^2 |r|^4)`` with ``u = o + M p`` and ``r = q - p``, evaluated as a Taylor
number; the maximum of the quadratic is bounded by its dual (see docs/proofs.md).
"""

from __future__ import annotations

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import excess
from nullpose.certificate.forms import COLUMN, COUNTED, IDENTITIES, ROW, adjugate, definite, matrices, squares
from nullpose.certificate.interval import Interval
from nullpose.certificate.taylor import Taylor, chosen, cross, inverse
from nullpose.certificate.weighted_sum import weighted_sum
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family

_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)


def link(
    field: AxisField,
    boxes: Boxes,
    points: FloatArray,
    leak: float,
    axes: FloatArray,
    through: FloatArray,
    gain: Taylor | None = None,
) -> Taylor:
    """Return a link over boxes.

    Args:
        field: the axis field.
        boxes: b of them.
        points: (b, 3) the ground point of each.
        leak: the antenna's gain along its axis.
        axes: (b, 3) the axes of the dipoles there, zero where there is none.
        through: (b,) the shares with which the dipoles receive as an isotropic antenna does.
        gain: the excess gains of their channels.
    """
    p = boxes.position
    r = points.T - p
    o, m = field.offset[:, None], field.matrix
    u = p[0] * m[:, [0]] + p[1] * m[:, [1]] + p[2] * m[:, [2]] + o
    inverse2, square, across = r.squared().total().of(inverse), u.squared().total(), cross(u, r)
    f = across.squared().total()
    if leak > 0.0:
        f = f + (u * r).total().squared() * leak
    f = f * inverse2 * inverse2 / square
    if np.any(has := np.any(axes != 0.0, axis=1)):
        beside = cross(r, Interval(axes.T))
        of_dipole = (across * beside).total().squared() * inverse2 / square
        if leak > 0.0:
            of_dipole = of_dipole * (1.0 - Interval(leak)) + beside.squared().total() * leak
        of_dipole = of_dipole * inverse2 * inverse2 * (1.0 - Interval(through)) + f * through
        f = chosen(has, of_dipole, f)
    f = f.within(0.0, inverse2.over.value)  # the gain is at most 1
    return f if gain is None else f * gain


def affine_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes their leaf's multipliers exclude under the axis field: lemma 3.

    Args:
        family: the ratios.
        field: the axis field.
        leaves: of the boxes, with multipliers and level.
        boxes: to be tested.
    """
    ratios, (identity, terms) = family.ratios, weighted_sum(family.ratios, leaves)
    plain = np.zeros_like(ratios.points_m), np.ones(len(ratios.points_m))
    axes, leaks = (ratios.ground_axes, ratios.ground_leaks) if len(ratios.ground_axes) else plain
    total = boxes.position[0].alike(identity)
    for point, scale, sign in terms:
        gain = excess(ratios, boxes, point, sign > 0.0)
        f = link(field, boxes, ratios.points_m[point], ratios.leak, axes[point], leaks[point], gain)
        total = total + f * (scale * sign)
    at, over = total.at, total.over

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        middle, steep, bent = at.value[rows], at.slopes[:, rows], over.bends[:, rows]
        for nu, bound in constraints:
            middle, steep = middle + bound.at.value * nu, steep + bound.at.slopes * nu
            bent = bent + bound.over.bends * nu
        return _quadratic_negative(boxes.half[rows].T, middle, steep, bent)

    holds = negative_where_allowed(family.domain, leaves, boxes, test, at.slopes.middle)
    # ranges hold for any axis, and so where u = 0 has no direction; weights of zero prove nothing
    weighs = [scale.high > 0.0 for _, scale, sign in terms if sign > 0.0]
    return np.asarray(np.any(weighs, axis=0) & (holds | (over.value.high < 0.0)))


def _quadratic_negative(half: FloatArray, value: Interval, slopes: Interval, hessian: Interval) -> np.ndarray:
    """Check where ``f + g.x + x^T H x / 2`` is negative for all ``|x_i| <= h_i`` and every H in bounds.

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
    guesses = [steep + np.maximum(lean, 0.0), *(share * steep + convex for share in _SHARES)]
    return np.asarray(np.any([_dual_negative(rest, g, middle, mu + tiny) for mu in guesses], axis=0))


def _dual_negative(rest: Interval, g: Interval, middle: FloatArray, mu: FloatArray) -> np.ndarray:
    a = Interval(mu[ROW] * IDENTITIES) - middle
    _, positive, det = definite(a)
    form = (squares(g) * adjugate(a) * COUNTED[:, None]).total()
    return np.asarray(positive & (((rest + Interval(mu).total() * 0.5) * det + form * 0.5).high < 0.0))
