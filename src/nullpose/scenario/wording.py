"""The words that describe what was given, and the known word nearest to an unknown one."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from datetime import date, time
from difflib import SequenceMatcher

import numpy as np

__all__ = ["described", "listed", "nearest", "plain", "printable"]

_LONGEST_QUOTE = 40  # characters of a given text that a message repeats
_LONGEST_WORD = 100  # characters of a word that is repeated, or compared with others
_LIKE_ENOUGH = 0.5  # similarity from which a known word is worth suggesting


def plain(value: object) -> object:
    """Returns the Python value behind a numpy scalar or array; other values pass unchanged."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return value


def described(value: object) -> str:
    """Returns a given value in words: ``the text "abc"``, ``NaN``, ``a list of 2 values``."""
    value = plain(value)
    match value:
        case None:
            return "nothing"
        case bool():
            return f"the truth value {str(value).lower()}"
        case int() | float():
            return _number(value)
        case str():
            shown = value if len(value) <= _LONGEST_QUOTE else value[: _LONGEST_QUOTE - 3] + "..."
            return "an empty text" if not value else f'the text "{printable(shown)}"'
        case list() | tuple():
            sizes = {0: "an empty list", 1: "a list of one value"}
            return sizes.get(len(value), f"a list of {len(value)} values")
        case Mapping():
            return "a table"
        case date() | time():
            return "a date or time"
        case _:
            return f"an object of type {type(value).__name__}"


def _number(value: float) -> str:
    if isinstance(value, float):
        if math.isnan(value):
            return "NaN"
        if math.isinf(value):
            return "infinity" if value > 0 else "minus infinity"
        return repr(value)
    # Very long integers cannot be printed in decimal by default, and nobody would read them.
    return str(value) if abs(value) < 10**15 else f"an integer beyond {'-' if value < 0 else ''}1e+15"


def printable(text: str) -> str:
    """Returns the text with control characters written as escapes; of a very long one the beginning."""
    shown = text if len(text) <= _LONGEST_WORD else f"{text[: _LONGEST_WORD - 3]}..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in shown)


def listed(words: Collection[str]) -> str:
    """Returns the words joined by commas."""
    return ", ".join(words)


def nearest(word: str, known: Collection[str], at_least: float = _LIKE_ENOUGH) -> str:
    """Returns the known word most like the given one, or an empty text when none is like it.

    Args:
        word: what was given.
        known: the words to choose from.
        at_least: similarity in [0, 1] below which nothing is suggested.
    """

    def similarity(candidate: str) -> float:
        return SequenceMatcher(None, word[:_LONGEST_WORD].casefold(), candidate.casefold()).ratio()

    best = max(known, key=similarity, default="")
    return best if best and similarity(best) >= at_least else ""
