"""Link vectors over boxes, to the second order, and the coordinates in which a point's form stands still.

The same lemmas as the solver's (see "The certificate explained", "Dipoles on the ground"), written down again
in interval arithmetic. Vectors have their components along the first axis, derivatives theirs along the
second, boxes lie along the last.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, Leaves
from nullpose.certificate.forms import COLUMN, COUNTED, IDENTITIES, ROW, gram, squares
from nullpose.certificate.frames import UNIT, axes_across
from nullpose.certificate.interval import Interval, dot, stack, swapped, where
from nullpose.certificate.lemmas import DIRECTION_THIRD, ROUNDING, VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.family import Family

_UPRIGHT = 0.4
_SHARP = 1e-8  # how well an anchor's vector must be known, so that the basis is orthonormal but for ROUNDING


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """Vectors over boxes, with their components along the first axis, and their derivatives.

    Args:
        value: (3, b) what they are at the centres.
        slopes: (3, 3, b) first derivatives there, along the second axis.
        bends: (3, 6, b) second derivatives there.
        over: (b,) bounds on the third derivatives along any unit direction, all over the boxes.
    """

    value: Interval
    slopes: Interval
    bends: Interval
    over: Interval


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

    Its derivatives at the centres are those along the world's axes, on the second axis; ``over`` is an upper
    bound on the third along any unit direction, anywhere in the box.

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
    first = (v[:, None] * ri + UNIT * ahead + r[:, None] * vi - r[:, None] * ri * (ahead * 3.0 / s)) / cube
    i, j = ROW, COLUMN
    along_v = r[i] * r[j] * 3.0 / s - IDENTITIES
    along_i, along_j = (r[k] * (ahead * 3.0 / s) - v[k] for k in (j, i))
    along_r = (v[i] * r[j] + v[j] * r[i] + IDENTITIES * ahead) * 3.0 / s
    along_r = along_r - r[i] * r[j] * (ahead * 15.0 / s.squared())
    second = v[:, None] * along_v + r[:, None] * along_r
    second = (second + UNIT[:, i] * along_i + UNIT[:, j] * along_j) / cube
    return Jet(value, first, second, (VECTOR_THIRD / boxes.nearest(points_m).squared().squared()).most())


def shear_of(family: Family, leaves: Leaves, boxes: Boxes) -> Shear:
    """Return the coordinates of boxes, each with its leaf."""
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    points_m, axes = family.points_m[anchor], family.ground_axes[anchor]
    is_dipole = np.any(axes != 0.0, axis=1)
    d0, length, y, first, second, most = _turn(points_m, axes, is_dipole, boxes)
    is_sharp = d0.radius().max(axis=0) < _SHARP
    on = turning & ((y / length).low > _UPRIGHT) & is_sharp
    # E = d0 w^T for a dipole, w d0^T for a point without
    e_first, e_second = (
        where(on, where(is_dipole, d0[:, None, None] * w[None], w[:, None] * d0[None, :, None]), 0.0)
        for w in (first, second)
    )
    basis, upright = _basis(on, is_dipole, d0)
    products = gram(basis)
    pull = where(on & ~is_dipole, d0 * 2.0 / length, 0.0)
    across = where((COLUMN == 2)[:, None], 0.0, products - squares(dot(basis, d0[:, None])))
    square = length.squared()
    shape = where(on, where(is_dipole, upright * square, across / square), 0.0)
    return Shear(on, anchor, is_dipole, e_first, e_second, where(on, most, 0.0), basis, products, shape, pull)


def _turn(
    points_m: FloatArray, axes: FloatArray, is_dipole: np.ndarray, boxes: Boxes
) -> tuple[Interval, ...]:
    """Return d0, ``a.d0`` at the centre and at least, the derivatives of w, and bounds on them and on w.

    w is ``(a0 - a) / (a.d0)`` of a dipole's link vector a, or ``a / (a.d0) - d0`` of the way to a point.
    """
    jet = link_vector(points_m, np.where(is_dipole[:, None], axes, [0.0, 0.0, 1.0]), boxes)
    near, half, reach = boxes.nearest(points_m), Interval(boxes.half.T), boxes.half2.sqrt().most()
    bend = smaller(
        (VECTOR_BEND / near / near.squared()).most(), (size_of(jet.bends) + jet.over * reach).most()
    )
    slope = smaller((VECTOR_SLOPE / near.squared()).most(), (size_of(jet.slopes) + bend * reach).most())
    to_point = (Interval(points_m) - boxes.centre).T
    pairs = (
        (jet.value, to_point),
        (jet.slopes, -UNIT),
        (jet.bends, 0.0),
        (slope, 1.0),
        (bend, 0.0),
        (jet.over, 0.0),
    )
    value, first, second, slope, bend, third = (where(is_dipole, *pair) for pair in pairs)
    length = value.squared().total().sqrt()
    d0 = value / length
    along = dot(first, d0[:, None])
    moved = (bend * boxes.half2 * 0.5).most()
    y = length - moved - dot(Interval(along.magnitude()), half)
    moved = (moved + dot(Interval(first.squared().total().sqrt().high), half)).most()
    safe = where(y.low > 0.0, y, 1.0)
    lean, rate = smaller(moved, (slope * reach).most()) / safe, slope / safe
    grown = where(is_dipole, lean + 1.0, (lean.squared() + 1.0).sqrt())
    twice, thrice = np.where(is_dipole, [[2.0], [6.0]], [[1.0], [DIRECTION_THIRD]])
    most = stack(
        [
            lean,
            grown * rate,
            grown * bend / safe + (lean * 2.0 + twice) * rate.squared(),
            grown * (third + bend * rate * 6.0) / safe + (lean * 6.0 + thrice) * rate.squared() * rate,
        ]
    ).most()
    across = where(is_dipole, first, first - d0[:, None] * along)
    mixed = across[:, ROW] * along[COLUMN] + across[:, COLUMN] * along[ROW]
    scale = Interval(np.where(is_dipole, -1.0, 1.0)) / length
    return d0, length, y, across * scale, (second - mixed / length) * scale, most


def _basis(on: np.ndarray, is_dipole: np.ndarray, d0: Interval) -> tuple[Interval, Interval]:
    """Return the bases, and ``d0 d0^T`` in them for dipoles, which has one entry exactly."""
    third = np.where(on, d0.middle(), UNIT[2])
    third = third / np.linalg.norm(third, axis=0)
    axes = axes_across(third, on)
    axes[:, 2, on] = third[:, on]
    plain = Interval(axes)
    # across the dipole's vector for certain, so that its form has no first and second row
    tilted = plain - d0[:, None] * (dot(plain, d0[:, None]) / d0.squared().total())[None]
    straight = where(on & is_dipole, tilted, plain)
    exact = where(on & ~is_dipole, d0, plain[:, 2])  # the direction itself, not a rounded one
    basis = swapped(stack([straight[:, 0], straight[:, 1], exact]))
    form = where((np.arange(6) == 2)[:, None], dot(basis[:, 2], d0).squared(), 0.0)
    return basis, form


def size_of(vectors: Interval) -> Interval:
    """Return upper bounds on derivatives along a unit direction: the roots of the sums of squares."""
    counted = COUNTED if vectors.low.shape[1] == 6 else np.ones(3)
    return (vectors.squared().total() * counted[:, None]).total().sqrt().most()


def smaller(first: Interval, second: Interval) -> Interval:
    """Take the smaller of two upper bounds."""
    return Interval(np.fmin(first.high, second.high))


def sheared(jet: Jet, shear: Shear, near: Interval) -> Jet:
    """Return ``basis^T (I + E)^T a`` of a link vector a."""
    value, e1, e2 = jet.value, shear.first, shear.second
    first = jet.slopes + dot(e1, value[:, None, None])
    second = jet.bends + dot(e2, value[:, None, None])
    mixed = dot(e1[:, :, COLUMN], jet.slopes[:, None, ROW])
    second = second + mixed + dot(e1[:, :, ROW], jet.slopes[:, None, COLUMN])
    m0, m1, m2, m3 = (shear.most[i] for i in range(4))
    i1 = 1.0 / near
    third = jet.over * (m0 + 1.0) + i1 * i1.squared() * m1 * (3.0 * VECTOR_BEND)
    third = third + i1.squared() * m2 * (3.0 * VECTOR_SLOPE) + i1 * m3
    basis = shear.basis
    # the basis' columns are longer than one by rounding alone
    grown = (third * ROUNDING).most()
    return Jet(
        dot(basis, value[:, None]),
        dot(basis[:, :, None], first[:, None]),
        dot(basis[:, :, None], second[:, None]),
        grown,
    )
