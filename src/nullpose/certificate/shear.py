"""Link vectors over boxes, to the second order, and the coordinates in which a point's form stands still.

The same lemmas as the solver's (see "The certificate explained", "Dipoles on the ground"), written down again
in interval arithmetic. Vectors have their components along the first axis, derivatives theirs along the
second, boxes lie along the last.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, FloatArray, IntArray, Leaves
from nullpose.certificate.forms import COLUMN, COUNTED, IDENTITY, ROW, gram, squares
from nullpose.certificate.frames import axes_across
from nullpose.certificate.interval import Interval, dot, stack, where
from nullpose.certificate.jets import Jet
from nullpose.certificate.lemmas import DIRECTION_THIRD, ROUNDING, VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.problem.family import Family

_UPRIGHT = 0.4
_SHARP = 1e-8  # how well an anchor's vector must be known, so that the basis is orthonormal but for ROUNDING
_UNIT = np.eye(3)[:, :, None]
_IDENTITIES = IDENTITY[:, None]


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
    first = (v[:, None] * ri + _UNIT * ahead + r[:, None] * vi - r[:, None] * ri * (ahead * 3.0 / s)) / cube
    i, j = ROW, COLUMN
    along_v = r[i] * r[j] * 3.0 / s - _IDENTITIES
    along_i, along_j = (r[k] * (ahead * 3.0 / s) - v[k] for k in (j, i))
    along_r = (v[i] * r[j] + v[j] * r[i] + _IDENTITIES * ahead) * 3.0 / s
    along_r = along_r - r[i] * r[j] * (ahead * 15.0 / s.squared())
    second = v[:, None] * along_v + r[:, None] * along_r
    second = (second + _UNIT[:, i] * along_i + _UNIT[:, j] * along_j) / cube
    near = boxes.nearest(points_m)
    return Jet(value, first, second, (VECTOR_THIRD / near.squared().squared()).most())


def shear_of(family: Family, leaves: Leaves, boxes: Boxes) -> Shear:
    """Return the coordinates of boxes, each with its leaf."""
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    points_m, axes = family.points_m[anchor], family.ground_axes[anchor]
    is_dipole = np.any(axes != 0.0, axis=1)
    jet = link_vector(points_m, np.where(is_dipole[:, None], axes, [0.0, 0.0, 1.0]), boxes)
    of_dipole, of_offset = _dipole_turn(jet, points_m, boxes), _direction_turn(points_m, boxes)
    chosen = [where(is_dipole, *pair) for pair in zip(of_dipole, of_offset, strict=True)]
    upright, still, first, second, most = chosen
    is_sharp = still.radius().max(axis=0) < _SHARP * np.linalg.norm(still.middle(), axis=0)
    on = turning & (upright.low > _UPRIGHT) & is_sharp
    # E = still w^T for a dipole, w still^T for a point without
    e_first, e_second = (
        where(on, where(is_dipole, still[:, None, None] * w[None], w[:, None] * still[None, :, None]), 0.0)
        for w in (first, second)
    )
    length = still.squared().total().sqrt()
    bounds = where(on, (most * length).most(), 0.0)
    basis, anchored = _basis(on, is_dipole, still)
    products = gram(basis)
    rho = (Interval(points_m) - boxes.centre).T.squared().total().sqrt()
    pull = where(on & ~is_dipole, still * 2.0 / rho, 0.0)
    across = where((COLUMN == 2)[:, None], 0.0, products - squares(dot(basis, still[:, None])))
    shape = where(on, where(is_dipole, anchored, across / rho.squared()), 0.0)
    return Shear(on, anchor, is_dipole, e_first, e_second, bounds, basis, products, shape, pull)


def _dipole_turn(jet: Jet, points_m: FloatArray, boxes: Boxes) -> tuple[Interval, ...]:
    """Return ``a.a0 / |a0|^2`` at least, -a0, and w = (a - a0) / (a.a0): derivatives, and bounds on them."""
    a, first, second = jet.value, jet.slopes, jet.bends
    near, half = boxes.nearest(points_m), Interval(boxes.half.T)
    reach = boxes.half2.sqrt().most()
    square, length = a.squared().total(), a.squared().total().sqrt().most()
    a3 = jet.over
    a2 = smaller((VECTOR_BEND / (near.squared() * near)).most(), (size_of(second) + a3 * reach).most())
    a1 = smaller((VECTOR_SLOPE / near.squared()).most(), (size_of(first) + a2 * reach).most())
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


def _direction_turn(points_m: FloatArray, boxes: Boxes) -> tuple[Interval, ...]:
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
            (reach * 6.0 + DIRECTION_THIRD) / (safe.squared() * safe),
        ]
    ).most()
    across = d[:, None] * d[None] - _UNIT  # minus the projector
    second = (across[:, ROW] * d[COLUMN] + across[:, COLUMN] * d[ROW]) / rho.squared()
    return y / rho, d, across / rho, second, most


def _basis(on: np.ndarray, is_dipole: np.ndarray, still: Interval) -> tuple[Interval, Interval]:
    """Return the bases, and the anchors' dipole forms in them, which have one entry exactly."""
    third = np.where(on, still.middle(), _UNIT[2])
    third = third / np.linalg.norm(third, axis=0)
    axes = axes_across(third, on)
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
