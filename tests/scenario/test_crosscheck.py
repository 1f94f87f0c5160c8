"""Keys that only one of the objectives reads."""

from typing import Any

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Eavesdropper, Node, Scenario, Transmitter

SINR: dict[str, Any] = {
    "airspace": {"altitude_m": [8.0, 30.0]},
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}],
}
SECRECY: dict[str, Any] = SINR | {
    "objective": "secrecy-rate",
    "transmitter": {"power_w": 1.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0]}],
    "eavesdroppers": [{"position_m": [17.0, 15.0, 4.0]}],
}


def faults_of(data: dict[str, Any]) -> dict[str, str]:
    """Returns the messages, by path, with which a scenario is refused."""
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_dict(data)
    assert len({fault.path for fault in caught.value.faults}) == len(caught.value.faults)
    return {fault.path: fault.message for fault in caught.value.faults}


@pytest.mark.parametrize(
    ("changes", "faults"),
    [
        ({"eavesdroppers": None}, {"eavesdroppers": "headed [[eavesdroppers]]; add it"}),
        (
            {"transmitter": None, "eavesdroppers": None},
            {"transmitter": "missing", "eavesdroppers": "missing"},
        ),
        (
            {"eavesdroppers": None, "eavesdropers": [{"position_m": [1, 2, 3]}]},
            {"eavesdropers": 'did you mean "eavesdroppers"?'},
        ),
        (
            {"nodes": [{"position_m": [0, 0, 0], "weight": 2}, {"position_m": [9, 0, 0], "min_sinr_db": 2}]},
            {
                "nodes[0].weight": "has no meaning with",
                "nodes[1].min_sinr_db": 'write objective = "min-sinr"',
            },
        ),
        (
            {"nodes": [{"position_m": [0, 0, 0], "noise_w": 1, "jamming_w": 1, "jamming_dbm": 1}]},
            {"nodes[0]": "both jamming_w and jamming_dbm are given, at most one"},
        ),
        (
            {"eavesdroppers": [{"position_m": [1, 2, 3], "power_w": 1}]},
            {"eavesdroppers[0].power_w": "unknown key"},
        ),
        (
            {"eavesdroppers": [{"position_m": [1, 2, 3], "noise_w": 1, "noise_dbm": 1}]},
            {"eavesdroppers[0]": "both noise_w and noise_dbm are given, at most one"},
        ),
        (
            {"eavesdroppers": [{"position_m": [0, 0, 0]}]},
            {"eavesdroppers[0].position_m": "nodes and eavesdroppers must be at different places"},
        ),
        (
            {"eavesdroppers": [{"position_m": [1, 1, 1], "name": "S1"}]},
            {"eavesdroppers[0].name": "the name of nodes[0] already"},
        ),
        ({"objective": "secrecy"}, {"objective": 'did you mean "secrecy-rate"?'}),
        ({"objective": ["secrecy-rate"]}, {"objective": "a list of one value"}),
    ],
)
def test_secrecy(changes: dict[str, Any], faults: dict[str, str]) -> None:
    """With the secrecy rate, eavesdroppers and a transmitter are needed, and SINRs have no meaning."""
    data = {key: value for key, value in (SECRECY | changes).items() if value is not None}
    messages = faults_of(data)
    assert messages.keys() == faults.keys()
    for path, words in faults.items():
        assert words in messages[path]


@pytest.mark.parametrize(
    ("changes", "faults"),
    [
        (
            {"eavesdroppers": SECRECY["eavesdroppers"]},
            {"eavesdroppers": 'remove it, or write objective = "secrecy-rate"'},
        ),
        (
            {"eavesdroppers": (Eavesdropper(position_m=(1, 2, 3)),), "transmitter": Transmitter(power_w=1)},
            {"eavesdroppers": "no meaning", "transmitter": 'write objective = "secrecy-rate"'},
        ),
        (
            {"nodes": [{"position_m": [0, 0, 0], "power_w": 1, "noise_w": 1, "jamming_dbm": 1}]},
            {"nodes[0].noise_w": "no meaning", "nodes[0].jamming_dbm": "remove it"},
        ),
        (
            {"nodes": [Node(position_m=(0, 0, 0), noise_dbm=1.0)]},
            {"nodes[0]": "power_w or power_dbm", "nodes[0].noise_dbm": "no meaning"},
        ),
        (
            {"nodes": [{"position_m": [0, 0, 0], "power_w": 1, "weight": 1, "min_sinr_db": 1}]},
            {"nodes[0]": "both weight and min_sinr_db are given, at most one is allowed"},
        ),
        (
            {"nodes": [{"position_m": [0, 0, 0], "power_w": 1, "min_sinr_db": float("nan")}]},
            {"nodes[0].min_sinr_db": "got NaN, must be a ratio in dB"},
        ),
        ({"nodes": [{"position_m": [0, 0, 0]}]}, {"nodes[0]": "needs power_w or power_dbm; add it"}),
    ],
)
def test_sinr(changes: dict[str, Any], faults: dict[str, str]) -> None:
    """With the SINR, what belongs to the downlink has no place, and every node needs a power."""
    messages = faults_of(SINR | changes)
    assert messages.keys() == faults.keys()
    for path, words in faults.items():
        assert words in messages[path]


def test_a_jammer_may_listen() -> None:
    """A jammer and an eavesdropper may be one and the same, at one place."""
    jammer = {"position_m": [17.0, 15.0, 4.0], "power_w": 1.0}
    assert Scenario.from_dict(SECRECY | {"jammers": [jammer]}).jammer_names == ("M1",)


def test_an_unknown_objective_hides_no_other_fault() -> None:
    """With an objective that cannot be read, the rest of the file is judged all the same."""
    messages = faults_of(SECRECY | {"objective": "rate", "receiver": {"noise_w": -1, "reference_gain_db": 0}})
    assert messages.keys() == {"objective", "receiver.noise_w"}
