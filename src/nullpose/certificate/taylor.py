"""Taylor numbers: a formula over boxes, with its two derivatives, in interval arithmetic.

A formula of coordinates is stated once, as in "The physics". Sums, products and functions of functions find
its value and slopes at the centre of each box, and the ranges of both and of its second derivatives over it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from nullpose.certificate.elementary import exp, log
from nullpose.certificate.interval import Interval, above, as_interval, common, where
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray

Rule: TypeAlias = tuple[Interval, Interval, Interval]
"""A function of one number and its first two derivatives."""


class Orders(NamedTuple):
    """What is known of a formula in one place: at the centres of b boxes, or all over them.

    Args:
        value: (..., b).
        slopes: (..., n, b) first derivatives.
        bends: (..., n (n + 1) / 2, b) second derivatives, by :func:`pairs`.
    """

    value: Interval
    slopes: Interval
    bends: Interval


@lru_cache
def pairs(n: int) -> tuple[IntArray, IntArray, IntArray]:
    """List both coordinates of each second derivative, squares first, and, (n, n), where each is."""
    off = np.triu_indices(n, 1)
    first, second = (np.append(np.arange(n), side) for side in off)
    place = np.zeros((n, n), dtype=np.int64)
    place[first, second] = place[second, first] = np.arange(len(first))
    return first, second, place


@dataclass(frozen=True, slots=True, eq=False)
class Taylor:
    """Numbers, or vectors along a first axis, as functions of n coordinates over b boxes.

    Along the axis before the last are the two places where they are known, the centres and all of the boxes;
    what is the same in both, or known at the centres alone, has one.

    Args:
        half: (n, b) bounds on the distance of each coordinate from its value at the centre.
        value: (..., places, b).
        slopes: (..., n, places, b) first derivatives.
        bends: (..., n (n + 1) / 2, places, b) second derivatives, by :func:`pairs`.
    """

    __array_ufunc__ = None  # numpy must leave mixed expressions to the operators below

    half: FloatArray
    value: Interval
    slopes: Interval
    bends: Interval

    @property
    def _orders(self) -> Orders:
        return Orders(self.value, self.slopes, self.bends)

    @property
    def at(self) -> Orders:
        """What is known at the centres."""
        return Orders(*(part[..., 0, :] for part in self._orders))

    @property
    def over(self) -> Orders:
        """What is known all over the boxes."""
        return Orders(*(part[..., -1, :] for part in self._orders))

    def at_centres(self) -> Taylor:
        """Leave out what is known all over the boxes: of the result ``at`` holds, and ``over`` does not."""
        return Taylor(self.half, *(part[..., :1, :] for part in self._orders))

    def __getitem__(self, index: Any) -> Taylor:
        return Taylor(self.half, *(part[index] for part in self._orders))

    def __add__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        if not isinstance(other, Taylor):
            return replace(self, value=self.value + _each(other))
        return Taylor(
            self.half, *(a + b for a, b in zip(self._orders, other._orders, strict=True))
        ).tightened()

    __radd__ = __add__

    def __neg__(self) -> Taylor:
        return Taylor(self.half, *(-part for part in self._orders))

    def __sub__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        return self + -other

    def __rsub__(self, other: FloatArray | float) -> Taylor:
        return -self + other

    def __mul__(self, other: Taylor | Interval | FloatArray | float) -> Taylor:
        if not isinstance(other, Taylor):
            scale = _each(other)
            each = _along(scale)
            return Taylor(self.half, self.value * scale, self.slopes * each, self.bends * each)
        x, y, (i, j, _) = self, other, pairs(len(self.half))
        mixed = x.slopes[..., None, :, :] * y.slopes[..., None, :, :, :]
        mixed = mixed[..., i, j, :, :] + mixed[..., j, i, :, :]
        slopes = x.slopes * _along(y.value) + y.slopes * _along(x.value)
        bends = x.bends * _along(y.value) + y.bends * _along(x.value) + mixed
        return Taylor(self.half, x.value * y.value, slopes, bends).tightened()

    __rmul__ = __mul__

    def __truediv__(self, other: Taylor) -> Taylor:
        return self * other.of(inverse)

    def of(self, function: Callable[[Interval], Rule]) -> Taylor:
        """Compose a function with these numbers, given by its rule."""
        return self.composed(*function(self.value))

    def composed(self, value: Interval, first: Interval, second: Interval) -> Taylor:
        """Compose a function with these numbers, from its value and derivatives in each place."""
        i, j, _ = pairs(len(self.half))
        square = self.slopes[..., i, :, :] * self.slopes[..., j, :, :]
        low = np.where((i == j)[:, None, None], np.maximum(square.low, 0.0), square.low)
        bends = self.bends * _along(first) + Interval(low, square.high) * _along(second)
        return Taylor(self.half, value, self.slopes * _along(first), bends).tightened()

    def squared(self) -> Taylor:
        """Square the numbers."""
        return self.of(lambda x: (x.squared(), x * 2.0, Interval(2.0)))

    def total(self) -> Taylor:
        """Sum over the first axis."""
        return Taylor(self.half, *(part.total() for part in self._orders)).tightened()

    def tightened(self) -> Taylor:
        """Narrow the ranges over the boxes to what the derivatives leave."""
        if self.value.low.shape[-2] == 1:
            return self
        at, over = self.at, self.over
        swing = _reach(self._sizes(), self.half)
        reach = _reach(above(at.slopes.magnitude() + 0.5 * swing), self.half)
        return replace(
            self,
            value=joined(at.value, common(over.value, at.value + Interval(-reach, reach))),
            slopes=joined(at.slopes, common(over.slopes, at.slopes + Interval(-swing, swing))),
        )

    def _sizes(self) -> FloatArray:
        """Bound the magnitudes of second derivatives over the boxes, (..., n, n, b)."""
        return self.over.bends.magnitude()[..., pairs(len(self.half))[2], :]

    def bent(self) -> FloatArray:
        """Bound what value and slopes at the centres leave out over the boxes, (b,)."""
        return 0.5 * _reach(_reach(self._sizes(), self.half), self.half)

    def largest(self) -> Interval:
        """Bound numbers from above over the boxes, (b,).

        Of ``f(c) + G.x + x.H x / 2`` with ``|x_i| <= h_i``: mixed terms are split by
        ``2 |x_i x_j| <= x_i^2 h_j / h_i + x_j^2 h_i / h_j``, which leaves a parabola for each coordinate.
        """
        bends, total, sizes = self.over.bends, self.at.value, self._sizes()
        steep = Interval(self.at.slopes.magnitude())
        for i, h in enumerate(self.half):
            # what x_i can add: (G + (mixed + own h / 2)) h at the end, or the parabola's top before it
            others = above(np.sum(np.delete(sizes[i] * self.half, i, axis=0), axis=0))
            curve = Interval(bends.high[i]) * h + others
            end = (steep[i] + curve * 0.5) * h
            top = steep[i].squared() * h / (curve * -2.0)
            before = (curve.high < 0.0) & ~(steep.low[i] >= -curve.low)
            total = total + where(before, top, end).most()
        return total

    def narrowed(self, third: Interval) -> Taylor:
        """Narrow the ranges by bounds, (b,), on third derivatives along any unit direction.

        They bound mixed ones too, and so how fast second derivatives change: see docs/proofs.md.
        """
        reach = (third * Interval(self.half).squared().total().sqrt()).most().high
        near = common(self.over.bends, self.at.bends + Interval(-reach, reach))
        return replace(self, bends=joined(self.at.bends, near)).tightened()

    def within(self, low: float, high: Interval) -> Taylor:
        """Narrow the ranges to between a number and others, (b,)."""
        return replace(self, value=joined(self.at.value, common(self.over.value, Interval(low, high.high))))

    def alike(self, number: Interval | FloatArray | float) -> Taylor:
        """Take constants over the same boxes."""
        n, value = len(self.half), _each(number)
        zeros = (np.zeros((*value.low.shape[:-2], m, 1, 1)) for m in (n, n * (n + 1) // 2))
        return Taylor(self.half, value, *map(Interval, zeros))


def coordinates(value: Interval, over: Interval) -> Taylor:
    """Take the coordinates themselves, (n, b), from what they are at the centres and over the boxes."""
    n = len(value.low)
    unit, zero = np.eye(n)[:, :, None, None], np.zeros((n, n * (n + 1) // 2, 1, 1))
    return Taylor((over - value).magnitude(), joined(value, over), Interval(unit), Interval(zero))


def joined(at: Interval, over: Interval) -> Interval:
    """Join what is known at the centres, (..., b), and all over the boxes to both places."""
    return Interval(
        *(np.stack(np.broadcast_arrays(*ends), -2) for ends in ((at.low, over.low), (at.high, over.high)))
    )


def chosen(mask: np.ndarray, a: Taylor, b: Taylor) -> Taylor:
    """Choose a where the mask holds, else b."""
    return Taylor(a.half, *(where(mask, x, y) for x, y in zip(a._orders, b._orders, strict=True)))


def cross(x: Taylor, y: Taylor | Interval) -> Taylor:
    """Multiply vectors by the cross product."""
    return x[[1, 2, 0]] * y[[2, 0, 1]] - x[[2, 0, 1]] * y[[1, 2, 0]]


def inverse(x: Interval) -> Rule:
    """State ``1 / x`` by its rule."""
    value = 1.0 / x
    square = value.squared()
    return value, -square, square * value * 2.0


def root(x: Interval) -> Rule:
    """State the square root of what is positive by its rule."""
    value = x.sqrt()
    slope = 0.5 / value
    return value, slope, -(slope / x) * 0.5


def logarithm(x: Interval) -> Rule:
    """State the logarithm of what is positive by its rule."""
    slope = 1.0 / x
    return log(x), slope, -slope.squared()


def exponential(x: Interval) -> Rule:
    """State ``e^x`` by its rule."""
    value = exp(x)
    return value, value, value


def _each(number: Interval | FloatArray | float) -> Interval:
    """Take numbers, (..., b), in each place: (..., 1, b)."""
    x = as_interval(number)
    return x[..., None, :] if x.low.ndim else x


def _along(x: Interval) -> Interval:
    """Take numbers, (..., places, b), for each derivative: (..., 1, places, b)."""
    return x[..., None, :, :] if x.low.ndim else x


def _reach(steep: FloatArray, half: FloatArray) -> FloatArray:
    """Bound how far slopes, (..., n, b), lead within the boxes."""
    return above(np.sum(steep * half, axis=-2))
