"""Exponentials, logarithms and arctangents of intervals contain the exact ones, and are tight."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from fractions import Fraction
from itertools import pairwise
from math import factorial

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import and_slow

from nullpose.certificate import elementary
from nullpose.certificate.elementary import arctan, exp, log
from nullpose.certificate.interval import Interval

LARGEST = float(np.finfo(float).max)
SMALLEST = 5e-324
UNIT = Fraction(1, 2**53)
COUNTS = pytest.mark.parametrize("count", and_slow([10_000], [100_000]))

ONE = 1 << 220  # arctangents are checked in integers, in units of 2^-220
SLACK = 1 << 20  # more units than their floors lose


def small_arctan(numerator: int, denominator: int) -> int:
    """Return the arctangent of a fraction of at most 1/15 in units, by its series."""
    term = e = numerator * ONE // denominator
    square, total, j = e * e // ONE, 0, 1
    while term not in (0, -1):
        total += term // j
        term, j = -(term * square // ONE), j + 2
    return total


SIXTEENTHS = [0]
for i in range(16):  # arctan((i+1)/16) - arctan(i/16) = arctan(16 / (256 + i (i+1)))
    SIXTEENTHS.append(SIXTEENTHS[-1] + small_arctan(16, 256 + i * (i + 1)))


def exact_arctan(x: float) -> int:
    """Return an arctangent in units, from the nearest sixteenth to the tangent or cotangent."""
    n, d = abs(x).as_integer_ratio()
    steep = n > d
    n, d = (d, n) if steep else (n, d)
    k = (32 * n + d) // (2 * d)
    angle = SIXTEENTHS[k] + small_arctan(16 * n - k * d, 16 * d + k * n)
    angle = 2 * SIXTEENTHS[16] - angle if steep else angle
    return angle if x > 0 else -angle


def assert_decimals_inside(result: Interval, exact: Callable[[Decimal], Decimal], x: np.ndarray) -> None:
    """Check a function of decimals, correctly rounded to 40 digits, against enclosures of it."""
    for a, low, high in zip(x.tolist(), result.low.tolist(), result.high.tolist(), strict=True):
        assert Decimal(low) < exact(Decimal(a)) < Decimal(high), a


def relative_width(result: Interval) -> np.ndarray:
    """Return the widths of enclosures that do not contain zero, as shares of their smaller ends."""
    return (result.high - result.low) / np.minimum(np.abs(result.low), np.abs(result.high))


@COUNTS
def test_exponentials_contain_the_exact_ones(count: int) -> None:
    """From where they are nearly the smallest number to nearly the largest one, to 14 digits."""
    rng = np.random.default_rng(1)
    x = np.concatenate(
        [
            rng.uniform(-700.0, 700.0, count),
            signed_powers(rng, -20.0, 0.0, count // 10),
            (np.arange(-2000, 2000) + 0.5) / 2.0 * np.log(2.0),  # halfway between multiples of ln 2
            [1.0, -1.0, 709.782712893384, -708.3],
        ]
    )
    x = x[(x > -708.4) & (x < 709.782712893384)]
    result = exp(Interval(x))
    with localcontext(prec=40):
        assert_decimals_inside(result, Decimal.exp, x)
    assert relative_width(result).max() < 5e-15


def test_exponentials_at_the_ends_of_the_numbers() -> None:
    """They under- and overflow to bounds that hold."""
    x = np.array([-np.inf, -LARGEST, -746.0, -745.2, -745.1, -720.0, 709.79, 710.0, LARGEST, np.inf])
    result = exp(Interval(x))
    assert np.all(result.low >= 0.0)
    assert result.high[:4].tolist() == [SMALLEST] * 4
    assert result.low[-4:].tolist() == [LARGEST] * 4
    assert result.high[-4:].tolist() == [np.inf] * 4
    with localcontext(prec=40):
        assert_decimals_inside(result[4:6], Decimal.exp, x[4:6])
    one = exp(Interval([0.0, -0.0, SMALLEST, -SMALLEST, 1e-300]))
    assert np.all((one.low < 1.0) & (one.high > 1.0) & (one.high - one.low < 1e-15))


@COUNTS
def test_logarithms_contain_the_exact_ones(count: int) -> None:
    """Over all numbers to 14 digits, also near 1, where they vanish."""
    rng = np.random.default_rng(2)
    x = np.concatenate(
        [
            10.0 ** rng.uniform(-300.0, 300.0, count),
            rng.uniform(0.5, 2.0, count // 10),
            1.0 + signed_powers(rng, -15.6, -0.3, count // 10),
            0.7 * 2.0 ** np.arange(-100, 100),
            [SMALLEST, 3 * SMALLEST, 2.2250738585072014e-308, LARGEST, 2.0, 0.5, 1.0 - 2.0**-53],
        ]
    )
    x = x[x != 1.0]
    result = log(Interval(x))
    with localcontext(prec=40):
        assert_decimals_inside(result, Decimal.ln, x)
    assert relative_width(result).max() < 1e-14


def test_logarithms_at_the_ends_of_the_numbers() -> None:
    """Zero has none, and leaves the lower side open; of 1 it is zero, to within the smallest numbers."""
    result = log(Interval([0.0, 0.0, 2.0, -1.0, 1.0, np.inf], [1.0, np.inf, np.inf, 1.0, 1.0, np.inf]))
    assert result.low[[0, 1, 3]].tolist() == [-np.inf] * 3
    assert result.high[[1, 2, 5]].tolist() == [np.inf] * 3
    assert 0.69 < result.low[2] < np.log(2.0)
    assert 709.0 < result.low[5] < 709.79
    assert -1e-320 < result.low[4] < 0.0 < result.high[4] < 1e-320


@COUNTS
def test_arctangents_contain_the_exact_ones(count: int) -> None:
    """From a billionth of a billionth to its inverse, to 13 digits, with either sign."""
    rng = np.random.default_rng(3)
    x = np.concatenate(
        [
            signed_powers(rng, -12.0, 12.0, count),
            rng.uniform(-1e12, 1e12, count // 10),
            signed_powers(rng, -18.0, 18.0, count // 10),
            np.arange(1, 500) / 16.0,
            [-1.0, 2.0**0.5 - 1.0, 1e30],
        ]
    )
    result = arctan(Interval(x))
    for a, low, high in zip(x.tolist(), result.low.tolist(), result.high.tolist(), strict=True):
        exact = exact_arctan(a)
        (n, d), (m, c) = low.as_integer_ratio(), high.as_integer_ratio()
        assert n * ONE < (exact - SLACK) * d, a
        assert m * ONE > (exact + SLACK) * c, a
    assert relative_width(result).max() < 2e-14


def test_arctangents_at_the_ends_of_the_numbers() -> None:
    """Of tiny numbers they are nearly these; of large and infinite ones, a right angle is inside."""
    tiny = np.array([0.0, SMALLEST, 1e-310, 1e-300, 1e-100, 1e-20])
    for sign in (1.0, -1.0):
        result = arctan(Interval(sign * tiny))
        assert np.all((result.low < sign * tiny) & (sign * tiny < result.high))
        assert np.all(result.high - result.low <= 1e-320 + 1e-14 * tiny)
        large = arctan(Interval(sign * np.array([1e17, 1e149, 1e151, LARGEST, np.inf]))).ends
        right, above = np.sort(sign * np.array([np.pi / 2, np.nextafter(np.pi / 2, 2.0)]))
        assert np.all((large[0] <= right) & (above <= large[1]) & (large[1] - large[0] < 2e-14))


@pytest.mark.parametrize("function", [exp, log, arctan])
def test_of_what_is_no_number_nothing_is_known(function: Callable[[Interval], Interval]) -> None:
    """An end that is not a number leaves both sides open, and its neighbours as they are."""
    result = function(Interval([np.nan, 1.0, np.nan, 1.0], [1.0, np.nan, np.nan, 2.0]))
    assert result.low[:3].tolist() == [0.0 if function is exp else -np.inf] * 3
    assert result.high[:3].tolist() == [np.inf] * 3
    assert np.isfinite([result.low[3], result.high[3]]).all()


@pytest.mark.parametrize("function", [exp, log, arctan])
def test_any_shape(function: Callable[[Interval], Interval]) -> None:
    """Results have the arguments' shape and do not depend on the neighbours."""
    x = np.random.default_rng(4).uniform(0.1, 3.0, (3, 4, 5))
    whole = function(Interval(x, x + 1.0))
    assert whole.low.shape == whole.high.shape == x.shape
    single = function(Interval(x[1, 2, 3], x[1, 2, 3] + 1.0))
    assert single.low.shape == ()
    assert (single.low, single.high) == (whole.low[1, 2, 3], whole.high[1, 2, 3])
    assert function(Interval(x[:0])).low.shape == (0, 4, 5)


ends = st.lists(st.floats(allow_nan=False), min_size=4, max_size=4).map(sorted)


@pytest.mark.parametrize("function", [exp, log, arctan])
@given(numbers=ends)
def test_a_part_has_its_values_among_those_of_the_whole(
    function: Callable[[Interval], Interval], numbers: list[float]
) -> None:
    """Wider intervals have wider results; ends that are closer than the tightness may cross by as much."""
    a, b, c, d = numbers if function is not log else sorted(map(abs, numbers))
    outer, inner = function(Interval(a, d)), function(Interval(b, c))
    assert outer.low <= inner.high
    assert inner.low <= outer.high
    low, high = function(Interval(a)), function(Interval(d))
    assert (outer.low, outer.high) == (low.low, high.high)
    assert inner.low >= outer.low - 1e-13 * abs(outer.low) - 1e-320
    assert inner.high <= outer.high + 1e-13 * abs(outer.high) + 1e-320


def test_members_of_wide_intervals_have_their_values_inside() -> None:
    """Whatever is between the ends has its value between the bounds."""
    rng = np.random.default_rng(5)
    a, x, b = np.sort(rng.uniform(1e-3, 700.0, (3, 1000)), axis=0)
    with localcontext(prec=40):
        assert_decimals_inside(exp(Interval(a, b)), Decimal.exp, x)
        assert_decimals_inside(exp(Interval(-b, -a)), Decimal.exp, -x)
        assert_decimals_inside(log(Interval(a, b)), Decimal.ln, x)
    result = arctan(Interval(a, b))
    assert np.all((result.low < np.arctan(x)) & (np.arctan(x) < result.high))


def test_the_two_parts_of_ln_2() -> None:
    """Ln 2 is the sum of 1 / (k 2ᵏ), of which the terms after the n-th are together less than the n-th."""
    partial = sum((Fraction(1, k << k) for k in range(1, 101)), Fraction(0))
    high, low = Fraction(elementary.LN2_HIGH), elementary.LN2_LOW
    assert high + Fraction(float(low.low)) < partial
    assert partial + Fraction(1, 100 << 100) < high + Fraction(float(low.high))
    assert (high * 2**32).denominator == 1
    assert high < 1


def test_what_the_series_leave_out() -> None:
    """It is below half a unit in the last place of 1, and the series are known to eight times as much."""
    e, t = Fraction(36, 100), Fraction(173, 1000)
    n, m = len(elementary._EXP), len(elementary._ARCTAN)
    assert e**n / factorial(n + 1) / (1 - e / (n + 2)) < UNIT
    assert t**m / (2 * m + 1) < UNIT
    x = np.concatenate([[-0.36, 0.36], np.random.default_rng(6).uniform(-0.36, 0.36, 300)])
    for coefficients, denominators, least in (
        (elementary._EXP, [factorial(j + 1) for j in range(n)], -0.36),
        (elementary._ARCTAN, [2 * j + 1 for j in range(m)], -0.173),
    ):
        points = x[x >= least]
        result = elementary._series(coefficients, points)
        for at, low, high in zip(points, result.low, result.high, strict=True):
            exact = sum(Fraction(float(at)) ** j / q for j, q in enumerate(denominators))
            middle = (Fraction(float(low)) + Fraction(float(high))) / 2
            assert abs(middle - exact) < 6 * UNIT
            assert Fraction(float(low)) <= exact - 2 * UNIT
            assert exact + 2 * UNIT <= Fraction(float(high))


def test_the_functions_increase_in_their_enclosures() -> None:
    """Along a row of numbers that are well apart, bounds increase."""
    x = np.linspace(0.01, 50.0, 2000)
    for result in (exp(Interval(x)), log(Interval(x)), arctan(Interval(x))):
        for end in result.ends:
            assert all(a < b for a, b in pairwise(end.tolist()))


def signed_powers(rng: np.random.Generator, low: float, high: float, count: int) -> np.ndarray:
    """Return numbers of either sign, of which the decimal logarithms are spread evenly."""
    return rng.choice([-1.0, 1.0], count) * 10.0 ** rng.uniform(low, high, count)
