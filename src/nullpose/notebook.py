"""Tables for notebooks by pandas, which is optional."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from types import ModuleType

from nullpose.errors import UsageError, install_command

_MOST_ROWS = 40


def imported(package: str) -> ModuleType:
    """Import an optional package, as in ``pandas``.

    Raises:
        UsageError: it is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        remedy = f"pip install {package}, or {install_command('study')}"
        raise UsageError(f"{package}: not installed here; try: {remedy}") from None


def html_table(rows: Sequence[Mapping[str, object]]) -> str | None:
    """Set rows as pandas does; None without pandas, so that a notebook shows the plain text."""
    try:
        table = imported("pandas").DataFrame(rows)
    except UsageError:
        return None
    return str(table.to_html(index=False, na_rep="", max_rows=_MOST_ROWS))
