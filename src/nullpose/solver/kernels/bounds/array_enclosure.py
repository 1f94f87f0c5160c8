"""A bound on an array's smallest ratio over a box of positions and yaws, with digital combining.

For any numbers c, ``h^H R^-1 h <= |h - H c|^2 + |c|^2``, where the columns of H are the jammers' channels
and ``R = I + H H^H``; equality holds at ``c = H^H R^-1 h``. With the c of the box's centre held, the right
side is a sum of squares ``|z|^2 + |c|^2``, ``z = h - H c``, in which the phases of h may be taken for zero:
only differences of directions count. Split z into its value at the centre, a linear part of size ``D`` at
most and a rest of size ``E`` at most; then the right side is not above

    value + slope . half widths + D^2 + 2 (|z| + D) E + E^2,

and its slope is that of the ratio itself. The smallest ratio is not above any mean of such bounds, and the
mean is chosen so that the slopes cancel. A jammer straight below the box is left out, which only raises the
bound. So does a channel that counts with the largest excess gain in the box for a node, and with the least
for a jammer.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.bounds.curved import mix_in
from nullpose.solver.kernels.bounds.sight import excess_range
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solver.kernels.linear_algebra.vectors import along, dot, minus, over, row, square_range
from nullpose.solver.kernels.search.array_response import channels_at, node_power, nulls_towards

_BEND = 2.0 / math.sqrt(3.0)  # a direction's second derivative along a line is at most this over r^2
_CYCLE = 2.0 * math.pi


class Spans(NamedTuple):
    """How amplitudes change over a box, (m,) each: infinite where they have no bound."""

    amplitude: FloatArray  # at the centre
    linear: FloatArray  # its linear change
    further: FloatArray  # and the rest of its change
    power: FloatArray  # the greatest
    distance_m: FloatArray  # the least


@inner_heap_kernel
def spans_over(problem, strengths_m2, channels, centre, half):
    """Bound how amplitudes change over a box.

    The amplitude ``sqrt(strength) |flat| / r^2`` has second derivatives of at most ``sqrt(strength) (1 /
    |flat| + 10 / r) / r^2``; infinite, if the box reaches over the point.
    """
    m = len(problem.ratios.points_m)
    table = np.full((4, m), math.inf)
    spans = Spans(np.abs(channels.values[:, 0]), np.zeros(m), table[0], table[1], table[2])
    for i in range(m):
        strength = strengths_m2[i]
        least2, _ = square_range(problem.ratios.points_m[i], centre, half, 3)
        least_flat2, most_flat2 = square_range(problem.ratios.points_m[i], centre, half, 2)
        least, least_flat = math.sqrt(least2), math.sqrt(least_flat2)
        for axis in range(3):
            spans.linear[i] += abs(channels.leans[i, axis]) * spans.amplitude[i] * half[axis]
        if least_flat > 0.0:
            bend = math.sqrt(strength) * (1.0 / least_flat + 10.0 / least) / least**2
            spans.further[i] = 0.5 * bend * dot(half, half)
        if least > 0.0:
            spans.power[i] = strength / least2 * min(1.0, most_flat2 / least2)
        spans.distance_m[i] = least
    return spans


@inner_kernel
def linear_swing(channels, j, q, u, half):
    """Bound the linear change of ``u.(e_j - e_q)``, u being fixed to the body."""
    e_j, e_q = row(channels.ways, j), row(channels.ways, q)
    apart = minus(e_j, e_q)
    rate_j = over(along(u, -dot(u, e_j), e_j), channels.distances[j])
    rate_q = over(along(u, -dot(u, e_q), e_q), channels.distances[q])
    total = abs(u[0] * apart[1] - u[1] * apart[0]) * half[3]
    for i in range(3):
        total += half[i] * abs(rate_j[i] - rate_q[i])
    return total


@inner_kernel
def further_swing(channels, spans, j, q, half):
    """Bound the rest of its change, for any horizontal u of unit length."""
    diagonal, yaw = math.sqrt(dot(half, half)), half[3]
    near_j, near_q = spans.distance_m[j], spans.distance_m[q]
    apart = minus(row(channels.ways, j), row(channels.ways, q))
    drift = diagonal * (1.0 / near_j + 1.0 / near_q)
    bend = 0.5 * _BEND * diagonal**2 * (1.0 / near_j**2 + 1.0 / near_q**2)
    return bend + yaw * drift + 0.5 * yaw**2 * min(2.0, math.hypot(apart[0], apart[1]) + drift)


@inner_heap_kernel
def node_bound(problem, channels, spans, nulls, q, centre, half, slope):
    """Bound a node's ratio without its first-order terms, and fill the slope that these come from.

    Of a jammer's ``alpha exp(j s)``, s the change of the phase, ``alpha' + alpha s'`` is linear, and the rest
    is at most ``alpha'' + alpha (s'' + s^2 / 2) + alpha' s``.
    """
    parts = np.empty(len(nulls.jammers), np.complex128)
    value = node_power(channels, nulls, q, slope, parts)
    forward = (math.cos(centre[3]), math.sin(centre[3]), 0.0)
    left = (-forward[1], forward[0], 0.0)
    square_linear = square_further = 0.0
    swings = np.empty((len(parts), 3))
    for i in range(len(parts)):
        j = nulls.jammers[i]
        swings[i, 0] = linear_swing(channels, j, q, forward, half)
        swings[i, 1] = linear_swing(channels, j, q, left, half)
        swings[i, 2] = further_swing(channels, spans, j, q, half)
    for n in range(len(problem.base)):
        x, y = abs(problem.base[n, 0]), abs(problem.base[n, 1])
        linear, further = spans.linear[q], spans.further[q]
        for i in range(len(parts)):
            j, share = nulls.jammers[i], abs(parts[i])
            phase = _CYCLE * (x * swings[i, 0] + y * swings[i, 1])
            more = _CYCLE * math.hypot(x, y) * swings[i, 2]
            whole = phase + more
            alpha, lean = spans.amplitude[j], spans.linear[j]
            linear += share * (lean + alpha * phase)
            further += share * (spans.further[j] + alpha * (more + 0.5 * whole * whole) + lean * whole)
        square_linear += linear**2
        square_further += further**2
    first, rest = math.sqrt(square_linear), math.sqrt(square_further)
    return value + square_linear + 2.0 * (math.sqrt(value) + first) * rest + square_further


@heap_kernel
def box_bound(problem, centre, half):
    """Bound the smallest ratio (not its logarithm) over a box.

    Args:
        problem: the array and its scene.
        centre: (4,) east, north, up and yaw of the box's centre.
        half: (4,) its half widths.
    """
    nodes, m = problem.nodes, len(problem.ratios.points_m)
    strengths_m2 = problem.strengths_m2.copy()
    for i in range(m):
        low, high = excess_range(problem.ratios, i, centre[:3], half[:3])
        strengths_m2[i] *= high if i < nodes else low
    channels = channels_at(problem, strengths_m2, centre)
    spans = spans_over(problem, strengths_m2, channels, centre, half)
    used, jammers = 0, np.empty(m - nodes, np.int64)
    for j in range(nodes, m):
        if spans.further[j] < math.inf:
            jammers[used] = j
            used += 1
    nulls = nulls_towards(channels.values, jammers[:used])
    levels, slopes = np.full(nodes, math.inf), np.zeros((nodes, 4))
    silent = math.inf
    for q in range(nodes):
        silent = min(silent, len(problem.base) * spans.power[q])  # K times one dipole without jamming
        if spans.further[q] < math.inf:
            levels[q] = node_bound(problem, channels, spans, nulls, q, centre, half, slopes[q])
    return min(silent, mix_in(levels, slopes, half, np.empty(nodes)))
