"""What every node gets from an array in a state: the logarithms of the ratios, and their slopes.

Channels are divided by the noise's amplitude, so that noise has the power 1. The variables of a state ``x``
are east, north, up and yaw.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel, inner_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import excess_at, excess_jet
from nullpose.solver.kernels.linear_algebra.vectors import minus, over, row, store
from nullpose.solver.kernels.search.domain import contains

ComplexArray = NDArray[np.complex128]

_TINY = 1e-300
_CYCLE = 2.0 * math.pi


class Channels(NamedTuple):
    """The channels in a state, and what their slopes are made of."""

    elements: FloatArray  # (k, 2) in world axes, wavelengths
    values: ComplexArray  # (m, k) h_i
    leans: FloatArray  # (m, 3) slopes of the log amplitudes
    ways: FloatArray  # (m, 3) unit vectors to the points
    distances: FloatArray  # (m,)


class Nulls(NamedTuple):
    """``R^-1 = S S^H`` with ``S = prod_j (I - g_j f_j f_j^H)`` for ``R = I + sum_j h_j h_j^H``."""

    jammers: NDArray[np.int64]  # (n,) which of the points they are
    factors: ComplexArray  # (n, k) f_j
    shares: FloatArray  # (n,) g_j


@inner_heap_kernel
def channels_at(problem, strengths_m2, x):
    """Evaluate the channels; an amplitude is ``sqrt(strength) |flat| / |r|^2``, flat r's horizontal part."""
    m, k = problem.ratios.points_m.shape[0], problem.base.shape[0]
    elements, values = np.empty((k, 2)), np.empty((m, k), np.complex128)
    leans, ways, distances = np.empty((m, 3)), np.empty((m, 3)), np.empty(m)
    cosine, sine = math.cos(x[3]), math.sin(x[3])
    for n in range(k):
        elements[n, 0] = cosine * problem.base[n, 0] - sine * problem.base[n, 1]
        elements[n, 1] = sine * problem.base[n, 0] + cosine * problem.base[n, 1]
    for i in range(m):
        r = minus(row(problem.ratios.points_m, i), x)
        flat = r[0] * r[0] + r[1] * r[1]
        square = flat + r[2] * r[2]
        distances[i] = math.sqrt(square)
        store(over(r, distances[i]), ways[i])
        amplitude = math.sqrt(strengths_m2[i] * flat) / square
        lean = 1.0 / flat if flat > _TINY else 0.0  # straight above, the amplitude itself is zero
        store((r[0] * (2.0 / square - lean), r[1] * (2.0 / square - lean), 2.0 * r[2] / square), leans[i])
        for n in range(k):
            phase = _CYCLE * (elements[n, 0] * ways[i, 0] + elements[n, 1] * ways[i, 1])
            values[i, n] = amplitude * complex(math.cos(phase), math.sin(phase))
    return Channels(elements, values, leans, ways, distances)


@small_kernel
def add_excess(ratios, x, strengths_m2, leans):
    """Multiply strengths by the excess gains of their points at a state, and add the slopes to the leans."""
    if ratios.channels.shape[0] > 0:
        slopes, bends = scratch(3), scratch(3, 3)
        for i in range(len(strengths_m2)):
            strengths_m2[i] *= excess_at(ratios, i, x)
            excess_jet(ratios.channels[i], minus(row(ratios.points_m, i), x), slopes, bends)
            for axis in range(3):
                leans[i, axis] += 0.5 * slopes[axis]


@inner_kernel
def beam_response(w, channels, i):
    """Return ``w^H h_i`` and its derivatives in east, north, up and yaw, w being held."""
    h, elements, lean, toward = channels.values[i], channels.elements, channels.leans[i], channels.ways[i]
    total = east = north = 0j
    for n in range(h.shape[0]):
        part = w[n].conjugate() * h[n]
        total += part
        east += part * elements[n, 0]
        north += part * elements[n, 1]
    ahead = east * toward[0] + north * toward[1]
    rate = -1j * _CYCLE / channels.distances[i]
    return total, (
        lean[0] * total + rate * (east - ahead * toward[0]),
        lean[1] * total + rate * (north - ahead * toward[1]),
        lean[2] * total - rate * ahead * toward[2],
        1j * _CYCLE * (east * toward[1] - north * toward[0]),
    )


@inner_kernel
def power_of(v):
    """Return ``|v|^2``."""
    total = 0.0
    for n in range(v.shape[0]):
        total += v[n].real ** 2 + v[n].imag ** 2
    return total


@inner_kernel
def whiten(nulls, first, last, step, v):
    """Multiply v by ``(I - g f f^H)`` of some factors in turn: all give ``S^H v``, all backwards ``S v``."""
    for j in range(first, last, step):
        part = 0j
        for n in range(v.shape[0]):
            part += nulls.factors[j, n].conjugate() * v[n]
        part *= nulls.shares[j]
        for n in range(v.shape[0]):
            v[n] -= part * nulls.factors[j, n]


@inner_heap_kernel
def nulls_towards(values, jammers):
    """Build the factors of ``R^-1`` by Potter's update: nothing of the jamming's size is subtracted."""
    nulls = Nulls(jammers, np.empty((len(jammers), values.shape[1]), np.complex128), np.empty(len(jammers)))
    for j in range(len(jammers)):
        for n in range(values.shape[1]):
            nulls.factors[j, n] = values[jammers[j], n]
        whiten(nulls, 0, j, 1, nulls.factors[j])
        root = math.sqrt(1.0 + power_of(nulls.factors[j]))
        nulls.shares[j] = 1.0 / (root * (root + 1.0))
    return nulls


@inner_heap_kernel
def node_power(channels, nulls, q, slope, parts):
    """Return ``h^H R^-1 h`` of node q; fill its slopes, (4,) or (0,), and ``c_j = h_j^H v`` if there are any.

    With ``v = R^-1 h`` a slope is ``2 Re(v^H dh) - 2 Re sum_j (h_j^H v)(v^H dh_j)``.
    """
    v = channels.values[q].copy()
    last = len(nulls.jammers)
    whiten(nulls, 0, last, 1, v)
    value = power_of(v)
    if slope.shape[0] > 0:
        whiten(nulls, last - 1, -1, -1, v)
        _, change = beam_response(v, channels, q)
        for a in range(4):
            slope[a] = 2.0 * change[a].real
        for j in range(last):
            parts[j], change = beam_response(v, channels, nulls.jammers[j])
            for a in range(4):
                slope[a] -= 2.0 * (parts[j].conjugate() * change[a]).real
    return value


@heap_kernel
def respond(problem, x, logs, slopes):
    """Fill every node's log of ``h^H R^-1 h`` and, unless they have no rows, its slopes; return the smallest.

    Args:
        problem: the array and its scene.
        x: (4,).
        logs: output, (nodes,).
        slopes: output, (nodes, 4) or (0, 4).
    """
    strengths_m2, leans = problem.strengths_m2.copy(), np.zeros((len(problem.ratios.points_m), 3))
    add_excess(problem.ratios, x, strengths_m2, leans)
    channels = channels_at(problem, strengths_m2, x)
    channels.leans[:] += leans
    nulls = nulls_towards(channels.values, np.arange(problem.nodes, len(problem.ratios.points_m)))
    parts, none = np.empty(len(nulls.jammers), np.complex128), np.empty(0)
    worst = math.inf
    for q in range(problem.nodes):
        slope = slopes[q] if len(slopes) > 0 else none
        value = node_power(channels, nulls, q, slope, parts)
        logs[q] = math.log(value) if value > 0.0 else -math.inf
        worst = min(worst, logs[q])
        for a in range(len(slope)):
            slope[a] /= max(value, _TINY)
    return worst


@heap_kernel
def array_value(problem, x):
    """Evaluate the smallest log ratio at a state, as :func:`respond`."""
    return respond(problem, x, np.empty(problem.nodes), np.empty((0, 4)))


@heap_kernel
def judge_array(problem, domain, states, out):
    """Fill the smallest log ratio of many states, (n, 4), minus infinity where a position is not allowed."""
    for i in range(len(states)):
        out[i] = array_value(problem, states[i]) if contains(domain, states[i]) else -math.inf
