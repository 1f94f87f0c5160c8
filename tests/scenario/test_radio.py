"""Noise, gains and powers, however they are stated."""

import math

import pytest
from hypothesis import given, strategies as st

from nullpose.scenario import Node, Receiver


@given(st.floats(-270.0, 270.0))
def test_either_unit_of_a_power_is_in_watts(dbm: float) -> None:
    """0 dBm is 1 mW, and 10 dB are a factor of ten."""
    stated = [Node(position_m=(0, 0, 0), power_dbm=each).transmit_power_w for each in (0.0, dbm, dbm + 10.0)]
    assert stated[0] == pytest.approx(1e-3, rel=1e-15)
    assert stated[2] / stated[1] == pytest.approx(10.0, rel=1e-12)
    assert Node(position_m=(0, 0, 0), power_w=2).transmit_power_w == 2.0


@given(st.floats(1e3, 1e12))
def test_gain_from_a_frequency_is_friis(frequency_hz: float) -> None:
    """At 2.4 GHz the free-space gain at 1 m is -40.05 dB; ten times the frequency costs 20 dB."""
    gains = [Receiver(noise_w=1.0, frequency_hz=hz).reference_gain for hz in (2.4e9, frequency_hz)]
    assert 10.0 * math.log10(gains[0]) == pytest.approx(-40.0520, abs=5e-5)
    assert gains[0] / gains[1] == pytest.approx((frequency_hz / 2.4e9) ** 2, rel=1e-12)
