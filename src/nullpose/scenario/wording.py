"""The words that describe what was given, and the known word nearest to an unknown one."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from datetime import date, time
from difflib import SequenceMatcher

import numpy as np

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
