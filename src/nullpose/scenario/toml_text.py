"""A scenario's values as the text of a TOML file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

__all__ = ["toml_text", "toml_value"]


def toml_text(scenario: Mapping[str, object]) -> str:
    """Returns the TOML text of plain values nested as in a scenario file: keys, tables, lists of tables."""
    return "\n\n".join(_blocks("", "", scenario)) + "\n"


def _blocks(header: str, path: str, values: Mapping[str, object]) -> Iterator[str]:
    """Yields a table's own keys under its header, then the tables inside it under theirs."""
    tables = {key: value for key, value in values.items() if _holds_tables(value)}
    own = [f"{key} = {toml_value(value)}" for key, value in values.items() if key not in tables]
    yield "\n".join([*([header] if header else []), *own])
    for key, value in tables.items():
        inner = f"{path}.{key}" if path else key
        if isinstance(value, Mapping):
            yield from _blocks(f"[{inner}]", inner, value)
        elif isinstance(value, Sequence):
            for member in value:
                yield from _blocks(f"[[{inner}]]", inner, member)


def _holds_tables(value: object) -> bool:
    if isinstance(value, str) or not isinstance(value, Sequence):
        return isinstance(value, Mapping)
    return len(value) == 0 or isinstance(value[0], Mapping)


def toml_value(value: object) -> str:
    """Returns one text, number or list in TOML."""
    if isinstance(value, str):
        # JSON's texts are TOML's too, but for the delete character, which TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(toml_value(member) for member in value)}]"
    return repr(value)
