"""From faults that pydantic collects, with places as tuples, to a ScenarioError in plain words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.wording import printable

__all__ = ["Place", "as_error_details", "collected", "path_of", "rejection", "scenario_error"]

Place = tuple[str | int, ...]
"""Where a value stands: keys and list indices from the root down."""

KIND = "scenario"
"""The type that every fault worded here carries through pydantic."""


_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def rejection(message: str) -> PydanticCustomError:
    """Returns the exception with which a validator refuses a value, in exactly these words."""
    # The message travels as context: braces in it (from user text) are then not taken for placeholders.
    return PydanticCustomError(KIND, "{message}", {"message": message})


def as_error_details(place: Place, message: str, given: object = None) -> InitErrorDetails:
    """Returns one fault in the form in which pydantic collects them."""
    return InitErrorDetails(type=rejection(message), loc=place, input=given)


def collected(title: str, details: Sequence[InitErrorDetails]) -> ValidationError:
    """Returns pydantic's exception that carries all the faults together."""
    return ValidationError.from_exception_data(title, list(details))


def path_of(place: Iterable[str | int]) -> str:
    """Returns a place as a person would write it: ``jammers[1].power_w``."""
    path = ""
    for step in place:
        if isinstance(step, int):
            path += f"[{step}]"
        else:
            key = printable(step) if _BARE_KEY.fullmatch(step) else f'"{printable(step)}"'
            path += f".{key}" if path else key
    return path


def scenario_error(error: ValidationError, data: object, source: str = "") -> ScenarioError:
    """Returns the ScenarioError that says the same, its faults in the order of the input.

    Args:
        error: what pydantic collected, already in plain words.
        data: the input that was judged.
        source: the file or object at fault, as the user would name it.
    """
    found = [(tuple(entry["loc"]), entry["msg"]) for entry in error.errors(include_url=False)]
    found.sort(key=lambda fault: _position(fault[0], data))
    return ScenarioError([Fault(path_of(place), message) for place, message in found], source)


def _position(place: Place, data: object) -> tuple[int, ...]:
    """Returns a sort key: the rank of each step of the place among its siblings in the input."""
    ranks = []
    for step in place:
        if isinstance(data, Mapping):
            keys = list(data)
            ranks.append(keys.index(step) if step in keys else len(keys))
            data = data.get(step)
        else:
            ranks.append(step if isinstance(step, int) else 0)
            data = _member(data, step)
    return tuple(ranks)


def _member(values: object, step: str | int) -> object:
    if isinstance(values, list | tuple) and isinstance(step, int) and 0 <= step < len(values):
        return values[step]
    return None
