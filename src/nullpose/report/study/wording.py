"""Numbers of a study as its report writes them."""

from __future__ import annotations

import math

from nullpose.physics.quantity import Quantity

__all__ = ["count_of", "escaped", "listed", "number", "percent", "span", "with_interval", "with_unit"]

_MINUS = "\N{MINUS SIGN}"
_NONE = "\N{EN DASH}"


def number(value: float, quantity: Quantity | None = None) -> str:
    """Return a number of decibels with two decimals, or of a rate with three digits; a dash if there is none.

    Args:
        value: the number.
        quantity: whose it is; None for one in decibels.
    """
    if math.isnan(value):
        return _NONE
    if math.isinf(value):
        return "\N{INFINITY}" if value > 0.0 else f"{_MINUS}\N{INFINITY}"
    text = f"{value:.3g}" if quantity is not None and quantity.is_rate else f"{value:.2f}"
    if float(text) == 0.0:
        text = text.removeprefix("-")
    return text.replace("-", _MINUS)


def with_unit(value: float, quantity: Quantity) -> str:
    """Return a number with its unit, for a sentence.

    Args:
        value: the number.
        quantity: whose it is.
    """
    return f"{number(value, quantity)} {quantity.unit}"


def span(low: float, high: float, quantity: Quantity | None = None) -> str:
    """Return an interval, as in "3.9 to 4.3"; an end that is not known is a dash.

    Args:
        low: its lower end.
        high: its upper end.
        quantity: whose it is; None for decibels.
    """
    return f"{number(low, quantity)} to {number(high, quantity)}"


def with_interval(value: float, low: float, high: float, quantity: Quantity | None = None) -> str:
    """Return a number with its interval, as in "4.10 (3.90 to 4.30)"; without, if neither end is known.

    Args:
        value: the number.
        low: the interval's lower end.
        high: its upper end.
        quantity: whose it is; None for decibels.
    """
    if math.isnan(low) and math.isnan(high):
        return number(value, quantity)
    return f"{number(value, quantity)} ({span(low, high, quantity)})"


def percent(share: float, digits: int = 0) -> str:
    """Return a share in per cent, never rounded to all or nothing unless it is.

    Args:
        share: 1 for all.
        digits: decimals.
    """
    if math.isnan(share):
        return _NONE
    text = f"{100.0 * share:.{digits}f}"
    step = 10.0**-digits
    if float(text) == 100.0 and share < 1.0 - 1e-9:
        text = f"{100.0 - step:.{digits}f}"
    if float(text) == 0.0 and share > 1e-12:
        return f"under {step:g} %"
    return f"{text} %".replace("-", _MINUS)


def count_of(count: int, noun: str) -> str:
    """Return a count with its noun, thousands apart, as in "2,000 scenes".

    Args:
        count: how many.
        noun: of one.
    """
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def listed(parts: list[str]) -> str:
    """Return parts as a list in a sentence, with "and" before the last.

    Args:
        parts: at least one.
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def escaped(text: str) -> str:
    """Return a text that Markdown shows as it is.

    Args:
        text: a title, a name or a reason, on one line.
    """
    return "".join(f"\\{letter}" if letter in "\\`*|<>[]#$" else letter for letter in " ".join(text.split()))
