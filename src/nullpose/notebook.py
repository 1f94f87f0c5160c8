"""What a notebook shows and works with: tables in HTML and text; data frames of pandas, which is optional."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib import import_module
from typing import Any

from nullpose.errors import UsageError

_MOST_ROWS, _MOST_LINES = 40, 10


def imported(package: str) -> Any:
    """Return an optional package.

    Args:
        package: its name, as in ``pandas``.

    Raises:
        UsageError: it is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        told = f"{package}: not installed here; try: pip install {package}, or pip install 'nullpose[study]'"
        raise UsageError(told) from None


def html_table(title: str, rows: Sequence[Mapping[str, object]], notes: Iterable[str] = ()) -> str:
    """Return rows as a table in HTML; of more than 40 the first.

    Args:
        title: stands above it.
        rows: cells by heading, numbers or texts; the first has every heading.
        notes: stand below it.
    """
    more = [f"{len(rows) - _MOST_ROWS} more rows"] if len(rows) > _MOST_ROWS else []
    head = "".join(f"<th>{escape(name)}</th>" for name in (rows[0] if rows else ()))
    cells = ((f"<td>{escape(_text(value))}</td>" for value in row.values()) for row in rows[:_MOST_ROWS])
    body = "".join(f"<tr>{''.join(row)}</tr>" for row in cells)
    below = "".join(f"<p>{escape(note)}</p>" for note in (*more, *notes))
    return f"<table><caption>{escape(title)}</caption><tr>{head}</tr>{body}</table>{below}"


def text_table(title: str, rows: Sequence[Mapping[str, object]]) -> str:
    """Return rows as a table in plain text; of more than 10 the first.

    Args:
        title: stands above it.
        rows: cells by heading, numbers or texts; at least one.
    """
    lines = [list(rows[0]), *([_text(value) for value in row.values()] for row in rows[:_MOST_LINES])]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    table = ["  ".join(map(str.rjust, line, widths)) for line in lines]
    more = [f"{len(rows) - _MOST_LINES} more rows; .frame() has all"] if len(rows) > _MOST_LINES else []
    return "\n".join([title, *table, *more])


def _text(value: object) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return "" if value is None else str(value)
