"""Leaves of an axis that the position gives: a weighted sum that stays negative all over the box.

Each link is ``f = |u x r|^2 / (|u|^2 |r|^4)`` with ``u = o + M p`` and ``r = q - p``, a quotient of
polynomials. Value and gradient are taken at the centre, the Hessian over the whole box, all in interval
arithmetic; the maximum of the quadratic is bounded by its dual (see "The certificate explained").
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import Excess, Interval3, excess
from nullpose.certificate.forms import (
    COLUMN,
    COUNTED,
    IDENTITIES,
    LAST,
    NEXT,
    PLACE,
    ROW,
    adjugate,
    definite,
    matrices,
    outer,
    squares,
)
from nullpose.certificate.interval import Interval, dot, stack, swapped, where
from nullpose.certificate.jets import Jet
from nullpose.certificate.weighted_sum import weighted_sum
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family

_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)
_UNIT = Interval(np.eye(3)[:, :, None])


def link_jet(
    field: AxisField,
    boxes: Boxes,
    points: FloatArray,
    leak: float,
    axes: FloatArray,
    gain: Excess | None = None,
) -> Jet:
    """Expand a link: value and gradient at the centres, its Hessian and what it is over the boxes.

    Args:
        field: the axis field.
        boxes: b of them.
        points: (b, 3) the ground point of each.
        leak: the antenna's gain along its axis.
        axes: (b, 3) the axes of the dipoles there, zero where there is none.
        gain: the excess gains of their channels.
    """
    if not np.any(has := np.any(axes != 0.0, axis=1)):
        return _isotropic_jet(field, boxes, points, leak, gain)
    jets = _dipole_jet(field, boxes, points, axes, gain)
    if leak > 0.0:  # what leaks is the dipole's own gain, as that of an axis along it
        alone = _isotropic_jet(axes, boxes, points, 0.0, gain)
        share = 1.0 - Interval(leak)
        jets = _joined(lambda jet, other: jet * share + other * leak, jets, alone)
    if not np.all(has):
        jets = _joined(partial(where, has), jets, _isotropic_jet(field, boxes, points, leak, gain))
    return jets


def _joined(join: Callable[[Interval, Interval], Interval], first: Jet, second: Jet) -> Jet:
    """Return a jet made of two, number by number."""
    value, slopes = join(first.value, second.value), join(first.slopes, second.slopes)
    return Jet(value, slopes, join(first.bends, second.bends), join(first.over, second.over))


def _dipole_jet(
    field: AxisField, boxes: Boxes, points: FloatArray, axes: FloatArray, gain: Excess | None
) -> Jet:
    """Expand links as :func:`link_jet` where points have dipoles, without what leaks.

    Their link is ``B^2 / (|u|^2 |r|^6)``, ``B = (u.v) |r|^2 - (u.r) (v.r)``.
    """
    matrix, v = Interval(field.matrix[:, :, None]), Interval(axes.T)
    both = matrix + swapped(matrix)
    slope = dot(matrix, v[:, None])  # of u.v

    def parts(u: Interval, r: Interval) -> tuple[Interval, Interval, Interval]:
        """Return B, its gradient and its Hessian."""
        uv, ur, vr, s = dot(u, v), dot(u, r), dot(v, r), r.squared().total()
        ahead = dot(matrix, r[:, None]) - u
        gradient = slope * s - r * uv * 2.0 - ahead * vr + v * ur
        bent = both[ROW, COLUMN] * vr - outer(slope, r) * 2.0 + outer(ahead, v)
        return dot(_cross(u, r), _cross(v, r)), gradient, bent + uv * 2.0 * IDENTITIES

    u, r = _axis_and_offset(field, points, Interval(boxes.centre.T))
    product, gradient, bend = parts(u, r)
    centre = _quotient(matrix, u, r, stack([product]), stack([gradient]), stack([bend]), 3)
    u, r = _axis_and_offset(field, points, boxes.hull)
    _, _, bend = parts(u, r)
    half = Interval(boxes.half.T)
    swing = dot(Interval(bend.magnitude())[PLACE], half[:, None]).high
    reach = dot(Interval(gradient.magnitude()) + Interval(swing) * 0.5, half).high
    product, gradient = product + Interval(-reach, reach), gradient + Interval(-swing, swing)
    over = _quotient(matrix, u, r, stack([product]), stack([gradient]), stack([bend]), 3)
    return _jet(centre, over, r, gain)


def _jet(centre: Interval3, over: Interval3, r: Interval, gain: Excess | None) -> Jet:
    """Return the jet of a link from its value, slopes and Hessian at the centres and over the boxes."""
    # the gain is at most 1, and never below zero
    most = np.fmin(over[0].high, (1.0 / r.squared().total()).high)
    ranged = Interval(np.maximum(over[0].low, 0.0), most)
    return gain.times(centre, (ranged, *over[1:])) if gain is not None else Jet(*centre[:2], over[2], ranged)


def _isotropic_jet(
    field: AxisField | FloatArray, boxes: Boxes, points: FloatArray, leak: float, gain: Excess | None
) -> Jet:
    """Expand links as :func:`link_jet` where points have no dipoles; the axis may be given, (b, 3)."""
    matrix = Interval(field.matrix[:, :, None] if isinstance(field, AxisField) else np.zeros((3, 3, 1)))
    half = Interval(boxes.half.T)
    u, r = _axis_and_offset(field, points, Interval(boxes.centre.T))
    cross, slopes = _cross(u, r), _cross(matrix, r[:, None]) - _cross(u[:, None], _UNIT)
    bend = -(_cross(matrix[:, ROW], _UNIT[:, COLUMN]) + _cross(matrix[:, COLUMN], _UNIT[:, ROW]))
    if leak > 0.0:  # a fourth entry, sqrt(leak) u.r: the sum of squares is |u x r|^2 + leak (u.r)^2
        root = Interval(leak).sqrt()
        along = dot(u, r), dot(matrix, r[:, None]) - u, -(matrix[ROW, COLUMN] + matrix[COLUMN, ROW])
        cross, slopes, bend = (
            stack([each[0], each[1], each[2], root * last])
            for each, last in zip((cross, slopes, bend), along, strict=True)
        )
    centre = _quotient(matrix, u, r, cross, slopes, bend)
    # u x r is quadratic in the position: over the boxes it is what its expansion at the centre makes of it
    swing = dot(Interval(np.moveaxis(bend.magnitude()[:, PLACE], 2, 0)), half[:, None, None]).high
    steep = Interval(slopes.magnitude()) + Interval(swing) * 0.5
    reach = dot(swapped(steep), half[:, None]).high
    cross, slopes = cross + Interval(-reach, reach), slopes + Interval(-swing, swing)
    u, r = _axis_and_offset(field, points, boxes.hull)
    return _jet(centre, _quotient(matrix, u, r, cross, slopes, bend), r, gain)


def _cross(x: Interval, y: Interval) -> Interval:
    return x[NEXT] * y[LAST] - x[LAST] * y[NEXT]


def _axis_and_offset(
    field: AxisField | FloatArray, points: FloatArray, p: Interval
) -> tuple[Interval, Interval]:
    """Return ``u = o + M p``, or the axis given, and ``r = q - p``, (3, b) each."""
    if not isinstance(field, AxisField):
        return Interval(field.T), Interval(points.T) - p
    u = dot(Interval(field.matrix.T[:, :, None]), p[:, None]) + field.offset[:, None]
    return u, Interval(points.T) - p


def _quotient(
    matrix: Interval,
    u: Interval,
    r: Interval,
    cross: Interval,
    slopes: Interval,
    bend: Interval,
    power: int = 2,
) -> tuple[Interval, Interval, Interval]:
    """Return ``n / (b s^power)`` with n, b and s the squares of x, u and r, its gradient and its Hessian.

    Args:
        matrix: (3, 3, 1) M, the derivative of u; that of r is -I.
        u: (3, b).
        r: (3, b).
        cross: (3, b) x = u x r, or (4, b) with sqrt(leak) u.r besides.
        slopes: (3, 3, b) its derivatives, along the second axis; (4, 3, b) likewise.
        bend: (3, 6, 1) its second derivatives; (4, 6, 1) likewise.
        power: 2 or 3.
    """
    n, b, s = (vector.squared().total() for vector in (cross, u, r))
    weight = b * s.squared() * (s if power == 3 else 1.0)
    dn = dot(slopes, cross[:, None]) * 2.0
    beta, sigma = dot(matrix, u[:, None]) * 2.0 / b, r * -2.0 / s  # of log b and log s
    fall = -(beta + sigma * power)  # l, of the log of w = 1 / (b s^power)
    bent = (swapped(squares(swapped(slopes))).total() + dot(bend, cross[:, None])) * 2.0
    q = squares(beta) * 2.0 + outer(beta, sigma) * power + squares(sigma) * (power * (power + 1.0))
    q = q - 2.0 * power * IDENTITIES / s
    q = q - dot(matrix[:, ROW], matrix[:, COLUMN]) * 2.0 / b
    # w (n'' + n' l + l' n + n q)
    return n / weight, (dn + n * fall) / weight, (bent + outer(dn, fall) + n * q) / weight


def affine_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes their leaf's multipliers exclude under the axis field.

    Args:
        family: the ratios.
        field: the axis field.
        leaves: of the boxes, with multipliers and level.
        boxes: to be tested.
    """
    family, identity, terms = weighted_sum(family, leaves)
    dipoles = family.ground_axes if len(family.ground_axes) else np.zeros_like(family.points_m)
    jets = [
        (
            scale * sign,
            link_jet(
                field,
                boxes,
                family.points_m[point],
                family.leak,
                dipoles[point],
                excess(family, boxes, point, sign > 0.0),
            ),
        )
        for point, scale, sign in terms
    ]
    zero = Interval(np.zeros((6, len(boxes))))
    value, slopes, hessian, ranged = (
        sum((scale * getattr(jet, part) for scale, jet in jets), start)
        for part, start in {"value": identity, "slopes": zero[:3], "bends": zero, "over": identity}.items()
    )

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        middle, steep, bent = value[rows], slopes[:, rows], hessian[:, rows]
        for nu, bound in constraints:
            middle, steep = middle + bound.value * nu, steep + bound.slopes * nu
            bent = bent + (2.0 * nu * bound.bend)[ROW] * IDENTITIES
        return _quadratic_negative(boxes.half[rows].T, middle, steep, bent)

    holds = (ranged.high < 0.0) | negative_where_allowed(family, leaves, boxes, test, slopes.middle)
    return np.asarray(np.any([scale.high > 0.0 for _, scale, sign in terms if sign > 0.0], axis=0) & holds)


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
    holds = _dual_negative(rest, g, middle, steep + np.maximum(lean, 0.0) + tiny)
    for share in _SHARES:
        holds |= _dual_negative(rest, g, middle, share * steep + convex + tiny)
    return holds


def _dual_negative(rest: Interval, g: Interval, middle: FloatArray, mu: FloatArray) -> np.ndarray:
    a = Interval(mu[ROW] * IDENTITIES) - middle
    _, positive, det = definite(a)
    form = (squares(g) * adjugate(a) * COUNTED[:, None]).total()
    return np.asarray(positive & (((rest + Interval(mu).total() * 0.5) * det + form * 0.5).high < 0.0))
