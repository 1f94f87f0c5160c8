"""The JSON Schema of scenario files, for editors and other programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from nullpose.scenario.ground_points import Emitter
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.section import Section

__all__ = ["json_schema"]

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """Returns the JSON Schema (2020-12) of scenario files: keys, units, ranges and either-or pairs.

    It says what can be said key by key; faults between keys, such as a reversed range, are left to ``load``.
    """
    schema = Scenario.model_json_schema(schema_generator=_TomlSchema)
    heading = {
        "$schema": DIALECT,
        "title": "nullpose scenario",
        "description": "Nodes, jammers, a receiver and an airspace; positions in metres east, north and up.",
    }
    return heading | {key: value for key, value in schema.items() if key not in heading}


class _TomlSchema(GenerateJsonSchema):
    """The schema as TOML needs it: keys are left out, never null, and pairs are either-or."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        inner = super().default_schema(schema)
        return {key: value for key, value in inner.items() if key != "default" or value not in (None, "", [])}

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        described = super().model_schema(schema)
        described.pop("title", None)
        kind = schema["cls"]
        if issubclass(kind, Section):
            # The class docstring speaks of Python; the fields describe themselves.
            described["description"] = str(described.get("description", "")).split("\n", 1)[0]
            either = {key for way in kind.ways for key in way}
            required = [key for key in described.pop("required", ()) if key not in either]
            described |= {"required": required} if required else {}
            described |= _together(_rules(kind))
        return described


def _rules(kind: type[Section]) -> list[dict[str, Any]]:
    """Returns what a table says of keys together: one of several, at most one, one of several ways."""
    rules: list[dict[str, Any]] = [_either_or(*((key,) for key in pair)) for pair in kind.pairs]
    rules += [{"not": {"required": list(pair)}} for pair in kind.alternatives]
    if kind.shapes:
        rules.append(_either_or(*kind.shapes))
    if kind.ways:
        # Not "oneOf": a scenario that is written to a file states such things in every way that it knows.
        rules.append({"anyOf": [{"required": list(way)} for way in kind.ways]})
    if issubclass(kind, Scenario):
        rules.append(_NODES_TRANSMIT)
    return rules


def _either_or(*groups: Sequence[str]) -> dict[str, Any]:
    return {"oneOf": [{"required": list(group)} for group in groups]}


_NODES_TRANSMIT: dict[str, Any] = {
    "if": {"properties": {"objective": {"const": "secrecy-rate"}}, "required": ["objective"]},
    "else": {"properties": {"nodes": {"items": _either_or(*((key,) for key in Emitter.pairs[0]))}}},
}
"""Every node has a power, but where the drone transmits."""


def _together(rules: Sequence[dict[str, Any]]) -> dict[str, Any]:
    match rules:
        case []:
            return {}
        case [rule]:
            return rule
        case _:
            return {"allOf": list(rules)}
