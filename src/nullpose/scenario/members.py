"""Lists of tables: nodes, jammers and the like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import rejection
from nullpose.scenario.names import named
from nullpose.scenario.wording import described

__all__ = ["Members"]


@dataclass(frozen=True, slots=True)
class Members:
    """A list of tables with names, as metadata of an annotated tuple.

    Args:
        key: how each table is headed.
        letter: the letter of names given by place.
        at_least: the smallest number of tables.
    """

    key: str
    letter: str
    at_least: int = 0

    def read(self, value: object) -> list[object]:
        """Returns the members, each with a name, or raises the fault that says what is wrong."""
        if isinstance(value, Mapping):
            raise rejection(f"got a table, must be a list: head each table with [[{self.key}]]")
        if not isinstance(value, list | tuple):
            raise rejection(f"got {described(value)}, must be a list of tables, each headed [[{self.key}]]")
        if len(value) < self.at_least:
            raise rejection(f"got an empty list, must have at least one; add a table headed [[{self.key}]]")
        return named(value, self.letter)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        members = handler(schema)
        return members | {"minItems": self.at_least} if self.at_least else members
