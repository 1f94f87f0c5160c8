"""The excess gain of a point's channel at a position, and its derivatives (:mod:`nullpose.channel`).

It is ``(d / d0)^e`` where e is not 0, times, by elevation, ``n + (1 - n) P`` or ``n^(1 - P)``, with the
probability ``P = 1 / (1 + exp(c - k theta))`` of line of sight, and the ground antenna's profile. Derivatives
are relative, ``g' / g``. Where no point has a channel, there are no rows.
"""

from __future__ import annotations

import math

from nullpose.channel.elevation import DB_AVERAGE
from nullpose.channel.model import (
    AVERAGE,
    BLOCKED,
    BY_ELEVATION,
    EXPONENT,
    HIDDEN,
    KNOTS,
    ONSET,
    RATE,
    REFERENCE_M,
)
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.vectors import dot, minus, row as row_of

_ZENITH = 1e-12  # of the distance: directly above a point the elevation has no derivative


@inner_kernel
def sight_probability(row, elevation_rad):
    """Return the probability of line of sight."""
    exponent = row[ONSET] - row[RATE] * elevation_rad
    small = math.exp(-abs(exponent))
    return (small if exponent > 0.0 else 1.0) / (1.0 + small)


@inner_kernel
def elevation_gain(row, probability):
    """Return the excess gain at a probability of line of sight."""
    if row[AVERAGE] == DB_AVERAGE:
        return row[HIDDEN] ** (1.0 - probability)
    return row[HIDDEN] + (1.0 - row[HIDDEN]) * probability


@inner_kernel
def steepness(row, gain):
    """Return ``g' / g`` over ``k P (1 - P)``."""
    return -math.log(row[HIDDEN]) if row[AVERAGE] == DB_AVERAGE else (1.0 - row[HIDDEN]) / gain


@inner_kernel
def knot_below(row, angle):
    """Find the column of a channel's row in which the last knot at an elevation or below it begins."""
    low, high = 0, int(row[KNOTS]) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if row[KNOTS + 1 + 3 * middle] <= angle:
            low = middle
        else:
            high = middle
    return KNOTS + 1 + 3 * low


@inner_kernel
def parabola(row, at, angle):
    """Return ``ln g`` of a profile by the knot below an elevation, its slope and its bend there."""
    step, bend = angle - row[at], (row[at + 5] - row[at + 2]) / (row[at + 3] - row[at])
    return row[at + 1] + step * (row[at + 2] + 0.5 * bend * step), row[at + 2] + bend * step, bend


@inner_kernel
def gain_by_elevation(row, angle):
    """Return the factor g of the excess gain by elevation, ``g' / g`` and ``g'' / g``."""
    p = sight_probability(row, angle)
    gain = elevation_gain(row, p)
    first = steepness(row, gain) * row[RATE] * p * (1.0 - p)
    second = first * row[RATE] * (1.0 - 2.0 * p) + (first * first if row[AVERAGE] == DB_AVERAGE else 0.0)
    if row.shape[0] > KNOTS and row[KNOTS] > 0.0:
        log, slope, bend = parabola(row, knot_below(row, angle), angle)
        second += slope * (2.0 * first + slope) + bend
        gain, first = gain * math.exp(log), first + slope
    return gain, first, second


@inner_kernel
def gain_by_distance(row, square):
    """Return the factor of the excess gain by distance, from that squared."""
    if row[EXPONENT] == 0.0:
        return 1.0
    return (square / (row[REFERENCE_M] * row[REFERENCE_M])) ** (0.5 * row[EXPONENT])


@rare_kernel
def blocked_gain(points, sides, start, row, p):
    """Return the share that a link keeps at a position, by shadows from one to another of ``start``."""
    for shadow in range(points[0], points[1]):
        inside = True
        for s in range(start[shadow], start[shadow + 1]):
            inside = inside and dot(sides[s], p) < sides[s, 4]
        if inside:
            return row[BLOCKED]
    return 1.0


@small_kernel
def sight_gain(family, j, p):
    """Return the share that point j's link keeps among buildings at a position; 1 in the clear."""
    if family.shadow_sides.shape[0] > 0:
        shadows = family.shadows_of_point[j : j + 2]
        return blocked_gain(shadows, family.shadow_sides, family.shadow_start, family.channels[j], p)
    return 1.0


@small_kernel
def excess_at(family, j, p):
    """Return the excess gain of point j at a position."""
    if family.channels.shape[0] > 0:
        r = minus(row_of(family.points_m, j), p)
        return sight_gain(family, j, p) * excess_in_sight(family.channels[j], r)
    return 1.0


@rare_kernel
def excess_in_sight(row, r):
    """Return the excess gain of a channel, r being the vector to the point, without buildings."""
    gain = gain_by_distance(row, dot(r, r))
    if row[0] == BY_ELEVATION:
        gain *= gain_by_elevation(row, math.atan2(-r[2], math.hypot(r[0], r[1])))[0]
    return gain


@inner_kernel
def fill_elevation(r, slopes, bends):
    """Fill the derivatives, by the position, of the elevation at a point; r is the vector to it.

    First (3,) and second (3, 3): with ``(x, y, z) = -r``, ``q^2 = x^2 + y^2`` and ``s = |r|^2`` the first are
    ``(-z x / q, -z y / q, q) / s``.
    """
    x, y, z, s = -r[0], -r[1], -r[2], dot(r, r)
    level = max(math.hypot(x, y), _ZENITH * math.sqrt(s))
    east, north = x / level, y / level
    slopes[0], slopes[1], slopes[2] = -z * east / s, -z * north / s, level / s
    outwards = 2.0 * z * level / (s * s)  # along (x, y)
    across = -z / (level * s)  # horizontally across it
    bends[0, 0] = outwards * east * east + across * north * north
    bends[1, 1] = outwards * north * north + across * east * east
    bends[0, 1] = bends[1, 0] = (outwards - across) * east * north
    bends[0, 2] = bends[2, 0] = (z * z - level * level) * east / (s * s)
    bends[1, 2] = bends[2, 1] = (z * z - level * level) * north / (s * s)
    bends[2, 2] = -outwards


@rare_kernel
def excess_jet(row, r, slopes, bends):
    """Return the excess gain of a channel; fill its relative derivatives by the position, (3,) and (3, 3)."""
    gain = elevation_jet(row, r, slopes, bends)
    if row[EXPONENT] == 0.0:
        return gain
    s, e = dot(r, r), row[EXPONENT]
    rate = e / s
    for i in range(3):
        for k in range(3):
            bends[i, k] += rate * ((e - 2.0) * r[i] * r[k] / s - r[i] * slopes[k] - slopes[i] * r[k])
        bends[i, i] += rate
    for i in range(3):
        slopes[i] -= rate * r[i]
    return gain * gain_by_distance(row, s)


@rare_kernel
def elevation_jet(row, r, slopes, bends):
    """Do what ``excess_jet`` does for the factor by elevation alone."""
    slopes[:], bends[:, :] = 0.0, 0.0
    if row[0] != BY_ELEVATION:
        return 1.0
    angle = scratch(3)
    fill_elevation(r, angle, bends)
    gain, first, second = gain_by_elevation(row, math.atan2(-r[2], math.hypot(r[0], r[1])))
    for i in range(3):
        slopes[i] = first * angle[i]
        for k in range(3):
            bends[i, k] = first * bends[i, k] + second * angle[i] * angle[k]
    return gain


@small_kernel
def reach_of(channels, j, square):
    """Return the largest distance at which the gain of point j is one over ``square``, in any direction."""
    if channels.shape[0] > 0 and channels[j, EXPONENT] != 0.0:
        e = channels[j, EXPONENT]
        return (square * channels[j, REFERENCE_M] ** -e) ** (1.0 / (2.0 - e))
    return math.sqrt(square)


@small_kernel
def most_excess(channels, j, square):
    """Return the excess that bounds ``excess / d^2`` of point j beyond a distance whose square is given.

    By any power law the gain falls with the distance; the factor by elevation is at most 1.
    """
    return gain_by_distance(channels[j], square) if channels.shape[0] > 0 else 1.0
