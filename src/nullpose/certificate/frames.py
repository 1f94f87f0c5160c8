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
from nullpose.certificate.forms import COLUMN, Linear, congruence, gram, outer, squares
from nullpose.certificate.interval import Interval, dot, swapped, where
from nullpose.certificate.lemmas import DIRECTION_BEND
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray

UNIT = np.eye(3)[:, :, None]
"""The world's axes, for any number of boxes."""


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Where each box's forms are looked at from.

    Args:
        turning: (b,) whether the frame turns towards a point.
        anchor: (b,) that point.
        direction: (3, b) the unit vector to it, zero where the frame stands still.
        rho: (b,) its distance from the centre.
        rho_least: (b,) its least distance from the box.
        basis: (3, 3, b) columns: the coordinates that definiteness is asked in. In a turning frame the third
            is the direction itself, and not a rounded one: the anchor's form then has no third row, however
            strong the anchor is.
        gram: (6, b) basis^T basis.
        across: (6, b) I - d d^T in the basis: in a turning frame the third row is zero.
    """

    turning: np.ndarray
    anchor: IntArray
    direction: Interval
    rho: Interval
    rho_least: Interval
    basis: Interval
    gram: Interval
    across: Interval

    def turned(self, vectors: Interval) -> Interval:
        """Return basis^T v of one vector for each box, (3, b), or of several, (3, n, b)."""
        several = vectors.low.ndim > 2
        return dot(self.basis[:, :, None] if several else self.basis, vectors[:, None])


def frames_of(ratios: Ratios, leaves: Leaves, boxes: Boxes) -> Frames:
    """Return the frames of boxes, each with its leaf."""
    turning = leaves.test == TOWARDS
    anchor = np.where(turning, leaves.point, 0)
    anchor_m = ratios.points_m[anchor]
    offset = (Interval(anchor_m) - boxes.centre).T
    rho = offset.squared().total().sqrt()
    direction = where(turning, offset / rho, 0.0)
    axes = axes_across(direction.middle(), turning)
    basis = Interval(axes.copy(), axes)
    basis.low[:, 2, turning], basis.high[:, 2, turning] = (
        direction.low[:, turning],
        direction.high[:, turning],
    )
    products = gram(basis)
    products.low[2] = products.high[2] = 1.0
    no_row = turning & (COLUMN == 2)[:, None]
    across = where(no_row, 0.0, products - squares(dot(basis, direction[:, None])))
    return Frames(turning, anchor, direction, rho, boxes.nearest(anchor_m), basis, products, across)


def axes_across(third: FloatArray, mask: np.ndarray) -> FloatArray:
    """Build bases, (3, 3, b), whose first two columns are across vectors, (3, b); else the world's axes."""
    chosen = third[:, mask].T
    pairs = np.stack([chosen, np.eye(3)[np.argmin(np.abs(chosen), axis=1)]], axis=-1)
    axes = np.tile(UNIT, third.shape[1])
    axes[:, :2, mask] = np.moveaxis(np.linalg.qr(pairs, "complete")[0][:, :, 1:], 0, -1)
    return axes


def expansion(
    ratios: Ratios, frames: Frames, boxes: Boxes, point: IntArray, is_above: bool
) -> tuple[Linear, Interval, Interval]:
    """Expand the form of one point for each box, and bound two second derivatives, (b,) each: lemmas 1 and 2.

    The first bounds that of the form (``is_above``) or of minus the form, a multiple of the identity;
    for the anchor of a turning frame, what its form is made of: :func:`anchor_shape`. The second bounds the
    length of the link vector's.
    """
    anchored = frames.turning & (point == frames.anchor)
    points_m = ratios.points_m[point]
    a = (Interval(points_m) - boxes.centre).T
    s = a.squared().total()
    seen = frames.turned(a)
    twice = less_leak(squares(seen), ratios)
    # the anchor's is (I - (1 - leak) d d^T) / rho^2, without the rounding of a - rho d
    shape = anchor_shape(ratios, frames)
    form = where(anchored, shape / s, (frames.gram * s - twice) / s.squared())
    # b' = -e + (e (d.a) - d (a.e)) / rho for the three axes e, and rho d for the anchor itself
    swing = (dot(frames.direction, a) * UNIT - frames.direction[:, None] * a) / frames.rho
    step = where(frames.turning, swing, 0.0) - UNIT
    rate = dot(a[:, None], step) * 2.0
    turned = less_leak(outer(frames.turned(step), seen[:, None]), ratios)
    bent = turned + rate * frames.gram[:, None]
    slopes = rate * twice[:, None] * 2.0 / (s.squared() * s) - bent / s.squared()
    pull = frames.direction * 2.0 / (s * frames.rho)
    slopes = where(anchored, shape[:, None] * pull, slopes)
    near = boxes.nearest(points_m)
    rate = where(frames.turning & ~anchored, 1.0 / frames.rho_least, 0.0)
    # the rules invert, scale and turn: bounds on the link vector and on its first two derivatives
    link, (h0, h1, h2) = Linear(form, slopes), (Interval(size) for size in (1.0, 0.0, 0.0))
    if len(ratios.channels):
        h, gradient, sizes = amplitude(ratios, boxes, point, is_above)
        square, change = h.squared(), gradient * h * 2.0
        link = Linear(form * square, slopes * square + form[:, None] * change)
        h0, h1, h2 = (sizes[i] for i in range(3))
    length = h0 / near
    slope = (length + h1) / near
    bend = (slope * 2.0 + h2) / near
    seen_slope = slope + length * rate
    seen_bend = bend + (slope * 2.0 + length * rate * DIRECTION_BEND) * rate
    # the rule square; the anchor's is the square of h / rho
    if is_above:
        second = slope.squared() + length * bend + seen_slope.squared() + length * seen_bend
    else:
        falling = (slope + h1 / near + h2) / near * length
        second = where(anchored, falling, length * seen_bend) * 2.0
    return link, second.most(), seen_bend.most()


def anchor_shape(ratios: Ratios, frames: Frames) -> Interval:
    """Return ``I - (1 - leak) d d^T`` in the bases, (6, b): an anchor's form times its distance squared.

    Without a leak its third row is exactly zero.
    """
    across = less_leak(frames.across, ratios)
    return across if ratios.leak == 0.0 else across + frames.gram * ratios.leak


def less_leak(form: Interval, ratios: Ratios) -> Interval:
    """Return ``1 - leak`` times a form; the form itself, not rounded, of an antenna with a perfect null."""
    return form if ratios.leak == 0.0 else form * (1.0 - Interval(ratios.leak))


def constant(frames: Frames, q: Interval) -> Linear:
    """Return constant forms, (6, b), in the basis; in a turning frame they have slopes.

    With ``K = (e d^T - d e^T) / rho`` the frame's transpose changes by K, which keeps d on the anchor; the
    form, by ``K Q + Q K^T``.
    """
    form, half = congruence(q, frames.basis)
    if not np.any(frames.turning):
        return Linear(form, Interval(np.zeros((6, 3, len(frames.turning)))))
    # in the basis: e (Q d)^T - d (Q e)^T and its transpose, over rho
    along = dot(half, frames.direction[:, None])
    d = frames.turned(frames.direction)
    slopes = outer(swapped(frames.basis), along[:, None]) - outer(d[:, None], swapped(half))
    return Linear(form, where(frames.turning, slopes / frames.rho, 0.0))
