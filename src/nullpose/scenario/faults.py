"""How faults are stated: where they are, what was given there, and which known word was perhaps meant."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from datetime import date, time
from difflib import SequenceMatcher
from typing import Any, TypeVar

import numpy as np
from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import InitErrorDetails, PydanticCustomError

from nullpose.errors import Fault, ScenarioError

_LONGEST_QUOTE = 40  # characters of a given text that a message repeats
_LONGEST_WORD = 100  # characters of a word that is repeated, or compared with others
_LIKE_ENOUGH = 0.5  # similarity from which a known word is worth suggesting
# how a number is converted from the unit of an unknown key, by what such a key has in it
_CONVERSIONS = {
    r"dbm_?(per_?)?hz|densit": "to a density in dBm/Hz add 10 log10(bandwidth in Hz), or state "
    "bandwidth_hz and noise_figure_db",
    r"eirp": "an EIRP is a power_dbm or power_w without gain_dbi",
    r"erp(_|$)": "an ERP is a power_dbm without gain_dbi, 2.15 dB more",
    r"dbw$": "0 dBW is 30 dBm",
    r"dbd$": "0 dBd is 2.15 dBi",
    r"_(ft|feet)$": "1 ft is 0.3048 m",
    r"_km$": "1 km is 1000 m",
    r"_(nm|nmi)$": "1 nautical mile is 1852 m",
    r"_mi(les?)?$": "1 mile is 1609.344 m",
    r"_mw$": "1 mW is 1e-3 W, or 0 dBm",
    r"_kw$": "1 kW is 1e3 W, or 60 dBm",
    r"_khz$": "1 kHz is 1e3 Hz",
    r"_mhz$": "1 MHz is 1e6 Hz",
    r"_ghz$": "1 GHz is 1e9 Hz",
    r"_rad$": "1 rad is 57.29578 degrees",
    r"uncertainty_attitude": "uncertainty_m is the radius of a ball, which has no attitude",
}


def plain(value: object) -> object:
    """Return the Python value behind a numpy scalar or array; other values pass unchanged."""
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def value_of(table: object, key: str) -> Any:
    """Return a value of a table, raw or not; None where it has none, or is no table."""
    return table.get(key) if isinstance(table, Mapping) else getattr(table, key, None)


def described(value: object) -> str:
    """Put a given value into words: ``the text "abc"``, ``NaN``, ``a list of 2 values``."""
    match plain(value):
        case None:
            return "nothing"
        case bool(truth):
            return f"the truth value {str(truth).lower()}"
        case float(number):
            return {"nan": "NaN", "inf": "infinity", "-inf": "minus infinity"}.get(repr(number), repr(number))
        case int(number):
            # Very long integers cannot be printed in decimal by default, and nobody would read them.
            return str(number) if abs(number) < 10**15 else f"an integer beyond {'-' * (number < 0)}1e+15"
        case str(text):
            shown = text if len(text) <= _LONGEST_QUOTE else text[: _LONGEST_QUOTE - 3] + "..."
            return f'the text "{printable(shown)}"' if text else "an empty text"
        case list() | tuple() as values:
            return {0: "an empty list", 1: "a list of one value"}.get(
                len(values), f"a list of {len(values)} values"
            )
        case Mapping():
            return "a table"
        case date() | time():
            return "a date or time"
    return f"an object of type {type(value).__name__}"


def printable(text: str) -> str:
    """Return the text with control characters written as escapes; of a very long one the beginning."""
    shown = text if len(text) <= _LONGEST_WORD else f"{text[: _LONGEST_WORD - 3]}..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in shown)


def nearest(word: str, words: Collection[str]) -> str:
    """Return the known word most like the given one, or an empty text when none is like it.

    Args:
        word: what was given.
        words: the words to choose from.
    """

    def similarity(candidate: str) -> float:
        return SequenceMatcher(None, word[:_LONGEST_WORD].casefold(), candidate.casefold()).ratio()

    best = max(words, key=similarity, default="")
    return best if best and similarity(best) >= _LIKE_ENOUGH else ""


def suggestion(word: object, words: Collection[str]) -> str:
    """Ask whether the known word nearest to an unknown one is meant; empty where none is like it."""
    guess = nearest(word, words) if isinstance(word, str) else ""
    return f'; did you mean "{guess}"?' if guess else ""


def unknown(noun: str, word: str, words: Collection[str], likely: Collection[str] = ()) -> str:
    """Word the fault of an unknown word, with the one that may be meant, and how its unit is converted.

    Args:
        noun: what the word is, such as a key.
        word: what was given.
        words: the words to choose from.
        likely: those of them that are the likelier meaning.
    """
    question = suggestion(word, likely) or suggestion(word, words) or ";"
    found = (why for sign, why in _CONVERSIONS.items() if re.search(sign, word[:_LONGEST_WORD].lower()))
    conversion = next((f" {why};" for why in found), "")
    return f"unknown {noun}{question}{conversion} the {noun}s here are {', '.join(words)}"


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


def faults_of(*checks: tuple[object, Place, str]) -> list[tuple[Place, str]]:
    """List place and message of the checks that are true, each of whether something is wrong."""
    return [(place, message) for is_wrong, place, message in checks if is_wrong]


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
