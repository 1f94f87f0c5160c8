"""Exponentials, logarithms and arctangents of intervals: what is computed contains what is meant.

Only what IEEE 754 rounds correctly, or does exactly as scaling by powers of two, is trusted; the library's
logarithm is a guess, of which the error is enclosed. All three increase, so that the ends suffice.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

import numpy as np

from nullpose.certificate.interval import ANY, Interval, common, where
from nullpose.physics.types import FloatArray

LN2_HIGH = 2977044471 / 2**32  # 32 bits: its product with an integer below 2^21 is exact
LN2_LOW = Interval(
    1.9082149292705877e-10, 1.908214929270588e-10
)  # ln 2 less that; the tests sum a series of ln 2

_EXP = [
    1.0 / factorial(j + 1) for j in range(13)
]  # (exp r - 1) / r in r; left out: < 1.1 * 0.36^13 / 14! < u
_ARCTAN = [1.0 / (2 * j + 1) for j in range(20)]  # (arctan s) / s in -s²; left out: 0.173^20 / 41 < u


def exp(x: Interval) -> Interval:
    """Return e to the power x, never below zero, not even where x is not a number.

    >>> power = exp(Interval(1.0))
    >>> print(f"{power.low:.13f} {power.high:.13f}")
    2.7182818284590 2.7182818284590
    """
    # exp -746 is below half of the smallest number, and exp 710 is above the largest one
    return common(_by_ends(_exp, x, -746.0, 710.0), Interval(0.0, np.inf))


def log(x: Interval) -> Interval:
    """Return the natural logarithms of numbers that are positive.

    An end that is zero or infinite leaves its side unbounded.

    >>> root = log(Interval(4.0)) * 0.5
    >>> print(f"{root.low:.13f} {root.high:.13f}")
    0.6931471805599 0.6931471805599
    """
    result = _by_ends(_log, x, 5e-324, np.finfo(float).max)  # the least and the largest number
    return Interval(
        np.where(x.low > 0.0, result.low, -np.inf), np.where(x.high < np.inf, result.high, np.inf)
    )


def arctan(x: Interval) -> Interval:
    """Return the angles between -π/2 and π/2 of which x are the tangents.

    >>> angle = arctan(Interval(1.0, float("inf"))) * 4.0
    >>> print(f"{angle.low:.13f} {angle.high:.13f}")
    3.1415926535898 6.2831853071796
    """
    # no floating-point number is between arctan 1e150 and π/2: a bound on the one is a bound on the other
    return _by_ends(_arctan, x, -1e150, 1e150)


def _by_ends(function: Callable[[FloatArray], Interval], x: Interval, low: float, high: float) -> Interval:
    """Return an increasing function from its values at the ends, moved into [low, high]; of NaN, ANY."""
    ends = np.stack(x.ends)
    unknown = np.asarray(np.isnan(ends).any(axis=0))
    value = function(np.clip(np.where(unknown, high, ends), low, high))
    return where(unknown, ANY, Interval(value.low[0], value.high[-1]))


def _exp(x: FloatArray) -> Interval:
    """Return exp x = 2ᵏ exp r, where r = x - k ln 2 with an integer k.

    |r| < 0.347, for k is within 0.5001 of x / ln 2.
    exp r is within 2 |r - m| of exp m, for its derivative is below exp 0.36 < 2.
    """
    k = np.rint(x / LN2_HIGH)
    r = Interval(x) - k * LN2_HIGH - k * LN2_LOW
    m, error = r.middle(), 2.0 * r.radius()
    power = 1.0 + (_power_less_one(m) + Interval(-error, error))
    with np.errstate(over="ignore", under="ignore"):
        low, high = (np.ldexp(end, k.astype(int)) for end in power.ends)
    return Interval(np.maximum(np.nextafter(low, -np.inf), 0.0), np.nextafter(high, np.inf))


def _log(x: FloatArray) -> Interval:
    """Return log x = k ln 2 + y + log(1 + d), where x = 2ᵏ m, y is near log m and 1 + d = m exp(-y).

    d = (m - 1) + m (exp(-y) - 1) keeps its digits where m is near 1. d / (1 + d) <= log(1 + d) <= d.
    """
    m, k = np.frexp(x)
    small = m < 0.7
    m, k = np.where(small, 2.0 * m, m), k - small  # 0.7 <= m < 1.4
    y = np.clip(np.log(m), -0.36, 0.36)
    d = (Interval(m) - 1.0) + _power_less_one(-y) * m
    return LN2_LOW * k + (Interval((d / (1.0 + d)).low, d.high) + y) + k * LN2_HIGH


def _arctan(x: FloatArray) -> Interval:
    """Return arctan x = 4 arctan s, where s = tan((arctan x) / 4), and s² < tan(π/8)² < 0.173.

    tan(a/2) = t / (1 + √(1 + t²)), t = tan a. arctan s is within |s - m| of arctan m: no slope is above 1.
    """
    s = Interval(x)
    for _ in range(2):
        s = s / (1.0 + (1.0 + s.squared()).sqrt())
    m, error = s.middle(), s.radius()
    return 4.0 * (m * _series(_ARCTAN, -m * m) + Interval(-error, error))


def _power_less_one(r: FloatArray) -> Interval:
    """Return exp r - 1, to relative precision, for |r| <= 0.36."""
    return r * _series(_EXP, r)


def _series(coefficients: list[float], x: FloatArray) -> Interval:
    """Return the sum cⱼ xʲ of numbers |cⱼ| <= 1, rounded to nearest; |x| <= 0.36.

    Partial sums in Horner's scheme are at most 1 / (1 - 0.36) < 1.6. With u = 2⁻⁵³, a step adds an error of
    at most (0.36 * 1.6 + 1.6 + 1) u, of its product, sum and coefficient, and takes over 0.36 of the error
    before it: in all below 3.2 u / 0.64 = 5 u. A relative error u of x adds below 0.36 * 2.5 u < u, and what
    the series leaves out is below u. 2⁻⁵⁰ = 8 u is more, also with the squares of u and with underflow.
    """
    value = np.full_like(x, coefficients[-1])
    for c in coefficients[-2::-1]:
        value = value * x + c
    return value + Interval(-(2.0**-50), 2.0**-50)
