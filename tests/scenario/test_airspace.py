"""The airspace's box."""

import numpy as np
import pytest

from nullpose.scenario import Airspace


def test_unbounded_sides_are_infinite() -> None:
    """Without x_m and y_m the box is a slab; the keep-out radius is 1 m unless stated."""
    airspace = Airspace(altitude_m=(8.0, 30.0))
    np.testing.assert_array_equal(airspace.lower_m, [-np.inf, -np.inf, 8.0])
    np.testing.assert_array_equal(airspace.upper_m, [np.inf, np.inf, 30.0])
    assert airspace.keep_out_m == 1.0


def test_bounded_sides() -> None:
    """The corners are in the order x, y, z and cannot be written to."""
    airspace = Airspace(altitude_m=[8, 30], x_m=[-1, 2], y_m=[-3, 4], keep_out_m=2)
    np.testing.assert_array_equal(airspace.lower_m, [-1.0, -3.0, 8.0])
    np.testing.assert_array_equal(airspace.upper_m, [2.0, 4.0, 30.0])
    with pytest.raises(ValueError, match="read-only"):
        airspace.lower_m[0] = 0.0


def test_a_fixed_value_is_a_range() -> None:
    """Equal ends are allowed in every direction."""
    airspace = Airspace(altitude_m=(20.0, 20.0), x_m=(1.0, 1.0), y_m=(2.0, 2.0))
    np.testing.assert_array_equal(airspace.lower_m, airspace.upper_m)
