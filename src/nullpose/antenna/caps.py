"""What a pattern does within caps of directions: its least and largest gain, and how fast it bends there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna.harmonics import FloatArray, Harmonics, directions, recurrence

_ROWS = {24: 128, 48: 256}  # of the table up to a degree, twice as many columns: powers of two
_ROUNDING = 1e-13  # of the sizes of a sum's terms: 450 units in the last place, at most 49 degrees
_DIRECTIONS = 16  # round half a circle, along which derivatives are taken
_ORDER = 4  # highest derivative that is looked at; the next is bounded by the degree

_Rotated = dict[tuple[int, int, int], NDArray[np.complex128]]


class PatternArrays(NamedTuple):
    """A pattern as the kernels take it.

    Args:
        cosine: (d + 1, d + 1) its harmonics.
        sine: likewise.
        start: (d + 1,) first Legendre function of each order.
        a: (d + 1, d + 1) the recurrence to the next.
        b: likewise.
        orders: how many orders are not zero, counted from 0.
        caps: (n, 5) over blocks of directions: minus the least gain, the largest, and the largest first,
            second and third derivative along a great circle.
        offset: (rows' levels, columns' levels) where the blocks of a size begin: level k joins 2^k.
        rows: rows of the finest blocks; there are twice as many columns.
        rounding: more than a gain that is evaluated in double precision can be off.
    """

    cosine: FloatArray
    sine: FloatArray
    start: FloatArray
    a: FloatArray
    b: FloatArray
    orders: int
    caps: FloatArray
    offset: NDArray[np.int64]
    rows: int
    rounding: float


@lru_cache(maxsize=8)
def pattern_arrays(harmonics: Harmonics) -> PatternArrays:
    """Return a pattern for the kernels, with the table of what it does within caps.

    Args:
        harmonics: the pattern.
    """
    used = np.any(harmonics.cosine != 0.0, axis=0) | np.any(harmonics.sine != 0.0, axis=0)
    finest = _finest(harmonics)
    levels = [[cells.reshape(-1, 5) for cells in _joined(rows, 1)] for rows in _joined(finest, 0)]
    sizes = [len(cells) for level in levels for cells in level]
    offset = np.reshape(np.cumsum([0, *sizes[:-1]]), (len(levels), -1))
    start, a, b = recurrence(harmonics.degree)
    orders = int(np.max(np.nonzero(used)[0], initial=0)) + 1
    norms = np.sqrt(2.0 * np.arange(harmonics.degree + 1) + 1.0)  # of a harmonic of each degree
    return PatternArrays(
        np.ascontiguousarray(harmonics.cosine),
        np.ascontiguousarray(harmonics.sine),
        start,
        a,
        b,
        orders,
        np.ascontiguousarray(np.concatenate([cells for level in levels for cells in level])),
        offset.astype(np.int64),
        len(finest),
        _ROUNDING * float(np.sum((np.abs(harmonics.cosine) + np.abs(harmonics.sine)).T * norms)),
    )


def _joined(cells: FloatArray, axis: int) -> Iterator[FloatArray]:
    """Yield cells, then the largest numbers of pairs along an axis, of pairs of those, and so on to one."""
    yield cells
    while (count := cells.shape[axis]) > 1:
        cells = np.maximum(*(cells.take(range(first, count, 2), axis) for first in (0, 1)))
        yield cells


def _finest(harmonics: Harmonics) -> FloatArray:
    """Return the five numbers of each cell of the table, (rows, columns, 5).

    The derivative of order m along the great circle that a rotation about the unit vector w makes is
    ``(w.L)^m g`` with the generators L of rotations, which map harmonics of a degree to such. Its values at a
    cell's middle for some w, and the bound ``|f'| <= degree max |f|`` of Bernstein for what lies between,
    make bounds for the cell.
    """
    rows = next(rows for degree, rows in _ROWS.items() if harmonics.degree <= degree)
    step = math.pi / rows
    theta = np.asarray((np.arange(rows) + 0.5) * step, dtype=np.float64)
    phi = np.asarray((np.arange(2 * rows) + 0.5) * step, dtype=np.float64)
    radius = math.hypot(step, step) / 2.0
    degree = max(1, harmonics.degree)
    angles = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    south = directions(np.degrees(theta) + 90.0, np.degrees(phi))
    east = directions([90.0], np.degrees(phi) + 90.0)
    found: _Rotated = {(0, 0, 0): _complex(harmonics)}
    gain, least = _values(found[0, 0, 0], theta, phi), []
    for order in range(1, _ORDER + 1):
        found = _rotated_once_more(found)
        fields = {power: _values(c, theta, phi) for power, c in found.items()}
        most = np.zeros(gain.shape)
        for angle in angles:
            about = math.cos(angle) * south + math.sin(angle) * east
            form = sum(
                f * about[..., 0] ** i * about[..., 1] ** j * about[..., 2] ** k
                for (i, j, k), f in fields.items()
            )
            most = np.maximum(most, np.abs(form))
        # between the directions: a trigonometric polynomial of this order
        least.append(most / math.cos(order * math.pi / (2 * _DIRECTIONS)))
    return _padded(gain, least, radius, degree)


def _padded(gain: FloatArray, slopes: list[FloatArray], radius: float, degree: int) -> FloatArray:
    """Return bounds over cells from what holds at their middles.

    While a direction moves over the sphere and carries its tangent with it, the symmetric derivative of
    order m changes by that of order m + 1 and, since the sphere is curved, by at most 2/3 of the first for
    m = 2 and 2 times the second for m = 3.

    Args:
        gain: at the middles.
        slopes: the derivatives of order 1 to 4 there.
        radius: of a cell.
        degree: of the pattern.
    """
    rate = degree + 4.0 * (math.pi / 2.0 + math.pi**3 / 24.0)  # Bernstein, and the turning of w
    most = float(np.max(slopes[3])) / (1.0 - radius * rate)
    fourth = slopes[3] + radius * rate * most
    mixed = np.array([[0.0, 1.0, 0.0], [2.0 / 3.0, 0.0, 1.0], [0.0, 2.0, 0.0]])
    at_middles = np.stack([slopes[0], slopes[1], slopes[2] + radius * fourth])
    bounds = np.tensordot(np.linalg.inv(np.eye(3) - radius * mixed), at_middles, axes=1)
    change = radius * slopes[0] + radius**2 / 2.0 * slopes[1] + radius**3 / 6.0 * bounds[2]
    return np.stack([change - gain, gain + change, *bounds], axis=-1)


def _complex(harmonics: Harmonics) -> NDArray[np.complex128]:
    """Return coefficients by n and degree + m of the orthonormal complex harmonics, m of both signs."""
    signs = (-1.0) ** np.arange(1, harmonics.degree + 1)
    upper = (harmonics.cosine[:, 1:] - 1j * harmonics.sine[:, 1:]) / math.sqrt(2.0)
    return np.hstack([np.conj(upper[:, ::-1]), harmonics.cosine[:, :1], signs * upper])


def _rotated_once_more(found: _Rotated) -> _Rotated:
    """Return the coefficients of ``(w.L)^(m+1) g`` by powers of w, from those of ``(w.L)^m g``."""
    more: _Rotated = {}
    for power, c in found.items():
        degree = len(c) - 1
        n, m = np.arange(degree + 1)[:, None], np.arange(-degree, degree + 1)
        up = np.sqrt(np.maximum(0.0, n * (n + 1) - m * (m + 1))) * c  # L+ takes m to m + 1
        down = np.sqrt(np.maximum(0.0, n * (n + 1) - m * (m - 1))) * c
        raised, lowered = np.zeros_like(c), np.zeros_like(c)
        raised[:, 1:], lowered[:, :-1] = up[:, :-1], down[:, 1:]
        parts = ((raised + lowered) / 2.0, (raised - lowered) / 2j, m * c)
        for axis, part in enumerate(parts):
            name = (power[0] + (axis == 0), power[1] + (axis == 1), power[2] + (axis == 2))
            more[name] = more.get(name, 0.0) + 1j * part
    return more


def _values(c: NDArray[np.complex128], theta: FloatArray, phi: FloatArray) -> FloatArray:
    """Return a real function's values on a grid from its complex coefficients."""
    orders = np.arange(len(c))
    upper = (-1.0) ** orders * np.where(orders > 0, math.sqrt(2.0), 1.0) * c[:, len(c) - 1 :]
    return Harmonics(upper.real, -upper.imag * (orders > 0)).on_grid(theta, phi)
