"""The JSON Schema of scenario files, for editors and other programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

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
            described |= _either_or(kind.pairs)
        return described


def _either_or(pairs: Sequence[tuple[str, str]]) -> dict[str, Any]:
    rules: list[dict[str, Any]] = [{"oneOf": [{"required": [key]} for key in pair]} for pair in pairs]
    match rules:
        case []:
            return {}
        case [rule]:
            return rule
        case _:
            return {"allOf": rules}
