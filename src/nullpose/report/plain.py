"""Results as JSON text that any parser reads."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping

__all__ = ["json_text"]


def _standard(value: object) -> object:
    if isinstance(value, Mapping):
        return {str(key): _standard(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_standard(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_text(value: object, indent: int | None = 2) -> str:
    """Return a value as JSON in ASCII; what JSON has no number for (NaN, infinities) becomes null.

    Args:
        value: mappings, sequences, texts, numbers, truth values and None, nested at will.
        indent: blanks by which each level is indented; None for all on one line.
    """
    return json.dumps(_standard(value), indent=indent, allow_nan=False)
