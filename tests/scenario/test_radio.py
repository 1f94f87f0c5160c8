"""Noise and reference gain, however they are stated."""

import math

import pytest
from hypothesis import given, strategies as st

from nullpose.scenario import Receiver


def test_gain_from_a_frequency_is_friis() -> None:
    """At 2.4 GHz the free-space gain at 1 m is -40.05 dB."""
    gain = Receiver(noise_w=1.0, frequency_hz=2.4e9).reference_gain
    assert 10.0 * math.log10(gain) == pytest.approx(-40.0520, abs=5e-5)


@given(st.floats(1e3, 1e12))
def test_gain_falls_with_the_square_of_frequency(frequency_hz: float) -> None:
    """Ten times the frequency costs 20 dB."""
    low = Receiver(noise_w=1.0, frequency_hz=frequency_hz).reference_gain
    high = Receiver(noise_w=1.0, frequency_hz=10.0 * frequency_hz).reference_gain
    assert low / high == pytest.approx(100.0, rel=1e-12)
