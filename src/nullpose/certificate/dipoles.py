"""Sums of forms where points have dipoles: an upper bound over each box, linear in the position."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import excess
from nullpose.certificate.forms import (
    COLUMN,
    COUNTED,
    IDENTITIES,
    IDENTITY,
    ROW,
    Linear,
    congruence,
    outer,
    squares,
    top_vectors,
)
from nullpose.certificate.interval import Interval, dot, where
from nullpose.certificate.lemmas import ROUNDING, VECTOR_BEND, VECTOR_SLOPE
from nullpose.certificate.shear import Jet, Shear, link_vector, shear_of, sheared, size_of, smaller
from nullpose.certificate.weighted_sum import Term, weighted_sum
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.family import Family

_MOST_ETA = 0.25
_SHARE = 0.1
_TINY = 1e-290


def dipole_sum(
    family: Family, leaves: Leaves, boxes: Boxes, constants: list[tuple[Interval, FloatArray]]
) -> tuple[Linear, Shear]:
    """Return an upper bound on a leaf's sum over its box, linear in the position, and its coordinates.

    Args:
        family: the ratios.
        leaves: with multipliers, frame and level.
        boxes: of the leaves.
        constants: forms, (6, b), that are not negative in the cells and the band, and their multipliers.
    """
    shear = shear_of(family, leaves, boxes)
    family, identity, parts = weighted_sum(family, leaves)
    terms = [
        (_vectors(family, shear, boxes, point), point, scale * _excess_end(family, boxes, point, sign), sign)
        for point, scale, sign in parts
    ]
    held = [(constant_form(shear, q), q, weight) for q, weight in constants if np.any(weight != 0.0)]
    centre = shear.gram * identity
    for jets, point, scale, sign in terms:
        for jet in jets:
            centre = centre + squares(jet.value) * (scale * (sign * (1.0 - family.leak)))
        if family.leak > 0.0:
            centre = centre + shear.gram * (_gain(family, boxes, point)[0] * scale * (sign * family.leak))
    for form, _, weight in held:
        centre = centre + form.value * weight
    top = top_vectors(centre)
    total = _identity(shear, boxes, identity, _jamming(family, shear, parts), top)
    for jets, point, scale, sign in terms:
        if family.leak > 0.0:
            total = total + _leaking(family, shear, boxes, point, scale * family.leak, sign)
        share = scale * (1.0 - Interval(family.leak))
        anchored = shear.on & (point == shear.anchor) & (sign < 0.0)
        for jet in jets:
            total = total + square_over(jet, boxes, top, where(anchored, 0.0, share), sign)
        if np.any(anchored):
            share = where(anchored, share, 0.0)
            total = total + _anchored(shear, boxes, family.points_m[shear.anchor], share)
    for form, q, weight in held:
        norm = (q.squared() * COUNTED[:, None]).total().sqrt()
        bent = shear.most[2] * boxes.half2 + shear.most[0].squared()
        total = total + form.times(Interval(weight)).plus(shear.gram * (norm * bent * np.abs(weight)).most())
    return total, shear


def _excess_end(family: Family, boxes: Boxes, point: IntArray, sign: float) -> Interval | float:
    """Return the largest excess gain in each box, or the least: what a link's form is bounded with."""
    gain = excess(family, boxes, point, sign > 0.0)
    return 1.0 if gain is None else Interval(gain.over.high if sign > 0.0 else gain.over.low)


def _vectors(family: Family, shear: Shear, boxes: Boxes, point: IntArray) -> list[Jet]:
    """Return the link vectors of a point for each box: one of a dipole, or three of which two count then."""
    points_m, axes = family.points_m[point], family.ground_axes[point]
    has = np.any(axes != 0.0, axis=1)
    near = boxes.nearest(points_m)
    directions = (
        np.where(has[:, None], axes if i == 0 else 0.0, np.eye(3)[i]) for i in range(1 if np.all(has) else 3)
    )
    return [sheared(link_vector(points_m, direction, boxes), shear, near) for direction in directions]


def square_over(jet: Jet, boxes: Boxes, top: FloatArray, scale: Interval, sign: float) -> Linear:
    """Return an upper bound on ``sign * scale * c c^T`` over boxes, linear in the position.

    With c's linear part p and the rest s, ``(p + s)^2`` is at most ``(1 + eta) p^2 + (1 + 1 / eta) s^2`` and
    at least ``(1 - eta) p^2 - s^2 / eta`` for any eta, sharp at ``top`` for the one that is chosen.

    Args:
        jet: of c.
        boxes: b of them.
        top: (3, b) where it counts.
        scale: (b,) not negative.
        sign: 1 or -1.
    """
    half = boxes.half.T
    steps = Interval(half)[ROW] * half[COLUMN] * np.where(IDENTITY > 0.0, 0.25, 1.0)[:, None]
    parts = jet.bends * steps
    value = jet.value + parts[:, 0] + parts[:, 1] + parts[:, 2]
    ball = (jet.over * boxes.half2 * boxes.half2.sqrt() / 6.0).most()
    middle = parts.middle()
    weight = np.abs(np.einsum("ksb,kb->sb", middle, top)) + 1e-2 * np.linalg.norm(middle, axis=0)
    weight = weight + 1e-3 * ball.high + _TINY
    total = (Interval(weight).total() + ball).most()
    ahead = np.abs(np.sum(value.middle() * top, axis=0))
    eta = np.clip(total.high / np.maximum(ahead, 1e-300), 1e-12, _MOST_ETA)
    near = scale * (Interval(eta) * sign + 1.0)
    far = scale * (1.0 / Interval(eta) + (1.0 if sign > 0.0 else 0.0)) * total
    rest = _spread(parts, weight) * far + IDENTITIES * (ball * far)
    form = squares(value)
    slopes = outer(jet.slopes, value[:, None])
    if sign > 0.0:
        steep = jet.slopes * half
        middle = steep.middle()
        weight = np.abs(np.einsum("kib,kb->ib", middle, top)) + 1e-2 * np.linalg.norm(middle, axis=0) + _TINY
        rest = rest + _spread(steep, weight) * (near * Interval(weight).total())
    return Linear(form * (near * sign) + rest, slopes * (near * sign))


def _spread(vectors: Interval, weight: FloatArray) -> Interval:
    """Return ``sum_s d_s d_s^T / weight_s``, (6, b)."""
    total: Interval = squares(vectors[:, 0]) / weight[0]
    for s in range(1, len(weight)):
        total = total + squares(vectors[:, s]) / weight[s]
    return total


def _gain(family: Family, boxes: Boxes, point: IntArray) -> tuple[Interval, Interval, Jet, np.ndarray]:
    """Return a point's gain over ``|r|^2``, whatever the axis, its derivatives, (3, b), and its link vector.

    And whether there is one, (b,).
    """
    points_m, axes = family.points_m[point], family.ground_axes[point]
    has = np.any(axes != 0.0, axis=1)
    jet = link_vector(points_m, axes, boxes)
    r = (Interval(points_m) - boxes.centre).T
    plain = 1.0 / r.squared().total()
    gain = where(has, jet.value.squared().total(), plain)
    return gain, where(has, dot(jet.slopes, jet.value[:, None]) * 2.0, r * plain.squared() * 2.0), jet, has


def _leaking(
    family: Family, shear: Shear, boxes: Boxes, point: IntArray, scale: Interval, sign: float
) -> Linear:
    """Return an upper bound on ``sign * scale * g (I + E)^T (I + E)``, g being a point's gain."""
    gain, change, jet, has = _gain(family, boxes, point)
    form = identity_form(shear)
    m0, m1, m2 = (shear.most[i] for i in range(3))
    i1 = 1.0 / boxes.nearest(family.points_m[point])
    a1, a2 = i1.squared() * VECTOR_SLOPE, i1 * i1.squared() * VECTOR_BEND
    reach = dot(Interval(jet.slopes.squared().total().sqrt().high), boxes.half.T) + a2 * boxes.half2 * 0.5
    of_dipole = smaller(i1.most(), (jet.value.squared().total().sqrt() + reach).most())
    most = where(has, of_dipole, i1.most())
    bent = (a1.squared() + most * a2) * (m0 + 1.0).squared() * 2.0
    bent = bent + most * a1 * m1 * (m0 + 1.0) * 8.0
    bent = bent + most.squared() * (m2 * (m0 + 1.0) + m1.squared()) * 2.0
    loose, share = (scale * bent * boxes.half2 * 0.5).most(), Interval(np.ones(len(boxes)))
    if sign < 0.0:
        share, loose = _beside_null(jet, has & ~shear.on, boxes, a2.most(), scale, loose)
    weight = scale * share * sign
    slopes = form.slopes * gain + shear.gram[:, None] * change
    return Linear(form.value * (gain * weight) + shear.gram * loose, slopes * weight)


def _beside_null(
    jet: Jet, fine: np.ndarray, boxes: Boxes, most: Interval, scale: Interval, plain: Interval
) -> tuple[Interval, Interval]:
    """Return by what to multiply a dipole's own gain, and what to take off it then, where that is less.

    ``|a + s|^2 >= (1 - eta) |a|^2 - |s|^2 / eta`` for the linear part of a link vector and the rest.

    Args:
        jet: of the link vectors.
        fine: (b,) where it may be done.
        boxes: b of them.
        most: bounds on the second derivatives.
        scale: what the gains are multiplied by.
        plain: what is to be taken off them elsewhere.
    """
    bound = smaller(most, (size_of(jet.bends) + jet.over * boxes.half2.sqrt()).most())
    bend = (bound * boxes.half2 * 0.5).most()
    gain = jet.value.squared().total().middle()
    eta = bend.high / np.sqrt(np.maximum(gain, 1e-300))
    fine = fine & (eta > 0.0) & (eta < 0.5)
    eta = np.where(fine, eta, 0.5)
    rest = (bend.squared() / eta * scale).most()
    fine &= eta * gain * scale.high + rest.high < plain.high
    return where(fine, 1.0 - Interval(eta), 1.0), where(fine, rest, plain)


def identity_form(shear: Shear) -> Linear:
    """Return ``(I + E)^T (I + E)`` in the basis, to first order."""
    return constant_form(shear, Interval(np.repeat(IDENTITIES, len(shear.on), axis=1)))


def constant_form(shear: Shear, q: Interval) -> Linear:
    """Return ``(I + E)^T Q (I + E)`` in the basis, to first order, of constant forms, (6, b)."""
    form, half = congruence(q, shear.basis)
    turned = _turned(shear)
    slopes = dot(turned[:, ROW], half[:, COLUMN][:, :, None]) + dot(
        turned[:, COLUMN], half[:, ROW][:, :, None]
    )
    return Linear(form, slopes)


def _turned(shear: Shear) -> Interval:
    """Return the derivatives of ``E basis``, (3, 3, 3, b): row, column of the basis, world axis."""
    parts = [shear.first[:, n][:, None] * shear.basis[n][None, :, None] for n in range(3)]
    total: Interval = parts[0] + parts[1] + parts[2]
    return total


def _jamming(family: Family, shear: Shear, parts: list[Term]) -> FloatArray:
    """Return about how strong the anchors' forms are where they are not zero, (b,)."""
    strength = np.zeros(len(shear.on))
    for point, scale, sign in parts:
        strength += np.where((sign < 0.0) & (point == shear.anchor), scale.middle(), 0.0)
    form = shear.anchored.middle()
    return np.asarray(strength * (1.0 - family.leak) * np.where(shear.is_dipole, form[2], form[0]))


def _identity(shear: Shear, boxes: Boxes, weight: Interval, jamming: FloatArray, top: FloatArray) -> Linear:
    """Return an upper bound on ``weight (I + E)^T (I + E)``, in the basis."""
    total = identity_form(shear).times(weight)
    above = where(weight.high > 0.0, weight.high, 0.0)
    total = total.plus(shear.gram * (above * shear.most[0].squared()).most())
    if not np.any(shear.on):
        return total
    # twice the product of a part along the anchor's form with one that is not
    bend = (Interval(weight.magnitude()) * boxes.half2 * 0.5 * shear.most[2]).most()
    upright, level = top[2] ** 2, top[0] ** 2 + top[1] ** 2
    seen, unseen = np.where(shear.is_dipole, (upright, np.ones_like(upright)), (level, upright))
    eta = np.fmin(
        np.fmax(bend.high, _SHARE * jamming), bend.high * np.sqrt(unseen / np.maximum(seen, 1e-300))
    )
    eta = np.fmax(eta, 1e-3 * bend.high) + _TINY
    more = (bend.squared() / eta).most()
    third = (np.arange(6) == 2)[:, None]
    level_form = where(third, 0.0, shear.gram)
    along = where(shear.is_dipole, where(third, 1.0, 0.0), level_form)
    rest = along * eta + where(shear.is_dipole, shear.gram, where(third, 1.0, 0.0)) * more
    return total.plus(where(shear.on, rest * ROUNDING, 0.0))


def _anchored(shear: Shear, boxes: Boxes, points_m: FloatArray, scale: Interval) -> Linear:
    """Return an upper bound on ``-scale`` times the anchors' forms."""
    near2 = boxes.nearest(points_m).squared()
    loose = where(shear.is_dipole, 0.0, (boxes.half2 * 2.0 / near2.squared() * scale).most())
    third = (COLUMN == 2)[:, None]
    rest = where(third, 0.0, shear.gram) * loose
    form = shear.anchored * -scale
    return Linear(form + rest, form[:, None] * shear.pull)
