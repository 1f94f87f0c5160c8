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
from nullpose.certificate.forms import COLUMN, PLACE, ROW
from nullpose.certificate.frames import THIRD_SQUARE, UNIT, bases_about
from nullpose.certificate.interval import Interval, where
from nullpose.certificate.lemmas import VECTOR_BEND, VECTOR_SLOPE, VECTOR_THIRD
from nullpose.certificate.taylor import Taylor, chosen, inverse, root
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray

_LEAST_SHARE = 0.4  # of y at the centre, that must be left of it all over the box
_SHARP = 1e-8  # how well an anchor's vector must be known, so that the basis is nearly orthonormal


@dataclass(frozen=True, slots=True, eq=False)
class AxisShear:
    """Coordinates of the axis that turn with a point, ``u = (I + E) u'``, E = 0 at the centres, and a basis.

    E is ``d0 w^T`` for a point with a dipole and ``w d0^T`` for another.

    Args:
        on: (b,) whether there are any; otherwise E is zero.
        anchor: (b,) the point.
        sizes: bounds, (b,) each, on E and on its first three derivatives along any unit direction.
        basis: (3, 3, b) columns: the coordinates that definiteness is asked in; see :func:`bases_about`.
        gram: (6, b) basis^T basis.
        columns: (3, 3, b) ``(I + E) basis``, all over the boxes.
        anchored: (6, b) the anchor's form in these coordinates. It has one entry, the third's, if the anchor
            has a dipole, and no third row otherwise.
    """

    on: np.ndarray
    anchor: IntArray
    sizes: list[Interval]
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
        (slope, bend, third), most = vector_sizes(near), self.sizes
        mixed = bend * most[1] * 3.0 + slope * most[2] * 3.0 + near * most[3]
        # no eigenvalue of basis^T basis is above the largest sum of magnitudes in a row
        stretch = Interval(Interval(self.gram.magnitude()[PLACE]).total().high.max(axis=0)).sqrt()
        turned = (self.columns.at_centres() * vector[:, None]).total() if np.any(self.on) else vector
        return turned, ((third * (most[0] + 1.0) + mixed) * stretch).most()

    def identity(self) -> Taylor:
        """Return ``basis^T (I + E + E^T) basis``, (6, b)."""
        both = self.columns[:, ROW] * self.basis[:, COLUMN] + self.columns[:, COLUMN] * self.basis[:, ROW]
        return both.total() - self.gram

    def form(self, q: Interval) -> Taylor:
        """Return ``basis^T (I + E)^T Q (I + E) basis`` of constant forms, (6, b)."""
        image = (self.columns[:, None] * q[PLACE][:, :, None]).total()
        return (self.columns[:, ROW] * image[:, COLUMN]).total()


def offset_to(points_m: FloatArray, boxes: Boxes) -> tuple[Taylor, Taylor]:
    """State the vector r from boxes to points, (3, b), and ``1 / |r|``."""
    r = points_m.T - boxes.position
    return r, r.squared().total().of(root).of(inverse)


def link_vector(r: Taylor, near: Taylor, axes: FloatArray) -> Taylor:
    """Return ``a = v / |r| - (v.r) r / |r|^3`` of dipoles v, (b, 3)."""
    v = Interval(axes.T)
    return near * v - r * ((r * v).total() * near * near.squared())


def vector_sizes(near: Interval) -> list[Interval]:
    """Bound the first three derivatives of a link vector, given ``1 / |r|``: lemma 5."""
    square = near.squared()
    return [square * VECTOR_SLOPE, square * near * VECTOR_BEND, square.squared() * VECTOR_THIRD]


def quotient_sizes(w: Interval, y: Interval, sizes: list[Interval]) -> list[Interval]:
    """Bound ``w = b / y`` and its first three derivatives along any unit direction: the quotient rule.

    As ``w y = b``, ``w' y = b' - w y'``, ``w'' y = b'' - 2 w' y' - w y''`` and so on.

    Args:
        w: (3, b).
        y: (b,) positive.
        sizes: bounds, (b,) each, on the first three derivatives of b and of y.
    """
    lean, (a1, a2, a3) = w.squared().total().sqrt(), sizes
    first = (lean + 1.0) * a1 / y
    second = ((lean + 1.0) * a2 + first * a1 * 2.0) / y
    third = ((lean + 1.0) * a3 + (second * a1 + first * a2) * 3.0) / y
    return [size.most() for size in (lean, first, second, third)]


def shear_of(ratios: Ratios, leaves: Leaves, boxes: Boxes) -> AxisShear:
    """Find coordinates that turn for boxes, each with its leaf; with a fixed frame they stand still.

    With a for the anchor's link vector if it has a dipole, and else for the vector to it, with d0 along a at
    the centre and with ``y = a.d0``, w is ``(a0 - a) / y`` or ``(a - y d0) / y``, and vanishes at the centre.
    """
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    axes, is_dipole = ratios.ground_axes[anchor], ratios.ground_leaks[anchor] < 1.0
    r, near = offset_to(ratios.points_m[anchor], boxes)
    a = chosen(is_dipole, link_vector(r, near, axes), r)
    length = a.at.value.squared().total().sqrt()
    d0 = a.at.value / length
    y = (a * d0).total()
    on = turning & ((y.over.value / length).low > _LEAST_SHARE) & (d0.radius().max(axis=0) < _SHARP)
    basis, products = bases_about(d0, on)
    w = chosen(is_dipole, -(a - a.at.value), a - y * d0) / y
    w = chosen(on, w, w.alike(Interval(np.zeros((3, len(on))))))
    of_vectors = zip(vector_sizes(near.over.value), (1.0, 0.0, 0.0), strict=True)
    sizes = [where(is_dipole, size, of_offset) for size, of_offset in of_vectors]
    most = [where(on, size, 0.0) for size in quotient_sizes(w.over.value, y.over.value, sizes)]
    w = w.narrowed(most[3])
    # (I + E) basis is basis + d0 (w^T basis), or basis + w e3^T, as basis^T d0 = e3
    one_row, one_column = (w[:, None] * basis).total() * d0[:, None], w[:, None] * UNIT[2]
    columns = chosen(is_dipole, one_row, one_column) + basis if np.any(on) else a.alike(basis)
    # a dipole's form is constant; that of another point has no third row
    still, across = a[0].alike(length.squared() * THIRD_SQUARE), (r[:, None] * basis).total()
    flat = (-(across[ROW] * across[COLUMN] * near.squared()) + products) * near.squared()
    anchored = chosen(is_dipole, still, flat * (COLUMN != 2)[:, None])
    return AxisShear(on, anchor, most, basis, products, columns, anchored)
