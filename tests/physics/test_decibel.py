"""Decibels of power ratios."""

import math

import numpy as np
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


@given(st.floats(1e-200, 1e200), st.floats(1e-100, 1e100))
def test_a_product_is_a_sum(ratio: float, factor: float) -> None:
    """Scaling a ratio adds the factor's decibels."""
    assert to_db(ratio * factor) == pytest.approx(float(to_db(ratio) + to_db(factor)), abs=1e-11)


def test_zero_is_minus_infinity() -> None:
    """A ratio of zero is minus infinity, without a warning."""
    assert to_db(0.0) == -math.inf
    assert from_db(-math.inf) == 0.0


def test_shapes_are_kept() -> None:
    """Any shape comes back as it was."""
    assert to_db(np.ones((2, 3, 4))).shape == (2, 3, 4)
    assert from_db([[1.0, 2.0]]).shape == (1, 2)
