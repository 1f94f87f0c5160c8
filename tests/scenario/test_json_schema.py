"""The JSON Schema of scenario files."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

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


def schema_of(table: str) -> dict[str, Any]:
    """Returns the part of the schema for one table."""
    return json_schema()["$defs"][table]


def keys() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields every key that a file may have, with its schema."""
    yield from json_schema()["properties"].items()
    for table in TABLES:
        yield from ((f"{table}.{key}", value) for key, value in schema_of(table)["properties"].items())


def accepts(schema: dict[str, Any], value: Any) -> bool:
    """Returns whether a value fits a schema, for the few words of JSON Schema that this one uses."""
    if "$ref" in schema:
        schema = json_schema()["$defs"][schema["$ref"].removeprefix("#/$defs/")]
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
            pairs = [rule["oneOf"] for rule in (*schema.get("allOf", ()), schema) if "oneOf" in rule]
            return (
                value.keys() <= schema["properties"].keys()
                and all(key in value for key in schema.get("required", ()))
                and all(sum(choice["required"][0] in value for choice in pair) == 1 for pair in pairs)
                and all(accepts(schema["properties"][key], member) for key, member in value.items())
            )


def test_dialect_and_title() -> None:
    """The schema says which dialect it is in and what it describes, and is JSON."""
    schema = json_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["title"] == "nullpose scenario"
    assert json.loads(json.dumps(schema, allow_nan=False)) == schema


def test_keys_are_those_of_the_tables() -> None:
    """The schema has the keys of the tables, no more and no fewer."""
    assert json_schema()["properties"].keys() == Scenario.model_fields.keys()
    for name, table in TABLES.items():
        assert schema_of(name)["properties"].keys() == table.model_fields.keys()


def test_tables_are_closed() -> None:
    """No table takes keys that it does not know."""
    assert json_schema()["additionalProperties"] is False
    assert all(schema_of(table)["additionalProperties"] is False for table in TABLES)


def test_required_keys() -> None:
    """Keys without which there is no scenario are required."""
    assert json_schema()["required"] == ["airspace", "receiver", "nodes"]
    assert schema_of("Airspace")["required"] == ["altitude_m"]
    assert schema_of("Node")["required"] == schema_of("Jammer")["required"] == ["position_m"]
    assert json_schema()["properties"]["nodes"]["minItems"] == 1


def test_pairs_are_either_or() -> None:
    """Of a quantity in two units, exactly one is required."""
    power = [{"required": ["power_w"]}, {"required": ["power_dbm"]}]
    assert schema_of("Node")["oneOf"] == schema_of("Jammer")["oneOf"] == power
    assert schema_of("Receiver")["allOf"] == [
        {"oneOf": [{"required": ["noise_w"]}, {"required": ["noise_dbm"]}]},
        {"oneOf": [{"required": ["reference_gain_db"]}, {"required": ["frequency_hz"]}]},
    ]


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


def test_no_null_and_no_internal_words() -> None:
    """TOML has no null, so the schema has none; nor does it speak of Python."""
    text = json.dumps(json_schema())
    for words in ("null", "None", "tuple", "anyOf", "prefixItems", "Args", "Raises"):
        assert words not in text.replace("nullpose", "")


def test_editors_are_told_the_default() -> None:
    """The one default that matters is stated."""
    assert schema_of("Airspace")["properties"]["keep_out_m"]["default"] == 1.0


@pytest.mark.parametrize("example", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.name)
def test_examples_fit(example: Path) -> None:
    """Every example fits the schema, and stops to when a key is added, misspelt, doubled or taken away."""
    data = tomllib.loads(example.read_text(encoding="utf-8"))
    assert accepts(json_schema(), data)
    assert not accepts(json_schema(), data | {"node": []})
    assert not accepts(json_schema(), {key: value for key, value in data.items() if key != "nodes"})
    assert not accepts(json_schema(), data | {"receiver": {}})
    assert not accepts(
        json_schema(), data | {"receiver": data["receiver"] | {"noise_w": 1.0, "noise_dbm": 1.0}}
    )
    assert not accepts(json_schema(), data | {"airspace": {"altitude_m": [1, 2, 3]}})


def test_schema_is_a_new_value_each_time() -> None:
    """Changing a schema that was handed out changes no other."""
    json_schema()["properties"].clear()
    assert json_schema()["properties"]
