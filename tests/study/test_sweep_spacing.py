"""The values of a sweep: both ends exact, evenly spaced, and every fault of a range at once."""

import itertools
import math

import pytest
from hypothesis import given, strategies as st

from nullpose.errors import UsageError
from nullpose.study import spaced

POSITIVE = st.floats(1e-6, 1e6)


@given(start=POSITIVE, stop=POSITIVE, points=st.integers(2, 50), log=st.booleans())
def test_ends_are_exact_and_the_order_is_kept(start: float, stop: float, points: int, log: bool) -> None:
    """First and last value are those given, and the rest lies between them in order."""
    if start == stop:
        return
    values = spaced(start, stop, points, log=log)
    assert (values[0], values[-1], len(values)) == (start, stop, points)
    assert list(values) == sorted(values, reverse=start > stop)


def test_linear_values_have_a_constant_difference() -> None:
    """Linear spacing."""
    assert spaced(-1.0, 1.0, 5) == (-1.0, -0.5, 0.0, 0.5, 1.0)


def test_logarithmic_values_have_a_constant_ratio() -> None:
    """Logarithmic spacing, decades landing on round numbers."""
    values = spaced(1e-3, 1e6, 37, log=True)
    assert values[4::4] == (0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
    ratios = [later / earlier for earlier, later in itertools.pairwise(values)]
    assert ratios == pytest.approx([10.0**0.25] * 36, rel=1e-9)


@pytest.mark.parametrize(
    ("start", "stop", "points", "log", "words"),
    [
        (math.nan, math.inf, 1, False, ["3 faults", "from: nan", "to: inf", "points: 1"]),
        (0.0, -2.0, 5, True, ["2 faults", "from: 0", "to: -2", "above 0"]),
        (3.0, 3.0, 5, False, ["1 fault", "to: 3", "two different ends"]),
        (1.0, 2.0, -4, False, ["points: -4", "at least 2"]),
    ],
)
def test_bad_ranges(start: float, stop: float, points: int, log: bool, words: list[str]) -> None:
    """Everything wrong with a range is told at once."""
    with pytest.raises(UsageError) as caught:
        spaced(start, stop, points, log=log)
    assert [word for word in words if word not in str(caught.value)] == []
