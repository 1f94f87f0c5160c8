"""Texts of a study as its report writes them."""

from __future__ import annotations

__all__ = ["count_of", "escaped"]


def count_of(count: int, noun: str) -> str:
    """Return a count with its noun, thousands apart, as in "2,000 scenes".

    Args:
        count: how many.
        noun: of one.
    """
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def escaped(text: str) -> str:
    """Return a text that Markdown shows as it is.

    Args:
        text: a title, a name or a reason, on one line.
    """
    return "".join(f"\\{letter}" if letter in "\\`*|<>[]#$" else letter for letter in " ".join(text.split()))
