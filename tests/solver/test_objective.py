"""Rates in Mbit/s: the value and the bound, where a bandwidth is stated."""

from typing import Any

import pytest

import nullpose
from nullpose import Scenario

FIELD: dict[str, Any] = {
    "airspace": {"altitude_m": [8.0, 30.0]},
    "receiver": {"bandwidth_hz": 20e6, "noise_figure_db": 6.0, "reference_gain_db": -80.0},
    "nodes": [
        {"name": "S1", "position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
        {"name": "S2", "position_m": [0.0, 50.0, 0.0], "power_w": 1.0},
    ],
    "jammers": [{"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0}],
}
SECRET = FIELD | {
    "objective": "secrecy-rate",
    "transmitter": {"power_w": 1.0},
    "nodes": [{"name": "S1", "position_m": [0.0, 0.0, 0.0]}, {"name": "S2", "position_m": [0.0, 50.0, 0.0]}],
    "jammers": [],
    "eavesdroppers": [{"name": "E", "position_m": [17.0, 15.0, 4.0]}],
}


@pytest.mark.parametrize("table", [FIELD | {"objective": "sum-rate"}, SECRET])
def test_a_rate_has_its_mbit_beside_it(table: dict[str, Any]) -> None:
    """The value and the bound, in Python and as plain data: so many bits a second for each hertz."""
    result = nullpose.solve(Scenario.from_dict(table), gap=1e-2)
    objective, plain = result.objective, result.to_dict()["objective"]
    assert result.status == "certified"
    assert objective.value_mbps == pytest.approx(20.0 * objective.value, rel=1e-12)
    assert objective.upper_bound_mbps == pytest.approx(20.0 * objective.upper_bound, rel=1e-12)
    assert [plain["value_mbps"], plain["upper_bound_mbps"]] == [
        objective.value_mbps,
        objective.upper_bound_mbps,
    ]
    searched = nullpose.solve(Scenario.from_dict(table), certify=False).objective
    assert (searched.value_mbps or 0.0) > 0.0
    assert searched.upper_bound_mbps is None


@pytest.mark.parametrize(
    "change", [{"objective": "min-sinr"}, {"receiver": {"noise_w": 1e-12, "frequency_hz": 2.4e9}}]
)
def test_what_is_no_rate_or_has_no_bandwidth_has_none(change: dict[str, Any]) -> None:
    """Then there are no keys either."""
    scenario = Scenario.from_dict(FIELD | {"objective": "sum-rate"} | change)
    objective = nullpose.solve(scenario, certify=False).objective
    assert (objective.value_mbps, objective.upper_bound_mbps) == (None, None)
    assert "value_mbps" not in objective.to_dict()


@pytest.mark.parametrize(
    ("own", "bandwidth_hz"),
    [
        ({}, 20e6),
        ({"bandwidth_hz": 20e6, "noise_figure_db": 3.0}, 20e6),
        ({"bandwidth_hz": 10e6, "noise_figure_db": 6.0}, None),
        ({"noise_dbm": -95.0}, None),
    ],
)
def test_all_who_receive_must_have_one_bandwidth(own: dict[str, Any], bandwidth_hz: float | None) -> None:
    """Of a secrecy rate the nodes and the eavesdroppers: with several no rate per hertz is one of bits."""
    for kind in ("nodes", "eavesdroppers"):
        table = SECRET | {kind: [*SECRET[kind][:-1], SECRET[kind][-1] | own]}
        assert Scenario.from_dict(table).rate_bandwidth_hz == bandwidth_hz
    assert Scenario.from_dict(FIELD | {"objective": "sum-rate"}).rate_bandwidth_hz == 20e6
