"""Noise and reference gain, however they are stated."""

import math

import pytest
from hypothesis import given, strategies as st

from nullpose.errors import ScenarioError
from nullpose.scenario import Receiver


def test_noise_in_either_unit() -> None:
    """Noise may be stated in W or in dBm."""
    assert Receiver(noise_w=2e-3, reference_gain_db=0.0).noise_power_w == 2e-3
    assert Receiver(noise_dbm=-90.0, reference_gain_db=0.0).noise_power_w == pytest.approx(1e-12, rel=1e-14)


def test_gain_in_decibels() -> None:
    """A reference gain in dB is a ratio of powers."""
    assert Receiver(noise_w=1.0, reference_gain_db=-20.0).reference_gain == pytest.approx(0.01, rel=1e-15)


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


def test_both_pairs_are_judged() -> None:
    """A receiver that states nothing has two faults."""
    with pytest.raises(ScenarioError) as caught:
        Receiver()
    assert [fault.message.split(",")[0] for fault in caught.value.faults] == [
        "neither noise_w nor noise_dbm is given",
        "neither reference_gain_db nor frequency_hz is given",
    ]
