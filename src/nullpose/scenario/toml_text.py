"""A scenario's values as the text of a TOML file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

__all__ = ["toml_text", "toml_value"]


def toml_text(scenario: Mapping[str, object]) -> str:
    """Returns the TOML text of plain values nested as in a scenario file: keys, tables, lists of tables."""
    keys, tables = [], []
    for key, value in scenario.items():
        if isinstance(value, Mapping):
            tables.append(_table(f"[{key}]", value))
        elif isinstance(value, Sequence) and not isinstance(value, str):
            tables += [_table(f"[[{key}]]", member) for member in value]
        else:
            keys.append(f"{key} = {toml_value(value)}")
    return "\n\n".join(["\n".join(keys), *tables]) + "\n"


def _table(header: str, values: Mapping[str, object]) -> str:
    return "\n".join([header, *(f"{key} = {toml_value(value)}" for key, value in values.items())])


def toml_value(value: object) -> str:
    """Returns one text, number or list in TOML."""
    if isinstance(value, str):
        # JSON's texts are TOML's too, but for the delete character, which TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(toml_value(member) for member in value)}]"
    return repr(value)
