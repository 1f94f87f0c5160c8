"""Taylor numbers: a formula over boxes, with its two derivatives, in interval arithmetic.

A formula of coordinates is stated once, as in "The physics". Sums, products and functions of functions find
its value and slopes at the centre of each box, and the ranges of both and of its second derivatives over it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from nullpose.certificate.elementary import exp, log
from nullpose.certificate.interval import Interval, as_interval, common, where
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray

Rule: TypeAlias = tuple[Interval, Interval, Interval]
"""A function of one number and its first two derivatives."""


@lru_cache
def pairs(n: int) -> tuple[IntArray, IntArray, IntArray]:
    """Return both coordinates of each second derivative, squares first, and, (n, n), where each is."""
    off = np.triu_indices(n, 1)
    first, second = (np.append(np.arange(n), side) for side in off)
    place = np.zeros((n, n), dtype=np.int64)
    place[first, second] = place[second, first] = np.arange(len(first))
    return first, second, place


@dataclass(frozen=True, slots=True, eq=False)
class Taylor:
    """Numbers, or vectors along a first axis, as functions of n coordinates over b boxes.

    Args:
        half: (n, b) bounds on the distance of each coordinate from its value at the centre.
        value: (..., b) at the centres.
        slopes: (..., n, b) first derivatives there.
        curve: (..., n (n + 1) / 2, b) second derivatives there, by :func:`pairs`.
        over: (..., b) what they are all over the boxes.
        steep: (..., n, b) first derivatives all over the boxes.
        bends: (..., n (n + 1) / 2, b) second derivatives all over the boxes.
    """

    __array_ufunc__ = None  # numpy must leave mixed expressions to the operators below

    half: FloatArray
    value: Interval
    slopes: Interval
    curve: Interval
    over: Interval
    steep: Interval
    bends: Interval

    @property
    def _parts(self) -> tuple[Interval, ...]:
        return self.value, self.slopes, self.curve, self.over, self.steep, self.bends

    @property
    def orders(self) -> tuple[tuple[Interval, ...], tuple[Interval, ...]]:
        """What is known at the centres and all over the boxes: value, first and second derivatives."""
        return self._parts[:3], self._parts[3:]

    def __getitem__(self, index: Any) -> Taylor:
        return Taylor(self.half, *(part[index] for part in self._parts))

    def __add__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        if not isinstance(other, Taylor):
            return replace(self, value=self.value + other, over=self.over + other)
        return Taylor(self.half, *(a + b for a, b in zip(self._parts, other._parts, strict=True))).tightened()

    __radd__ = __add__

    def __neg__(self) -> Taylor:
        return Taylor(self.half, *(-part for part in self._parts))

    def __sub__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        return self + -other

    def __rsub__(self, other: FloatArray | float) -> Taylor:
        return -self + other

    def __mul__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        if not isinstance(other, Taylor):
            scale = as_interval(other)
            scales = (scale, _each(scale), _each(scale)) * 2
            return Taylor(self.half, *(part * by for part, by in zip(self._parts, scales, strict=True)))
        i, j, _ = pairs(len(self.half))
        parts: list[Interval] = []
        for (x, dx, ddx), (y, dy, ddy) in zip(self.orders, other.orders, strict=True):
            mixed = dx[..., i, :] * dy[..., j, :] + dx[..., j, :] * dy[..., i, :]
            slopes = dx * _each(y) + dy * _each(x)
            parts += [x * y, slopes, ddx * _each(y) + ddy * _each(x) + mixed]
        return Taylor(self.half, *parts).tightened()

    __rmul__ = __mul__

    def __truediv__(self, other: Taylor) -> Taylor:
        return self * other.of(inverse)

    def of(self, function: Callable[[Interval], Rule]) -> Taylor:
        """Return a function of these numbers, given by its rule."""
        return self.composed(function(self.value), function(self.over))

    def composed(self, at: Rule, over: Rule) -> Taylor:
        """Return a function of these numbers, from its rule at the centres and all over the boxes."""
        i, j, _ = pairs(len(self.half))
        parts: list[Interval] = []
        for (_, dx, ddx), (value, first, second) in zip(self.orders, (at, over), strict=True):
            square = dx[..., i, :] * dx[..., j, :]
            low = np.where((i == j)[:, None], np.maximum(square.low, 0.0), square.low)
            bends = ddx * _each(first) + Interval(low, square.high) * _each(second)
            parts += [value, dx * _each(first), bends]
        return Taylor(self.half, *parts).tightened()

    def squared(self) -> Taylor:
        """Return the squares."""
        return self.of(lambda x: (x.squared(), x * 2.0, Interval(2.0)))

    def total(self) -> Taylor:
        """Return the sum over the first axis."""
        return Taylor(self.half, *(part.total() for part in self._parts)).tightened()

    def tightened(self) -> Taylor:
        """Return the same functions, whose ranges are no wider than what the derivatives leave."""
        swing = _reach(self.bends.magnitude()[..., pairs(len(self.half))[2], :], self.half)
        steep = Interval(self.slopes.magnitude()) + Interval(swing) * 0.5
        reach = _reach(steep.high, self.half)
        return replace(
            self,
            over=common(self.over, self.value + Interval(-reach, reach)),
            steep=common(self.steep, self.slopes + Interval(-swing, swing)),
        )

    def largest(self) -> Interval:
        """Return bounds above over the boxes, (b,), of numbers.

        Of ``f(c) + G.x + x.H x / 2`` with ``|x_i| <= h_i``: mixed terms are split by
        ``2 |x_i x_j| <= x_i^2 h_j / h_i + x_j^2 h_i / h_j``, which leaves a parabola for each coordinate.
        """
        place, sizes, total = pairs(len(self.half))[2], self.bends.magnitude(), self.value
        for i, h in enumerate(self.half):
            others = [Interval(sizes[place[i, j]]) * k for j, k in enumerate(self.half) if j != i]
            # what x_i can add: (G + (mixed + own h / 2)) h at the end, or the parabola's top before it
            steep = Interval(self.slopes[i].magnitude())
            curve = sum(others, Interval(self.bends[i].high) * h)
            end = steep * h + curve * h * 0.5
            top = steep.squared() * h / (curve * -2.0)
            before = (curve.high < 0.0) & ~(steep.low >= -curve.low)
            total = total + where(before, top, end).most()
        return total

    def narrowed(self, third: Interval) -> Taylor:
        """Return the same functions, whose third derivatives along any unit direction are bounded, (b,)."""
        reach = (third * Interval(self.half).squared().total().sqrt()).most().high
        return replace(self, bends=common(self.bends, self.curve + Interval(-reach, reach))).tightened()

    def within(self, low: float, high: Interval) -> Taylor:
        """Return the same functions, which are between a number and others."""
        return replace(self, over=common(self.over, Interval(low, high.high)))

    def alike(self, number: Interval | FloatArray | float) -> Taylor:
        """Return constants over the same boxes."""
        n = len(self.half)
        zero = Interval(np.zeros((n, 1))), Interval(np.zeros((n * (n + 1) // 2, 1)))
        return Taylor(self.half, *(as_interval(number), *zero) * 2)


def coordinates(value: Interval, over: Interval) -> Taylor:
    """Return the coordinates themselves, (n, b), from what they are at the centres and over the boxes."""
    n = len(value.low)
    unit, zero = Interval(np.eye(n)[:, :, None]), Interval(np.zeros((n, n * (n + 1) // 2, 1)))
    return Taylor((over - value).magnitude(), value, unit, zero, over, unit, zero)


def chosen(mask: np.ndarray, a: Taylor, b: Taylor) -> Taylor:
    """Return a where the mask holds, else b."""
    return Taylor(a.half, *(where(mask, x, y) for x, y in zip(a._parts, b._parts, strict=True)))


def cross(x: Taylor, y: Taylor | Interval) -> Taylor:
    """Return the cross products of vectors."""
    return x[[1, 2, 0]] * y[[2, 0, 1]] - x[[2, 0, 1]] * y[[1, 2, 0]]


def inverse(x: Interval) -> Rule:
    """Return ``1 / x`` by its rule."""
    value = 1.0 / x
    square = value.squared()
    return value, -square, square * value * 2.0


def root(x: Interval) -> Rule:
    """Return the square root of what is positive by its rule."""
    value = x.sqrt()
    slope = 0.5 / value
    return value, slope, -(slope / x) * 0.5


def inverse_root(x: Interval) -> Rule:
    """Return ``1 / sqrt(x)`` of what is positive by its rule."""
    value = 1.0 / x.sqrt()
    square = value.squared()
    slope = value * square * -0.5
    return value, slope, slope * square * -1.5


def logarithm(x: Interval) -> Rule:
    """Return the logarithm of what is positive by its rule."""
    slope = 1.0 / x
    return log(x), slope, -slope.squared()


def exponential(x: Interval) -> Rule:
    """Return ``e^x`` by its rule."""
    value = exp(x)
    return value, value, value


def _each(x: Interval) -> Interval:
    """Return numbers for each of the derivatives, which lie along the axis before the last."""
    return Interval(*(end[..., None, :] if end.ndim else end for end in x.ends))


def _reach(steep: FloatArray, half: FloatArray) -> FloatArray:
    """Return bounds on how far slopes, (..., n, b), lead within the boxes."""
    return sum((Interval(steep[..., i, :]) * h for i, h in enumerate(half)), Interval(0.0)).high
