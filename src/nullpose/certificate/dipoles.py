"""Sums of forms where points have dipoles: link vectors over boxes, to the second order.

The same lemmas as the solver's (see "The certificate explained", "Dipoles on the ground"), written down again
in interval arithmetic. Vectors have their components along the first axis, derivatives theirs along the
second, boxes lie along the last.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, FloatArray, IntArray, Leaves
from nullpose.certificate.forms import COLUMN, COUNTED, IDENTITY, PLACE, ROW, matrices, outer, squares
from nullpose.certificate.interval import Interval, dot, stack, where
from nullpose.certificate.linear import Linear
from nullpose.certificate.weighted_sum import Multiple, weighted_sum
from nullpose.problem.family import Family

# The derivatives of a link vector along a unit direction, times powers of the distance; and of its square.
_UP = 1.0 + 1e-9
_SLOPE, _BEND, _THIRD = 2.0 / np.sqrt(3.0) * _UP, 3.0 * _UP, 9.89 * _UP
_TURN = 2.31  # 6 cos^2 sin, rounded up

_UPRIGHT = 0.4
_SHARP = 1e-8  # how well an anchor's vector must be known, so that the basis is orthonormal but for _UP
_MOST_ETA = 0.25
_SHARE = 0.1
_TINY = 1e-290
_UNIT = np.eye(3)[:, :, None]
_SAME = IDENTITY[:, None]


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """A vector over boxes: its value and derivatives at the centres, and a bound on the third.

    Args:
        value: (3, b).
        first: (3, 3, b) the derivative along each of the world's axes, on the second axis.
        second: (3, 6, b) likewise.
        third: (b,) upper bound, along any unit direction, anywhere in the box.
    """

    value: Interval
    first: Interval
    second: Interval
    third: Interval


@dataclass(frozen=True, slots=True, eq=False)
class Shear:
    """Coordinates of the axis that turn with a point, ``u = (I + E) u'``, E = 0 at the centres, and a basis.

    Args:
        on: (b,) whether there are any; otherwise E is zero.
        anchor: (b,) the point.
        is_dipole: (b,) whether it has one.
        first: (3, 3, 3, b) the derivatives of E along the world's axes, on the third axis.
        second: (3, 3, 6, b) its second derivatives.
        most: (4, b) bounds on E and on its first three derivatives along any unit direction.
        basis: (3, 3, b) columns: the coordinates that definiteness is asked in. The anchor's form has one
            entry, the third's, if it has a dipole, and no third row otherwise.
        gram: (6, b) basis^T basis.
        anchored: (6, b) the anchor's form at the centre; times the squared distance if it has no dipole.
        pull: (3, b) derivatives of that form, over the form.
    """

    on: np.ndarray
    anchor: IntArray
    is_dipole: np.ndarray
    first: Interval
    second: Interval
    most: Interval
    basis: Interval
    gram: Interval
    anchored: Interval
    pull: Interval


def link_vector(points_m: FloatArray, axes: FloatArray, boxes: Boxes) -> Jet:
    """Return ``a = (|r|^2 v - (v.r) r) / |r|^3`` of points and dipoles, one of each for a box.

    Args:
        points_m: (b, 3).
        axes: (b, 3) v.
        boxes: b of them.
    """
    r, v = (Interval(points_m) - boxes.centre).T, Interval(axes.T)
    s = r.squared().total()
    cube, ahead = s * s.sqrt(), dot(r, v)
    value = (v * s - r * ahead) / cube
    ri, vi = r[None], v[None]
    first = (v[:, None] * ri + _UNIT * ahead + r[:, None] * vi - r[:, None] * ri * (ahead * 3.0 / s)) / cube
    i, j = ROW, COLUMN
    along_v = r[i] * r[j] * 3.0 / s - _SAME
    along_i, along_j = (r[k] * (ahead * 3.0 / s) - v[k] for k in (j, i))
    along_r = (v[i] * r[j] + v[j] * r[i] + _SAME * ahead) * 3.0 / s
    along_r = along_r - r[i] * r[j] * (ahead * 15.0 / s.squared())
    second = v[:, None] * along_v + r[:, None] * along_r
    second = (second + _UNIT[:, i] * along_i + _UNIT[:, j] * along_j) / cube
    near = boxes.nearest(points_m)
    return Jet(value, first, second, (_THIRD / near.squared().squared()).most())


def shear_of(family: Family, leaves: Leaves, boxes: Boxes) -> Shear:
    """Return the coordinates of boxes, each with its leaf."""
    asked = leaves.test == TOWARDS
    anchor = np.where(asked, leaves.point, 0)
    points_m, axes = family.points_m[anchor], family.ground_axes[anchor]
    is_dipole = np.any(axes != 0.0, axis=1)
    jet = link_vector(points_m, np.where(is_dipole[:, None], axes, [0.0, 0.0, 1.0]), boxes)
    of_dipole, of_way = _dipole_turn(jet, points_m, boxes), _way_turn(points_m, boxes)
    chosen = [where(is_dipole, one, other) for one, other in zip(of_dipole, of_way, strict=True)]
    upright, still, first, second, most = chosen
    known = still.radius().max(axis=0) < _SHARP * np.linalg.norm(still.middle(), axis=0)
    on = asked & (upright.low > _UPRIGHT) & known
    # E = still w^T for a dipole, w still^T for a point without
    left = still[:, None, None] * first[None]
    right = first[:, None] * still[None, :, None]
    e_first = where(on, where(is_dipole, left, right), 0.0)
    left, right = still[:, None, None] * second[None], second[:, None] * still[None, :, None]
    e_second = where(on, where(is_dipole, left, right), 0.0)
    length = still.squared().total().sqrt()
    bounds = where(on, (most * length).most(), 0.0)
    basis, anchored = _basis(on, is_dipole, still)
    gram = dot(basis[:, ROW], basis[:, COLUMN])
    rho = (Interval(points_m) - boxes.centre).T.squared().total().sqrt()
    pull = where(on & ~is_dipole, still * 2.0 / rho, 0.0)
    across = where((COLUMN == 2)[:, None], 0.0, gram - squares(dot(basis, still[:, None])))
    shape = where(is_dipole, anchored, across / rho.squared())
    return Shear(on, anchor, is_dipole, e_first, e_second, bounds, basis, gram, where(on, shape, 0.0), pull)


def _dipole_turn(jet: Jet, points_m: FloatArray, boxes: Boxes) -> tuple[Interval, ...]:
    """Return ``a.a0 / |a0|^2`` at least, -a0, and w = (a - a0) / (a.a0): derivatives, and bounds on them."""
    a, first, second = jet.value, jet.first, jet.second
    near, half = boxes.nearest(points_m), Interval(boxes.half.T)
    reach = boxes.half2.sqrt().most()
    square, length = a.squared().total(), a.squared().total().sqrt().most()
    a3 = jet.third
    a2 = _least((_BEND / (near.squared() * near)).most(), (_size(second) + a3 * reach).most())
    a1 = _least((_SLOPE / near.squared()).most(), (_size(first) + a2 * reach).most())
    bend = (a2 * boxes.half2 * 0.5).most()
    along = Interval(dot(first, a[:, None]).magnitude())
    y = square - dot(along, half) - length * bend
    g = (bend + dot(Interval(first.squared().total().sqrt().high), half)).most()
    safe = where(y.low > 0.0, y, 1.0)
    r1, r2, r3 = length * a1 / safe, length * a2 / safe, length * a3 / safe
    i1 = r1 / safe
    i2 = (r2 + r1.squared() * 2.0) / safe
    i3 = (r3 + r1 * r2 * 6.0 + r1 * r1.squared() * 6.0) / safe
    most = stack(
        [
            g / safe,
            a1 / safe + g * i1,
            a2 / safe + a1 * i1 * 2.0 + g * i2,
            a3 / safe + a2 * i1 * 3.0 + a1 * i2 * 3.0 + g * i3,
        ]
    ).most()
    lean = dot(first, a[:, None])
    mixed = first[:, ROW] * lean[COLUMN] + first[:, COLUMN] * lean[ROW]
    return y / square, -a, first / square, (second - mixed / square) / square, most


def _way_turn(points_m: FloatArray, boxes: Boxes) -> tuple[Interval, ...]:
    """Return ``y / rho``, d0, and w = d / (d.d0) - d0: its derivatives, and bounds on them."""
    r = (Interval(points_m) - boxes.centre).T
    rho = r.squared().total().sqrt()
    d = r / rho
    y = rho - dot(Interval(d.magnitude()), Interval(boxes.half.T))
    safe = where(y.low > 0.0, y, 1.0)
    reach = boxes.half2.sqrt() / safe
    most = stack(
        [
            reach,
            (reach.squared() + 1.0).sqrt() / safe,
            (reach * 2.0 + 1.0) / safe.squared(),
            (reach * 6.0 + _TURN) / (safe.squared() * safe),
        ]
    ).most()
    across = d[:, None] * d[None] - _UNIT  # minus the projector
    second = (across[:, ROW] * d[COLUMN] + across[:, COLUMN] * d[ROW]) / rho.squared()
    return y / rho, d, across / rho, second, most


def _basis(on: np.ndarray, is_dipole: np.ndarray, still: Interval) -> tuple[Interval, Interval]:
    """Return the bases, and the anchors' dipole forms in them, which have one entry exactly."""
    third = np.where(on, still.middle(), _UNIT[2])
    third = third / np.linalg.norm(third, axis=0)
    pairs = np.stack([third.T, np.eye(3)[np.argmin(np.abs(third.T), axis=1)]], axis=-1)
    axes = np.tile(_UNIT, third.shape[1])
    axes[:, :2, on] = np.moveaxis(np.linalg.qr(pairs[on], "complete")[0][:, :, 1:], 0, -1)
    axes[:, 2, on] = third[:, on]
    plain = Interval(axes)
    # across the dipole's vector for certain, so that its form has no first and second row
    square = still.squared().total()
    tilted = plain - still[:, None] * (dot(plain, still[:, None]) / square)[None]
    straight = where(on & is_dipole, tilted, plain)
    exact = where(on & ~is_dipole, still, plain[:, 2])  # the direction itself, not a rounded one
    basis = stack([straight[:, 0], straight[:, 1], exact])
    basis = Interval(basis.low.swapaxes(0, 1), basis.high.swapaxes(0, 1))
    form = where((np.arange(6) == 2)[:, None], dot(basis[:, 2], still).squared(), 0.0)
    return basis, form


def _size(vectors: Interval) -> Interval:
    """Return upper bounds on derivatives along a unit direction: the roots of the sums of squares."""
    counted = COUNTED if vectors.low.shape[1] == 6 else np.ones(3)
    return (vectors.squared().total() * counted[:, None]).total().sqrt().most()


def _least(one: Interval, other: Interval) -> Interval:
    return Interval(np.fmin(one.high, other.high))


def sheared(jet: Jet, shear: Shear, near: Interval) -> Jet:
    """Return ``basis^T (I + E)^T a`` of a link vector a."""
    value, e1, e2 = jet.value, shear.first, shear.second
    first = jet.first + dot(e1, value[:, None, None])
    second = jet.second + dot(e2, value[:, None, None])
    one = dot(e1[:, :, COLUMN], jet.first[:, None, ROW])
    second = second + one + dot(e1[:, :, ROW], jet.first[:, None, COLUMN])
    m0, m1, m2, m3 = (shear.most[i] for i in range(4))
    i1 = 1.0 / near
    third = jet.third * (m0 + 1.0) + i1 * i1.squared() * m1 * (3.0 * _BEND)
    third = third + i1.squared() * m2 * (3.0 * _SLOPE) + i1 * m3
    basis = shear.basis
    # the basis' columns are longer than one by rounding alone
    grown = (third * _UP).most()
    return Jet(
        dot(basis, value[:, None]),
        dot(basis[:, :, None], first[:, None]),
        dot(basis[:, :, None], second[:, None]),
        grown,
    )


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
    family, identity, above, below = weighted_sum(family, leaves)
    wanted = [(_vectors(family, shear, boxes, point), point, scale) for point, scale in above]
    unwanted = [(_vectors(family, shear, boxes, point), point, scale) for point, scale in below]
    held = [(constant_form(shear, q), q, weight) for q, weight in constants if np.any(weight != 0.0)]
    centre = shear.gram * identity
    for sign, terms in ((1.0, wanted), (-1.0, unwanted)):
        for jets, point, scale in terms:
            for jet in jets:
                centre = centre + squares(jet.value) * (scale * (sign * (1.0 - family.leak)))
            if family.leak > 0.0:
                gain, _ = _gain(family, boxes, point)
                centre = centre + shear.gram * (gain * scale * (sign * family.leak))
    for form, _, weight in held:
        centre = centre + form.value * weight
    top = _top(centre)
    total = _identity(shear, boxes, identity, _jamming(family, shear, below), top)
    for sign, terms in ((1.0, wanted), (-1.0, unwanted)):
        for jets, point, scale in terms:
            if family.leak > 0.0:
                total = total + _leaking(family, shear, boxes, point, scale * family.leak, sign)
            share = scale * (1.0 - Interval(family.leak))
            own = shear.on & (point == shear.anchor) & (sign < 0.0)
            for jet in jets:
                used = where(own, 0.0, share)
                total = total + square_over(jet, boxes, top, used, sign)
            if np.any(own):
                total = total + _anchored(shear, boxes, family.points_m[shear.anchor], where(own, share, 0.0))
    for form, q, weight in held:
        norm = (q.squared() * COUNTED[:, None]).total().sqrt()
        bent = shear.most[2] * boxes.half2 + shear.most[0].squared()
        total = total + form.times(Interval(weight)).plus(shear.gram * (norm * bent * np.abs(weight)).most())
    return total, shear


def _top(form: Interval) -> FloatArray:
    """Return about the vectors of the largest eigenvalues, (3, b)."""
    full = matrices(form.middle())
    full[~np.all(np.isfinite(full), axis=(1, 2))] = 0.0
    return np.asarray(np.linalg.eigh(full)[1][:, :, -1].T)


def _vectors(family: Family, shear: Shear, boxes: Boxes, point: IntArray) -> list[Jet]:
    """Return the link vectors of a point for each box: one of a dipole, or three of which two count then."""
    points_m, axes = family.points_m[point], family.ground_axes[point]
    has = np.any(axes != 0.0, axis=1)
    near = boxes.nearest(points_m)
    jets = []
    for i in range(1 if np.all(has) else 3):
        own = np.where(has[:, None], axes if i == 0 else 0.0, np.eye(3)[i])
        jets.append(sheared(link_vector(points_m, own, boxes), shear, near))
    return jets


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
    parts = jet.second * steps
    value = jet.value + parts[:, 0] + parts[:, 1] + parts[:, 2]
    reach = boxes.half2.sqrt()
    ball = (jet.third * boxes.half2 * reach / 6.0).most()
    middle = parts.middle()
    weight = np.abs(np.einsum("ksb,kb->sb", middle, top)) + 1e-2 * np.linalg.norm(middle, axis=0)
    weight = weight + 1e-3 * ball.high + _TINY
    total = (Interval(weight).total() + ball).most()
    ahead = np.abs(np.sum(value.middle() * top, axis=0))
    eta = np.clip(total.high / np.maximum(ahead, 1e-300), 1e-12, _MOST_ETA)
    near = scale * (Interval(eta) * sign + 1.0)
    far = scale * (1.0 / Interval(eta) + (1.0 if sign > 0.0 else 0.0)) * total
    rest = _spread(parts, weight) * far + _SAME * (ball * far)
    form = squares(value)
    slopes = outer(jet.first, value[:, None])
    if sign > 0.0:
        steep = jet.first * half
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


def _gain(family: Family, boxes: Boxes, point: IntArray) -> tuple[Interval, Interval]:
    """Return a point's gain over ``|r|^2``, whatever the axis, and its derivatives, (3, b)."""
    points_m, axes = family.points_m[point], family.ground_axes[point]
    has = np.any(axes != 0.0, axis=1)
    jet = link_vector(points_m, axes, boxes)
    r = (Interval(points_m) - boxes.centre).T
    plain = 1.0 / r.squared().total()
    gain = where(has, jet.value.squared().total(), plain)
    return gain, where(has, dot(jet.first, jet.value[:, None]) * 2.0, r * plain.squared() * 2.0)


def _leaking(
    family: Family, shear: Shear, boxes: Boxes, point: IntArray, scale: Interval, sign: float
) -> Linear:
    """Return an upper bound on ``sign * scale * g (I + E)^T (I + E)``, g being a point's gain."""
    gain, change = _gain(family, boxes, point)
    form = identity_form(shear)
    m0, m1, m2 = (shear.most[i] for i in range(3))
    points_m, axes = family.points_m[point], family.ground_axes[point]
    i1 = 1.0 / boxes.nearest(points_m)
    a1, a2 = i1.squared() * _SLOPE, i1 * i1.squared() * _BEND
    jet = link_vector(points_m, axes, boxes)
    reach = dot(Interval(jet.first.squared().total().sqrt().high), boxes.half.T) + a2 * boxes.half2 * 0.5
    of_dipole = _least(i1.most(), (jet.value.squared().total().sqrt() + reach).most())
    most = where(np.any(axes != 0.0, axis=1), of_dipole, i1.most())
    bent = (a1.squared() + most * a2) * (m0 + 1.0).squared() * 2.0
    bent = bent + most * a1 * m1 * (m0 + 1.0) * 8.0
    bent = bent + most.squared() * (m2 * (m0 + 1.0) + m1.squared()) * 2.0
    loose, share = (scale * bent * boxes.half2 * 0.5).most(), Interval(np.ones(len(boxes)))
    if sign < 0.0:
        share, loose = _beside_null(family, shear, boxes, point, scale, loose)
    weight = scale * share * sign
    slopes = form.slopes * gain + shear.gram[:, None] * change
    return Linear(form.value * (gain * weight) + shear.gram * loose, slopes * weight)


def _beside_null(
    family: Family, shear: Shear, boxes: Boxes, point: IntArray, scale: Interval, plain: Interval
) -> tuple[Interval, Interval]:
    """Return by what to multiply a dipole's own gain, and what to take off it then, where that is less.

    ``|a + s|^2 >= (1 - eta) |a|^2 - |s|^2 / eta`` for the linear part of a link vector and the rest.
    """
    points_m, axes = family.points_m[point], family.ground_axes[point]
    jet, near = link_vector(points_m, axes, boxes), boxes.nearest(points_m)
    reach = boxes.half2.sqrt()
    bound = _least((_BEND / (near.squared() * near)).most(), (_size(jet.second) + jet.third * reach).most())
    bend = (bound * boxes.half2 * 0.5).most()
    gain = jet.value.squared().total().middle()
    eta = bend.high / np.sqrt(np.maximum(gain, 1e-300))
    fine = np.any(axes != 0.0, axis=1) & ~shear.on & (eta > 0.0) & (eta < 0.5)
    eta = np.where(fine, eta, 0.5)
    rest = (bend.squared() / eta * scale).most()
    fine &= eta * gain * scale.high + rest.high < plain.high
    return where(fine, 1.0 - Interval(eta), 1.0), where(fine, rest, plain)


def identity_form(shear: Shear) -> Linear:
    """Return ``(I + E)^T (I + E)`` in the basis, to first order."""
    return constant_form(shear, Interval(np.repeat(_SAME, len(shear.on), axis=1)))


def constant_form(shear: Shear, q: Interval) -> Linear:
    """Return ``(I + E)^T Q (I + E)`` in the basis, to first order, of constant forms, (6, b)."""
    basis = shear.basis
    half = dot(q[PLACE][:, :, None], basis[:, None])  # Q basis
    form = dot(basis[:, ROW], half[:, COLUMN])
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


def _jamming(family: Family, shear: Shear, below: list[Multiple]) -> FloatArray:
    """Return about how strong the anchors' forms are where they are not zero, (b,)."""
    strength = np.zeros(len(shear.on))
    for point, scale in below:
        strength += np.where(point == shear.anchor, scale.middle(), 0.0)
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
    return total.plus(where(shear.on, rest * _UP, 0.0))


def _anchored(shear: Shear, boxes: Boxes, points_m: FloatArray, scale: Interval) -> Linear:
    """Return an upper bound on ``-scale`` times the anchors' forms."""
    near2 = boxes.nearest(points_m).squared()
    loose = where(shear.is_dipole, 0.0, (boxes.half2 * 2.0 / near2.squared() * scale).most())
    third = (COLUMN == 2)[:, None]
    rest = where(third, 0.0, shear.gram) * loose
    form = shear.anchored * -scale
    return Linear(form + rest, form[:, None] * shear.pull)
