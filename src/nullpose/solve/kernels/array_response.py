"""What every node gets from an array in a state: the logarithms of the ratios, and their slopes.

Channels are divided by the noise's amplitude, so that noise has the power 1. The variables of a state ``x``
are east, north, up, yaw and, for a shared beam, one phase for each element.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel, kernel

__all__ = ["array_value", "respond"]

_TINY = 1e-300
_TURN = 2.0 * math.pi


@inner_kernel
def fill_channels(scene, base, x, places, channels, leans, ways, distances):
    """Fill turned elements (k, 2), channels (m, k), slopes of log amplitudes, unit vectors and distances.

    The amplitude is ``sqrt(strength) |flat| / |r|^2``, ``flat`` being the level part of ``r``.
    """
    points, strengths = scene[0], scene[1]
    cosine, sine = math.cos(x[3]), math.sin(x[3])
    for n in range(base.shape[0]):
        places[n, 0] = cosine * base[n, 0] - sine * base[n, 1]
        places[n, 1] = sine * base[n, 0] + cosine * base[n, 1]
    for i in range(points.shape[0]):
        east, north, up = points[i, 0] - x[0], points[i, 1] - x[1], points[i, 2] - x[2]
        flat = east * east + north * north
        square = flat + up * up
        distances[i] = math.sqrt(square)
        ways[i, 0], ways[i, 1], ways[i, 2] = east / distances[i], north / distances[i], up / distances[i]
        amplitude = math.sqrt(strengths[i] * flat) / square
        lean = 1.0 / flat if flat > _TINY else 0.0  # straight above, the amplitude itself is zero
        leans[i, 0] = east * (2.0 / square - lean)
        leans[i, 1] = north * (2.0 / square - lean)
        leans[i, 2] = 2.0 * up / square
        for n in range(base.shape[0]):
            phase = _TURN * (places[n, 0] * ways[i, 0] + places[n, 1] * ways[i, 1])
            channels[i, n] = amplitude * complex(math.cos(phase), math.sin(phase))


@inner_kernel
def inner(f, h):
    """Return ``f^H h``."""
    total = 0j
    for n in range(f.shape[0]):
        total += f[n].conjugate() * h[n]
    return total


@inner_kernel
def inner_slopes(w, h, places, lean, way, distance, out):
    """Return ``w^H h``; fill its derivatives in east, north, up and yaw, w being held."""
    total = 0j
    east = 0j
    north = 0j
    for n in range(h.shape[0]):
        part = w[n].conjugate() * h[n]
        total += part
        east += part * places[n, 0]
        north += part * places[n, 1]
    along = east * way[0] + north * way[1]
    rate = -1j * _TURN / distance
    out[0] = lean[0] * total + rate * (east - along * way[0])
    out[1] = lean[1] * total + rate * (north - along * way[1])
    out[2] = lean[2] * total - rate * along * way[2]
    out[3] = 1j * _TURN * (east * way[1] - north * way[0])
    return total


@inner_kernel
def whiten(factors, shares, count, v):
    """Multiply v by ``(I - g f f^H)`` of each of the first factors in turn."""
    for i in range(count):
        part = shares[i] * inner(factors[i], v)
        for n in range(v.shape[0]):
            v[n] -= part * factors[i, n]


@inner_kernel
def unwhiten(factors, shares, v):
    """Multiply v by the same factors, last first: whitening and this one after the other are ``R^-1``."""
    for i in range(factors.shape[0] - 1, -1, -1):
        part = shares[i] * inner(factors[i], v)
        for n in range(v.shape[0]):
            v[n] -= part * factors[i, n]


@inner_kernel
def jammer_factors(channels, nodes, factors, shares):
    """Fill f and g with ``R^-1 = S S^H``, ``S = prod_j (I - g_j f_j f_j^H)``, ``R = I + sum_j h_j h_j^H``.

    Potter's square-root update: nothing of the size of the jamming is subtracted from anything.
    """
    for j in range(factors.shape[0]):
        for n in range(factors.shape[1]):
            factors[j, n] = channels[nodes + j, n]
        whiten(factors, shares, j, factors[j])
        square = 0.0
        for n in range(factors.shape[1]):
            square += factors[j, n].real ** 2 + factors[j, n].imag ** 2
        root = math.sqrt(1.0 + square)
        shares[j] = 1.0 / (root * (root + 1.0))


@inner_heap_kernel
def digital(scene, base, x, logs, slopes):
    """Fill the log of ``h_k^H R^-1 h_k`` for every node, and its slopes (nodes, 4) unless they have no rows.

    Returns the smallest. With ``v = R^-1 h_k`` a slope is ``2 Re(v^H dh_k) - 2 Re sum_j (h_j^H v)(v^H
    dh_j)``.
    """
    nodes, m, k = scene[2], scene[0].shape[0], base.shape[0]
    places, channels = np.empty((k, 2)), np.empty((m, k), np.complex128)
    leans, ways, distances = np.empty((m, 3)), np.empty((m, 3)), np.empty(m)
    fill_channels(scene, base, x, places, channels, leans, ways, distances)
    factors, shares = np.empty((m - nodes, k), np.complex128), np.empty(m - nodes)
    jammer_factors(channels, nodes, factors, shares)
    v, change = np.empty(k, np.complex128), np.empty(4, np.complex128)
    worst = math.inf
    for q in range(nodes):
        for n in range(k):
            v[n] = channels[q, n]
        whiten(factors, shares, m - nodes, v)
        value = 0.0
        for n in range(k):
            value += v[n].real ** 2 + v[n].imag ** 2
        logs[q] = math.log(value) if value > 0.0 else -math.inf
        worst = min(worst, logs[q])
        if slopes.shape[0] == 0:
            continue
        unwhiten(factors, shares, v)
        inner_slopes(v, channels[q], places, leans[q], ways[q], distances[q], change)
        for a in range(4):
            slopes[q, a] = 2.0 * change[a].real
        for j in range(nodes, m):
            part = inner_slopes(v, channels[j], places, leans[j], ways[j], distances[j], change)
            for a in range(4):
                slopes[q, a] -= 2.0 * (part.conjugate() * change[a]).real
        for a in range(4):
            slopes[q, a] /= max(value, _TINY)
    return worst


@inner_heap_kernel
def beam_power(w, h, places, lean, way, distance, slopes):
    """Return ``|w^H h|^2`` and add its slopes in the variables of a shared beam, unless there are none."""
    change = np.empty(4, np.complex128)
    part = inner_slopes(w, h, places, lean, way, distance, change)
    for a in range(min(4, slopes.shape[0])):
        slopes[a] += 2.0 * (part.conjugate() * change[a]).real
    for n in range(slopes.shape[0] - 4):
        slopes[4 + n] += 2.0 * (part.conjugate() * w[n].conjugate() * h[n]).imag
    return part.real**2 + part.imag**2


@inner_heap_kernel
def shared_beam(scene, base, x, logs, slopes):
    """Fill the log SINR of every node with one beam of phase shifters, and its slopes (nodes, 4 + k)."""
    nodes, m, k = scene[2], scene[0].shape[0], base.shape[0]
    places, channels = np.empty((k, 2)), np.empty((m, k), np.complex128)
    leans, ways, distances = np.empty((m, 3)), np.empty((m, 3)), np.empty(m)
    fill_channels(scene, base, x, places, channels, leans, ways, distances)
    w = np.empty(k, np.complex128)
    for n in range(k):
        w[n] = complex(math.cos(x[4 + n]), math.sin(x[4 + n])) / math.sqrt(k)
    asked = slopes.shape[0] > 0
    of_jamming, of_signal = (
        np.zeros(slopes.shape[1] if asked else 0),
        np.zeros(slopes.shape[1] if asked else 0),
    )
    below = 1.0
    for j in range(nodes, m):
        below += beam_power(w, channels[j], places, leans[j], ways[j], distances[j], of_jamming)
    worst = math.inf
    for q in range(nodes):
        of_signal[:] = 0.0
        value = beam_power(w, channels[q], places, leans[q], ways[q], distances[q], of_signal)
        logs[q] = math.log(value / below) if value > 0.0 else -math.inf
        worst = min(worst, logs[q])
        for a in range(of_signal.shape[0]):
            slopes[q, a] = of_signal[a] / max(value, _TINY) - of_jamming[a] / below
    return worst


@kernel
def respond(scene, base, shared, x, logs, slopes):
    """Fill every node's log ratio at a state and, unless they have no rows, its slopes; return the smallest.

    Args:
        scene: (points (m, 3), strengths (m,), number of nodes), the nodes first; a strength is power times
            path gain over noise, m^2, a node's divided by what the node requires.
        base: (k, 2) elements in body axes, wavelengths.
        shared: whether one beam serves all nodes; otherwise each has its own weights.
        x: (4,) or, with a shared beam, (4 + k,).
        logs: output, (nodes,).
        slopes: output, (nodes, size of x) or (0, size of x).
    """
    if shared:
        return shared_beam(scene, base, x, logs, slopes)
    return digital(scene, base, x, logs, slopes)


@heap_kernel
def array_value(scene, base, shared, x):
    """Return the smallest log ratio at a state, as :func:`respond`."""
    return respond(scene, base, shared, x, np.empty(scene[2]), np.empty((0, x.shape[0])))
