"""Decibels of power ratios."""

import math

import pytest
from hypothesis import example, given, strategies as st

from nullpose.physics import from_db, to_db


@example(-30.0)
@example(120.0)
@given(st.floats(-300.0, 300.0))
def test_ten_decibels_are_a_factor_of_ten(ratio_db: float) -> None:
    """Both ways; a ratio of zero is minus infinity, without a warning."""
    assert from_db(ratio_db) == pytest.approx(10.0 ** (ratio_db / 10.0), rel=1e-13)
    assert to_db(from_db(ratio_db)) == pytest.approx(ratio_db, abs=1e-12)
    assert (to_db(0.0), from_db(-math.inf)) == (-math.inf, 0.0)
