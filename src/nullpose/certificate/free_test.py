"""Leaves of a free axis: a weighted sum of forms that is negative definite all over the box."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, WORLD, Leaves
from nullpose.certificate.dipoles import dipole_sum
from nullpose.certificate.forms import COUNTED, IDENTITY, linear, negative, quadratic, side_form, top_vectors
from nullpose.certificate.frames import THIRD_SQUARE, Frames, constant, expansion, frames_of
from nullpose.certificate.interval import Interval, where
from nullpose.certificate.lemmas import CONSTANT_SWING, SPREAD_OVER_NORM
from nullpose.certificate.weighted_sum import weighted_sum
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family

_LARGEST_ETA = 0.5


def free_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes their leaf's multipliers exclude, whatever the axis in the leaf's cell and the band.

    Weak duality: where the sum is negative definite, no axis has all ratios at the level. Where every axis is
    horizontal, it need only be so on the horizontal plane.

    Args:
        family: the ratios.
        field: the axes; an affine field stands for all of them.
        leaves: of the boxes, with frame, multipliers and level.
        boxes: to be tested.
    """
    holds, vectors = _holds(family, field, leaves, boxes, None)
    left = np.flatnonzero(~holds & ((leaves.test == TOWARDS) | (len(family.ratios.ground_axes) == 0)))
    failed = leaves.chosen(left)
    if len(family.ratios.ground_axes):  # in coordinates that turn too fast, still ones may do
        failed = replace(failed, test=np.full(len(left), WORLD))
    if len(left):  # without dipoles the denominators' remainders near a null may be had smaller
        holds[left], _ = _holds(family, field, failed, boxes.chosen(left), vectors[:, left])
    return holds


def _holds(
    family: Family, field: AxisField, leaves: Leaves, boxes: Boxes, vectors: FloatArray | None
) -> tuple[np.ndarray, FloatArray]:
    """Check which boxes are excluded, and find about the largest eigenvalues' vectors at their centres."""
    if len(family.ratios.ground_axes):
        held = sum((q * weight for q, weight, _ in constants(field, leaves)), Interval(np.zeros((6, 1))))
        total, shear = dipole_sum(family.ratios, leaves, boxes, held)
        whole, turning = shear.gram, shear.on
    else:
        frames = frames_of(family.ratios, leaves, boxes)
        total = ratio_forms(family.ratios, leaves, boxes, frames, vectors)
        total = with_constants(total, field, leaves, boxes, frames)
        whole, turning = frames.gram, frames.turning
    horizontal = ~turning & (field.is_free and field.band[1] == 0.0)
    top = top_vectors(total[:, 0], horizontal)

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        bound, gram, half = total[..., rows], whole[:, rows], boxes.half[rows].T
        for weight, constraint in constraints:
            value, slopes = constraint.at.value + constraint.bent(), constraint.at.slopes
            bound = bound + linear(gram * (value * weight), gram[:, None] * (slopes * weight))
        return negative(bound, half, horizontal[rows])

    return negative_where_allowed(family.domain, leaves, boxes, test, lambda: steepest(total, top)), top


def ratio_forms(
    ratios: Ratios, leaves: Leaves, boxes: Boxes, frames: Frames, vectors: FloatArray | None
) -> Interval:
    """Return ``sum_k lambda_k (N_k - t D_g(k))``, what its expansion leaves out being put into its value.

    With vectors, (3, b) in the basis, along which the sums are largest, denominators that are small there
    get the remainder that is sharp near a null if it is the smaller one.
    """
    identity, terms = weighted_sum(ratios, leaves)
    half_square, value = boxes.half2 * 0.5, frames.gram * identity
    total = Interval(np.zeros((6, 4, len(boxes))))
    for point, scale, sign in terms:
        form, bent, bend = expansion(ratios, frames, boxes, point, sign > 0.0)
        share, rest, around = np.zeros(len(boxes)), bent * half_square, frames.gram
        if sign < 0.0:  # the remainder of what is added is bounded by the identity, anchored or not
            around = where(frames.turning & (point == frames.anchor), frames.shape, frames.gram)
            if vectors is not None:
                share, rest = sharper(form[:, 0], vectors, boxes, frames, point, bend, rest)
        total = total + form * (scale * (1.0 - Interval(share)) * sign)
        value = value + around * where(scale.high != 0.0, (scale * rest).most(), 0.0)
    return total + linear(value, Interval(np.zeros((6, 3, len(boxes)))))


def sharper(
    form: Interval,
    vectors: FloatArray,
    boxes: Boxes,
    frames: Frames,
    point: IntArray,
    bend: Interval,
    plain: Interval,
) -> tuple[FloatArray, Interval]:
    """Choose each box's eta and the remainder near a null, or zero and the plain one where that is smaller.

    Args:
        form: of one point, at the centres, in the frames' bases.
        vectors: (3, b) where it counts.
        boxes: whose remainders they are.
        frames: of the boxes.
        point: (b,) which point; the one that a frame turns towards keeps its own remainder.
        bend: (b,) bounds on the second derivatives of its link vectors.
        plain: lemma 2's remainder, positive.
    """
    at_centre = form.middle()
    seen = quadratic(at_centre, vectors)
    square = (bend * boxes.half2 * 0.5).squared()
    eta = np.sqrt(square.high / np.maximum(seen, 1e-12 * at_centre[:3].sum(axis=0)))
    use = (eta > 0.0) & (eta < _LARGEST_ETA) & ~(frames.turning & (point == frames.anchor))
    eta = np.where(use, eta, _LARGEST_ETA)
    rest = (square / eta).most()
    use &= eta * seen + rest.high < plain.high
    return np.where(use, eta, 0.0), where(use, rest, plain)


def with_constants(
    total: Interval, field: AxisField, leaves: Leaves, boxes: Boxes, frames: Frames
) -> Interval:
    """Return a sum with multiples of the forms that are not negative in the cells and the band added."""
    for q, weight, spread in constants(field, leaves):
        if np.any(weight != 0.0):
            bent = boxes.half2 * 0.5 * np.abs(weight) * CONSTANT_SWING * spread / frames.rho_least.squared()
            value, slopes = (part * weight for part in constant(frames, q))
            total = total + linear(value + frames.gram * where(frames.turning, bent.most(), 0.0), slopes)
    return total


def constants(field: AxisField, leaves: Leaves) -> Iterator[tuple[Interval, FloatArray, Interval]]:
    """Yield forms, (6, b), with their multipliers and a bound on the spread of their eigenvalues.

    For the sides of the cells ``(v - low a)(high a - v)``; for the band ``c_hi I - e3 e3^T`` with a positive
    multiplier, ``e3 e3^T - c_lo I`` with minus a negative one.
    """
    on_face = leaves.face >= 0
    cell = np.where(on_face[:, None], leaves.cell, 0)
    for side in range(2):
        q = side_form(cell, side)
        norm = (q.squared() * COUNTED[:, None]).total().sqrt()
        yield q, np.where(on_face, leaves.sides[:, side], 0.0), norm * SPREAD_OVER_NORM
    ends = np.where(leaves.band > 0.0, field.band[1], field.band[0])
    # the multiple of the identity does not turn, and the spread of e3 e3^T is one
    yield Interval(IDENTITY[:, None] * ends) - THIRD_SQUARE, leaves.band, Interval(np.ones(len(leaves)))


def steepest(total: Interval, top: FloatArray) -> FloatArray:
    """Return about the gradient of the largest eigenvalue at the centres, (3, b).

    Args:
        total: the sums.
        top: (3, b) the vectors of those eigenvalues.
    """
    gradient = quadratic(total[:, 1:].middle(), top[:, None])
    return np.where(np.isfinite(gradient), gradient, 0.0)
