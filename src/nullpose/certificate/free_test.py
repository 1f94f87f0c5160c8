"""Leaves of a free axis: a weighted sum of forms that is negative definite all over the box."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.axis_cells import side_form
from nullpose.certificate.boxes import Boxes, group_shares, mix_slots
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.frames import (
    PAIRS,
    SWING,
    Frames,
    congruent,
    expansion,
    finite,
    frames_of,
    projector,
    turning_rate,
)
from nullpose.certificate.interval import Interval
from nullpose.family import AxisField, Family

__all__ = ["Sum", "free_holds", "negative_definite"]

_LARGEST_ETA = 0.5
_SWERVE = (2.0 + 2.0 / np.sqrt(3.0)) * (1.0 + 1e-12)  # see "Near a null", rounded up
_DIAGONAL = np.sqrt(2.0) * (1.0 + 1e-12)  # a form's spread of eigenvalues over its Frobenius norm, rounded up


@dataclass(slots=True, eq=False)
class Sum:
    """A sum of forms over each box, in its frame: the expansion at the centre and what is left out of it.

    Args:
        matrix: the value at the centre, six numbers.
        slopes: its three derivatives there.
        rest: how much the sum may exceed the expansion, times the identity.
        across: the same, times the projector across the frame's direction.
    """

    matrix: list[Interval]
    slopes: list[list[Interval]]
    rest: Interval
    across: Interval

    @classmethod
    def empty(cls, boxes: Boxes) -> Sum:
        """Return the sum of nothing.

        Args:
            boxes: one sum for each.
        """
        zero = Interval(np.zeros(len(boxes)))
        return cls([zero] * 6, [[zero] * 6 for _ in range(3)], zero, zero)

    def add(self, scale: Interval, form: list[Interval], slopes: list[list[Interval]]) -> None:
        """Add a multiple of a form and of its slopes."""
        self.matrix = [m + scale * f for m, f in zip(self.matrix, form, strict=True)]
        self.slopes = [
            [m + scale * f for m, f in zip(mine, others, strict=True)]
            for mine, others in zip(self.slopes, slopes, strict=True)
        ]

    def closed(self, frames: Frames) -> None:
        """Put what is left out of the expansion into its value."""
        cover = projector(frames)
        self.matrix = [
            m + g * self.rest + q * self.across
            for m, g, q in zip(self.matrix, frames.gram, cover, strict=True)
        ]


def free_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes their leaf's multipliers exclude, whatever the axis in the leaf's cell and the band.

    Where every axis is level, the sum need only be negative on the level plane.

    Args:
        family: the ratios.
        field: the axes; an affine field stands for all of them.
        leaves: with frame, multipliers and level.
        boxes: to be tested.
    """
    holds, vectors = _holds(family, field, leaves, boxes, None)
    left = np.flatnonzero(~holds)
    if len(left):  # near a null the denominators' remainders may be had smaller
        holds[left], _ = _holds(family, field, leaves, boxes.chosen(left), vectors[left])
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
    total.closed(frames)
    level_axes = ~frames.turning & (field.is_free and field.band[1] == 0.0)
    top = top_vectors(total, level_axes)

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        matrix = [m[rows] for m in total.matrix]
        slopes = [[m[rows] for m in slope] for slope in total.slopes]
        gram = [g[rows] for g in frames.gram]
        half = boxes.half[rows]
        for weight, bound in constraints:
            swing = (Interval(half).squared() * bound.bend).total()
            value = (bound.value + swing) * weight
            matrix = [m + g * value for m, g in zip(matrix, gram, strict=True)]
            for e in range(3):
                slope = bound.slopes[:, e] * weight
                slopes[e] = [m + g * slope for m, g in zip(slopes[e], gram, strict=True)]
        return at_corners(half, matrix, slopes, level_axes[rows])

    return negative_where_allowed(family, leaves, boxes, test, lambda: steepest(total, top)), top


def add_ratios(
    total: Sum, family: Family, leaves: Leaves, boxes: Boxes, frames: Frames, vectors: FloatArray | None
) -> None:
    """Add ``sum_k lambda_k (N_k - t D_g(k))``, denominators gathered by group.

    With vectors, (b, 3) in the basis, along which the sums are largest, denominators that are small there
    get the remainder that is sharp near a null if it is the smaller one.
    """
    ratio, weight = mix_slots(leaves, boxes)
    half2 = boxes.half2 * 0.5
    zero = Interval(np.zeros(len(boxes)))
    plain, shares = zero, group_shares(family, ratio, weight)
    for k, w in zip(ratio, weight, strict=True):
        plain = plain + Interval(w) * family.numerator_isotropic[k]
    levels = [share * leaves.level[boxes.leaf] for share in shares]
    for level, isotropic in zip(levels, family.denominator_isotropic, strict=True):
        plain = plain - level * isotropic
    total.add(plain, frames.gram, [[zero] * 6] * 3)
    for k, w in zip(ratio, weight, strict=True):
        scale = Interval(w) * family.numerator_weight[k]
        form, slopes, up, _ = expansion(family, frames, boxes, family.numerator_point[k])
        total.add(scale, form, slopes)
        # a numerator's remainder is bounded by the identity, anchored or not
        total.rest = total.rest + np.where(w > 0.0, (scale * up * half2).high, 0.0)
    for g, level in enumerate(levels):
        if np.any(shares[g].high > 0.0):
            add_denominator(total, family, g, level, boxes, frames, vectors)


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
        where = np.full(len(boxes), family.denominator_point[e])
        scale = level * family.denominator_weight[e]
        form, slopes, _, down = expansion(family, frames, boxes, where)
        rest = down * boxes.half2 * 0.5
        if vectors is not None:
            share, rest = sharper(form, vectors, boxes, frames, where, family.points_m[where], rest)
            total.add(-(scale * (1.0 - Interval(share))), form, slopes)
        else:
            total.add(-scale, form, slopes)
        used = np.where(level.high > 0.0, (scale * rest).high, 0.0)
        anchored = frames.turning & (where == frames.anchor)
        total.rest = total.rest + np.where(anchored, 0.0, used)
        total.across = total.across + np.where(anchored, used, 0.0)


def sharper(
    form: list[Interval],
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
        vectors: (b, 3) where it counts.
        boxes: whose remainders they are.
        frames: of the boxes.
        point: (b,) which point; the one that a frame turns towards keeps its own remainder.
        point_m: (b, 3) where it is.
        plain: lemma 2's remainder, positive.
    """
    here = np.asarray(
        sum(
            (1.0 if i == j else 2.0) * f.middle() * vectors[:, i] * vectors[:, j]
            for f, (i, j) in zip(form, PAIRS, strict=True)
        )
    )
    near = Interval(Interval(boxes.nearest2(point_m)).sqrt().low)
    turn = np.where(frames.turning, 1.0, 0.0)
    bend = 2.0 / (near.squared() * near)
    bend = bend + 6.0 / (near.squared() * frames.rho_least) * turn
    bend = bend + _SWERVE / (near * frames.rho_least.squared()) * turn
    square = (bend * boxes.half2 * 0.5).squared()
    least = 1e-12 * sum(f.middle() for f in form[:3])
    eta = np.sqrt(square.high / np.maximum(here, least))
    use = (eta > 0.0) & (eta < _LARGEST_ETA) & ~(frames.turning & (point == frames.anchor))
    eta = np.where(use, eta, _LARGEST_ETA)
    rest = square / eta
    use &= eta * here + rest.high < plain.high
    return np.where(use, eta, 0.0), Interval(
        np.where(use, finite(rest.low), plain.low), np.where(use, finite(rest.high), plain.high)
    )


def add_cells(total: Sum, leaves: Leaves, boxes: Boxes, frames: Frames) -> None:
    """Add the sides of the cells, ``(v - low a)(high a - v) >= 0``, with their multipliers."""
    cell, sides = leaves.cell[boxes.leaf], leaves.sides[boxes.leaf]
    on_face = cell[:, 0] >= 0
    cell = np.where(on_face[:, None], cell, 0)
    for side in range(2):
        weight = np.where(on_face, sides[:, side], 0.0)
        if np.any(weight > 0.0):
            q = side_form(cell, side)
            flat = Interval(q.low.reshape(-1, 9), q.high.reshape(-1, 9))
            add_constant(total, boxes, frames, q, weight, flat.squared().total().sqrt() * _DIAGONAL)


def add_band(total: Sum, field: AxisField, leaves: Leaves, boxes: Boxes, frames: Frames) -> None:
    """Add ``c_hi I - e3 e3^T >= 0`` with a positive multiplier, ``e3 e3^T - c_lo I >= 0`` with a negative."""
    weight = leaves.band[boxes.leaf]
    if not np.any(weight != 0.0):
        return
    q = np.zeros((len(boxes), 3, 3))
    q[:, 2, 2] = 1.0
    # the multiple of the identity does not turn, and the spread of e3 e3^T is one
    add_constant(total, boxes, frames, Interval(q), -weight, Interval(np.ones(len(boxes))))
    ends = Interval(np.where(weight > 0.0, field.band[1], field.band[0])) * weight
    total.matrix = [m + g * ends for m, g in zip(total.matrix, frames.gram, strict=True)]


def add_constant(
    total: Sum, boxes: Boxes, frames: Frames, q: Interval, weight: FloatArray, spread: Interval
) -> None:
    """Add multiples of constant forms, (b, 3, 3), with a bound on the spread of their eigenvalues."""
    zero = Interval(np.zeros(len(boxes)))
    slopes = [[zero] * 6 for _ in range(3)]
    if np.any(frames.turning):
        turning = np.where(frames.turning, 1.0, 0.0)
        slopes = [[x * turning for x in congruent(frames, turning_rate(frames, q, e))] for e in range(3)]
        bend = spread / frames.rho_least.squared() * SWING * np.abs(weight) * (boxes.half2 * 0.5)
        total.rest = total.rest + np.where(frames.turning, finite(bend.high), 0.0)
    total.add(Interval(weight), congruent(frames, q), slopes)


def top_vectors(total: Sum, level_axes: np.ndarray) -> FloatArray:
    """Return about the vectors of the largest eigenvalues at the centres, (b, 3).

    Args:
        total: the sums.
        level_axes: (b,) whether the level plane is all that counts.
    """
    full = np.zeros((len(level_axes), 3, 3))
    for m, (i, j) in enumerate(PAIRS):
        full[:, i, j] = full[:, j, i] = total.matrix[m].middle()
    full[level_axes, 2, :] = full[level_axes, :, 2] = 0.0
    full[level_axes, 2, 2] = -np.linalg.norm(full[level_axes], axis=(1, 2)) - 1.0
    full[~np.all(np.isfinite(full), axis=(1, 2))] = 0.0
    return np.asarray(np.linalg.eigh(full)[1][:, :, -1])


def steepest(total: Sum, top: FloatArray) -> FloatArray:
    """Return about the gradient of the largest eigenvalue at the centres, (b, 3).

    Args:
        total: the sums.
        top: (b, 3) the vectors of those eigenvalues.
    """
    slope = np.zeros((3, len(top), 3, 3))
    for e in range(3):
        for m, (i, j) in enumerate(PAIRS):
            slope[e, :, i, j] = slope[e, :, j, i] = total.slopes[e][m].middle()
    gradient = np.einsum("bi,ebij,bj->be", top, slope, top)
    return np.where(np.isfinite(gradient), gradient, 0.0)


def at_corners(
    half: FloatArray, matrix: list[Interval], slopes: list[list[Interval]], level_axes: np.ndarray
) -> np.ndarray:
    """Return which linear matrices are negative definite at all eight corners, and so in the whole box.

    Args:
        half: (b, 3) the boxes' half sides.
        matrix: six numbers, at the centre.
        slopes: three times six.
        level_axes: (b,) whether the level plane is all that counts.
    """
    holds = np.ones(len(half), dtype=bool)
    for corner in range(8):
        sign = [1.0 if corner >> i & 1 else -1.0 for i in range(3)]
        here = list(matrix)
        for i in range(3):
            here = [h + s * (sign[i] * half[:, i]) for h, s in zip(here, slopes[i], strict=True)]
        holds &= negative_definite(here, level_axes)
    return holds


def negative_definite(a: list[Interval], level_axes: np.ndarray | bool = False) -> np.ndarray:
    """Return which forms are negative definite for certain, by the leading minors of their negatives.

    Args:
        a: six numbers.
        level_axes: where the first two coordinates are all that counts.
    """
    minor = a[0] * a[1] - a[3].squared()
    det = -(a[2] * minor) + a[0] * a[5].squared() + a[1] * a[4].squared() - a[3] * a[4] * a[5] * 2.0
    return np.asarray((a[0].high < 0.0) & (minor.low > 0.0) & (level_axes | (det.low > 0.0)))
