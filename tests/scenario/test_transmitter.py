"""The drone's own power."""

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Transmitter


def test_power_in_either_unit() -> None:
    """30 dBm is 1 W."""
    assert Transmitter(power_w=2.0).transmit_power_w == 2.0
    assert Transmitter(power_dbm=30.0).transmit_power_w == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "neither power_w nor power_dbm"),
        ({"power_w": 1.0, "power_dbm": 30.0}, "both power_w and power_dbm"),
        ({"power_w": 0.0}, "a power is never zero or negative"),
    ],
)
def test_faults(values: dict[str, float], words: str) -> None:
    """One power, in one unit."""
    with pytest.raises(ScenarioError, match=words):
        Transmitter.from_dict(values)
