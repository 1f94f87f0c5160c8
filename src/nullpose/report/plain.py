"""Results as JSON text that any parser reads."""

from __future__ import annotations

import json


def json_text(value: object, indent: int | None = 2) -> str:
    """Return a value as JSON in ASCII; what JSON has no number for (NaN, infinities) becomes null.

    Args:
        value: mappings, sequences, texts, numbers, truth values and None, nested at will.
        indent: blanks by which each level is indented; None for all on one line.
    """
    read_back = json.loads(json.dumps(value, default=dict), parse_constant=lambda _: None)
    return json.dumps(read_back, indent=indent)
