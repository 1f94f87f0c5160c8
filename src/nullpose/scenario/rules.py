"""What a value of a file must be: a number within limits, a list of so many members, a list of tables."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import described, plain, rejection, require_value, suggestion

MOST_MEMBERS = 10_000
"""The most members of a list, such as nodes or the corners of a polygon."""

_NUMBER = re.compile(r"[-+.\deE]*\d[-+.\deE]*")


class Rule:
    """What a value must be, as the metadata of an annotated type."""

    def read(self, value: object) -> Any:
        """Convert a raw value to what its type takes; raise the fault that says what is wrong with it."""
        return value

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Write the JSON Schema of the rule from that of the type."""
        return inner

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return self.schema(handler(schema))


@dataclass(frozen=True, slots=True)
class Limits(Rule):
    """A finite number with a unit, between two limits; used as the metadata of an annotated float.

    The limits are wide enough for any radio scene and narrow enough that no product of such numbers in
    the physics overflows.

    Args:
        noun: what the number is, with its unit, as in ``a power in W``.
        low: smallest number allowed.
        high: largest number allowed.
        hint: what to try when a number is outside the limits.
    """

    noun: str
    low: float
    high: float
    hint: str

    @property
    def allowed(self) -> str:
        """The allowed numbers in words."""
        return f"{self.noun} from {self.low:g} to {self.high:g}"

    def read(self, value: object) -> float:
        """Check a number; raise the fault that says what is wrong with it."""
        value = plain(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            is_quoted = isinstance(value, str) and _NUMBER.fullmatch(value)
            remedy = "; write it without quotes" if is_quoted else ""
            raise rejection(f"got {described(value)}, must be a number: {self.allowed}{remedy}")
        if not self.low <= value <= self.high:  # also refuses NaN
            raise rejection(f"got {described(value)}, must be {self.allowed} ({self.hint})")
        return float(value)

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Return the JSON Schema: the type with its limits."""
        return {"type": inner["type"], "minimum": self.low, "maximum": self.high}


class Count(Limits):
    """A whole number between two limits; used as the metadata of an annotated int."""

    def read(self, value: object) -> int:
        """Check a whole number; raise the fault that says what is wrong with it."""
        number = super().read(value)
        if not number.is_integer():
            raise rejection(f"got {described(value)}, must be a whole number: {self.allowed} ({self.hint})")
        return int(number)


@dataclass(frozen=True, slots=True)
class Choice(Rule):
    """One of some words, as the metadata of an annotated text.

    Args:
        noun: what is chosen, as in ``an objective``.
        words: the words to choose from.
    """

    noun: str
    words: Collection[str] = field(hash=False)

    def read(self, value: object) -> str:
        """Check a word; raise the fault that names the words and the one nearest."""
        if isinstance(value, str) and value in self.words:
            return value
        allowed = " or ".join(f'"{word}"' for word in self.words)
        raise rejection(
            f"got {described(value)}, must be {self.noun}: {allowed}{suggestion(value, self.words)}"
        )

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Return the JSON Schema: a text with its allowed values."""
        return {"type": "string", "enum": list(self.words)}


@dataclass(frozen=True, slots=True)
class ByName(Rule):
    """A table, in place of which a name may stand, as the metadata of an annotated table.

    Args:
        noun: what may be written, as in ``a table with tilt_max_deg, or a name``.
        tables: the table that each name stands for.
    """

    noun: str
    tables: Mapping[str, object] = field(hash=False)

    def read(self, value: object) -> Any:
        """Look up a table by its name; raise the fault that lists the names."""
        return self.tables[Choice(self.noun, self.tables).read(value)] if isinstance(value, str) else value

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Return the JSON Schema: one of the names, or that of the table."""
        return {"anyOf": [{"type": "string", "enum": list(self.tables)}, inner]}


@dataclass(frozen=True, slots=True)
class ListOf(Rule):
    """A list of so many members, as the metadata of an annotated tuple.

    Args:
        noun: what the list is, in words.
        fewest: the smallest number of members.
        most: the largest.
    """

    noun: str
    fewest: int
    most: int

    def read(self, value: object) -> list[object]:
        """Check the members of a list; raise the fault that says what is wrong with it."""
        value = plain(value)
        if not isinstance(value, list | tuple) or not self.fewest <= len(value) <= self.most:
            raise rejection(f"got {described(value)}, must be {self.noun}")
        return list(value)

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Return the JSON Schema of the list."""
        # One "items" for all members, not "prefixItems": editors that know only older drafts read it too.
        members = inner["prefixItems"] if "prefixItems" in inner else [inner["items"]]
        items = dict(members[0])
        for limit, widest in (("minimum", min), ("maximum", max)):
            if limit in items:
                items[limit] = widest(member[limit] for member in members)
        return {"type": "array", "items": items, "minItems": self.fewest, "maxItems": self.most}


@dataclass(frozen=True, slots=True)
class NumberOr(Rule):
    """A number, in place of which a list of several may stand, as the metadata of an annotated union.

    Args:
        number: what one alone must be.
        several: the type of the list.
    """

    number: Limits
    several: TypeAdapter[Any]

    def read(self, value: object) -> Any:
        """Check a number or a list; raise the fault that says what is wrong with it."""
        value = plain(value)
        is_list = isinstance(value, list | tuple)
        return self.several.validate_python(value) if is_list else self.number.read(value)

    def schema(self, inner: JsonSchemaValue) -> JsonSchemaValue:
        """Return the JSON Schema: that of the list with the limits of the number."""
        return self.several.json_schema() | self.number.schema({"type": ["number", "array"]})


def ascending(value: tuple[float, float]) -> tuple[float, float]:
    """Return two numbers, or raise the fault that the second is less than the first."""
    require_value(
        value[0] <= value[1],
        f"got {list(value)}, which is reversed and so holds nothing; must have the lowest first; "
        f"try {list(value[::-1])}",
    )
    return value


class Members(ListOf):
    """A list of tables, of which each that leaves its name out is named by its letter and its place."""

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(
            _named_by_place, super().__get_pydantic_core_schema__(source, handler)
        )


def _named_by_place(value: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(
        member
        if member.name or member.letter is None
        else BaseModel.model_copy(member, update={"name": f"{member.letter}{place}"})
        for place, member in enumerate(value, 1)
    )


def list_of_tables(key: str, fewest: int = 0, most: int = MOST_MEMBERS) -> Members:
    """Return the rule of a list of so many tables that are headed by a key."""
    number = "at least one table" if fewest else f"at most {most} tables" if most < MOST_MEMBERS else "tables"
    return Members(f"a list of {number}, each headed [[{key}]]", fewest, most)
