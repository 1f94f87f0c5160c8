"""Channels in interval arithmetic: the amplitude of a link over boxes, and its excess gain.

The same statements as the solver's kernels (``link_field``, ``excess``), written down again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias, TypeVar

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.elementary import arctan, exp, log
from nullpose.certificate.forms import COLUMN, IDENTITY, ROW, outer, squares
from nullpose.certificate.interval import Interval, stack, where
from nullpose.certificate.jets import Jet
from nullpose.channel.elevation import DB_AVERAGE
from nullpose.channel.model import BY_DISTANCE, BY_ELEVATION, KNOTS
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.family import Family


@dataclass(frozen=True, slots=True, eq=False)
class Amplitude:
    """The amplitudes of links over their boxes, the roots of their excess gains.

    Args:
        value: (b,) at the centres; or the end of its range that makes the bound valid, with no slope.
        gradient: (3, b) by the position, at the centres.
        most: (b,) the largest in the box.
        slope: (b,) a bound on the first derivative along any unit direction.
        bend: (b,) likewise on the second.
    """

    value: Interval
    gradient: Interval
    most: Interval
    slope: Interval
    bend: Interval


_ROUND = 2e-13  # of ln g of a profile: more than its knots are rounded
Interval3: TypeAlias = tuple[Interval, Interval, Interval]
_Part = TypeVar("_Part", "Amplitude", "Excess")
_Parts: TypeAlias = tuple[tuple[int, Callable[..., _Part]], ...]


def power(x: Interval, exponent: FloatArray) -> Interval:
    """Return powers of positive numbers."""
    return exp(log(x) * exponent)


def most_excess(family: Family, point: IntArray, square: FloatArray) -> Interval | float:
    """Return a bound on the excess over ``d^2`` beyond a distance, by its square: the gain falls with it.

    Args:
        family: with its channels.
        point: (b,).
        square: (b,) lower bounds.
    """
    if not len(family.channels):
        return 1.0
    kind, e, unit = family.channels[point].T[:3]
    is_law = kind == BY_DISTANCE
    ratio = Interval(square) / Interval(np.where(is_law, unit, 1.0)).squared()
    return where(is_law, power(ratio, 0.5 * e), 1.0 + _ROUND * (family.channels.shape[1] > KNOTS))


def amplitude(family: Family, boxes: Boxes, point: IntArray, is_above: bool) -> Amplitude | None:
    """Return the amplitude of one point for each box; None where all are in free space.

    Args:
        family: with its channels.
        boxes: b of them.
        point: (b,).
        is_above: whether the link is to be bounded from above, else from below.
    """
    if not len(family.channels):
        return None
    unit, zeros = Interval(np.ones(len(boxes))), Interval(np.zeros((3, len(boxes))))
    parts = ((BY_DISTANCE, _by_distance), (BY_ELEVATION, _by_elevation))
    return _by_kind(Amplitude(unit, zeros, unit, zeros[0], zeros[0]), parts, family, boxes, point, is_above)


def _by_distance(rows: FloatArray, points_m: FloatArray, boxes: Boxes, is_above: bool) -> Amplitude:
    """Return the amplitude ``(d / d0)^c``."""
    c, unit = 0.5 * rows[1], Interval(rows[2]).squared()
    r = (Interval(points_m) - boxes.centre).T
    s, near = r.squared().total(), boxes.nearest(points_m)
    value, most = power(s / unit, 0.5 * c), power(near.squared() / unit, 0.5 * c)
    slope = most * np.abs(c) / near
    bend = slope * np.maximum(1.0, (Interval(c) - 1.0).magnitude()) / near
    far = power(Interval(boxes.farthest2(points_m)) / unit, 0.5 * c)
    most = where(c > 0.0, far, most)
    return Amplitude(value, r * (value * -c / s), most.most(), slope.most(), bend.most())


def _by_elevation(rows: FloatArray, points_m: FloatArray, boxes: Boxes, is_above: bool) -> Amplitude:
    """Return the amplitude of channels by elevation, or an end of its range where that leaves out less."""
    r = (Interval(points_m) - boxes.centre).T
    angles = _Angles.over(points_m, boxes)
    gain, first, second, _ = _relative(rows, angles.tangent)
    size, steep = Interval(second.magnitude()), Interval((first * 0.5).magnitude())
    bend = (size + (size.squared() + steep.squared() * 4.0).sqrt()) * 0.5
    slant = steep * angles.tangent.magnitude()
    bend = Interval(np.maximum(bend.high, slant.high))
    near, root = boxes.nearest(points_m), gain.sqrt().most()
    whole = root, (root * steep / near).most(), (root * bend / near.squared()).most()
    level = (r[0].squared() + r[1].squared()).sqrt()
    at_centre, change, *_ = _relative(rows, -r[2] / level)
    value = at_centre.sqrt()
    by = value * change * 0.5 / r.squared().total()
    gradient = stack([-(by * r[2] * r[0] / level), -(by * r[2] * r[1] / level), by * level])
    end = gain.high if is_above else gain.low
    inverse, square, (h0, h1, h2) = 1.0 / near.low, 0.5 * boxes.half2.low, (x.high for x in whole)
    b0, b1 = h0 * inverse, (h0 * inverse + h1) * inverse
    left_out = square * (b1 * b1 + b0 * (2.0 * b1 + h2) * inverse)
    use = left_out < np.abs(end - at_centre.middle()) * inverse**2 + 3.0 * square * end * inverse**4
    ends = Interval(end).sqrt()
    ends = Interval(ends.high if is_above else ends.low)
    return Amplitude(
        where(use, value, ends),
        where(use, gradient, 0.0),
        where(use, whole[0], ends),
        where(use, whole[1], 0.0),
        where(use, whole[2], 0.0),
    )


def _relative(rows: FloatArray, tangent: Interval) -> tuple[Interval, Interval, Interval, Interval]:
    """Return bounds on the excess gain g, ``g' / g`` by elevation, ``h'' / h`` of its root h, ``g'' / g``."""
    _, c, k, n, average = rows[:5]
    p = 1.0 / (exp(c - arctan(tangent) * k) + 1.0)
    p = Interval(np.maximum(p.low, 0.0), np.minimum(p.high, 1.0))
    in_db = average == DB_AVERAGE
    loss = log(Interval(n))
    hidden = 1.0 - p
    gain = where(in_db, exp(loss * hidden), (1.0 - Interval(n)) * p + n)
    # P (1 - P) = q (1 - q) grows with the lesser q of P and 1 - P, and keeps the digits of a small P
    least, most = np.minimum(p.low, hidden.low), np.minimum(np.minimum(p.high, hidden.high), 0.5)
    low, high = (Interval(q) * (1.0 - Interval(q)) for q in (least, most))
    spread = Interval(np.maximum(low.low, 0.0), high.high)
    first = where(in_db, -loss, (1.0 - Interval(n)) / gain) * spread * k
    bent, half = (1.0 - p * 2.0) * k, first * 0.5
    second = half * where(in_db, bent + half, bent - half)
    third = first * where(in_db, bent + first, bent)
    if len(rows) > KNOTS:
        log_gain, slope, bend = _profiles(rows, arctan(tangent))
        gain, both, square = gain * exp(log_gain), first * slope, slope.squared()
        first, second = first + slope, second + (both + square * 0.5 + bend) * 0.5
        third = third + both * 2.0 + square + bend
    return gain, first, second, third


def _profiles(rows: FloatArray, angle: Interval) -> tuple[Interval, Interval, Interval]:
    """Return bounds on ``ln g`` of profiles between two elevations, on its slope and its bend, (b,) each."""
    knots = rows[KNOTS + 1 :].reshape(-1, 3, rows.shape[1])
    (start, log, slope), (end, _, last) = knots[:-1].swapaxes(0, 1), knots[1:].swapaxes(0, 1)
    inside = (np.arange(1, len(knots))[:, None] < rows[KNOTS]) & (start <= angle.high) & (end >= angle.low)
    bend = (Interval(last) - slope) / (Interval(end) - start)
    low, high = (Interval(np.clip(a, start, end)) - start for a in (angle.low, angle.high))
    slopes = [bend * step + slope for step in (low, high)]
    logs = [(bend * step * 0.5 + slope) * step + log for step in (low, high)]
    # where the slope changes its sign, ln g goes on by slope^2 / (2 |bend|) from the low end
    steep = slopes[0].magnitude()
    rest = np.minimum((Interval(steep) / bend).magnitude(), (high - low).high)
    over = (Interval(steep) * rest * 0.5).high
    logs[0] += Interval(np.where(slopes[0].low < 0.0, -over, 0.0), np.where(slopes[0].high > 0.0, over, 0.0))
    return _hull(logs, inside) + Interval(-_ROUND, _ROUND), _hull(slopes, inside), _hull([bend], inside)


def _hull(parts: list[Interval], inside: np.ndarray) -> Interval:
    """Return bounds on all parts that are inside, over the first axis; 0 where none is."""
    low = np.min([np.where(inside, part.low, np.inf) for part in parts], axis=(0, 1))
    high = np.max([np.where(inside, part.high, -np.inf) for part in parts], axis=(0, 1))
    return where(np.any(inside, axis=0), Interval(low, high), 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Angles:
    """What is known of the elevation over boxes: of its tangent, and of its derivatives by the position."""

    tangent: Interval
    slopes: Interval
    bends: Interval

    @classmethod
    def over(cls, points_m: FloatArray, boxes: Boxes) -> _Angles:
        """Bound them for boxes, seen from a point each."""
        return cls.at((boxes.hull - Interval(points_m.T)), boxes.nearest2(points_m))

    @classmethod
    def at(cls, q: Interval, nearest2: FloatArray) -> _Angles:
        """Bound them for the drone at q as seen from the point, (3, b)."""
        x, y, z = q[0], q[1], q[2]
        level2, s = x.squared() + y.squared(), q.squared().total()
        s = Interval(np.maximum(s.low, nearest2), s.high)
        level = level2.sqrt()
        east, north = (_cosine(e / level) for e in (x, y))
        inwards, across = -z / s, -z / level / s
        outwards = z * level * 2.0 / s.squared()
        upright = (z.squared() - level2) / s.squared()
        slopes = stack([inwards * east, inwards * north, level / s])
        ee, nn = east.squared(), north.squared()
        bends = [outwards * ee + across * nn, outwards * nn + across * ee, -outwards]
        bends += [east * north * (outwards - across), upright * east, upright * north]
        # where a box is over the point, or under it, one end is infinite
        low = Interval(z.low) / np.where(z.low > 0.0, level.high, level.low)
        high = Interval(z.high) / np.where(z.high > 0.0, level.low, level.high)
        return cls(Interval(low.low, high.high), slopes, stack(bends))


def _cosine(x: Interval) -> Interval:
    return Interval(np.fmax(x.low, -1.0), np.fmin(x.high, 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class Excess:
    """Excess gains of links over their boxes.

    Args:
        value: (b,) at the centres.
        slopes: (3, b) by the position, there.
        over: (b,) all over the boxes, as are the two that follow.
        steep: (3, b) the slopes.
        bends: (6, b) the second derivatives.
    """

    value: Interval
    slopes: Interval
    over: Interval
    steep: Interval
    bends: Interval

    def times(self, centre: Interval3, over: Interval3) -> Jet:
        """Return the jet of a link from its value, slopes and Hessian without it: at centres, over boxes."""
        (value, slopes, _), (ranged, steep, bends) = centre, over
        mixed = outer(steep, self.steep) + self.bends * ranged
        return Jet(
            value * self.value,
            slopes * self.value + self.slopes * value,
            bends * self.over + mixed,
            ranged * self.over,
        )


def excess(family: Family, boxes: Boxes, point: IntArray, is_above: bool) -> Excess | None:
    """Return the excess gains of one point for each box; None where all points are in free space.

    An end of the range stands for all of it, where that leaves out less.
    """
    if not len(family.channels):
        return None
    unity, zeros = Interval(np.ones(len(boxes))), Interval(np.zeros((6, len(boxes))))
    parts = ((BY_DISTANCE, _excess_by_distance), (BY_ELEVATION, _excess_by_elevation))
    return _by_kind(Excess(unity, zeros[:3], unity, zeros[:3], zeros), parts, family, boxes, point, is_above)


def _by_kind(
    result: _Part, parts: _Parts[_Part], family: Family, boxes: Boxes, point: IntArray, is_above: bool
) -> _Part:
    """Put each kind's part where a box's point has that kind of channel."""
    rows, points_m = family.channels[point].T, family.points_m[point]
    for kind, part in parts:
        mask = rows[0] == kind
        if np.any(mask):
            # numbers of a row of the same kind for all others
            alike = np.where(mask, rows, rows[:, [np.argmax(mask)]])
            with np.errstate(invalid="ignore"):  # directly over a point nothing is known: infinity less that
                other = part(alike, points_m, boxes, is_above)
            names = type(result).__slots__
            result = replace(result, **{n: where(mask, getattr(other, n), getattr(result, n)) for n in names})
    return result


def _excess_by_distance(rows: FloatArray, points_m: FloatArray, boxes: Boxes, is_above: bool) -> Excess:
    """Return ``(d / d0)^e``."""
    e, unit = rows[1], Interval(rows[2]).squared()

    def at(r: Interval, s: Interval) -> tuple[Interval, Interval, Interval]:
        value = power(s / unit, 0.5 * e)
        bends = squares(r) * (value * (Interval(e) * (Interval(e) - 2.0)) / s.squared())
        return value, r * (value * -e / s), bends + (value * e / s) * IDENTITY[:, None]

    r = (Interval(points_m) - boxes.centre).T
    value, slopes, _ = at(r, r.squared().total())
    ends = Interval(boxes.nearest2(points_m), boxes.farthest2(points_m))
    return Excess(value, slopes, *at(Interval(points_m.T) - boxes.hull, ends))


def _excess_by_elevation(rows: FloatArray, points_m: FloatArray, boxes: Boxes, is_above: bool) -> Excess:
    """Return the excess gain of channels by elevation."""
    angles = _Angles.over(points_m, boxes)
    gain, first, _, second = _relative(rows, angles.tangent)
    bends = (angles.bends * first + squares(angles.slopes) * second) * gain
    centre = _Angles.at(Interval(boxes.centre.T) - points_m.T, np.zeros(len(boxes)))
    value, change, *_ = _relative(rows, centre.tangent)
    end = gain.high if is_above else gain.low
    half = boxes.half.T
    weight = np.where(IDENTITY > 0.0, 0.25, 0.5)[:, None] * half[ROW] * half[COLUMN]
    use = np.sum((bends.high - bends.low) * weight, axis=0) < np.abs(end - value.middle())
    return Excess(
        where(use, value, end),
        where(use, centre.slopes * (value * change), 0.0),
        where(use, gain, end),
        where(use, angles.slopes * (first * gain), 0.0),
        where(use, bends, 0.0),
    )


def excess_at(family: Family, position_m: Iterable[Fraction]) -> Interval | None:
    """Return the excess gain of every point at a position, (m,); None where all are in free space.

    Args:
        family: with its channels.
        position_m: (3,) metres.
    """
    if not len(family.channels):
        return None
    place = np.array([float(x) for x in position_m])
    many = np.tile(place, (len(family.points_m), 1))
    slack = np.nextafter(np.abs(many), np.inf) - np.abs(many)
    boxes = Boxes(leaf=np.arange(len(many)), centre=many, half=slack)
    ends = [excess(family, boxes, np.arange(len(many)), is_above) for is_above in (False, True)]
    low, high = (gain.over for gain in ends if gain is not None)
    return Interval(low.low, high.high)
