"""A power law of the distance."""

import numpy as np
import pytest

from nullpose.channel import PointChannels, excess_gain
from nullpose.channel.model import CONSTANT
from nullpose.channel.power_law import power_law


@pytest.mark.parametrize("exponent", [1.6, 2.0, 2.7, 6.0])
def test_gain_at_the_reference_distance(exponent: float) -> None:
    """It is 1 there whatever the exponent, and falls by 10 times the exponent in dB for each decade."""
    links = PointChannels.of([power_law(exponent, 5.0)])
    for decades in (0, 1, 2):
        away = np.array([[3.0, 0.0, -4.0]]) * 10.0**decades
        gain = float(excess_gain(links, away)[0]) / float(np.sum(away**2))
        assert gain == pytest.approx(10.0 ** (-exponent * decades), rel=1e-12)


def test_free_space_is_a_power_law() -> None:
    """An exponent of 2 asks for nothing of the position, so that nothing is lost to rounding."""
    channel = power_law(2.0, 3.0)
    assert (channel.row[0], channel.strength) == (CONSTANT, 9.0)
