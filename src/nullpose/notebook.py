"""What a notebook shows and works with: tables in HTML, and data frames of pandas, which is optional."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib import import_module
from typing import Any

from nullpose.errors import UsageError

_MOST_ROWS = 40


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
    body = "".join(f"<tr>{''.join(map(_cell, row.values()))}</tr>" for row in rows[:_MOST_ROWS])
    below = "".join(f"<p>{escape(note)}</p>" for note in (*more, *notes))
    return f"<table><caption>{escape(title)}</caption><tr>{head}</tr>{body}</table>{below}"


def _cell(value: object) -> str:
    text = "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"<td>{escape(text)}</td>"
