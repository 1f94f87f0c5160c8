"""Sums of forms where points have dipoles: an upper bound over each box, linear in the position ("The sum").

Links are squares of link vectors, which are bounded as such (see :func:`square_over`): near a null the square
is never below zero, which the derivatives of the form alone do not know.
"""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import excess_end
from nullpose.certificate.forms import COLUMN, IDENTITIES, IDENTITY, ROW, linear, outer, squares, top_vectors
from nullpose.certificate.frames import UNIT
from nullpose.certificate.interval import Interval, stack, where
from nullpose.certificate.shear import AxisShear, link_vector, offset_to, shear_of
from nullpose.certificate.taylor import Taylor, cross
from nullpose.certificate.weighted_sum import weighted_sum
from nullpose.objectives.ratios import Ratios
from nullpose.physics.types import FloatArray

_MOST_ETA = 0.25
_SHARE = 0.1
_TINY = 1e-290


def dipole_sum(
    ratios: Ratios, leaves: Leaves, boxes: Boxes, constant: Interval
) -> tuple[Interval, AxisShear]:
    """Bound the sum of a leaf from above over its box, linear in the position, in coordinates that turn.

    Args:
        ratios: over the points.
        leaves: with multipliers, frame and level.
        boxes: of the leaves.
        constant: forms, (6, b), that are not negative in the cells and the band.
    """
    shear, (identity, terms) = shear_of(ratios, leaves, boxes), weighted_sum(ratios, leaves)
    whole = shear.identity()
    rest, leaking = whole.alike(Interval(np.zeros((6, len(boxes))))), whole[0].alike(identity)
    links: list[tuple[Taylor, Interval, Interval, float]] = []
    for point, plain, sign in terms:
        scale = plain * excess_end(ratios, boxes, point, sign > 0.0)
        r, near = offset_to(ratios.points_m[point], boxes)
        axes, through = ratios.ground_axes[point], ratios.ground_leaks[point]
        if ratios.leak > 0.0:
            leaking = leaking + _gain(r, near, axes, through) * (scale * (sign * ratios.leak))
        scale = scale * (1.0 - Interval(ratios.leak))
        anchored = shear.on & (point == shear.anchor) & (sign < 0.0)
        # an isotropic antenna is three dipoles across each other, and a dipole that leaks is one in part
        for counts, still, share, vectors in (
            (through < 1.0, anchored & (through < 1.0), 1.0 - Interval(through), [axes]),
            (through > 0.0, anchored & (through == 1.0), Interval(through), [UNIT[i].T for i in range(3)]),
        ):
            part = where(counts, scale * share, 0.0)
            if np.any(still):
                rest = rest + shear.anchored * where(still, part * sign, 0.0)
            part = where(still, 0.0, part)
            for v in vectors if np.any(part.high != 0.0) else ():
                a = link_vector(r.at_centres(), near.at_centres(), v)
                links.append((*shear.seen(a, near.over.value), part, sign))
    # E^T E, which the identity leaves out, is not negative, and at most the square of E
    square = shear.sizes[0].squared() * np.maximum(leaking.over.value.high, 0.0)
    rest = rest + whole * leaking + shear.gram * square.most()
    if np.any(constant.magnitude() != 0.0):
        rest = rest + shear.form(constant)
    centre = sum((squares(a.at.value) * (scale * sign) for a, _, scale, sign in links), rest.at.value)
    top = top_vectors(centre)
    total = linear_above(rest, np.abs(centre.middle()[:3]), top)
    squared = (square_over(a, third, top, scale, sign) for a, third, scale, sign in links)
    return sum(squared, total), shear


def _gain(r: Taylor, near: Taylor, axes: FloatArray, through: FloatArray) -> Taylor:
    """State a point's own gain over ``|r|^2``, ``|v x r|^2 / |r|^4`` of a dipole along v where it has one."""
    square = near.squared()
    of_dipole = cross(r, Interval(axes.T)).squared().total() * square * square
    return of_dipole * (1.0 - Interval(through)) + square * through


def linear_above(form: Taylor, sizes: FloatArray, top: FloatArray) -> Interval:
    """Return an upper bound on forms over boxes, (6, b), linear in the position.

    What is not linear changes an entry off the diagonal by at most r from the middle, and
    ``2 r x y <= e x^2 + r^2 y^2 / e`` for any e.

    Args:
        form: the forms.
        sizes: (3, b) about how large a sum's diagonal is at the centres: it bears a share of that.
        top: (3, b) where it counts.
    """
    products = squares(Interval(-form.half, form.half)) * np.where(IDENTITY > 0.0, 0.5, 1.0)[:, None]
    bent = (form.over.bends * products).T.total()
    middle, radius = bent.middle(), Interval(bent.radius()[3:])
    i, j = ROW[3:], COLUMN[3:]
    larger = sizes[i] >= sizes[j]
    seen = np.abs(np.where(larger, top[i], top[j]))
    e = np.fmax(radius.high, _SHARE * np.maximum(sizes[i], sizes[j]))
    e = np.fmin(e, radius.high / np.maximum(seen, 1e-300)) + _TINY
    share, rest = Interval(e), (radius.squared() / e).most()
    first, second = where(larger, share, rest), where(larger, rest, share)
    # x bears its part of xy and xz, y of xy and yz, z of xz and yz
    pairs = (first[0], first[1]), (second[0], first[2]), (second[1], second[2])
    diagonal = [bent[k].most() + left + right for k, (left, right) in enumerate(pairs)]
    value = form.at.value + stack(diagonal + [Interval(entry) for entry in middle[3:]])
    return linear(value, form.at.slopes)


def square_over(vector: Taylor, third: Interval, top: FloatArray, scale: Interval, sign: float) -> Interval:
    """Return an upper bound on ``sign * scale * c c^T`` over boxes, linear in the position.

    With c's linear part p and the rest s, ``(p + s)^2`` is at most ``(1 + eta) p^2 + (1 + 1 / eta) s^2`` and
    at least ``(1 - eta) p^2 - s^2 / eta`` for any eta, sharp at ``top`` for the one that is chosen.

    Args:
        vector: c.
        third: (b,) a bound on its third derivative along any unit direction.
        top: (3, b) where it counts.
        scale: (b,) not negative.
        sign: 1 or -1.
    """
    half, at = vector.half, vector.at
    steps = Interval(half)[ROW] * half[COLUMN] * np.where(IDENTITY > 0.0, 0.25, 1.0)[:, None]
    parts, reach2 = at.bends * steps, Interval(half).squared().total()
    value = at.value + parts[:, 0] + parts[:, 1] + parts[:, 2]
    ball = (third * reach2 * reach2.sqrt() / 6.0).most()
    weight = _weights(parts, top) + 1e-3 * ball.high
    total = (Interval(weight).total() + ball).most()
    ahead = np.abs(np.sum(value.middle() * top, axis=0))
    eta = np.clip(total.high / np.maximum(ahead, 1e-300), 1e-12, _MOST_ETA)
    kept = scale * (Interval(eta) * sign + 1.0)
    added = scale * (1.0 / Interval(eta) + (1.0 if sign > 0.0 else 0.0)) * total
    rest = _spread(parts, weight) * added + IDENTITIES * (ball * added)
    if sign > 0.0:
        steep = at.slopes * half
        weight = _weights(steep, top)
        rest = rest + _spread(steep, weight) * (kept * Interval(weight).total())
    slopes = outer(at.slopes, value[:, None])
    return linear(squares(value) * (kept * sign) + rest, slopes * (kept * sign))


def _weights(vectors: Interval, top: FloatArray) -> FloatArray:
    """Return about how much vectors, (3, n, b), count along others."""
    middle = vectors.middle()
    along = np.abs(np.einsum("ksb,kb->sb", middle, top))
    return np.asarray(along + 1e-2 * np.linalg.norm(middle, axis=0) + _TINY)


def _spread(vectors: Interval, weight: FloatArray) -> Interval:
    """Return ``sum_s d_s d_s^T / weight_s``, (6, b)."""
    return (squares(vectors) * (1.0 / Interval(weight))).T.total()
