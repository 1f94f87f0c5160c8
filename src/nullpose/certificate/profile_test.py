"""Leaves of rotationally symmetric antennas: a weighted sum that is negative whatever position and axis.

With r the vector from a position to the leaf's anchor, a ground point, an axis is given by the angle u from r
to it and a spin s about r. With ``w_j = r + d_j`` the vector to point j and x, y, z the coordinates of r in
cyclic order from the leaf's chart on, the cosine between axis and w_j is

    c_j |w_j| = cos u (r.w_j) / |r| + sin u sin s (f d_y - y (x d_x + z d_z)) / (|r| sqrt f)
                - sin u cos s (z d_x - x d_z) / sqrt f,   f = x^2 + z^2.

The sum of ``g(c_j) / |w_j|^2`` with the leaf's multipliers is bounded by its value and slopes at the centre
and its second derivatives over the box. Where the polynomial g is below zero, the gain is zero. For an
interferer the sum is then too large, which is safe; for a node its ratio is below the level, which is tested:
that holds for the smallest ratio, and no mean has a certificate here.
"""

from __future__ import annotations

from functools import reduce

import numpy as np

from nullpose.certificate.boxes import Boxes, halved
from nullpose.certificate.certificate import DEEPEST, Leaves
from nullpose.certificate.interval import Interval, where
from nullpose.certificate.plain_tests import borders, kept_out
from nullpose.certificate.profile import ProfileField
from nullpose.certificate.profile_links import PI, Link, links_of, sine_cosine
from nullpose.certificate.taylor import Taylor, joined, pairs
from nullpose.certificate.weighted_sum import weighted_sum
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family

_ROUNDS = 60  # of halving what is not excluded
_MOST = (
    4  # pieces of a leaf at once, on average, and some thousand: a certificate that holds needs one or two
)
_NOTHING = 1e-300  # a share below it is outward rounding of zero
_CHUNK = 4096
_ANGLE_SLACK_RAD = 1e-12  # radians: what is reached is taken so much wider, for the rounding of its ends


def profile_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes their leaves exclude.

    Args:
        family: the ratios.
        field: with the antenna's gain.
        leaves: of the boxes, with anchor, chart, cell of axes and multipliers.
        boxes: to be tested.
    """
    assert isinstance(field, ProfileField)
    holds = _kept_out_somewhere(family, boxes)
    isotropic = family.ratios.denominator_isotropic[family.ratios.denominator_of]
    unheard = Interval(leaves.level[:, None]) * isotropic - family.ratios.numerator_isotropic
    rows = np.flatnonzero(~holds & np.all(unheard.low > 0.0, axis=1))
    # what is left: parts of leaves, with the row of each
    parts, cells = Boxes(leaf=rows, centre=boxes.centre[rows], half=boxes.half[rows]), leaves.chosen(rows)
    most = _MOST * len(rows) + _CHUNK
    for _ in range(_ROUNDS):
        if not 0 < len(parts) <= most or np.any(cells.depths > DEEPEST):
            break
        excluded, side = _excluded(family, field, cells, parts)
        parts, cells = _halved(parts.chosen(~excluded), cells.chosen(~excluded), side[~excluded])
    holds[rows] = True
    holds[np.unique(parts.leaf)] = False
    return holds


def _kept_out_somewhere(family: Family, boxes: Boxes) -> np.ndarray:
    """Check which boxes lie in some keep-out ball or zone."""
    each = (kept_out(family, np.full(len(boxes), border), boxes) for border in range(borders(family)))
    return reduce(np.logical_or, each, np.zeros(len(boxes), dtype=bool))


def _halved(boxes: Boxes, leaves: Leaves, side: IntArray) -> tuple[Boxes, Leaves]:
    """Cut into both halves of each cell, across a coordinate: x, y, z, the angle or the spin."""
    both = leaves.chosen(np.tile(np.arange(len(side)), 2))
    rows = np.flatnonzero(np.tile(side, 2) >= 3)
    depth = 1 + 2 * (np.tile(side, 2)[rows] - 3)
    both.cell[rows, depth] += 1
    both.cell[rows, depth + 1] = 2 * both.cell[rows, depth + 1] + (rows >= len(side))
    return halved(boxes, side), both


def _excluded(
    family: Family, field: ProfileField, leaves: Leaves, boxes: Boxes
) -> tuple[np.ndarray, IntArray]:
    """Check which cells are excluded, and find the coordinate to halve of those that are not."""
    excluded, side = _kept_out_somewhere(family, boxes), np.zeros(len(boxes), dtype=np.int64)
    key = leaves.point * 3 + leaves.face
    for shared in np.unique(key[~excluded]):
        rows = np.flatnonzero((key == shared) & ~excluded)
        excluded[rows], side[rows] = _excluded_by_bound(
            family, field, leaves.chosen(rows), boxes.chosen(rows)
        )
    return excluded, side


def _excluded_by_bound(
    family: Family, field: ProfileField, leaves: Leaves, boxes: Boxes
) -> tuple[np.ndarray, IntArray]:
    """Check which cells of one anchor and chart have a negative sum, or no axis within reach."""
    chart, anchor = int(leaves.face[0]), int(leaves.point[0])
    order = np.array([chart, chart + 1, chart + 2]) % 3
    upright, begin = (2 - chart) % 3, family.ratios.points_m[max(anchor, 0), order]
    points_m, centre_m = family.ratios.points_m[:, order], boxes.centre.T[order]
    apart, offset = Interval(points_m) - begin, Interval(begin[:, None]) - centre_m
    depth, index = leaves.depths[:, 3:].T, leaves.indices[:, 3:].T
    low, high = field.spans[int(anchor < 0)].T[:, :, None]  # of both angles, in multiples of pi
    half_turn = PI * ((high - low) * np.ldexp(0.5, -depth)) + _ANGLE_SLACK_RAD * (low < high)
    half = np.vstack([boxes.half.T[order], half_turn.high])
    turns = [sine_cosine(x) for x in low + (high - low) * np.ldexp(index + 0.5, -depth)]
    links, axis = links_of(apart, anchor, offset, turns, half)
    missed = (anchor >= 0) & _out_of_reach(field, axis, upright)
    bound, shares = _largest(family, field, leaves, links, axis[upright])
    # a gain that hardly changes needs no cuts across the turn: what adds most is halved
    length_m = np.linalg.norm(offset.middle(), axis=0)
    sizes = half / np.vstack([np.tile(0.5 * length_m, (3, 1)), np.ones((2, len(length_m)))])
    # without multipliers of ratios the leaf is out of reach, whatever the sum: the largest side is cut
    tells = np.all(np.isfinite(shares), axis=0) & np.any(shares > _NOTHING, axis=0)
    side = np.argmax(np.where(tells, shares, sizes), axis=0)
    return missed | (bound < 0.0), np.where(side < 3, order[np.minimum(side, 2)], side)


def _largest(
    family: Family, field: ProfileField, leaves: Leaves, links: list[Link], vertical: Taylor
) -> tuple[FloatArray, FloatArray]:
    """Return upper bounds of the sums over cells, (b,), and about what each coordinate adds to them, (5, b).

    Args:
        family: the ratios.
        field: with the antenna's gain.
        leaves: with multipliers and level.
        links: of each point.
        vertical: cosine of the axis to the vertical.
    """
    profile, (identity, terms) = field.profile, weighted_sum(family.ratios, leaves)
    zero, total = Interval(np.zeros(len(leaves))), links[0][0].alike(identity)
    for j, (cosine, inverse2) in enumerate(links):
        weight = sum((where(point == j, scale * sign, 0.0) for point, scale, sign in terms), zero)
        at, over = cosine.at.value, cosine.over.value
        gain = cosine.composed(*(joined(profile.near(n, at), profile.within(n, over)) for n in range(3)))
        total = total + gain * inverse2 * weight
    if np.any(leaves.band):
        total = total + _within_reach(field, leaves.band, vertical)
    shares, bent = total.at.slopes.magnitude() * total.half, total.over.bends.magnitude()
    for pair, (i, j) in enumerate(zip(*pairs(5)[:2], strict=True)):
        shares[[i, j]] += bent[pair] * total.half[i] * total.half[j]
    return np.asarray(np.fmin(total.largest().high, total.over.value.high)), shares


def _within_reach(field: ProfileField, band: FloatArray, vertical: Taylor) -> Taylor:
    """Multiply what is not negative for axes within reach by its multiplier.

    Args:
        field: with the ends of what is reached.
        band: multipliers of the largest angle from the vertical, or minus those of the least.
        vertical: cosine of the axis to the vertical.
    """
    cos_least, cos_most = field.ends[0][1], field.ends[1][1]
    # if it is even, the nearer of both directions, where all of the cell has the same: |n3|
    cos_least = max(cos_least, -cos_most) if field.even else cos_least
    ahead, behind = vertical.over.value.low > 0.0, vertical.over.value.high < 0.0
    side = ahead.astype(float) - behind if field.even else np.ones(len(band))
    # 1e-15: rounding of the angles that are reached, and of their cosines, changes these by less
    end = where(band > 0.0, cos_most - 1e-15, cos_least + 1e-15)
    return (vertical * side - end) * (band * np.abs(side))


def _out_of_reach(field: ProfileField, axis: list[Taylor], upright: int) -> np.ndarray:
    """Check which cells have no axis that the airframe reaches.

    With t the angle between the vertical and the axis at the centre, and b that of an end of what is reached,
    ``sin(t - b)`` and ``cos t`` change by no more than the axis moves, on the straight way between both ends.

    Args:
        field: with the ends of what is reached.
        axis: its coordinates.
        upright: which coordinate is the altitude.
    """
    # the vertical coordinate and the other two in cyclic order, by negative indices
    x, y, z = (axis[upright - ahead].at.value for ahead in (2, 1, 0))
    sine = (x.squared() + y.squared()).sqrt()
    steps = (Interval((part.over.value - part.at.value).magnitude()).squared() for part in axis)
    moved = Interval((sum(steps, Interval(0.0)).sqrt() + _ANGLE_SLACK_RAD).high)
    (sine_low, cosine_low), (sine_high, cosine_high) = field.ends
    missed = np.ones(len(moved.low), dtype=bool)
    for cosine in (z, -z)[: 1 + field.even]:
        nearer, farther = cosine * sine_low - sine * cosine_low, sine * cosine_high - cosine * sine_high
        below = ((nearer - moved).low > 0.0) | ((cosine - moved).low > cosine_low)
        above = ((farther - moved).low > 0.0) | ((cosine + moved).high < cosine_high)
        missed &= below | above
    return missed
