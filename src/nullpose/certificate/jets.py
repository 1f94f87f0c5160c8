"""Functions with their first and second derivatives over boxes, in interval arithmetic."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from nullpose.certificate.interval import ANY, Interval, where
from nullpose.physics.types import FloatArray

PAIRS = np.array(list(combinations_with_replacement(range(5), 2)))
"""Coordinates of each second derivative that is kept, (15, 2)."""

_FIRST, _SECOND = PAIRS.T


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """Functions over boxes, numbers or vectors, and their derivatives; products are those of numbers.

    Args:
        value: (b,) what they are; vectors have their components along a first axis, and so in what follows.
        slopes: (n, b) first derivatives.
        bends: second derivatives, (15, b) by ``PAIRS`` of five coordinates, or (6, b) as a form of three.
        over: what else is known of them all over the boxes.
    """

    value: Interval
    slopes: Interval
    bends: Interval
    over: Interval = ANY

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.slopes + other.slopes, self.bends + other.bends)

    def __sub__(self, other: Jet) -> Jet:
        return Jet(self.value - other.value, self.slopes - other.slopes, self.bends - other.bends)

    def times(self, scale: Interval | FloatArray) -> Jet:
        """Return multiples, one for each box."""
        return Jet(self.value * scale, self.slopes * scale, self.bends * scale)

    def __mul__(self, other: Jet) -> Jet:
        mixed = self.slopes[_FIRST] * other.slopes[_SECOND] + self.slopes[_SECOND] * other.slopes[_FIRST]
        return Jet(
            self.value * other.value,
            self.slopes * other.value + other.slopes * self.value,
            self.bends * other.value + other.bends * self.value + mixed,
        )

    def of(self, value: Interval, first: Interval, second: Interval) -> Jet:
        """Return a function of this one, given what it and its two derivatives are there, (b,) each."""
        bends = self.bends * first + self.slopes[_FIRST] * self.slopes[_SECOND] * second
        return Jet(value, self.slopes * first, bends)

    def inverse_root(self) -> Jet:
        """Return one over the square root, of what is positive."""
        root = 1.0 / self.value.sqrt()
        cube = root * root.squared()
        return self.of(root, cube * -0.5, cube * root.squared() * 0.75)


def flat(value: Interval, slopes: dict[int, Interval | FloatArray], bends: dict[int, Interval]) -> Jet:
    """Return a jet whose other derivatives are zero.

    Args:
        value: (b,).
        slopes: first derivatives by coordinate, (b,) each.
        bends: second derivatives by place in ``PAIRS``.
    """
    low, high = np.zeros((2, 5 + len(PAIRS), *value.low.shape))
    for at, each in [*slopes.items(), *((5 + pair, bend) for pair, bend in bends.items())]:
        low[at], high[at] = (each.low, each.high) if isinstance(each, Interval) else (each, each)
    return Jet(value, Interval(low[:5], high[:5]), Interval(low[5:], high[5:]))


def largest(value: Interval, slopes: Interval, bends: Interval, half: FloatArray) -> Interval:
    """Return bounds above on functions over their boxes, (b,).

    Of ``f(c) + G.x + x.H x / 2`` with ``|x_i| <= h_i``: mixed terms are split by
    ``2 |x_i x_j| <= x_i^2 h_j / h_i + x_j^2 h_i / h_j``, which leaves a parabola for each coordinate.

    Args:
        value: (b,) f at the centres.
        slopes: (5, b) G, there.
        bends: (15, b) H, all over the boxes.
        half: (5, b) the half sides h.
    """
    mixed = np.where((_FIRST == _SECOND)[:, None], 0.0, bends.magnitude())
    total = value
    for i in range(5):
        h, square = Interval(half[i]), int(np.flatnonzero((i == _FIRST) & (i == _SECOND))[0])
        spread = Interval(np.zeros(half.shape[1]))
        for pair in np.flatnonzero((i == _FIRST) ^ (i == _SECOND)):
            other = _SECOND[pair] if _FIRST[pair] == i else _FIRST[pair]
            spread = spread + Interval(mixed[pair]) * half[other]
        # what x_i can add: (G + (mixed + own h / 2)) h at the end, or the parabola's top before it
        steep = Interval(slopes[i].magnitude())
        curve = Interval(bends[square].high) * h + spread
        end = steep * h + curve * h * 0.5
        top = steep.squared() * h / (curve * -2.0)
        before = (curve.high < 0.0) & ~(steep.low >= -curve.low)
        total = total + where(half[i] > 0.0, where(before, top, end), 0.0).most()
    return total
