"""From faults that pydantic collects, with places as tuples, to a ScenarioError in plain words."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import InitErrorDetails, PydanticCustomError

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.wording import described, printable

Place = tuple[str | int, ...]
"""Where a value stands: keys and list indices from the root down."""

EXCHANGED = "are latitude and longitude exchanged?"
"""What is asked of places that would be right the other way round."""
ONLY_LOCAL = "only a scenario file on this machine may name another"
"""Said where a file is named by anything else."""
_KIND = "scenario"  # the type that every fault worded here carries through pydantic
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_Raw = TypeVar("_Raw")
_Read = TypeVar("_Read")


def refusal(path: str, message: str, source: str = "") -> ScenarioError:
    """Return the error of one fault.

    Args:
        path: its place in the input; empty for the input as a whole.
        message: what was given, what is allowed and what to try.
        source: the file or object at fault, as the user would name it.
    """
    return ScenarioError([Fault(path, message)], source)


def require(holds: object, path: str, message: str) -> None:
    """Raise the error of one fault unless a condition holds, as :func:`refusal` words it."""
    if not holds:
        raise refusal(path, message)


def raise_all(faults: Sequence[Fault], source: str = "") -> None:
    """Raise the error of all faults together, if there is any."""
    if faults:
        raise ScenarioError(faults, source)


def key_faults(table: Mapping[str, object], keys: Iterable[str], message: str) -> Iterator[tuple[Place, str]]:
    """Yield a fault for each of some keys that a raw table states."""
    return (((key,), message) for key in keys if table.get(key) is not None)


def call_each(function: Callable[[_Raw], _Read], members: Iterable[_Raw]) -> tuple[list[_Read], list[Fault]]:
    """Call a function with each member; return its values, and the faults that it raises."""
    values, faults = list[_Read](), list[Fault]()
    for member in members:
        try:
            values.append(function(member))
        except ScenarioError as error:
            faults += error.faults
    return values, faults


def rejection(message: str) -> PydanticCustomError:
    """Build the exception with which a validator refuses a value, in exactly these words."""
    # The message travels as context: braces in it (from user text) are then not taken for placeholders.
    return PydanticCustomError(_KIND, "{message}", {"message": message})


def require_value(holds: object, message: str) -> None:
    """Refuse a value in a validator, in exactly these words, unless a condition holds."""
    if not holds:
        raise rejection(message)


def collected(title: str, faults: Iterable[tuple[Place, str]]) -> ValidationError:
    """Return pydantic's exception that carries all the faults together."""
    details = [InitErrorDetails(type=rejection(message), loc=place, input=None) for place, message in faults]
    return ValidationError.from_exception_data(title, details)


def reworded(
    error: ValidationError, fields: Mapping[str, FieldInfo], left_out: Collection[str] = ()
) -> Iterator[tuple[Place, str]]:
    """Yield in plain words what pydantic found in a table.

    Args:
        error: what it found.
        fields: the fields of the table.
        left_out: keys of which it need not be said that they are missing.
    """
    for entry in error.errors(include_url=False):
        place, kind = entry["loc"], entry["type"]
        message = entry["msg"]
        if kind == "missing":
            message = f"missing; it must be given: {(fields[str(place[-1])].description or '').rstrip('.')}"
        elif kind != _KIND:
            message = f"got {described(entry['input'])}, which cannot be used here"
        if kind != "missing" or place[-1] not in left_out:
            yield place, message


def path_of(place: Iterable[str | int]) -> str:
    """Return a place as a person would write it: ``jammers[1].power_w``."""
    words = (f"[{step}]" if isinstance(step, int) else f".{_key(step)}" for step in place)
    return "".join(words).removeprefix(".")


def _key(step: str) -> str:
    return printable(step) if _BARE_KEY.fullmatch(step) else f'"{printable(step)}"'


def scenario_error(error: ValidationError, data: object, source: str = "") -> ScenarioError:
    """Convert errors of pydantic to a ScenarioError, its faults in the order of the input.

    Args:
        error: what pydantic collected, already in plain words.
        data: the input that was judged.
        source: the file or object at fault, as the user would name it.
    """
    found = sorted(error.errors(include_url=False), key=lambda entry: _ranks(entry["loc"], data))
    alike = [entry for entry in found if EXCHANGED in entry["msg"]]  # likely of all places: told once
    listed = [entry for entry in found if entry not in alike[1:]]
    more = f" (and so in {len(alike) - 1} more)" if alike[1:] else ""
    return ScenarioError(
        [Fault(path_of(entry["loc"]), entry["msg"] + (more if entry in alike else "")) for entry in listed],
        source,
    )


def _ranks(place: Place, data: Any) -> list[int]:
    """Rank each step of a place among its siblings in the input."""
    ranks = []
    for step in place:
        # a range looks itself up at once, however long it is
        places = range(len(data)) if isinstance(data, list | tuple) else range(0)
        keys: Sequence[object] = list(data) if isinstance(data, Mapping) else places
        ranks.append(keys.index(step) if step in keys else len(keys))
        data = data[step] if step in keys else ()
    return ranks
