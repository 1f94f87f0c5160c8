"""Words for what was given."""

import datetime

import numpy as np
import pytest

from nullpose.scenario.wording import described, nearest


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "nothing"),
        (True, "the truth value true"),
        (-1, "-1"),
        (0.1, "0.1"),
        (float("nan"), "NaN"),
        (float("-inf"), "minus infinity"),
        (10**5000, "an integer beyond 1e+15"),
        (-(10**5000), "an integer beyond -1e+15"),
        ("", "an empty text"),
        ("a\tb\x1b[0m", 'the text "a\\tb\\x1b[0m"'),
        ("x" * 41, f'the text "{"x" * 37}..."'),
        ([], "an empty list"),
        ((1,), "a list of one value"),
        ([1, 2], "a list of 2 values"),
        ({"a": 1}, "a table"),
        (datetime.date(2024, 1, 1), "a date or time"),
        (np.float64(0.5), "0.5"),
        (np.zeros(2), "a list of 2 values"),
        (3j, "an object of type complex"),
    ],
    ids=lambda item: item if isinstance(item, str) else "",
)
def test_described(value: object, words: str) -> None:
    """Each kind of value is described in plain words, on one line and shortly."""
    assert described(value) == words


def test_nearest() -> None:
    """The most similar word is found whatever its case; nothing is suggested for what is like no other."""
    known = ["power_w", "power_dbm", "position_m"]
    assert nearest("POWER", known) == "power_w"
    assert nearest("power_db", known) == "power_dbm"
    assert nearest("zzz", known) == ""
    assert nearest("power_w", []) == ""
