"""JSON that any parser reads."""

import json
import math
from types import MappingProxyType

from nullpose.report.plain import json_text


def test_numbers_that_json_lacks_become_null() -> None:
    """NaN and both infinities are null, wherever they are."""
    value = MappingProxyType({"a": [math.nan, {"b": (math.inf, -math.inf, 1.5)}], "c": None, "d": True})
    assert json.loads(json_text(value)) == {"a": [None, {"b": [None, None, 1.5]}], "c": None, "d": True}


def test_text_is_plain_ascii_and_reads_back() -> None:
    """Any terminal can print it, and names come back whole."""
    text = json_text({"name": "Čáp 駅"})
    assert text.isascii()
    assert json.loads(text) == {"name": "Čáp 駅"}
