"""Which channel a scenario and its points state."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.channel.model import BLOCKED, EXPONENT
from nullpose.errors import ScenarioError
from nullpose.scenario import Channel, Scenario, apply_overrides, json_schema, load
from nullpose.scenario.toml_file import tables_of
from scenes import NODE, faults_of, small

URBAN = {"model": "elevation", "environment": "urban", "average": "power"}
NUMBERS = {"a": 9.61, "b": 0.16, "los_loss_db": 1.0, "nlos_loss_db": 20.0}
PAPER = load("examples/paper.toml")


@pytest.mark.parametrize(
    ("channel", "place", "words"),
    [
        ({"model": "two-ray"}, "model", 'got the text "two-ray", must be a channel model'),
        ({"model": "power-law"}, "exponent", 'missing, but model = "power-law" needs it'),
        ({"model": "power-law", "exponent": 1.5}, "exponent", "must be a path-loss exponent from 1.6 to 6"),
        ({"model": "power-law", "exponent": 6.5}, "exponent", "got 6.5"),
        (
            {"exponent": 3.0},
            "exponent",
            'write model = "power-law" or model = "elevation"',
        ),
        ({**URBAN, "exponent": 6.5}, "exponent", "must be a path-loss exponent from 1.6 to 6"),
        (URBAN | {"average": None}, "average", 'missing, but model = "elevation" needs it'),
        (URBAN | {"average": "median"}, "average", "must be an average"),
        (URBAN | {"environment": "rural"}, "environment", 'did you mean "urban"?'),
        (URBAN | {"environment": None}, "environment", "or a, b, los_loss_db and nlos_loss_db; add either"),
        (URBAN | NUMBERS, "", "both environment and a and b and los_loss_db and nlos_loss_db are given"),
        (URBAN | {"environment": None, "a": 5.0, "b": 0.4}, "", "given without los_loss_db and nlos_loss_db"),
        (
            URBAN | NUMBERS | {"environment": None, "los_loss_db": 21.0},
            "nlos_loss_db",
            "losses that make line of sight the weaker",
        ),
        (
            URBAN | NUMBERS | {"environment": None, "nlos_loss_db": 0.0},
            "nlos_loss_db",
            "losses that make line of sight the weaker",
        ),
        ({"blocked_loss_db": 0.0}, "blocked_loss_db", "must be a loss in dB"),
        ({"model": "free-space", "average": "db"}, "average", 'or write model = "elevation"'),
    ],
)
def test_faults(channel: dict[str, object], place: str, words: str) -> None:
    """Each fault has one message, at its place; of a point as of the scenario."""
    stated = {key: value for key, value in channel.items() if value is not None}
    for path, data in (
        ("channel", small(channel=stated)),
        ("nodes[0].channel", small(nodes=[NODE | {"channel": stated}])),
    ):
        ((found, message),) = faults_of(data).items()
        assert found == f"{path}.{place}".rstrip(".")
        assert words in message


def test_the_drone_comes_no_closer_than_the_reference_distance() -> None:
    """A power law means nothing below it; and the gain at another distance than 1 m has no frequency."""
    law = {"model": "power-law", "exponent": 3.0, "reference_distance_m": 5.0}
    assert "at most airspace.keep_out_m = 1" in faults_of(small(channel=law))["channel.reference_distance_m"]
    airspace = {"altitude_m": [8.0, 30.0], "keep_out_m": 5.0}
    assert faults_of(small(channel=law, airspace=airspace)) == {}
    jammer = NODE | {"position_m": [9.0, 9.0, 0.0], "channel": law | {"reference_distance_m": 6.0}}
    (path,) = faults_of(small(airspace=airspace, jammers=[jammer]))
    assert path == "jammers[0].channel.reference_distance_m"
    receiver = {"noise_w": 1e-3, "frequency_hz": 2.4e9}
    (message,) = faults_of(small(channel=law, airspace=airspace, receiver=receiver)).values()
    assert "reference_gain_db = -54.03" in message
    near = {"altitude_m": [8.0, 30.0], "keep_out_m": 0.5}
    assert (
        "got 1"
        in faults_of(small(channel={"model": "power-law", "exponent": 3.0}, airspace=near)).popitem()[1]
    )


def test_sight_by_elevation_has_a_reference_distance_too() -> None:
    """Where it states an exponent it means nothing below that distance; where it does not, it has none."""
    near = {"altitude_m": [8.0, 30.0], "keep_out_m": 0.5}
    assert faults_of(small(channel=URBAN, airspace=near)) == {}
    found = faults_of(small(channel=URBAN | {"exponent": 2.4}, airspace=near))
    assert "must be at most airspace.keep_out_m = 0.5" in found["channel.reference_distance_m"]


@pytest.mark.parametrize(
    "channel", [URBAN | {"exponent": 2.6}, {"model": "elevation", "average": "db", **NUMBERS}]
)
def test_round_trips(channel: dict[str, object]) -> None:
    """Tables and texts lead back to an equal scenario, and what is not stated stays so."""
    assert "channel" not in PAPER.to_dict()
    data = PAPER.to_dict() | {"channel": channel | {"blocked_loss_db": 20.0}}
    data["jammers"][0]["channel"] = "free-space"
    scenario = Scenario.from_dict(data)
    assert scenario.to_dict()["channel"] == data["channel"]
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    assert Scenario.from_dict(tables_of(scenario.to_toml())) == scenario
    assert scenario.jammers[0].channel == Channel(model="free-space")


def test_overrides() -> None:
    """A key of a channel can be set by its path, that of a point too; an environment replaces its numbers."""
    begun = apply_overrides(
        PAPER, ['channel={model="power-law", exponent=2.5}', "nodes.S1.channel=free-space"]
    )
    changed = apply_overrides(begun, ["channel.exponent=3"])
    assert (changed.channel.exponent, changed.nodes[0].channel.model) == (3.0, "free-space")
    own = apply_overrides(
        changed, ["nodes.S1.channel={model='power-law', exponent=2.2}", "nodes.S1.channel.exponent=4"]
    )
    assert own.nodes[0].channel.exponent == 4.0
    numbers = Scenario.from_dict(small(channel={"model": "elevation", "average": "db", **NUMBERS}))
    named = apply_overrides(numbers, ["channel.environment=urban"])
    assert (named.channel.a, named.node_channels.rows.tolist()) == (None, numbers.node_channels.rows.tolist())


def test_schema_takes_a_name_or_a_table() -> None:
    """Editors offer the model that needs no more than its name, and the keys of the table."""
    schema = json_schema()
    word, table = schema["$defs"]["Jammer"]["properties"]["channel"]["anyOf"]
    assert word == {"type": "string", "enum": ["free-space"]}
    assert table == {"$ref": "#/$defs/Channel"}
    assert "oneOf" not in schema["$defs"]["Channel"]


def test_no_average_is_asked_for_where_buildings_decide(paper: Callable) -> None:
    """The losses with and without line of sight count there; without buildings the average is missing."""
    data = paper().to_dict() | {"channel": {"model": "elevation", "environment": "urban"}}
    with pytest.raises(ScenarioError, match=r"channel\.average: missing, .*unless buildings decide"):
        Scenario.from_dict(data)
    data["buildings"] = [{"polygon_m": [[5, 20], [9, 20], [9, 30], [5, 30]], "height_m": 6.0}]
    asked = Scenario.from_dict(data | {"channel": data["channel"] | {"average": "db"}})
    unasked = Scenario.from_dict(data)
    np.testing.assert_array_equal(unasked.source_channels.rows, asked.source_channels.rows)
    np.testing.assert_array_equal(unasked.source_channels.strengths, asked.source_channels.strengths)
    by_law = Scenario.from_dict(data | {"channel": data["channel"] | {"exponent": 2.6}}).source_channels
    np.testing.assert_allclose(by_law.rows[:, EXPONENT], -0.6)
    np.testing.assert_array_equal(by_law.strengths, unasked.source_channels.strengths)
    np.testing.assert_array_equal(by_law.rows[:, BLOCKED], unasked.source_channels.rows[:, BLOCKED])
