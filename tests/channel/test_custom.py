"""Channels that are functions in Python: what their bounds promise."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.channel import Custom
from nullpose.channel.convex import FloatArray
from nullpose.errors import UsageError


def _two_slopes(distance_m: FloatArray, elevation_rad: FloatArray, azimuth_rad: FloatArray) -> FloatArray:
    steep = np.minimum(distance_m**-2.0, 80.0**1.5 * distance_m**-3.5)
    return np.asarray(steep * 10.0 ** (0.05 * np.degrees(elevation_rad) * np.sin(azimuth_rad) ** 2))


BOUNDED = Custom(gain=_two_slopes, exponents=(2.0, 3.5), db_per_deg=0.5, azimuth_db_per_deg=0.8)
# by its elevation alone, and by no less than is stated
RISING = Custom(
    gain=lambda d, e, a: d**-2.0 * 10.0 ** (0.05 * np.degrees(e)), exponents=(2.0, 2.0), db_per_deg=0.5
)
sides = st.floats(0.01, 200.0)
places = st.tuples(st.floats(-300.0, 300.0), st.floats(-300.0, 300.0), st.floats(0.0, 200.0))


@pytest.mark.parametrize("channel", [BOUNDED, RISING])
@given(centre_m=places, half_m=st.tuples(sides, sides, st.floats(0.01, 50.0)), seed=st.integers(0, 99))
def test_the_range_over_a_box_contains_the_gain_at_its_positions(
    channel: Custom, centre_m: tuple[float, ...], half_m: tuple[float, ...], seed: int
) -> None:
    """Whatever the box, no position in it has another excess gain."""
    middle_m = np.add(centre_m, (0.0, 0.0, half_m[2] + 1.0))
    low, high = channel.excess_range(np.zeros(3), middle_m, np.array(half_m), 1.0)
    positions_m = middle_m + np.array(half_m) * np.random.default_rng(seed).uniform(-1.0, 1.0, (50, 3))
    east, north, up = positions_m.T
    distance_m = np.linalg.norm(positions_m, axis=1)
    excess = channel.excess((), distance_m, np.arctan2(up, np.hypot(east, north)), np.arctan2(east, north))
    assert np.all((low * (1.0 - 1e-12) <= excess) & (excess <= high * (1.0 + 1e-12)))


@given(gain=st.floats(1e-9, 1e-3))
def test_no_link_beyond_the_reach_has_the_gain(gain: float) -> None:
    """Farther away than the reach every link is weaker."""
    reach_m = BOUNDED.reach_m(gain, 1.0)
    angles = np.random.default_rng(0).uniform(0.0, [[0.5 * math.pi], [2.0 * math.pi]], (2, 500))
    assert np.all(BOUNDED.gain(np.array(1.0001 * reach_m), *angles) <= gain)


@pytest.mark.parametrize(
    "stated",
    [
        {"exponents": (2.0, 3.0), "db_per_deg": 0.5, "azimuth_db_per_deg": 0.8},
        {"exponents": (2.0, 3.5), "db_per_deg": 0.1, "azimuth_db_per_deg": 0.8},
        {"exponents": (2.0, 3.5), "db_per_deg": 0.5},
    ],
)
def test_bounds_that_the_gain_contradicts_are_refused(stated: dict[str, Any]) -> None:
    """The message names the channel and what to try."""
    with pytest.raises(UsageError, match=r"street: the gain contradicts .* wider exponents"):
        Custom(gain=_two_slopes, name="street", **stated)


@pytest.mark.parametrize("gain", [lambda d, e, a: -d, lambda d, e, a: np.ones(3), lambda d, e, a: 0.0 * d])
def test_a_gain_that_is_not_a_positive_number_for_each_link_is_refused(gain: Callable[..., Any]) -> None:
    """So the physics never meets one."""
    with pytest.raises(UsageError, match="positive number for each link"):
        Custom(gain=gain)
