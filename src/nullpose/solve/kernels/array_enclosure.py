"""A bound on an array's smallest ratio over a box of positions and yaws, with digital combining.

For any numbers c, ``h^H R^-1 h <= |h - H c|^2 + |c|^2``, where the columns of H are the jammers' channels
and ``R = I + H H^H``; equality holds at ``c = H^H R^-1 h``. With the c of the box's centre held, the right
side is a sum of squares ``|z|^2 + |c|^2``, ``z = h - H c``, in which the phases of h may be taken for zero:
only differences of directions count. Split z into its value at the centre, a linear part of size ``D`` at
most and a rest of size ``E`` at most; then the right side is not above

    value + slope . half widths + D^2 + 2 (|z| + D) E + E^2,

and its slope is that of the ratio itself. The smallest ratio is not above any mean of such bounds, and the
mean is chosen so that the slopes cancel. A jammer straight below the box is left out, which only raises the
bound.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.array_response import (
    fill_channels,
    inner_slopes,
    jammer_factors,
    unwhiten,
    whiten,
)
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel

__all__ = ["box_bound"]

_BEND = 2.0 / math.sqrt(3.0)  # a direction's second derivative along a line is at most this over r^2
_TURN = 2.0 * math.pi
_PASSES = 3


@inner_kernel
def span(point, centre, half, axes):
    """Return the least and the greatest distance from a point to a box, along the first axes only."""
    least, most = 0.0, 0.0
    for i in range(axes):
        away = abs(point[i] - centre[i])
        least += max(away - half[i], 0.0) ** 2
        most += (away + half[i]) ** 2
    return math.sqrt(least), math.sqrt(most)


@inner_kernel
def fill_sizes(scene, centre, half, channels, leans, sizes):
    """Fill, for every point: amplitude, linear and further change, greatest power, least distance, (m, 5).

    The amplitude ``sqrt(strength) |flat| / r^2`` has second derivatives of at most ``sqrt(strength) (1 /
    |flat| + 10 / r) / r^2``; infinite, if the box reaches over the point.
    """
    points, strengths = scene[0], scene[1]
    square = half[0] ** 2 + half[1] ** 2 + half[2] ** 2
    for i in range(points.shape[0]):
        least, _ = span(points[i], centre, half, 3)
        least_flat, most_flat = span(points[i], centre, half, 2)
        amplitude = abs(channels[i, 0])
        sizes[i, 0], sizes[i, 1], sizes[i, 2], sizes[i, 3] = amplitude, 0.0, math.inf, math.inf
        for c in range(3):
            sizes[i, 1] += abs(leans[i, c]) * amplitude * half[c]
        if least_flat > 0.0:
            bend = math.sqrt(strengths[i]) * (1.0 / least_flat + 10.0 / least) / least**2
            sizes[i, 2] = 0.5 * bend * square
        if least > 0.0:
            sizes[i, 3] = strengths[i] / least**2 * min(1.0, (most_flat / least) ** 2)
        sizes[i, 4] = least


@inner_heap_kernel
def swing(way_j, way_k, reach, half, cosine, sine):
    """Return bounds on the changes of ``u.(e_j - e_k)``: linear, for u along each body axis, and further.

    ``reach`` is (r_j, r_k, least r_j, least r_k, half diagonal).
    """
    r_j, r_k, least_j, least_k, diagonal = reach
    linear = np.empty(2)
    for axis in range(2):
        u0, u1 = (cosine, sine) if axis == 0 else (-sine, cosine)
        along_j, along_k = u0 * way_j[0] + u1 * way_j[1], u0 * way_k[0] + u1 * way_k[1]
        linear[axis] = abs(u0 * (way_j[1] - way_k[1]) - u1 * (way_j[0] - way_k[0])) * half[3]
        for i in range(3):
            u = u0 if i == 0 else (u1 if i == 1 else 0.0)
            linear[axis] += half[i] * abs((u - along_j * way_j[i]) / r_j - (u - along_k * way_k[i]) / r_k)
    apart = math.hypot(way_j[0] - way_k[0], way_j[1] - way_k[1])
    drift = diagonal * (1.0 / least_j + 1.0 / least_k)
    rest = 0.5 * _BEND * diagonal**2 * (1.0 / least_j**2 + 1.0 / least_k**2)
    rest += half[3] * drift + 0.5 * half[3] ** 2 * min(2.0, apart + drift)
    return linear[0], linear[1], rest


@inner_kernel
def add_jammer(base, weight, jammer, swings, linear, rest):
    """Add a jammer's share to the bounds on the linear and further change of every component of z.

    Of ``alpha exp(j s)``, s the change of the phase: ``alpha' + alpha s'`` is linear, and the rest is at most
    ``alpha'' + alpha (s'' + s^2 / 2) + alpha' s``.
    """
    for n in range(base.shape[0]):
        x, y = abs(base[n, 0]), abs(base[n, 1])
        turn = _TURN * (x * swings[0] + y * swings[1])
        more = _TURN * math.hypot(x, y) * swings[2]
        whole = turn + more
        linear[n] += weight * (jammer[1] + jammer[0] * turn)
        rest[n] += weight * (jammer[2] + jammer[0] * (more + 0.5 * whole * whole) + jammer[1] * whole)


@inner_kernel
def norm(v):
    """Return the length of a vector, real or complex."""
    total = 0.0
    for n in range(v.shape[0]):
        total += abs(v[n]) ** 2
    return math.sqrt(total)


@inner_heap_kernel
def node_bound(scene, base, q, field, jammers, half, slope):
    """Return a node's bound without its first-order terms, and fill the slope that these come from."""
    channels, places, leans, ways, distances, sizes, turn = field
    which, factors, shares = jammers
    diagonal = math.sqrt(half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    v, change = channels[q].copy(), np.empty(4, np.complex128)
    whiten(factors, shares, which.shape[0], v)
    length = norm(v)
    unwhiten(factors, shares, v)
    inner_slopes(v, channels[q], places, leans[q], ways[q], distances[q], change)
    for a in range(4):
        slope[a] = 2.0 * change[a].real
    linear, rest = np.full(base.shape[0], sizes[q, 1]), np.full(base.shape[0], sizes[q, 2])
    for j in which:
        part = inner_slopes(v, channels[j], places, leans[j], ways[j], distances[j], change)
        for a in range(4):
            slope[a] -= 2.0 * (part.conjugate() * change[a]).real
        reach = (distances[j], distances[q], sizes[j, 4], sizes[q, 4], diagonal)
        swings = swing(ways[j], ways[q], reach, half, turn[0], turn[1])
        add_jammer(base, abs(part), sizes[j], swings, linear, rest)
    first, further = norm(linear), norm(rest)
    return length**2 + first**2 + 2.0 * (length + first) * further + further**2


@inner_kernel
def total_of(level, slope, half):
    """Return a bound with its first-order terms."""
    for a in range(4):
        level += abs(slope[a]) * half[a]
    return level


@inner_heap_kernel
def blend(level, slope, other, other_slope, half):
    """Return the share of one bound in the best mean of two: where a slope cancels, or all or nothing."""
    best_share, best = 1.0, total_of(level, slope, half)
    mixed = np.empty(4)
    for a in range(5):
        share = 0.0
        if a < 4:
            bend = other_slope[a] - slope[a]
            share = other_slope[a] / bend if bend != 0.0 else 1.0
        if 0.0 <= share <= 1.0:
            for b in range(4):
                mixed[b] = share * slope[b] + (1.0 - share) * other_slope[b]
            total = total_of(share * level + (1.0 - share) * other, mixed, half)
            if total < best:
                best, best_share = total, share
    return best_share


@inner_heap_kernel
def best_mean(levels, slopes, half):
    """Return the least mean of the nodes' bounds that a few passes of pairwise blending find."""
    low = 0
    for q in range(levels.shape[0]):
        if total_of(levels[q], slopes[q], half) < total_of(levels[low], slopes[low], half):
            low = q
    level, slope = levels[low], slopes[low].copy()
    if not level < math.inf:
        return math.inf
    for _ in range(_PASSES):
        for q in range(levels.shape[0]):
            if levels[q] < math.inf:
                share = blend(level, slope, levels[q], slopes[q], half)
                level = share * level + (1.0 - share) * levels[q]
                for a in range(4):
                    slope[a] = share * slope[a] + (1.0 - share) * slopes[q, a]
    return total_of(level, slope, half)


@heap_kernel
def box_bound(scene, base, centre, half):
    """Return what the smallest ratio (not its logarithm) exceeds nowhere in a box.

    Args:
        scene: points, strengths and number of nodes, as for the response.
        base: (k, 2) elements in body axes, wavelengths.
        centre: (4,) east, north, up and yaw of the box's centre.
        half: (4,) its half widths.
    """
    nodes, m, k = scene[2], scene[0].shape[0], base.shape[0]
    places, channels = np.empty((k, 2)), np.empty((m, k), np.complex128)
    leans, ways, distances = np.empty((m, 3)), np.empty((m, 3)), np.empty(m)
    fill_channels(scene, base, centre, places, channels, leans, ways, distances)
    sizes = np.empty((m, 5))
    fill_sizes(scene, centre, half, channels, leans, sizes)
    used = 0
    which = np.empty(m - nodes, np.int64)
    heard = np.empty((m - nodes, k), np.complex128)
    for j in range(nodes, m):
        if sizes[j, 2] < math.inf:
            which[used] = j
            heard[used] = channels[j]
            used += 1
    factors, shares = np.empty((used, k), np.complex128), np.empty(used)
    jammer_factors(heard, 0, factors, shares)
    field = (channels, places, leans, ways, distances, sizes, (math.cos(centre[3]), math.sin(centre[3])))
    jammers = (which[:used], factors, shares)
    levels, slopes = np.full(nodes, math.inf), np.zeros((nodes, 4))
    silent = math.inf
    for q in range(nodes):
        silent = min(silent, k * sizes[q, 3])  # K times one dipole without jamming
        if sizes[q, 2] < math.inf:
            levels[q] = node_bound(scene, base, q, field, jammers, half, slopes[q])
    return min(silent, best_mean(levels, slopes, half))
