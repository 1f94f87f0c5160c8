"""The JSON Schema of scenario files."""

import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import (
    Airframe,
    Airspace,
    Array,
    Eavesdropper,
    Jammer,
    Node,
    NoFlyZone,
    Receiver,
    Scenario,
    Transmitter,
    json_schema,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENARIOS = sorted(path for path in EXAMPLES.glob("*.toml") if path.name != "study.toml")  # which is a spec
TABLES = {
    "Airframe": Airframe,
    "Airspace": Airspace,
    "Array": Array,
    "Eavesdropper": Eavesdropper,
    "Jammer": Jammer,
    "NoFlyZone": NoFlyZone,
    "Node": Node,
    "Receiver": Receiver,
    "Transmitter": Transmitter,
}


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
    """Returns whether a value fits a schema, for the few words of JSON Schema that this one uses."""
    if "$ref" in schema:
        schema = whole_schema()["$defs"][schema["$ref"].removeprefix("#/$defs/")]
    kind = schema["type"]
    if isinstance(kind, list):
        return any(accepts(schema | {"type": one}, value) for one in kind)
    match kind:
        case "integer":
            return isinstance(value, int) and schema["minimum"] <= value <= schema["maximum"]
        case "number":
            number = isinstance(value, int | float) and not isinstance(value, bool)
            return number and schema["minimum"] <= value <= schema["maximum"]
        case "string":
            fits = isinstance(value, str) and len(value) >= schema.get("minLength", 0)
            return fits and value in schema.get("enum", [value])
        case "array":
            if not isinstance(value, list):
                return False
            fits = schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))
            return fits and all(accepts(schema["items"], member) for member in value)
        case _:
            return (
                isinstance(value, dict)
                and value.keys() <= schema["properties"].keys()
                and keeps(schema, value)
                and all(accepts(schema["properties"][key], member) for key, member in value.items())
            )


def keeps(rule: dict[str, Any], value: dict[str, Any]) -> bool:
    """Returns whether a table keeps the rules on keys together, for the few words that this schema uses."""
    members = rule.get("properties", {}).get("nodes", {}).get("items", {})
    objectives = rule.get("properties", {}).get("objective", {}).get("enum")
    return (
        all(key in value for key in rule.get("required", ()))
        and all(keeps(one, value) for one in rule.get("allOf", ()))
        and ("anyOf" not in rule or any(keeps(one, value) for one in rule["anyOf"]))
        and ("oneOf" not in rule or sum(keeps(one, value) for one in rule["oneOf"]) == 1)
        and ("not" not in rule or not keeps(rule["not"], value))
        and ("if" not in rule or keeps(rule["if"], value) or keeps(rule["else"], value))
        and (objectives is None or value.get("objective", objectives[0]) in objectives)
        and ("$ref" in members or all(keeps(members, node) for node in value.get("nodes", ())))
    )


def test_keys_are_those_of_the_tables() -> None:
    """The schema has the keys of the tables, no more and no fewer."""
    assert json_schema()["properties"].keys() == Scenario.model_fields.keys()
    for name, table in TABLES.items():
        assert schema_of(name)["properties"].keys() == table.model_fields.keys()


POWER = {"oneOf": [{"required": ["power_w"]}, {"required": ["power_dbm"]}]}


def test_pairs_are_either_or() -> None:
    """Of a quantity in two units, exactly one is required."""
    assert schema_of("Transmitter")["oneOf"] == POWER["oneOf"]
    assert POWER in schema_of("Jammer")["allOf"]
    assert schema_of("Airframe")["oneOf"] == [{"required": ["preset"]}, {"required": ["tilt_max_deg"]}]
    assert schema_of("Receiver")["allOf"] == [
        {"oneOf": [{"required": ["noise_w"]}, {"required": ["noise_dbm"]}]},
        {"oneOf": [{"required": ["reference_gain_db"]}, {"required": ["frequency_hz"]}]},
    ]


@pytest.mark.parametrize(
    ("table", "fits"),
    [
        ({"x_m": [0, 1], "y_m": [0, 1]}, True),
        ({"centre_m": [0, 1], "radius_m": 2}, True),
        ({"polygon_m": [[0, 0], [1, 0], [0, 1]], "altitude_m": [0, 9]}, True),
        ({}, False),
        ({"x_m": [0, 1]}, False),
        ({"polygon_m": [[0, 0], [1, 0]]}, False),
        ({"x_m": [0, 1], "y_m": [0, 1], "centre_m": [0, 1], "radius_m": 2}, False),
    ],
)
def test_a_zone_has_one_shape(table: dict[str, Any], fits: bool) -> None:
    """A no-fly zone has exactly one of the three shapes, as the schema says and as the program does."""
    assert accepts(schema_of("NoFlyZone"), table) is fits
    if fits:
        NoFlyZone(**table)
    else:
        with pytest.raises(ScenarioError):
            NoFlyZone(**table)


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
