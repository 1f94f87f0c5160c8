"""Forms of points seen from a box, in a frame that stands still or turns towards a point.

The same lemmas as the solver's (see docs/proofs.md), written down again: in world coordinates,
turned into a convenient basis by a congruence, which changes no sign, and in interval arithmetic. Vectors
have their components, and forms their six numbers, along the first axis, the boxes along the last.

Lemmas 1 and 2 bound what is left of a form by one number. The sums of link vectors would do for isotropic
points too, but each leaf would take ten times as long and more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, Leaves
from nullpose.certificate.channels import amplitude
from nullpose.certificate.forms import COLUMN, IDENTITIES, congruence, gram, linear, outer, squares
from nullpose.certificate.interval import Interval, dot, where
from nullpose.certificate.lemmas import DIRECTION_BEND
from nullpose.objectives.ratios import IntArray, Ratios

UNIT = np.eye(3)[:, :, None]
"""The world's axes, for any number of boxes."""
THIRD_SQUARE = (np.arange(6) == 2)[:, None]
"""``e3 e3^T``, and which of a form's six numbers that is, for any number of boxes."""


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Where each box's forms are looked at from.

    Args:
        turning: (b,) whether the frame turns towards a point.
        anchor: (b,) that point.
        direction: (3, b) the unit vector d to it, zero where the frame stands still.
        rho: (b,) its distance from the centre.
        rho_least: (b,) its least distance from the box.
        basis: (3, 3, b) columns: the coordinates that definiteness is asked in; see :func:`bases_about`.
        gram: (6, b) basis^T basis.
        shape: (6, b) ``I - (1 - leak) d d^T`` in the basis of a turning frame: the anchor's form times its
            distance squared. Without a leak its third row is exactly zero, however strong the anchor is.
    """

    turning: np.ndarray
    anchor: IntArray
    direction: Interval
    rho: Interval
    rho_least: Interval
    basis: Interval
    gram: Interval
    shape: Interval


def frames_of(ratios: Ratios, leaves: Leaves, boxes: Boxes) -> Frames:
    """Return the frames of boxes, each with its leaf."""
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    anchor_m = ratios.points_m[anchor]
    offset = (Interval(anchor_m) - boxes.centre).T
    rho = offset.squared().total().sqrt()
    direction = where(turning, offset / rho, 0.0)
    basis, products = bases_about(direction, turning)
    shape = where(THIRD_SQUARE, ratios.leak, products)
    return Frames(turning, anchor, direction, rho, boxes.nearest(anchor_m), basis, products, shape)


def bases_about(third: Interval, mask: np.ndarray) -> tuple[Interval, Interval]:
    """Build bases, (3, 3, b), about unit vectors; where the mask does not hold, the world's axes.

    The third column is the vector d itself, enclosed and not rounded, and the other two are across it for
    certain: ``d d^T`` has one entry in the basis, which is 1. Also returns the columns' products, (6, b).
    """
    chosen = third.middle()[:, mask].T
    beside = np.stack([chosen, np.eye(3)[np.argmin(np.abs(chosen), axis=1)]], axis=-1)
    axes = np.tile(UNIT, third.low.shape[1])
    axes[:, :2, mask] = np.moveaxis(np.linalg.qr(beside, "complete")[0][:, :, 1:], 0, -1)
    across = Interval(axes) - third[:, None] * dot(Interval(axes), third[:, None])
    exact = where((np.arange(3) == 2)[:, None], third[:, None], across)
    basis = where(mask, exact, axes)
    return basis, where(mask & (COLUMN == 2)[:, None], IDENTITIES, gram(basis))


def expansion(
    ratios: Ratios, frames: Frames, boxes: Boxes, point: IntArray, is_above: bool
) -> tuple[Interval, Interval, Interval]:
    """Expand the form of one point for each box, and bound two second derivatives, (b,) each: lemmas 1 and 2.

    The first bounds that of the form (``is_above``) or of minus the form, a multiple of the identity;
    for the anchor of a turning frame, of its shape. The second bounds the length of the link vector's.
    """
    anchored = frames.turning & (point == frames.anchor)
    points_m = ratios.points_m[point]
    a = (Interval(points_m) - boxes.centre).T
    s = a.squared().total()
    h, gradient, (h0, h1, h2) = amplitude(ratios, boxes, point, is_above)
    # steps[:, i] is b' of "The test of a box" for e_i: K a - e_i with K = (e d^T - d e^T) / rho
    swing = (dot(frames.direction, a) * UNIT - frames.direction[:, None] * a) / frames.rho
    steps, share = where(frames.turning, swing, 0.0) - UNIT, h / s
    # those of h a / s, where s changes by -2 a_i
    slopes = steps * share + a[:, None] * ((gradient + a * share * 2.0) / s)
    seen = dot(frames.basis[:, :, None], linear(a * share, slopes)[:, None])
    # (1 - leak) w w^T of the link vector w = h a / s
    kept = 1.0 - Interval(ratios.leak)
    along = linear(squares(seen[:, 0]) * kept, outer(seen[:, 1:] * kept, seen[:, :1]))
    # |w|^2 = h^2 / s is the same in every frame
    square = h * share
    length2 = linear(square[None], ((gradient * h + a * square) * 2.0 / s)[None])
    link = where(anchored, frames.shape, frames.gram)[:, None] * length2 - where(anchored, 0.0, along)
    least_m = boxes.nearest(points_m)
    rate = where(frames.turning & ~anchored, 1.0 / frames.rho_least, 0.0)
    # the rules invert, scale and turn: bounds on the link vector and on its first two derivatives
    length = h0 / least_m
    slope = (length + h1) / least_m
    bend = (slope * 2.0 + h2) / least_m
    seen_slope = slope + length * rate
    seen_bend = bend + (slope * 2.0 + length * rate * DIRECTION_BEND) * rate
    # the rule square; the anchor's is the square of h / rho
    if is_above:
        second = slope.squared() + length * bend + seen_slope.squared() + length * seen_bend
    else:
        falling = (slope + h1 / least_m + h2) / least_m * length
        second = where(anchored, falling, length * seen_bend) * 2.0
    return link, second.most(), seen_bend.most()


def constant(frames: Frames, q: Interval) -> tuple[Interval, Interval]:
    """Return constant forms, (6, b), in the basis, and their slopes, (6, 3, b), in a turning frame.

    With ``K = (e d^T - d e^T) / rho`` the frame's transpose changes by K, which keeps d on the anchor; the
    form, by ``K Q + Q K^T``: in the basis ``e (Q d)^T - d (Q e)^T`` and its transpose, over rho.
    """
    form, half = congruence(q, frames.basis)
    along = dot(half, frames.direction[:, None])
    slopes = outer(frames.basis.T, along[:, None]) - outer(Interval(UNIT[:, 2:]), half.T)
    return form, where(frames.turning, slopes / frames.rho, 0.0)
