"""Texts: titles, names by which results and overrides refer to something."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, WithJsonSchema

from nullpose.scenario.faults import rejection
from nullpose.scenario.wording import described


def _line(value: object) -> str:
    if not isinstance(value, str):
        raise rejection(f"got {described(value)}, must be text in quotes")
    if not value.isprintable() or value != value.strip():
        raise rejection(
            f"got {described(value)}, must be text on one line, without control characters "
            "and without blanks at its ends"
        )
    return str(value)


def _name(value: object) -> str:
    if value is None:
        return ""  # left out: named by its place
    if isinstance(value, str) and not value.strip():
        raise rejection(f"got {described(value)}, must be a name with at least one visible character")
    return _line(value)


Title = Annotated[str, BeforeValidator(_line)]
"""A text on one line, possibly empty."""
Label = Annotated[str, BeforeValidator(_name), WithJsonSchema({"type": "string", "minLength": 1})]
"""A name by which results and overrides refer to a node or jammer, or the name of a file."""
