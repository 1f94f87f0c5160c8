"""Decibels of power ratios."""

import math

import pytest
from hypothesis import given, strategies as st

from nullpose.physics import from_db, to_db


@pytest.mark.parametrize(("ratio", "ratio_db"), [(1.0, 0.0), (10.0, 10.0), (1e-3, -30.0), (1e12, 120.0)])
def test_powers_of_ten(ratio: float, ratio_db: float) -> None:
    """A factor of ten in power is ten decibels, both ways."""
    assert to_db(ratio) == pytest.approx(ratio_db, abs=1e-13)
    assert from_db(ratio_db) == pytest.approx(ratio, rel=1e-14)


@given(st.floats(-300.0, 300.0))
def test_round_trip(ratio_db: float) -> None:
    """Decibels to a ratio and back change nothing."""
    assert to_db(from_db(ratio_db)) == pytest.approx(ratio_db, abs=1e-12)


def test_zero_is_minus_infinity() -> None:
    """A ratio of zero is minus infinity, without a warning."""
    assert to_db(0.0) == -math.inf
    assert from_db(-math.inf) == 0.0
