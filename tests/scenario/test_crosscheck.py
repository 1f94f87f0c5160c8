"""Keys that only one of the objectives reads."""

from typing import Any

import pytest

from nullpose.scenario import Eavesdropper, Node, Scenario, Transmitter
from scenes import faults_of, small

AT = {"position_m": [0.0, 0.0, 0.0]}
THERE = {"position_m": [17.0, 15.0, 4.0]}
SECRECY = small(objective="secrecy-rate", transmitter={"power_w": 1.0}, nodes=[AT], eavesdroppers=[THERE])
SECRECY_CASES: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({"eavesdroppers": None}, {"eavesdroppers": "headed [[eavesdroppers]]; add it"}),
    ({"transmitter": None}, {"transmitter": "missing"}),
    ({"eavesdroppers": None, "eavesdropers": [THERE]}, {"eavesdropers": 'did you mean "eavesdroppers"?'}),
    ({"nodes": [AT | {"weight": 2}]}, {"nodes[0].weight": "has no meaning with"}),
    ({"nodes": [AT | {"min_sinr_db": 2}]}, {"nodes[0].min_sinr_db": 'write objective = "min-sinr"'}),
    ({"nodes": [AT | {"jamming_w": 1, "jamming_dbm": 1}]}, {"nodes[0]": "both jamming_w and"}),
    ({"eavesdroppers": [THERE | {"power_w": 1}]}, {"eavesdroppers[0].power_w": "unknown key"}),
    ({"eavesdroppers": [THERE | {"noise_w": 1, "noise_dbm": 1}]}, {"eavesdroppers[0]": "at most one"}),
    ({"eavesdroppers": [AT]}, {"eavesdroppers[0].position_m": "must be at different places"}),
    ({"eavesdroppers": [THERE | {"name": "S1"}]}, {"eavesdroppers[0].name": "the name of nodes[0] already"}),
    ({"objective": "secrecy"}, {"objective": 'did you mean "secrecy-rate"?'}),
    ({"objective": ["secrecy-rate"]}, {"objective": "a list of one value"}),
]
SINR_CASES: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({"eavesdroppers": [THERE]}, {"eavesdroppers": 'remove it, or write objective = "secrecy-rate"'}),
    ({"eavesdroppers": (Eavesdropper(**THERE),)}, {"eavesdroppers": "no meaning"}),
    ({"transmitter": Transmitter(power_w=1)}, {"transmitter": 'write objective = "secrecy-rate"'}),
    ({"destination": THERE}, {"destination": 'remove it, or write objective = "relay"'}),
    ({"nodes": [AT | {"power_w": 1, "noise_w": 1}]}, {"nodes[0].noise_w": "no meaning"}),
    (
        {"nodes": [Node(**AT, noise_dbm=1.0)]},
        {"nodes[0]": "power_w or power_dbm", "nodes[0].noise_dbm": "no meaning"},
    ),
    ({"nodes": [AT | {"power_w": 1, "weight": 1, "min_sinr_db": 1}]}, {"nodes[0]": "both weight and min"}),
    ({"nodes": [AT]}, {"nodes[0]": "needs power_w or power_dbm; add it"}),
]

POWERED = AT | {"power_w": 1.0}
DOWNLINK = small(objective="downlink", transmitter={"power_w": 1.0}, nodes=[AT])
DOWNLINK_CASES: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({"transmitter": None}, {"transmitter": "a table headed [transmitter]; add it"}),
    ({"eavesdroppers": [THERE]}, {"eavesdroppers": 'write objective = "secrecy-rate"'}),
    ({"destination": THERE}, {"destination": 'remove it, or write objective = "relay"'}),
    ({"nodes": [AT | {"weight": 2.0, "noise_w": 1.0, "jamming_dbm": 3.0}]}, {}),
]
RELAY = DOWNLINK | {"objective": "relay", "nodes": [POWERED], "destination": THERE}
RELAY_CASES: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({"destination": None}, {"destination": "a table headed [destination]; add it"}),
    ({"transmitter": None}, {"transmitter": "a table headed [transmitter]; add it"}),
    ({"nodes": [AT]}, {"nodes[0]": "needs power_w or power_dbm; add it"}),
    ({"nodes": [POWERED | {"noise_w": 1.0}]}, {"nodes[0].noise_w": 'write objective = "secrecy-rate"'}),
    ({"destination": AT}, {"destination.position_m": "the place of nodes[0] already; nodes and destination"}),
    ({"destination": THERE | {"name": "S1"}}, {"destination.name": "the name of nodes[0] already"}),
    ({"destination": THERE | {"power_w": 1.0}}, {"destination.power_w": "unknown key"}),
    ({"destination": [THERE]}, {"destination": "must be a table headed [destination]"}),
    ({"destination": {"noise_w": 1.0}}, {"destination.position_m": "missing"}),
    ({"destination": THERE | {"noise_w": -1.0}}, {"destination.noise_w": "must be a power"}),
    ({"destination": THERE | {"weight": 1.0, "min_sinr_db": 1.0}}, {"destination": "both weight and min"}),
    ({"destinaton": THERE, "destination": None}, {"destinaton": 'did you mean "destination"?'}),
    ({"eavesdroppers": [AT]}, {"eavesdroppers": "no meaning", "eavesdroppers[0].position_m": "different"}),
    ({"destination": THERE | {"antenna": "profile"}}, {"destination.antenna_profile": "missing"}),
]
ROOM = {"altitude_m": [8.0, 30.0], "x_m": [-99.0, 99.0], "y_m": [-99.0, 99.0]}
SOURCE = {"position_m": [9.0, 9.0, 0.0], "power_w": 1}
JAMMED = SECRECY | {"objective": "friendly-jamming", "sources": [SOURCE], "airspace": ROOM}
TWO = [{"position_m": [9.0, at, 0.0], "power_w": 1} for at in (8.0, 9.0)]
JAMMED_CASES: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({"sources": None}, {"sources": "a source, in a table of its own headed [[sources]]; add it"}),
    ({"transmitter": None}, {"transmitter": "a table headed [transmitter]; add it"}),
    ({"eavesdroppers": None}, {"eavesdroppers": "headed [[eavesdroppers]]; add it"}),
    ({"airspace": ROOM | {"x_m": None}}, {"airspace": "add x_m and y_m"}),
    ({"airspace": {"altitude_m": [8, 30], "geofence_m": [[0, 0], [50, 0], [0, 50]]}}, {}),
    ({"sources": TWO}, {"nodes[0].from": "missing, and there are 2 sources: A1, A2; add the name of one"}),
    ({"sources": TWO, "nodes": [AT | {"from": "A2"}]}, {}),
    ({"sources": TWO, "nodes": [AT | {"from": "A3"}]}, {"nodes[0].from": 'got "A3", an unknown source'}),
    ({"sources": [TWO[0] | {"name": "A"}], "nodes": [AT | {"from": "B"}]}, {"nodes[0].from": "here are A"}),
    ({"nodes": [AT | {"weight": 2}]}, {"nodes[0].weight": "has no meaning with"}),
    ({"sources": [THERE | {"power_w": 1}]}, {"sources[0].position_m": "must be at different places"}),
    ({"sources": [{"position_m": [9.0, 9.0, 0.0]}]}, {"sources[0]": "power_w"}),
    ({"objective": "secrecy-rate"}, {"sources": 'remove it, or write objective = "friendly-jamming"'}),
    (
        {"objective": "secrecy-rate", "sources": None, "nodes": [AT | {"from": "A1"}]},
        {"nodes[0].from": 'write objective = "friendly-jamming"'},
    ),
]


@pytest.mark.parametrize(
    ("data", "faults"),
    [
        *((DOWNLINK | changes, faults) for changes, faults in DOWNLINK_CASES),
        *((RELAY | changes, faults) for changes, faults in RELAY_CASES),
        *((SECRECY | changes, faults) for changes, faults in SECRECY_CASES),
        *((JAMMED | changes, faults) for changes, faults in JAMMED_CASES),
        *((small(**changes), faults) for changes, faults in SINR_CASES),
    ],
)
def test_what_an_objective_needs_and_what_has_no_meaning(
    data: dict[str, Any], faults: dict[str, str]
) -> None:
    """What belongs to a drone that transmits, to eavesdroppers and to a destination is refused elsewhere."""
    messages = faults_of({key: value for key, value in data.items() if value is not None})
    assert messages.keys() == faults.keys()
    assert all(words in messages[path] for path, words in faults.items())


def test_a_jammer_may_listen() -> None:
    """A jammer and an eavesdropper may be one and the same, at one place."""
    jammer = {"position_m": [17.0, 15.0, 4.0], "power_w": 1.0}
    assert Scenario.from_dict(SECRECY | {"jammers": [jammer]}).jammer_names == ("M1",)


def test_an_unknown_objective_hides_no_other_fault() -> None:
    """With an objective that cannot be read, the rest of the file is judged all the same."""
    messages = faults_of(SECRECY | {"objective": "rate", "receiver": {"noise_w": -1, "reference_gain_db": 0}})
    assert messages.keys() == {"objective", "receiver.noise_w"}
