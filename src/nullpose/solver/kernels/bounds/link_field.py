"""A link over a box of positions: what bounds its form's second derivative, and its channel's amplitude.

A link is the squared length of something linear in the axis: ``|u x w|^2`` with ``w = h r / |r|^2``, h being
the amplitude of the point's channel, the root of its excess gain. Four rules bound it along any unit
direction: *invert* (``r / |r|^2``), *scale* by h, *turn* with a frame, and *square*. Proofs:
docs/proofs.md, lemmas 1 and 2, and "Channels".
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nullpose.channel.elevation import DB_AVERAGE
from nullpose.channel.model import AVERAGE, BY_ELEVATION, EXPONENT, KNOTS, RATE
from nullpose.solver.kernels.bounds.constants import DIRECTION_BEND
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.linear_algebra.channel import (
    elevation_gain,
    gain_by_distance,
    gain_by_elevation,
    knot_below,
    parabola,
    sight_probability,
    steepness,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot, minus, row as row_of, square_range


class Amplitude(NamedTuple):
    """The amplitude of a channel over a box.

    Args:
        value: at the centre; or the end of its range in the box that makes the bound valid, with no slope.
        gradient: by the position, at the centre.
        most: the largest in the box.
        slope: a bound on its first derivative along any unit direction, in the box.
        bend: likewise on its second derivative.
    """

    value: float
    gradient: tuple[float, float, float]
    most: float
    slope: float
    bend: float


class Reach(NamedTuple):
    """Bounds over a box on the length of a vector and of its first two derivatives along a unit direction."""

    length: float
    slope: float
    bend: float


@small_kernel
def times_amplitude(field, reach):
    """Return the reach of a vector times an amplitude: the rule *scale*."""
    slope = field.most * reach.slope + field.slope * reach.length
    bend = field.most * reach.bend + 2.0 * field.slope * reach.slope + field.bend * reach.length
    return Reach(field.most * reach.length, slope, bend)


@small_kernel
def scaled_inverse(field, a):
    """Return the reach of ``h r / |r|^2``, a being the least length of r: the rules *invert* and *scale*.

    ``H0 / a``, ``H0 / a^2 + H1 / a`` and ``2 H0 / a^3 + 2 H1 / a^2 + H2 / a``.
    """
    inverse = 1.0 / a
    square = inverse * inverse
    return times_amplitude(field, Reach(inverse, square, 2.0 * square * inverse))


@small_kernel
def turned(reach, rate):
    """Return the reach of a vector in a frame that turns at a rate of at most so much: the rule *turn*."""
    bend = reach.bend + (2.0 * reach.slope + DIRECTION_BEND * reach.length * rate) * rate
    return Reach(reach.length, reach.slope + reach.length * rate, bend)


@small_kernel
def rise_of(reach, seen):
    """Bound the second derivative of a form from above: the rule *square*.

    Args:
        reach: of the link vector at rest; turning does not change its length.
        seen: the same in the frame.
    """
    along = reach.slope * reach.slope + reach.length * reach.bend
    return along + seen.slope * seen.slope + seen.length * seen.bend


@small_kernel
def fall_of(seen):
    """Bound minus the second derivative of a form from above: the rule *square*."""
    return 2.0 * seen.length * seen.bend


@small_kernel
def anchor_fall(field, a):
    """Bound minus the second derivative of ``(h / |r|)^2``: at least ``2 (h / |r|) (h / |r|)''``."""
    inverse = 1.0 / a
    bend = field.bend + (2.0 * field.slope + field.most * inverse) * inverse
    return 2.0 * field.most * inverse * bend * inverse


@small_kernel
def amplitude(family, j, is_above, centre, half):
    """Return the amplitude of point j's channel over a box that it is outside of.

    Args:
        family: with the points and their channels.
        j: which point.
        is_above: whether the form is to be bounded from above, else from below.
        centre: of the box.
        half: its half sides.
    """
    if family.channels.shape[0] > 0:
        row, r = family.channels[j], minus(row_of(family.points_m, j), centre)
        least, most = square_range(family.points_m[j], centre, half, 3)
        if row[0] == BY_ELEVATION:
            seen = elevation_amplitude(row, r, least, is_above, family.points_m[j], centre, half)
            if row[EXPONENT] == 0.0:
                return seen
            return amplitude_product(distance_amplitude(row, r, least, most), seen)
        if row[EXPONENT] != 0.0:
            return distance_amplitude(row, r, least, most)
    return Amplitude(1.0, (0.0, 0.0, 0.0), 1.0, 0.0, 0.0)


@rare_kernel
def amplitude_product(a, b):
    """Return the product of two amplitudes."""
    most = times_amplitude(a, Reach(b.most, b.slope, b.bend))
    (x, y, z), (u, v, w) = a.gradient, b.gradient
    gradient = a.value * u + b.value * x, a.value * v + b.value * y, a.value * w + b.value * z
    return Amplitude(a.value * b.value, gradient, most.length, most.slope, most.bend)


@rare_kernel
def excess_end(family, j, is_above, centre, half):
    """Return the largest excess gain of point j in a box, or the least, as ``is_above`` says."""
    if family.channels.shape[0] > 0:
        row, points = family.channels[j], family.points_m
        least, most = square_range(points[j], centre, half, 3)
        gain = gain_by_distance(row, least if is_above == (row[EXPONENT] < 0.0) else most)
        if row[0] == BY_ELEVATION:
            low, high = elevation_range(minus(row_of(points, j), centre), points[j], centre, half)
            gain *= relative_range(row, low, high)[0][1 if is_above else 0]
        return gain
    return 1.0


@rare_kernel
def distance_amplitude(row, r, least, most):
    """Return an amplitude's factor ``(d / d0)^c`` over squared distances from least to most."""
    c, square = 0.5 * row[EXPONENT], dot(r, r)
    value, near = math.sqrt(gain_by_distance(row, square)), math.sqrt(gain_by_distance(row, least))
    top = near if c < 0.0 else math.sqrt(gain_by_distance(row, most))
    by = -c * value / square
    slope = abs(c) * near / math.sqrt(least)  # falls with the distance: c is less than 1
    return Amplitude(
        value,
        (by * r[0], by * r[1], by * r[2]),
        top,
        slope,
        slope * max(1.0, abs(c - 1.0)) / math.sqrt(least),
    )


@small_kernel
def product(a, b):
    """Return bounds on the product of two numbers of which bounds are given."""
    w, x, y, z = a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]
    return min(min(w, x), min(y, z)), max(max(w, x), max(y, z))


@small_kernel
def square(a):
    """Return bounds on the square of a number of which bounds are given."""
    x, y = a[0] * a[0], a[1] * a[1]
    return (0.0 if a[0] < 0.0 < a[1] else min(x, y)), max(x, y)


@inner_kernel
def total(a, b):
    """Return bounds on a sum."""
    return a[0] + b[0], a[1] + b[1]


@inner_kernel
def hull(a, x, y):
    """Return bounds that hold for two more numbers."""
    return min(a[0], min(x, y)), max(a[1], max(x, y))


@inner_kernel
def profile_range(row, low, high):
    """Return bounds on ``ln g`` of a profile between two elevations, on its slope and on its bend."""
    at, last = knot_below(row, low), KNOTS + 3 * int(row[KNOTS]) - 5
    logs = slopes = bends = (math.inf, -math.inf)
    while True:
        log, slope, bend = parabola(row, at, max(low, row[at]))
        end = high if at >= last else min(high, row[at + 3])
        log_end, slope_end, _ = parabola(row, at, end)
        peak = log - 0.5 * slope * slope / bend if slope * slope_end < 0.0 else log
        logs = hull(hull(logs, log, log_end), peak, peak)
        slopes, bends = hull(slopes, slope, slope_end), hull(bends, bend, bend)
        if end >= high:
            return logs, slopes, bends
        at += 3


@inner_kernel
def relative_range(row, low, high):
    """Return bounds on a gain g by elevation, on ``g' / g``, ``h'' / h`` of its root h, and ``g'' / g``.

    Args:
        row: of the channel.
        low: the tangent of the least elevation.
        high: that of the largest.
    """
    p_low, p_high = sight_probability(row, math.atan(low)), sight_probability(row, math.atan(high))
    gain = elevation_gain(row, p_low), elevation_gain(row, p_high)
    ends = p_low * (1.0 - p_low), p_high * (1.0 - p_high)
    spread = min(ends[0], ends[1]), (0.25 if p_low < 0.5 < p_high else max(ends[0], ends[1]))
    first = steepness(row, gain[1]) * row[RATE] * spread[0], steepness(row, gain[0]) * row[RATE] * spread[1]
    bent = row[RATE] * (1.0 - 2.0 * p_high), row[RATE] * (1.0 - 2.0 * p_low)
    # h' / h = g' / (2 g) and h'' / h = g'' / (2 g) - (g' / (2 g))^2
    root, in_db = (0.5 * first[0], 0.5 * first[1]), row[AVERAGE] == DB_AVERAGE
    bend_of_root = product(root, total(bent, root if in_db else (-root[1], -root[0])))
    bend = product(first, total(bent, first) if in_db else bent)
    if row.shape[0] > KNOTS and row[KNOTS] > 0.0:
        logs, slopes, bends = profile_range(row, math.atan(low), math.atan(high))
        both, steep = product(first, slopes), square(slopes)
        more = bends[0] + both[0] + 0.5 * steep[0], bends[1] + both[1] + 0.5 * steep[1]
        bend_of_root = bend_of_root[0] + 0.5 * more[0], bend_of_root[1] + 0.5 * more[1]
        bend = bend[0] + more[0] + both[0] + 0.5 * steep[0], bend[1] + more[1] + both[1] + 0.5 * steep[1]
        gain, first = (gain[0] * math.exp(logs[0]), gain[1] * math.exp(logs[1])), total(first, slopes)
    return gain, first, bend_of_root, bend


@rare_kernel
def elevation_amplitude(row, r, least, is_above, point, centre, half):
    """Return an amplitude's factor by elevation, over squared distances of ``least`` or more."""
    low, high = elevation_range(r, point, centre, half)
    (bottom, top), by, of_root, _ = relative_range(row, low, high)
    first, second = 0.5 * max(abs(by[0]), abs(by[1])), max(abs(of_root[0]), abs(of_root[1]))
    root = math.sqrt(top)
    steep = max(abs(low), abs(high))
    bend = 0.5 * (second + math.sqrt(second * second + 4.0 * first * first))
    inverse = 1.0 / math.sqrt(least)
    whole = Amplitude(
        1.0,
        (0.0, 0.0, 0.0),
        root,
        root * first * inverse,
        root * max(first * steep, bend) * inverse * inverse,
    )
    level = math.hypot(r[0], r[1])
    gain, change, _ = gain_by_elevation(row, math.atan2(-r[2], level))
    value = math.sqrt(gain)
    end = top if is_above else bottom
    # first order, or the end of the range: whichever leaves out less
    reach, square = scaled_inverse(whole, 1.0 / inverse), 0.5 * dot(half, half)
    left_out = square * (reach.slope * reach.slope + reach.length * reach.bend)
    if not left_out < abs(end - gain) * inverse * inverse + 3.0 * square * end * inverse**4:
        return Amplitude(math.sqrt(end), (0.0, 0.0, 0.0), math.sqrt(end), 0.0, 0.0)
    rate = value * 0.5 * change / dot(r, r)
    gradient = -rate * r[2] * r[0] / level, -rate * r[2] * r[1] / level, rate * level
    return Amplitude(value, gradient, whole.most, whole.slope, whole.bend)


@inner_kernel
def elevation_range(r, point, centre, half):
    """Return the tangents of the least and of the largest elevation of a box, seen from a point."""
    near, far = square_range(point, centre, half, 2)
    near, far = math.sqrt(near), math.sqrt(far)
    bottom, top = -r[2] - half[2], -r[2] + half[2]
    return bottom / (far if bottom > 0.0 else near), top / (near if top > 0.0 else far)
