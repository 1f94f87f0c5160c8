"""Leaves of a free axis: a weighted sum of forms that is negative definite all over the box."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.axis_cells import side_form
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.forms import definite, matrices, quadratic
from nullpose.certificate.frames import SWING, Frames, constant, expansion, frames_of
from nullpose.certificate.interval import Interval, where
from nullpose.certificate.mixes import group_shares, mix_slots
from nullpose.family import AxisField, Family

__all__ = ["Sum", "free_holds", "negative_definite"]

_LARGEST_ETA = 0.5
_SWERVE = (2.0 + 2.0 / np.sqrt(3.0)) * (1.0 + 1e-12)  # see "Near a null", rounded up
_DIAGONAL = np.sqrt(2.0) * (1.0 + 1e-12)  # a form's spread of eigenvalues over its Frobenius norm, rounded up


@dataclass(slots=True, eq=False)
class Sum:
    """A sum of forms over each box, in its frame: the expansion at the centre and what is left out of it.

    Args:
        matrix: (6, b) the value at the centre.
        slopes: (6, 3, b) its three derivatives there.
        rest: (b,) how much the sum may exceed the expansion, times the identity.
        across: (b,) the same, times the projector across the frame's direction.
    """

    matrix: Interval
    slopes: Interval
    rest: Interval
    across: Interval

    @classmethod
    def empty(cls, boxes: Boxes) -> Sum:
        """Return the sum of nothing.

        Args:
            boxes: one sum for each.
        """
        b = len(boxes)
        return cls(*(Interval(np.zeros(shape)) for shape in ((6, b), (6, 3, b), (b,), (b,))))

    def add(self, scale: Interval, form: Interval, slopes: Interval) -> None:
        """Add a multiple of a form and of its slopes."""
        self.matrix = self.matrix + scale * form
        self.slopes = self.slopes + scale * slopes


def free_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes their leaf's multipliers exclude, whatever the axis in the leaf's cell and the band.

    Where every axis is horizontal, the sum need only be negative on the horizontal plane.

    Args:
        family: the ratios.
        field: the axes; an affine field stands for all of them.
        leaves: of the boxes, with frame, multipliers and level.
        boxes: to be tested.
    """
    holds, vectors = _holds(family, field, leaves, boxes, None)
    left = np.flatnonzero(~holds)
    if len(left):  # near a null the denominators' remainders may be had smaller
        holds[left], _ = _holds(family, field, leaves.chosen(left), boxes.chosen(left), vectors[:, left])
    return holds


def _holds(
    family: Family, field: AxisField, leaves: Leaves, boxes: Boxes, vectors: FloatArray | None
) -> tuple[np.ndarray, FloatArray]:
    """Return which boxes are excluded, and about the largest eigenvalues' vectors at their centres."""
    frames = frames_of(family, leaves, boxes)
    total = Sum.empty(boxes)
    add_ratios(total, family, leaves, boxes, frames, vectors)
    add_cells(total, leaves, boxes, frames)
    add_band(total, field, leaves, boxes, frames)
    total.matrix = total.matrix + frames.gram * total.rest + frames.across * total.across
    horizontal = ~frames.turning & (field.is_free and field.band[1] == 0.0)
    top = top_vectors(total, horizontal)

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        matrix, slopes, gram = total.matrix[:, rows], total.slopes[:, :, rows], frames.gram[:, rows]
        half = boxes.half[rows].T
        for weight, bound in constraints:
            value = bound.value + (Interval(half).squared() * bound.bend).total()
            matrix = matrix + gram * (value * weight)
            slopes = slopes + gram[:, None] * (bound.slopes * weight)
        return at_corners(half, matrix, slopes, horizontal[rows])

    return negative_where_allowed(family, leaves, boxes, test, lambda: steepest(total, top)), top


def add_ratios(
    total: Sum, family: Family, leaves: Leaves, boxes: Boxes, frames: Frames, vectors: FloatArray | None
) -> None:
    """Add ``sum_k lambda_k (N_k - t D_g(k))``, denominators gathered by group.

    With vectors, (3, b) in the basis, along which the sums are largest, denominators that are small there
    get the remainder that is sharp near a null if it is the smaller one.
    """
    ratio, weight = mix_slots(leaves)
    half2 = boxes.half2 * 0.5
    plain = Interval(np.zeros(len(boxes)))
    for k, w in zip(ratio, weight, strict=True):
        plain = plain + Interval(w) * family.numerator_isotropic[k]
        scale = Interval(w) * family.numerator_weight[k]
        form, slopes, up, _ = expansion(family, frames, boxes, family.numerator_point[k])
        total.add(scale, form, slopes)
        # a numerator's remainder is bounded by the identity, anchored or not
        total.rest = total.rest + where(w > 0.0, (scale * up * half2).most(), 0.0)
    for g, share in enumerate(group_shares(family, ratio, weight)):
        level = share * leaves.level
        plain = plain - level * family.denominator_isotropic[g]
        if np.any(share.high > 0.0):
            add_denominator(total, family, g, level, boxes, frames, vectors)
    total.matrix = total.matrix + frames.gram * plain


def add_denominator(
    total: Sum,
    family: Family,
    g: int,
    level: Interval,
    boxes: Boxes,
    frames: Frames,
    vectors: FloatArray | None,
) -> None:
    """Add ``-level`` times what the points give to one denominator; a level of zero has no effect."""
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        point = np.full(len(boxes), family.denominator_point[e])
        scale = level * family.denominator_weight[e]
        form, slopes, _, down = expansion(family, frames, boxes, point)
        share, rest = np.zeros(len(boxes)), down * boxes.half2 * 0.5
        if vectors is not None:
            share, rest = sharper(form, vectors, boxes, frames, point, family.points_m[point], rest)
        total.add(-(scale * (1.0 - Interval(share))), form, slopes)
        used = where(level.high > 0.0, (scale * rest).most(), 0.0)
        anchored = frames.turning & (point == frames.anchor)
        total.rest = total.rest + where(anchored, 0.0, used)
        total.across = total.across + where(anchored, used, 0.0)


def sharper(
    form: Interval,
    vectors: FloatArray,
    boxes: Boxes,
    frames: Frames,
    point: IntArray,
    point_m: FloatArray,
    plain: Interval,
) -> tuple[FloatArray, Interval]:
    """Return each box's eta and the remainder near a null, or zero and the plain one where that is smaller.

    Args:
        form: of one point, at the centres, in the frames' bases.
        vectors: (3, b) where it counts.
        boxes: whose remainders they are.
        frames: of the boxes.
        point: (b,) which point; the one that a frame turns towards keeps its own remainder.
        point_m: (b, 3) where it is.
        plain: lemma 2's remainder, positive.
    """
    at_centre = form.middle()
    here = quadratic(at_centre, vectors)
    near, rho = boxes.nearest(point_m), frames.rho_least
    turning = 6.0 / (near.squared() * rho) + _SWERVE / (near * rho.squared())
    bend = 2.0 / (near.squared() * near) + where(frames.turning, turning, 0.0)
    square = (bend * boxes.half2 * 0.5).squared()
    eta = np.sqrt(square.high / np.maximum(here, 1e-12 * at_centre[:3].sum(axis=0)))
    use = (eta > 0.0) & (eta < _LARGEST_ETA) & ~(frames.turning & (point == frames.anchor))
    eta = np.where(use, eta, _LARGEST_ETA)
    rest = (square / eta).most()
    use &= eta * here + rest.high < plain.high
    return np.where(use, eta, 0.0), where(use, rest, plain)


def add_cells(total: Sum, leaves: Leaves, boxes: Boxes, frames: Frames) -> None:
    """Add the sides of the cells, ``(v - low a)(high a - v) >= 0``, with their multipliers."""
    on_face = leaves.cell[:, 0] >= 0
    cell = np.where(on_face[:, None], leaves.cell, 0)
    for side in range(2):
        weight = np.where(on_face, leaves.sides[:, side], 0.0)
        if np.any(weight > 0.0):
            q = side_form(cell, side)
            squares = q.squared()
            norm = (squares.total() + squares[3:].total()).sqrt()
            add_constant(total, boxes, frames, q, weight, norm * _DIAGONAL)


def add_band(total: Sum, field: AxisField, leaves: Leaves, boxes: Boxes, frames: Frames) -> None:
    """Add ``c_hi I - e3 e3^T >= 0`` with a positive multiplier, ``e3 e3^T - c_lo I >= 0`` with a negative."""
    weight = leaves.band
    if not np.any(weight != 0.0):
        return
    upright = np.tile([[0.0], [0.0], [1.0], [0.0], [0.0], [0.0]], len(boxes))
    # the multiple of the identity does not turn, and the spread of e3 e3^T is one
    add_constant(total, boxes, frames, Interval(upright), -weight, Interval(np.ones(len(boxes))))
    ends = Interval(np.where(weight > 0.0, field.band[1], field.band[0])) * weight
    total.matrix = total.matrix + frames.gram * ends


def add_constant(
    total: Sum, boxes: Boxes, frames: Frames, q: Interval, weight: FloatArray, spread: Interval
) -> None:
    """Add multiples of constant forms, (6, b), with a bound on the spread of their eigenvalues."""
    total.add(Interval(weight), *constant(frames, q))
    bend = spread / frames.rho_least.squared() * SWING * np.abs(weight) * (boxes.half2 * 0.5)
    total.rest = total.rest + where(frames.turning, bend.most(), 0.0)


def top_vectors(total: Sum, horizontal: np.ndarray) -> FloatArray:
    """Return about the vectors of the largest eigenvalues at the centres, (3, b).

    Args:
        total: the sums.
        horizontal: (b,) whether the horizontal plane is all that counts.
    """
    full = matrices(total.matrix.middle())
    full[horizontal, 2, :] = full[horizontal, :, 2] = 0.0
    full[horizontal, 2, 2] = -np.linalg.norm(full[horizontal], axis=(1, 2)) - 1.0
    full[~np.all(np.isfinite(full), axis=(1, 2))] = 0.0
    return np.asarray(np.linalg.eigh(full)[1][:, :, -1].T)


def steepest(total: Sum, top: FloatArray) -> FloatArray:
    """Return about the gradient of the largest eigenvalue at the centres, (3, b).

    Args:
        total: the sums.
        top: (3, b) the vectors of those eigenvalues.
    """
    gradient = quadratic(total.slopes.middle(), top[:, None])
    return np.where(np.isfinite(gradient), gradient, 0.0)


def at_corners(half: FloatArray, matrix: Interval, slopes: Interval, horizontal: np.ndarray) -> np.ndarray:
    """Return which linear matrices are negative definite at all eight corners, and so in the whole box.

    Args:
        half: (3, b) the boxes' half sides.
        matrix: (6, b) at the centre.
        slopes: (6, 3, b).
        horizontal: (b,) whether the horizontal plane is all that counts.
    """
    ahead = slopes * half
    steps = list(zip((ahead[:, i] for i in range(3)), (-ahead[:, i] for i in range(3)), strict=True))
    holds = np.ones(half.shape[1], dtype=bool)
    for x, y, z in product(*steps):
        holds &= negative_definite(matrix + x + y + z, horizontal)
    return holds


def negative_definite(a: Interval, horizontal: np.ndarray | bool = False) -> np.ndarray:
    """Return which forms, (6, b), are negative definite for certain.

    Args:
        a: the forms.
        horizontal: where the first two coordinates are all that counts.
    """
    block, whole, _ = definite(-a)
    return np.asarray(np.where(horizontal, block, whole))
