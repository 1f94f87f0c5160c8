"""Channels in interval arithmetic: the logarithm of the excess gain, as formulas of distance and elevation.

From it follow the gain of a link over boxes, by the position, and its amplitude, by distance and elevation.
A gain has two factors, each stated once.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import partial, reduce
from operator import add

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.elementary import arctan, exp, log
from nullpose.certificate.forms import COLUMN, IDENTITY, ROW, outer
from nullpose.certificate.interval import Interval, above, stack, where
from nullpose.certificate.taylor import (
    Rule,
    Taylor,
    chosen,
    coordinates,
    exponential,
    joined,
    logarithm,
    root,
)
from nullpose.channel.elevation import DB_AVERAGE
from nullpose.channel.model import BLOCKED, BY_ELEVATION, EXPONENT, KNOTS, ONSET, REFERENCE_M
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray


def _by_distance(rows: FloatArray, distance: Taylor, angle: Taylor) -> Taylor:
    """Return the logarithm of the factor by distance, ``(d / d0)^e``."""
    e, unit = map(Interval, rows[[EXPONENT, REFERENCE_M]])
    return (distance * (1.0 / unit)).of(logarithm) * e


def _by_elevation(rows: FloatArray, distance: Taylor, angle: Taylor) -> Taylor:
    """Return the logarithm of the factor by the chance P of sight: ``n + (1 - n) P``, or ``n^(1 - P)``."""
    c, k, n, average = rows[ONSET:BLOCKED]
    sight = (angle * k - c).of(_logistic)
    in_power = (sight * (1.0 - Interval(n)) + n).of(logarithm)
    gain = chosen(average == DB_AVERAGE, (1.0 - sight) * log(Interval(n)), in_power)
    return gain + angle.of(partial(_profiles, rows)) if len(rows) > KNOTS else gain


def _log_gain(rows: FloatArray, distance: Taylor, angle: Taylor) -> Taylor:
    """Return the logarithm of the excess gains of channels, (width, b): the sum over the factors of each."""
    none, factors = distance.alike(np.zeros(rows.shape[1])), []
    for mask, formula in ((rows[EXPONENT] != 0.0, _by_distance), (rows[0] == BY_ELEVATION, _by_elevation)):
        if np.any(mask):
            # numbers of a row that has the factor for all others
            alike = np.where(mask, rows, rows[:, [np.argmax(mask)]])
            factors.append(chosen(mask, formula(alike, distance, angle), none))
    return reduce(add, factors) if factors else none


def _logistic(x: Interval) -> Rule:
    """Return ``P = 1 / (1 + e^-x)`` by its rule: ``P' = P (1 - P)`` and ``P'' = P' (1 - 2 P)``."""
    p = 1.0 / (exp(-x) + 1.0)
    p = Interval(np.maximum(p.low, 0.0), np.minimum(p.high, 1.0))
    hidden = 1.0 - p
    # q (1 - q) grows with the lesser q of P and 1 - P, and keeps the digits of a small P
    least, most = np.minimum(p.low, hidden.low), np.minimum(np.minimum(p.high, hidden.high), 0.5)
    low, high = (Interval(q) * (1.0 - Interval(q)) for q in (least, most))
    spread = Interval(np.maximum(low.low, 0.0), high.high)
    return p, spread, spread * (hidden - p)


def _profiles(rows: FloatArray, angle: Interval) -> Rule:
    """Return bounds on ``ln g`` of profiles between two elevations by its rule, (places, b) each.

    Parabolas do not quite end where the next ones begin. With twice these jumps added, the range encloses the
    function less what it has jumped since the centre, which is smooth.
    """
    knots = rows[KNOTS + 1 :].reshape(-1, 3, 1, rows.shape[1])
    (start, level, slope), (end, after, last) = knots[:-1].swapaxes(0, 1), knots[1:].swapaxes(0, 1)
    outside = (start > angle.high) | (end < angle.low)
    inside = (np.arange(1, len(knots))[:, None, None] < rows[KNOTS]) & ~outside
    width = Interval(end) - start
    bend = (Interval(last) - slope) / width
    jumps = np.where(
        inside, (((bend * width * 0.5) + slope) * width + (Interval(level) - after)).magnitude(), 0.0
    )
    jumped = 2.0 * above(np.sum(jumps, axis=0)).max(axis=0)
    low, high = (Interval(np.clip(a, start, end)) - start for a in (angle.low, angle.high))
    slopes = [bend * step + slope for step in (low, high)]
    logs = [(bend * step * 0.5 + slope) * step + level for step in (low, high)]
    # where the slope changes its sign, ln g goes on by slope^2 / (2 |bend|) from the low end
    steep = slopes[0].magnitude()
    rest = np.minimum((Interval(steep) / bend).magnitude(), (high - low).high)
    over = (Interval(steep) * rest * 0.5).high
    logs[0] += Interval(np.where(slopes[0].low < 0.0, -over, 0.0), np.where(slopes[0].high > 0.0, over, 0.0))
    return _hull(logs, inside) + Interval(-jumped, jumped), _hull(slopes, inside), _hull([bend], inside)


def _hull(parts: list[Interval], inside: np.ndarray) -> Interval:
    """Return bounds on all parts that are inside, over the first axis; 0 where none is."""
    low = np.min([np.where(inside, part.low, np.inf) for part in parts], axis=(0, 1))
    high = np.max([np.where(inside, part.high, -np.inf) for part in parts], axis=(0, 1))
    return where(np.any(inside, axis=0), Interval(low, high), 0.0)


def most_excess(ratios: Ratios, point: IntArray, square: FloatArray) -> Interval | float:
    """Bound the excess at a distance, by its square. Over the squared distance none beyond is larger.

    Args:
        ratios: with its channels.
        point: (b,).
        square: (b,) lower bounds.
    """
    if not len(ratios.channels):
        return 1.0
    rows, every = ratios.channels[point].T, Interval([[-2.0]], [[2.0]])
    e, unit = rows[[EXPONENT, REFERENCE_M]]
    ratio = Interval(square) / Interval(np.where(e != 0.0, unit, 1.0)).squared()
    by_law = where(e != 0.0, exp(log(ratio) * (0.5 * e)), 1.0)
    # a profile's gain at any angle is at most 1, but for rounding
    return by_law * exp(_profiles(rows, every)[0][0]) if len(rows) > KNOTS else by_law


def _sight(points_m: FloatArray, boxes: Boxes, rows: FloatArray) -> tuple[Taylor, Taylor, Interval]:
    """Return the distance of boxes from points, the elevation that these see them at, and its tangent.

    The last two are zero where no channel depends on them.
    """
    q = boxes.position - points_m.T
    distance, none = q.squared().total().of(root), Interval(np.zeros(len(boxes)))
    if not np.any(mask := rows[0] == BY_ELEVATION):
        return distance, q.alike(none), none
    angle, tangent = elevation(q)
    return distance, chosen(mask, angle, q.alike(none)), where(mask, tangent, none)


def elevation(q: Taylor) -> tuple[Taylor, Interval]:
    """Return the elevation of places, ``arctan(z / L)`` with ``L^2 = x^2 + y^2``, and its tangent over boxes.

    Its slopes are ``(L z_i - z L_i) / |q|^2``.
    """
    z, square = q[2], q.squared().total()
    level = q[:2].squared().total().of(root)
    up, height, whole = z.value[None], level.value[None], square.value[None]
    slopes = (z.slopes * height - level.slopes * up) / whole
    bends = (-(level.bends * up) - outer(slopes, square.slopes) * 0.5) / whole
    # where a box is over the point, or under it, one end is infinite
    z_over, near_far = z.over.value, level.over.value
    low = Interval(z_over.low) / np.where(z_over.low > 0.0, near_far.high, near_far.low)
    high = Interval(z_over.high) / np.where(z_over.high > 0.0, near_far.low, near_far.high)
    tangent = Interval(low.low, high.high)
    angle = arctan(joined(z.at.value / level.at.value, tangent))
    return Taylor(q.half, angle, slopes, bends).tightened(), tangent


@np.errstate(over="ignore", invalid="ignore")  # directly over a point nothing is known: infinity less that
def amplitude(
    ratios: Ratios, boxes: Boxes, point: IntArray, is_above: bool
) -> tuple[Interval, Interval, list[Interval]]:
    """Bound the amplitude of one point over each box, the root of its excess gain.

    An end of the range stands for all of it, with no slope, where that leaves out less.
    Returns its value at the centres, (b,), its gradient there, (3, b), and bounds, (b,) each, on it and on
    its first two derivatives along any unit direction.

    Args:
        ratios: with its channels.
        boxes: b of them.
        point: (b,).
        is_above: whether the link is to be bounded from above, else from below.
    """
    if not len(ratios.channels):
        unit, flat = Interval(np.ones(1)), Interval(np.zeros((3, 1)))
        return unit, flat, [unit, flat[0], flat[0]]
    rows = ratios.channels[point].T
    distance, angle, tangent = _sight(ratios.points_m[point], boxes, rows)
    at, d = stack([distance.at.value, angle.at.value]), distance.over.value
    polar = coordinates(at, stack([d, angle.over.value]))
    h = (_log_gain(rows, polar[0], polar[1]) * 0.5).of(exponential)
    # derivatives along the line of sight, as the elevation grows, and across both
    value, slopes, bends = h.over
    out, up = slopes[0], slopes[1] / d
    outwards, turned, mixed = bends[0], (bends[1] / d + out) / d, (bends[2] - up) / d
    block = Interval(np.maximum(outwards.magnitude(), turned.magnitude())) + mixed.magnitude()
    bend = Interval(np.maximum(block.high, ((out - up * tangent) / d).magnitude()))
    slope = (out.squared() + up.squared()).sqrt()
    gradient = distance.at.slopes * h.at.slopes[0] + angle.at.slopes * h.at.slopes[1]
    h0, h1, h2 = (x.most().high for x in (value, slope, bend))
    end, closeness, square = _end(h, is_above), 1.0 / d.low, 0.5 * boxes.half2.low
    b0, b1 = h0 * closeness, (h0 * closeness + h1) * closeness
    left_out = square * (b1 * b1 + b0 * (2.0 * b1 + h2) * closeness)
    by_end = np.abs(end**2 - h.at.value.middle() ** 2) * closeness**2 + 3.0 * square * end**2 * closeness**4
    use = left_out < by_end
    sizes = [where(use, size, alone) for size, alone in ((h0, end), (h1, 0.0), (h2, 0.0))]
    return where(use, h.at.value, end), where(use, gradient, 0.0), sizes


@np.errstate(over="ignore", invalid="ignore")
def _gain(ratios: Ratios, boxes: Boxes, point: IntArray) -> Taylor:
    """Return the excess gains of one point for each box."""
    rows = ratios.channels[point].T
    return _log_gain(rows, *_sight(ratios.points_m[point], boxes, rows)[:2]).of(exponential)


def _end(gain: Taylor, is_above: bool) -> FloatArray:
    """Take the end of a range over boxes that bounds it from above, or from below."""
    return gain.over.value.high if is_above else gain.over.value.low


def excess_end(ratios: Ratios, boxes: Boxes, point: IntArray, is_above: bool) -> Interval | float:
    """Bound the excess gains of one point over each box from above, or from below."""
    return Interval(_end(_gain(ratios, boxes, point), is_above)) if len(ratios.channels) else 1.0


def excess(ratios: Ratios, boxes: Boxes, point: IntArray, is_above: bool) -> Taylor | None:
    """Return the excess gains of one point for each box; None where all points are in free space.

    An end of the range stands for all of it, where that leaves out less.
    """
    if not len(ratios.channels):
        return None
    gain, half = _gain(ratios, boxes, point), boxes.half.T
    end = _end(gain, is_above)
    weight = np.where(IDENTITY > 0.0, 0.25, 0.5)[:, None] * half[ROW] * half[COLUMN]
    bends = gain.over.bends
    use = np.sum((bends.high - bends.low) * weight, axis=0) < np.abs(end - gain.at.value.middle())
    return chosen(use, gain, gain.alike(end))


def excess_at(ratios: Ratios, position_m: Iterable[Fraction]) -> Interval | None:
    """Return the excess gain of every point at a position, (m,); None where all are in free space.

    Args:
        ratios: with its channels.
        position_m: (3,) metres.
    """
    if not len(ratios.channels):
        return None
    place, points = np.array([float(x) for x in position_m]), np.arange(len(ratios.points_m))
    many = np.tile(place, (len(points), 1))
    # the position in fractions, which a pose's need not be, is within a last place of its nearest numbers
    slack = np.nextafter(np.abs(many), np.inf) - np.abs(many)
    return _gain(ratios, Boxes(leaf=points, centre=many, half=slack), points).over.value
