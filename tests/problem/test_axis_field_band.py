"""Axis fields that hold a band of elevations."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.problem.axis_field import AxisField

SHARES = st.floats(0.0, 1.0)


@given(SHARES, SHARES)
def test_the_kind_tells_what_a_band_holds(one: float, other: float) -> None:
    """Kind 2 is a band, 3 a cone; all axes are kind 0 and the vertical one is an affine field."""
    least, greatest = sorted((one, other))
    field = AxisField.within(least, greatest)
    kind, ends = field.arrays.kind, field.arrays.offset
    if (least, greatest) == (0.0, 1.0):
        assert kind == 0
    elif least == 1.0:
        assert kind == 1
        np.testing.assert_array_equal(ends, [0.0, 0.0, 1.0])
    else:
        assert kind == (3 if least == greatest else 2)
        np.testing.assert_array_equal(ends, [least, greatest, 0.0])
        assert field.is_free
    ends[:] = 9.0  # a copy: the field itself does not change
    assert field.band == ((least, greatest) if field.is_free else (0.0, 1.0))
    assert not np.any(field.arrays.offset == 9.0)


def test_bands_at_their_ends() -> None:
    """The whole sphere is the free field, level axes are a cone, the upright one is the vertical field."""
    assert AxisField.within(0.0, 1.0).arrays.kind == AxisField.free().arrays.kind
    assert AxisField.within(0.0, 0.0).arrays.kind == 3
    for ours, theirs in zip(AxisField.within(1.0, 1.0).arrays, AxisField.vertical().arrays, strict=True):
        np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize(
    "band", [(0.5, 0.4), (-0.1, 0.5), (0.5, 1.1), (math.nan, 0.5), (0.5, math.nan), (math.inf, math.inf)]
)
def test_bands_that_hold_no_axis_are_refused(band: tuple[float, float]) -> None:
    """Ends out of order, out of range or no numbers are refused with what was given."""
    with pytest.raises(ValueError, match=r"band must be 0 <= low <= high <= 1; given \("):
        AxisField.within(*band)
