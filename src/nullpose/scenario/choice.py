"""A word out of a few."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import rejection
from nullpose.scenario.wording import described, listed, nearest

__all__ = ["Choice"]


@dataclass(frozen=True, slots=True)
class Choice:
    """One of some words, as metadata of an annotated Literal.

    Args:
        noun: what is chosen, as in ``an objective``.
        words: the words to choose from.
    """

    noun: str
    words: tuple[str, ...]

    def read(self, value: object) -> str:
        """Returns the word, or raises the fault that names the words and the one nearest."""
        if isinstance(value, str) and value in self.words:
            return value
        guess = nearest(value, self.words) if isinstance(value, str) else ""
        hint = f'; did you mean "{guess}"?' if guess else ""
        quoted = [f'"{word}"' for word in self.words]
        allowed = f"{listed(quoted[:-1])} or {quoted[-1]}"
        raise rejection(f"got {described(value)}, must be {self.noun}: {allowed}{hint}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"type": "string", "enum": list(self.words)}
