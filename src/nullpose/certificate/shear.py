"""Link vectors over boxes, and the coordinates in which a point's form stands still.

The same lemmas as the solver's (see docs/proofs.md, "Dipoles on the ground"). Vectors have their
components along the first axis, boxes lie along the last. Derivatives are those of Taylor numbers but for the
third, which none has: bounding what is left of a link vector by the range of its second derivatives instead
would make a remainder several times as large, and every other leaf fail. There lemma 5 stays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, Leaves
from nullpose.certificate.forms import COLUMN, PLACE, ROW, gram
from nullpose.certificate.frames import UNIT, axes_across
from nullpose.certificate.interval import Interval, dot, stack, swapped, where
from nullpose.certificate.lemmas import DIRECTION_THIRD, ROUNDING, VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.certificate.taylor import Taylor, chosen, coordinates, inverse_root
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray

_UPRIGHT = 0.4
_SHARP = 1e-8  # how well an anchor's vector must be known, so that the basis is orthonormal but for rounding


@dataclass(frozen=True, slots=True, eq=False)
class AxisShear:
    """Coordinates of the axis that turn with a point, ``u = (I + E) u'``, E = 0 at the centres, and a basis.

    E is ``d0 w^T`` for a point with a dipole and ``w d0^T`` for another.

    Args:
        on: (b,) whether there are any; otherwise E is zero.
        anchor: (b,) the point.
        most: (4, b) bounds on E and on its first three derivatives along any unit direction.
        basis: (3, 3, b) columns: the coordinates that definiteness is asked in.
        gram: (6, b) basis^T basis.
        columns: (3, 3, b) ``(I + E) basis``, all over the boxes.
        anchored: (6, b) the anchor's form in these coordinates. It has one entry, the third's, if the anchor
            has a dipole, and no third row otherwise.
    """

    on: np.ndarray
    anchor: IntArray
    most: Interval
    basis: Interval
    gram: Interval
    columns: Taylor
    anchored: Taylor

    def seen(self, vector: Taylor, near: Interval) -> tuple[Taylor, Interval]:
        """Turn link vectors, ``basis^T (I + E)^T a``, and bound what that is in its third derivative.

        Args:
            vector: a, (3, b), at the centres.
            near: (b,) ``1 / |r|`` over the boxes.
        """
        (slope, bend, third), most = vector_sizes(near), [self.most[i] for i in range(4)]
        mixed = bend * most[1] * 3.0 + slope * most[2] * 3.0 + near * most[3]
        # the basis' columns are longer than one by rounding alone
        whole = (third * (most[0] + 1.0) + mixed) * ROUNDING
        turned = (self.columns.at_centres() * vector[:, None]).total() if np.any(self.on) else vector
        return turned, whole.most()

    def identity(self) -> Taylor:
        """Return ``basis^T (I + E + E^T) basis``, (6, b)."""
        if not np.any(self.on):
            return self.columns[0, 0].alike(self.gram)
        both = self.columns[:, ROW] * self.basis[:, COLUMN] + self.columns[:, COLUMN] * self.basis[:, ROW]
        return both.total() - self.gram

    def form(self, q: Interval) -> Taylor:
        """Return ``basis^T (I + E)^T Q (I + E) basis`` of constant forms, (6, b)."""
        if not np.any(self.on):
            return self.columns[0, 0].alike(q)
        image = (self.columns[:, None] * q[PLACE][:, :, None]).total()
        return (self.columns[:, ROW] * image[:, COLUMN]).total()


def offset_to(points_m: FloatArray, boxes: Boxes) -> tuple[Taylor, Taylor]:
    """State the vector r from boxes to points, (3, b), and ``1 / |r|``."""
    r = points_m.T - coordinates(Interval(boxes.centre.T), boxes.hull)
    return r, r.squared().total().of(inverse_root)


def link_vector(r: Taylor, near: Taylor, axes: FloatArray) -> Taylor:
    """Return ``a = v / |r| - (v.r) r / |r|^3`` of dipoles v, (b, 3)."""
    v = Interval(axes.T)
    return near * v - r * ((r * v).total() * near * near.squared())


def shear_of(ratios: Ratios, leaves: Leaves, boxes: Boxes) -> AxisShear:
    """Find coordinates that turn for boxes, each with its leaf; with a fixed frame they stand still."""
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    if not np.any(turning):
        none, still = Interval(np.zeros((6, len(boxes)))), coordinates(Interval(boxes.centre.T), boxes.hull)
        basis = Interval(np.tile(UNIT, len(boxes)))
        return AxisShear(turning, anchor, none[:4], basis, gram(basis), still.alike(basis), still.alike(none))
    axes = ratios.ground_axes[anchor]
    is_dipole = np.any(axes != 0.0, axis=1)
    r, near = offset_to(ratios.points_m[anchor], boxes)
    a = chosen(is_dipole, link_vector(r, near, axes), r)
    a0 = a.at.value
    length = a0.squared().total().sqrt()
    d0 = a0 / length
    along = (a * d0).total()
    on = turning & ((along.over.value / length).low > _UPRIGHT) & (d0.radius().max(axis=0) < _SHARP)
    # (a0 - a) / (a.d0) of a dipole's link vector a, r / (r.d0) - d0 of the vector to another point
    w = chosen(is_dipole, -(a - a0), a) / along - where(is_dipole, 0.0, d0)
    w = chosen(on, w, w.alike(Interval(np.zeros((3, len(on))))))
    most = where(on, _sizes(w.over.value, along.over.value, near.over.value, is_dipole), 0.0)
    w = w.narrowed(most[3])
    basis, upright = _basis(on, is_dipole, d0)
    one_row, one_column = (w[:, None] * basis).total() * d0[:, None], w[:, None] * dot(basis, d0[:, None])
    turned = chosen(is_dipole, one_row, one_column)
    products, across = gram(basis), (r[:, None] * basis).total()
    flat = (-(across[ROW] * across[COLUMN] * near.squared()) + products) * near.squared()
    flat = flat * np.where(COLUMN == 2, 0.0, 1.0)[:, None]
    still = flat.alike(upright * length.squared())
    return AxisShear(on, anchor, most, basis, products, turned + basis, chosen(is_dipole, still, flat))


def _sizes(w: Interval, along: Interval, near: Interval, is_dipole: np.ndarray) -> Interval:
    """Return bounds on w and its first three derivatives along a unit direction, by the quotient rule."""
    y, lean = Interval(along.low), w.squared().total().sqrt().most()
    # of a link vector, or of the vector to a point
    sizes = zip(vector_sizes(near), (1.0, 0.0, 0.0), strict=True)
    slope, bend, third = (where(is_dipole, *pair) for pair in sizes)
    rate = slope / y
    grown = where(is_dipole, lean + 1.0, (lean.squared() + 1.0).sqrt())
    twice, thrice = np.where(is_dipole, [[2.0], [6.0]], [[1.0], [DIRECTION_THIRD]])
    second = grown * bend / y + (lean * 2.0 + twice) * rate.squared()
    most = grown * (third + bend * rate * 6.0) / y
    most = most + (lean * 6.0 + thrice) * rate.squared() * rate
    return stack([lean, grown * rate, second, most]).most()


def vector_sizes(near: Interval) -> tuple[Interval, ...]:
    """Bound the first three derivatives of a link vector, given ``1 / |r|``: lemma 5."""
    square = near.squared()
    sizes = square * VECTOR_SLOPE, square * near * VECTOR_BEND, square.squared() * VECTOR_THIRD
    return tuple(size.most() for size in sizes)


def _basis(on: np.ndarray, is_dipole: np.ndarray, d0: Interval) -> tuple[Interval, Interval]:
    """Return the bases, and ``d0 d0^T`` in them for dipoles, which has one entry exactly."""
    third = np.where(on, d0.middle(), UNIT[2])
    third = third / np.linalg.norm(third, axis=0)
    axes = axes_across(third, on)
    axes[:, 2, on] = third[:, on]
    plain = Interval(axes)
    # across the anchor's vector for certain: its form has no first and second row, or no third
    tilted = plain - d0[:, None] * (dot(plain, d0[:, None]) / d0.squared().total())[None]
    straight = where(on, tilted, plain)
    exact = where(on & ~is_dipole, d0, plain[:, 2])  # the direction itself, not a rounded one
    basis = swapped(stack([straight[:, 0], straight[:, 1], exact]))
    form = where((np.arange(6) == 2)[:, None], dot(basis[:, 2], d0).squared(), 0.0)
    return basis, form
