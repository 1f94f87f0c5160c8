"""A scenario's values as the text of a TOML file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any


def toml_text(scenario: Mapping[str, object]) -> str:
    """Returns the TOML text of plain values nested as in a scenario file: keys, tables, lists of tables."""
    return "\n\n".join(_blocks([], "", scenario)) + "\n"


def _blocks(header: list[str], path: str, values: Mapping[str, object]) -> Iterator[str]:
    """Yields a table's own keys under its header, then the tables inside it under theirs."""
    tables = {key: _tables(value) for key, value in values.items()}
    yield "\n".join(header + [f"{key} = {toml_value(values[key])}" for key in values if tables[key] is None])
    for key, inner in tables.items():
        name = f"{path}.{key}".removeprefix(".")
        is_alone = isinstance(values[key], Mapping)
        for table in inner or ():
            yield from _blocks([f"[{name}]" if is_alone else f"[[{name}]]"], name, table)


def _tables(value: Any) -> Sequence[Mapping[str, object]] | None:
    """Returns the tables that a value is, one or a list of them; None if it is a value of another kind."""
    if isinstance(value, Mapping):
        return [value]
    is_list = isinstance(value, Sequence) and not isinstance(value, str)
    return value if is_list and all(isinstance(member, Mapping) for member in value) else None


def toml_value(value: object) -> str:
    """Returns one text, number or list in TOML."""
    if isinstance(value, str):
        # JSON's texts are TOML's too, but for the delete character, which TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(toml_value(member) for member in value)}]"
    return repr(value)
