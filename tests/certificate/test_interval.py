"""Interval arithmetic: what is computed contains the exact result, whatever the numbers."""

import operator
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.certificate.interval import Interval, _down, _up, dot

SPECIAL = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    -5e-324,
    2.2250738585072014e-308,
    1e-200,
    1e200,
    1.7976931348623157e308,
]

numbers = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(-100.0, 100.0, allow_nan=False),
    st.sampled_from(SPECIAL),
)
pairs = st.tuples(numbers, numbers).map(sorted)


def holds(interval: Interval, exact: Fraction) -> bool:
    """Return whether an interval of one number contains an exact one."""
    return bool(float(interval.low) <= exact <= float(interval.high))


def members(pair: list[float]) -> list[Fraction]:
    """Return the ends of a pair and some numbers between them, exactly."""
    low, high = map(Fraction, pair)
    return [low + (high - low) * share for share in (0, Fraction(1, 7), Fraction(1, 2), 1)]


@given(a=pairs, b=pairs)
@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul])
def test_sums_and_products_contain_the_exact_ones(
    operation: Callable, a: list[float], b: list[float]
) -> None:
    """Members of two intervals have their sum, difference and product in the result."""
    with np.errstate(all="ignore"):
        result = operation(Interval(*a), Interval(*b))
        for x in members(a):
            for y in members(b):
                assert holds(result, operation(x, y))
        for x in members(a):
            assert holds(operation(Interval(*a), b[0]), operation(x, Fraction(b[0])))
            assert holds(operation(b[0], Interval(*a)), operation(Fraction(b[0]), x))


@given(a=pairs, b=pairs)
def test_quotients_contain_the_exact_ones(a: list[float], b: list[float]) -> None:
    """Members of two intervals have their quotient in the result; by what may be zero, it is unbounded."""
    with np.errstate(all="ignore"):
        result = Interval(*a) / Interval(*b)
        for x in members(a):
            for y in members(b):
                assert y == 0 or holds(result, x / y)
        if b[0] <= 0.0 <= b[1]:
            assert not np.isfinite(result.low)
            assert not np.isfinite(result.high)
        if b[0] > 0.0:
            assert holds(a[0] / Interval(*b), Fraction(a[0]) / Fraction(b[1]))


@given(a=pairs)
def test_squares_and_roots_contain_the_exact_ones(a: list[float]) -> None:
    """Squares are never below zero, also across zero; the ends of a root, squared, enclose the number."""
    with np.errstate(all="ignore"):
        square = Interval(*a).squared()
        assert square.low >= 0.0
        for x in members(a):
            assert holds(square, x * x)
            assert holds(-Interval(*a), -x)
            assert abs(x) <= float(Interval(*a).magnitude())
        root = Interval(*a).sqrt()
        for x in members(a):
            if x >= 0:
                assert root.low >= 0.0
                assert Fraction(float(root.low)) ** 2 <= x <= Fraction(float(root.high)) ** 2


@given(a=pairs)
def test_the_middle_is_inside_and_the_radius_reaches_both_ends(a: list[float]) -> None:
    """The radius, from the middle, covers the whole interval."""
    with np.errstate(all="ignore"):
        middle, radius = float(Interval(*a).middle()), float(Interval(*a).radius())
    assert a[0] <= middle <= a[1]
    assert Fraction(a[1]) - Fraction(middle) <= radius
    assert Fraction(middle) - Fraction(a[0]) <= radius


@given(rows=st.lists(st.tuples(numbers, numbers), min_size=1, max_size=6))
def test_inner_products_contain_the_exact_ones(rows: list[tuple[float, float]]) -> None:
    """Sums over the first axis and inner products hold the exact values, unless they overflow to unknown."""
    x, y = (np.array(column) for column in zip(*rows, strict=True))
    with np.errstate(all="ignore"):
        for result, exact in (
            (Interval(x).total(), sum(map(Fraction, x), Fraction(0))),
            (dot(Interval(x), y), sum((Fraction(p) * Fraction(q) for p, q in rows), Fraction(0))),
        ):
            assert np.isnan(result.low) or float(result.low) <= exact
            assert np.isnan(result.high) or exact <= float(result.high)


expressions = st.recursive(
    numbers.map(lambda x: (Interval(x), Fraction(x))),
    lambda inner: st.tuples(st.sampled_from("+-*/"), inner, inner).map(lambda parts: combined(*parts)),
    max_leaves=12,
)

OPERATIONS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}


def combined(
    sign: str, a: tuple[Interval, Fraction], b: tuple[Interval, Fraction]
) -> tuple[Interval, Fraction]:
    """Return an operation of two numbers, in intervals and exactly; a division by zero is left out."""
    if sign == "/" and b[1] == 0:
        return a
    with np.errstate(all="ignore"):
        return OPERATIONS[sign](a[0], b[0]), OPERATIONS[sign](a[1], b[1])


@given(value=expressions)
def test_whole_expressions_contain_the_exact_values(value: tuple[Interval, Fraction]) -> None:
    """Errors do not get lost over several operations; an undefined end claims nothing."""
    interval, exact = value
    assert np.isnan(interval.low) or float(interval.low) <= exact
    assert np.isnan(interval.high) or exact <= float(interval.high)


def test_results_stay_tight() -> None:
    """One operation widens by a few units in the last place, no more."""
    rng = np.random.default_rng(0)
    x, y = rng.uniform(1.0, 2.0, 100), rng.uniform(1.0, 2.0, 100)
    for result in (
        Interval(x) + y,
        Interval(x) * y,
        Interval(x) / y,
        Interval(x).sqrt(),
        Interval(x).squared(),
    ):
        assert np.all(result.high - result.low <= 4e-15)


@given(
    x=st.one_of(numbers, st.floats(allow_nan=False)), step=st.integers(-2, 2), power=st.integers(-1074, 1023)
)
def test_rounding_goes_to_the_next_numbers_at_least(x: float, step: int, power: int) -> None:
    """Beside powers of two and zero, too, where the distance of numbers changes; and by no more than two."""
    edge = np.ldexp(1.0, power)
    beside = edge * (1.0 + step * 2.0**-53)
    with np.errstate(over="ignore", under="ignore"):
        for number in np.array([x, beside, -beside]):
            below, above = np.nextafter(number, -np.inf), np.nextafter(number, np.inf)
            assert np.nextafter(below, -np.inf) <= _down(number) <= below
            assert np.nextafter(above, np.inf) >= _up(number) >= above
