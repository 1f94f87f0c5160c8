"""The JSON Schema of scenario files, for editors and other programs."""

from __future__ import annotations

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from nullpose.files import PlainTable
from nullpose.objectives import RECORDS
from nullpose.scenario.radio import POWER
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.section import Section


def json_schema() -> PlainTable:
    """Return the JSON Schema (2020-12) of scenario files: keys, units, ranges and either-or pairs.

    It says what can be said key by key; faults between keys, such as a reversed range, are left to ``load``.

    Example:
        >>> import nullpose
        >>> schema = nullpose.json_schema()
        >>> schema["title"], "jammers" in schema["properties"]
        ('nullpose scenario', True)
    """
    schema = Scenario.model_json_schema(schema_generator=_TomlSchema)
    heading = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
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

    def field_title_should_be_set(self, schema: object) -> bool:
        return False

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        described = super().model_schema(schema)
        described.pop("title", None)
        if issubclass(kind := schema["cls"], Section):
            either = {key for ways in kind.ways for group in ways.groups for key in group}
            required = [key for key in described.pop("required", ()) if key not in either]
            rules = _rules(kind)
            described |= {
                # The rest of the class docstring speaks of Python; the fields describe themselves.
                "description": str(described.get("description", "")).split("\n", 1)[0],
                **({"required": required} if required else {}),
                **(rules[0] if len(rules) == 1 else {"allOf": rules} if rules else {}),
            }
        return described


def _rules(kind: type[Section]) -> list[PlainTable]:
    """Write the rules of a table's keys together, and of what an objective needs of the nodes."""
    needed = {key for key, field in kind.model_fields.items() if field.is_required()}
    rules = [ways.schema() for ways in kind.ways if ways.most == 1 or needed.intersection(ways.groups[0])]
    silent = [name for name, record in RECORDS.items() if "nodes.power" not in record.needs]
    if issubclass(kind, Scenario):
        rules.append(
            {
                "if": {"properties": {"objective": {"enum": silent}}, "required": ["objective"]},
                "else": {"properties": {"nodes": {"items": POWER.schema()}}},
            }
        )
    return rules
