"""The JSON Schema of scenario files."""

import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from nullpose.errors import ScenarioError
from nullpose.scenario import (
    Airframe,
    Airspace,
    Array,
    Building,
    Eavesdropper,
    Jammer,
    Node,
    NoFlyZone,
    Receiver,
    Scenario,
    Transmitter,
    json_schema,
)
from scenes import EXAMPLES

SCENARIOS = sorted(path for path in EXAMPLES.glob("*.toml") if not path.stem.startswith("study"))  # a spec
KINDS = (Airframe, Airspace, Array, Building, Eavesdropper, Jammer, Node, NoFlyZone, Receiver, Transmitter)
TABLES = {kind.__name__: kind for kind in KINDS}


@cache
def whole_schema() -> dict[str, Any]:
    """Returns the schema, made once."""
    return json_schema()


def schema_of(table: str) -> dict[str, Any]:
    """Returns the part of the schema for one table."""
    return whole_schema()["$defs"][table]


def keys() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields every key that a file may have, with its schema."""
    yield from whole_schema()["properties"].items()
    for table in TABLES:
        yield from ((f"{table}.{key}", value) for key, value in schema_of(table)["properties"].items())


def accepts(schema: dict[str, Any], value: Any) -> bool:
    """Returns whether a value fits a part of the schema."""
    whole = schema | {"$defs": whole_schema()["$defs"]}
    return Draft202012Validator(whole).is_valid(value)


def test_keys_are_those_of_the_tables() -> None:
    """The schema has the keys of the tables, no more and no fewer."""
    assert json_schema()["properties"].keys() == Scenario.model_fields.keys()
    for name, table in TABLES.items():
        assert schema_of(name)["properties"].keys() == table.model_fields.keys()


BOX, BALL = {"x_m": [0, 1], "y_m": [0, 1]}, {"centre_m": [0, 1], "radius_m": 2}
NOISE, GAIN, HERTZ = {"noise_w": 1e-3}, {"reference_gain_db": 0}, {"frequency_hz": 1e9}
PLACE = {"position_m": [0, 0, 9]}


@pytest.mark.parametrize(
    ("table", "good", "bad"),
    [
        (Transmitter, [{"power_w": 1}, {"power_dbm": 1}], [{}, {"power_w": 1, "power_dbm": 1}]),
        (Jammer, [PLACE | {"power_w": 1}], [PLACE, PLACE | {"power_w": 1, "power_dbm": 1}]),
        (Airframe, [{"preset": "level"}, {"tilt_max_deg": 1}], [{}, {"preset": "level", "tilt_max_deg": 1}]),
        (
            Receiver,
            [NOISE | GAIN, NOISE | {"frequency_hz": 1e9}],
            [NOISE, GAIN, NOISE | GAIN | {"noise_dbm": 1}],
        ),
        (
            NoFlyZone,
            [BOX, BALL, {"polygon_m": [[0, 0], [1, 0], [0, 1]], "altitude_m": [0, 9]}],
            [{}, {"x_m": [0, 1]}, {"polygon_m": [[0, 0], [1, 0]]}, BOX | BALL],
        ),
    ],
)
def test_schema_and_program_agree(table: type[Any], good: list[dict], bad: list[dict]) -> None:
    """Of a quantity in two units exactly one is stated, and of the three shapes of a zone exactly one."""
    for values in good:
        assert accepts(schema_of(table.__name__), values)
        table(**values)
    for values in bad:
        assert not accepts(schema_of(table.__name__), values)
        with pytest.raises(ScenarioError):
            table(**values)


UNITS = {"_m": "metres", "_w": "watts", "_dbm": "dBm", "_db": "dB", "_hz": "Hz", "_deg": "degrees"}


@pytest.mark.parametrize(
    ("key", "schema"), list(keys()), ids=lambda value: value if isinstance(value, str) else ""
)
def test_every_key_is_described(key: str, schema: dict[str, Any]) -> None:
    """Every key has a description, which names the unit that the key ends in, and its examples fit."""
    assert schema["description"]
    for ending, unit in UNITS.items():
        if key.endswith(ending):
            assert unit in schema["description"]
            assert schema["examples"]
    assert all(accepts(schema, example) for example in schema.get("examples", ()))


@pytest.mark.parametrize("example", SCENARIOS, ids=lambda path: path.name)
def test_examples_fit(example: Path) -> None:
    """Every example fits the schema, and stops to when a key is added, misspelt, doubled or taken away."""
    data = tomllib.loads(example.read_text(encoding="utf-8"))
    assert accepts(whole_schema(), data)
    assert not accepts(whole_schema(), data | {"node": []})
    without_nodes = {key: value for key, value in data.items() if key not in ("nodes", "nodes_from")}
    assert not accepts(whole_schema(), without_nodes)
    assert not accepts(whole_schema(), data | {"receiver": {}})
    assert not accepts(
        whole_schema(), data | {"receiver": data["receiver"] | {"noise_w": 1.0, "noise_dbm": 1.0}}
    )
    assert not accepts(whole_schema(), data | {"airspace": {"altitude_m": [1, 2, 3]}})
