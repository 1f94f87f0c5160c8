"""Colours and scales."""

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose.studio.colours import linear_colours, scale_colours, scale_range


def test_brightness_grows_along_the_scale() -> None:
    """A larger value is never darker, so that the scale reads without colour vision too."""
    colours = scale_colours(np.linspace(-5.0, 5.0, 200), -4.0, 4.0).astype(float)
    brightness = colours @ np.array([0.2126, 0.7152, 0.0722])
    assert np.all(np.diff(brightness) >= -1.5)
    assert brightness[-1] > brightness[0] + 100.0


@seed(0)
@given(values=st.lists(st.floats(-80.0, 80.0), min_size=1, max_size=30))
def test_a_scale_spans_a_readable_range(values: list[float]) -> None:
    """Its ends are whole numbers 6 to 30 apart, with the largest value inside."""
    low, high = scale_range([*values, np.nan, -np.inf])
    assert low == round(low)
    assert high == round(high)
    assert 6.0 <= high - low <= 30.0
    assert low <= max(values) <= high


@seed(0)
@given(values=st.lists(st.floats(-1.0, 12.0), min_size=1, max_size=30))
def test_a_scale_of_rates_shows_small_differences(values: list[float]) -> None:
    """Its ends are tenths of a bit/s/Hz about the largest value, and no further apart than they must be."""
    low, high = scale_range(values, is_rate=True)
    assert 0.5 - 1e-9 <= high - low <= max(0.5, max(values) - min(values) + 0.2) + 1e-9
    assert low - 1e-9 <= max(values) <= high + 1e-9
    assert [10.0 * low, 10.0 * high] == pytest.approx([round(10.0 * low), round(10.0 * high)], abs=1e-9)


def test_nothing_finite_has_a_scale_too() -> None:
    """Without a single value the scale is still one."""
    assert scale_range([np.nan])[0] < scale_range([np.nan])[1]


def test_one_value_has_one_colour() -> None:
    """A number alone gives the three parts of its colour; what is beyond an end has that end's."""
    assert scale_colours(0.5, 0.0, 1.0).shape == (3,)
    assert (
        scale_colours([-np.inf, np.inf, 1e300], 0.0, 1.0).tolist() == scale_colours([0, 1, 1], 0, 1).tolist()
    )


def test_a_link_has_the_colour_of_the_scale() -> None:
    """A colour in linear light, shown as a screen shows light, is that of the scale but for rounding."""
    scale = scale_colours(np.linspace(0.0, 1.0, 50), 0.0, 1.0)
    light = linear_colours(scale) / 255.0
    shown = 255.0 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)
    assert np.max(np.abs(shown - scale)) <= 7.0  # dark parts have few steps of linear light
    bright = scale >= 60
    assert np.max(np.abs(shown - scale)[bright]) <= 2.0
    assert linear_colours([0, 255, 128]).tolist() == [0, 255, 55]
