"""Quantities: what they accept, and conversions of units."""

import pytest
from hypothesis import given, strategies as st
from pydantic_core import PydanticCustomError

from nullpose.scenario.units import Quantity, ratio_from_db, watts_from_dbm

LENGTH = Quantity("a length in m", -10.0, 10.0, "stay near")


def test_known_conversions() -> None:
    """0 dBm is 1 mW and 30 dBm is 1 W; 10 dB is a factor of ten."""
    assert watts_from_dbm(0.0) == pytest.approx(1e-3, rel=1e-15)
    assert watts_from_dbm(30.0) == 1.0
    assert watts_from_dbm(-97.0) == pytest.approx(1.9952623149688828e-13, rel=1e-14)
    assert ratio_from_db(10.0) == 10.0
    assert ratio_from_db(0.0) == 1.0
    assert ratio_from_db(-3.0) == pytest.approx(0.5011872336272722, rel=1e-14)


@given(st.one_of(st.floats().filter(lambda value: not -10.0 <= value <= 10.0), st.integers(min_value=11)))
def test_numbers_outside_the_limits_are_refused(value: float) -> None:
    """Any number beyond the limits, infinite or NaN is refused with the limits and the hint."""
    with pytest.raises(PydanticCustomError, match=r"must be a length in m from -10 to 10 \(stay near\)"):
        LENGTH.read(value)


@given(
    st.one_of(
        st.none(),
        st.booleans(),
        st.text(max_size=9),
        st.lists(st.floats(), max_size=3),
        st.dictionaries(st.text(), st.none()),
    )
)
def test_anything_else_is_no_number(value: object) -> None:
    """Truth values, texts, lists and tables are refused as no numbers."""
    with pytest.raises(PydanticCustomError, match="must be a number: a length in m from -10 to 10"):
        LENGTH.read(value)
