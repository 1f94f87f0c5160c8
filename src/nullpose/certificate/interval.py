"""Interval arithmetic on arrays, rounded outward: what is computed contains what is meant.

IEEE 754 has sums, products, quotients and square roots correctly rounded, so that the next
floating-point numbers on either side enclose the exact result. Nothing else is used.

An end that is infinite or not a number (NaN) is unknown; the other end holds by itself. Comparisons with
NaN are false. So what excludes is a comparison that must hold, and what leaves out a term or an alternative
is one too: ``~(high < floor)`` keeps all that may be above a floor, ``high >= floor`` would lose what is
unknown. Only what need not be there at all, such as a multiplier's constraint, may be lost.
"""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.types import FloatArray

_MORE, _LEAST = 2.0**-53 * (1.0 + 2.0**-52), 5e-324
_LARGEST = float(np.finfo(float).max)


def _step(x: FloatArray) -> FloatArray:
    """Take more than half of the way to either neighbour, so that its rounding leads there at least."""
    return np.abs(x) * _MORE + _LEAST


def _down(x: FloatArray) -> FloatArray:
    """Bound from below the numbers to which x are nearest."""
    x = np.minimum(x, _LARGEST)  # what is too large for a number is no less than that
    return x - _step(x)


def _up(x: FloatArray) -> FloatArray:
    """Bound from above the numbers to which x are nearest."""
    x = np.maximum(x, -_LARGEST)
    return x + _step(x)


def above(x: FloatArray) -> FloatArray:
    """Bound from above a sum of at most a thousand products of two numbers that are not negative.

    Each sum and each product is off by a 2^53rd, or by less than the least number.
    """
    return x * (1.0 + 2.0**-40) + 2.0**-1000


class Interval:
    """Arrays of numbers of which only bounds are known.

    Args:
        low: lower bounds.
        high: upper bounds, of the same shape; left out, the numbers are known exactly.
    """

    __array_ufunc__ = None  # numpy must leave mixed expressions to the operators below
    __slots__ = ("high", "low")

    def __init__(self, low: ArrayLike, high: ArrayLike | None = None) -> None:
        self.low: FloatArray = np.asarray(low, dtype=float)
        self.high: FloatArray = self.low if high is None else np.asarray(high, dtype=float)

    @property
    def ends(self) -> tuple[FloatArray, ...]:
        """Lower and upper bounds; one array where the numbers are known exactly."""
        return (self.low,) if self.low is self.high else (self.low, self.high)

    def __getitem__(self, index: Any) -> Interval:
        return Interval(*(end[index] for end in self.ends))

    def __neg__(self) -> Interval:
        return Interval(-self.high, -self.low)

    def __add__(self, other: Interval | ArrayLike) -> Interval:
        o = as_interval(other)
        return Interval(_down(self.low + o.low), _up(self.high + o.high))

    __radd__ = __add__

    def __sub__(self, other: Interval | ArrayLike) -> Interval:
        return self + -as_interval(other)

    def __rsub__(self, other: ArrayLike) -> Interval:
        return as_interval(other) - self

    def __mul__(self, other: Interval | ArrayLike) -> Interval:
        products = [x * y for x in self.ends for y in as_interval(other).ends]
        return Interval(_down(reduce(np.minimum, products)), _up(reduce(np.maximum, products)))

    __rmul__ = __mul__

    def __truediv__(self, other: Interval | ArrayLike) -> Interval:
        o = as_interval(other)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            defined = (o.low > 0.0) | (o.high < 0.0)
            quotient = self * where(defined, Interval(_down(1.0 / o.high), _up(1.0 / o.low)), ANY)
        # 0 times infinity: nothing is known
        return where(np.isnan(quotient.low) | np.isnan(quotient.high), ANY, quotient)

    def __rtruediv__(self, other: ArrayLike) -> Interval:
        return as_interval(other) / self

    @property
    def T(self) -> Interval:  # noqa: N802 - as an array's
        """The same numbers with the first two axes in the other order."""
        return Interval(*(end.swapaxes(0, 1) for end in self.ends))

    def squared(self) -> Interval:
        """Square the numbers; what is squared is never below zero."""
        a, b = self.low * self.low, self.high * self.high
        low = np.where((self.low < 0.0) & (self.high > 0.0), 0.0, _down(np.minimum(a, b)))
        return Interval(np.maximum(low, 0.0), _up(np.maximum(a, b)))

    def sqrt(self) -> Interval:
        """Return the square roots of numbers that are not negative."""
        root = np.sqrt(np.maximum(self.low, 0.0))
        return Interval(np.maximum(_down(root), 0.0), _up(np.sqrt(np.maximum(self.high, 0.0))))

    def magnitude(self) -> FloatArray:
        """Return upper bounds on the absolute values."""
        return np.maximum(np.abs(self.low), np.abs(self.high))

    def most(self) -> Interval:
        """Return the upper bounds as exact numbers, infinite where nothing is known."""
        return Interval(np.where(np.isnan(self.high), np.inf, self.high))

    def middle(self) -> FloatArray:
        """Return numbers inside, near the middle."""
        return np.clip(0.5 * self.low + 0.5 * self.high, self.low, self.high)

    def radius(self) -> FloatArray:
        """Return upper bounds on the distance from :meth:`middle` to the ends."""
        middle = self.middle()
        return _up(np.maximum(self.high - middle, middle - self.low))

    def total(self) -> Interval:
        """Return the sum over the first axis."""
        return reduce(add, (self[i] for i in range(len(self.low))))


ANY = Interval(-np.inf, np.inf)
"""A number of which nothing is known."""


def as_interval(value: Interval | ArrayLike) -> Interval:
    """Return exact numbers as an interval, and an interval as it is."""
    return value if isinstance(value, Interval) else Interval(value)


def common(a: Interval, b: Interval) -> Interval:
    """Intersect two enclosures of the same numbers; undefined ends do not count, as each holds by itself."""
    return Interval(np.fmax(a.low, b.low), np.fmin(a.high, b.high))


def dot(a: Interval, b: Interval | FloatArray) -> Interval:
    """Return the inner product over the first axis."""
    return (a * b).total()


def stack(parts: list[Interval]) -> Interval:
    """Return intervals of one shape along a new first axis."""
    return Interval(np.stack([p.low for p in parts]), np.stack([p.high for p in parts]))


def where(mask: np.ndarray, a: Interval | ArrayLike, b: Interval | ArrayLike) -> Interval:
    """Return a where the mask holds, else b."""
    a, b = as_interval(a), as_interval(b)
    return Interval(np.where(mask, a.low, b.low), np.where(mask, a.high, b.high))
