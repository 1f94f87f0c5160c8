"""Names: what may be one, and those that are given by position when left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import rejection
from nullpose.scenario.wording import described

__all__ = ["FileOnly", "Label", "Title", "is_unnamed", "named", "numbered"]


@dataclass(frozen=True, slots=True)
class _Text:
    """A text on one line, as metadata of an annotated str."""

    may_be_empty: bool

    def read(self, value: object) -> str:
        if not isinstance(value, str):
            raise rejection(f"got {described(value)}, must be text in quotes")
        if not value.strip() and not self.may_be_empty:
            raise rejection(f"got {described(value)}, must be a name with at least one visible character")
        if not value.isprintable() or value != value.strip():
            raise rejection(
                f"got {described(value)}, must be text on one line, without control characters "
                "and without blanks at its ends"
            )
        return str(value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"type": "string"} if self.may_be_empty else {"type": "string", "minLength": 1}


@dataclass(frozen=True, slots=True)
class _FileName(_Text):
    """The name of a file that is read before the scenario is built, as metadata of an annotated str."""

    def read(self, value: object) -> str:
        raise rejection(
            f"got {described(value)}, which only a scenario file may name, since it is read together with it"
        )


Title = Annotated[str, _Text(may_be_empty=True)]
"""A text on one line, possibly empty."""
FileOnly = Annotated[str, _FileName(may_be_empty=False)]
"""The name of a file that stands for a part of a scenario file."""
Label = Annotated[str, _Text(may_be_empty=False)]
"""A name by which results and overrides refer to a node or jammer."""


def numbered(letter: str, index: int) -> str:
    """Returns the name of a node or jammer that has none: its letter and its place, counted from 1."""
    return f"{letter}{index + 1}"


def named(members: Sequence[object], letter: str) -> list[object]:
    """Returns the raw nodes or jammers, each that leaves its name out being named by its place."""
    return [
        _with_name(member, numbered(letter, index)) if is_unnamed(member) else member
        for index, member in enumerate(members)
    ]


def is_unnamed(member: object) -> bool:
    """Returns whether a raw node or jammer leaves its name out."""
    if isinstance(member, Mapping):
        return member.get("name") is None
    return isinstance(member, BaseModel) and getattr(member, "name", None) == ""


def _with_name(member: object, name: str) -> object:
    if isinstance(member, Mapping):
        return {**member, "name": name}
    return member.model_copy(update={"name": name}) if isinstance(member, BaseModel) else member
