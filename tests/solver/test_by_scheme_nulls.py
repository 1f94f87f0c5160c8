"""Where whips at jammers keep a proof from closing, the answer says why and which line helps."""

from collections.abc import Callable

import pytest

import nullpose
from nullpose.scenario import Scenario


@pytest.fixture(scope="module")
def farm() -> Callable[..., Scenario]:
    """Returns a builder: three whips, an isotropic jammer, and one with a whip, whose keys may be changed."""
    whip = {"antenna": "dipole"}

    def build(**jammer: object) -> Scenario:
        places = [(0, 0, 1.5), (250, 50, 1.5), (100, 250, 1.5)]
        return Scenario.from_dict(
            {
                "nodes": [{"position_m": at, "power_dbm": 14} | whip for at in places],
                "jammers": [
                    {"position_m": [80, 110, 2], "power_dbm": 27},
                    {"position_m": [300, 220, 5], "power_dbm": 24} | whip | jammer,
                ],
                "airspace": {"altitude_m": [20, 100], "x_m": [-50, 450], "y_m": [-50, 350]},
                "receiver": {"noise_dbm": -100, "frequency_hz": 868e6},
            }
        )

    return build


def test_a_whip_that_keeps_the_gap_wide_is_named(farm: Callable) -> None:
    """The note has the jammer's place in the file, the key that helps, and the robust pose."""
    result = nullpose.solve(farm(), node_limit=300)
    assert result.objective.relative_gap > 1.0
    for words in ("jammers[1]", "null_depth_db = 20", "--robust"):
        assert words in result.note
    assert "jammers[0]" not in result.note


def test_without_a_perfect_null_nothing_is_said(farm: Callable) -> None:
    """A whip with a null of 20 dB, or none, is not the cause, whatever ends the proof."""
    for jammer in ({"null_depth_db": 20.0}, {"antenna": "isotropic"}):
        result = nullpose.solve(farm(**jammer), node_limit=20)
        assert result.reason
        assert result.note == ""
