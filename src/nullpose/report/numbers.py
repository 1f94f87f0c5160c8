"""Numbers as every report writes them."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, Context, Decimal
from typing import TYPE_CHECKING

from nullpose.objectives import Quantity

if TYPE_CHECKING:
    from nullpose.solver import Objective

MINUS = "\N{MINUS SIGN}"
_UNITS = {"w": "W", "dbm": "dBm", "db": "dB", "hz": "Hz", "m": "m", "deg": "degrees", "m2": "per m²"}
_KEY_WORDS = {
    "noise_w": "noise power",
    "noise_dbm": "noise power",
    "min_sinr_db": "required SINR",
    "keep_out_m": "keep-out radius",
    "tilt_max_deg": "largest tilt",
    "mount_deg": "angle of the dipole",
    "null_depth_db": "depth of the null",
    "frequency_hz": "carrier frequency",
    "reference_gain_db": "path gain at 1 m",
    "spacing_wavelengths": "spacing in wavelengths",
    "uncertainty_m": "uncertainty of the position",
}
_PARTS = {("position_m", str(i)): f", {name}" for i, name in enumerate(("east", "north", "up"))}
_PARTS |= {("altitude_m", "0"): ", lowest", ("altitude_m", "1"): ", highest"}
NONE = "\N{EN DASH}"


def begun(text: str) -> str:
    """Return a text with a capital letter first.

    Args:
        text: may be empty.
    """
    return text[:1].upper() + text[1:]


def fixed(value: float, digits: int) -> str:
    """Return a number with so many decimals, without the sign of a zero.

    Args:
        value: any number.
        digits: how many decimals.
    """
    return f"{value:z.{digits}f}"


def stated(value: float | None, digits: str) -> str | None:
    """Return a number as a cell of a table; None, which is no cell, if it is not stated.

    Args:
        value: the number.
        digits: its format, as in ``.6g``.
    """
    return None if value is None else format(value, digits)


def degrees_text(angle_rad: float, digits: int = 2) -> str:
    """Return an angle in degrees.

    Args:
        angle_rad: the angle, radians.
        digits: how many decimals.
    """
    return fixed(math.degrees(angle_rad), digits)


def short(number: float) -> str:
    """Return a number rounded up to two digits, small and large ones as in ``1e-6``.

    Args:
        number: at least 0.
    """
    mantissa, _, exponent = at_most(number).partition("e")
    if 0.0 < number <= 1e-3:
        mantissa, _, exponent = f"{float(at_most(number)):.1e}".partition("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}" if exponent else mantissa


def at_most(number: float, digits: int = 2) -> str:
    """Return a number rounded up to so many significant digits.

    Args:
        number: any.
        digits: how many.
    """
    known = Decimal(f"{number:.9g}")  # what is behind the ninth digit is rounding
    return f"{float(Context(prec=digits, rounding=ROUND_CEILING).plus(known)):.{digits}g}"


def number(value: float, quantity: Quantity | None = None) -> str:
    """Return a number of decibels with two decimals, or of a rate with three digits; a dash if there is none.

    Args:
        value: the number.
        quantity: whose it is; None for one in decibels.
    """
    if math.isnan(value):
        return NONE
    text = f"{value:z.3g}" if quantity is not None and quantity.is_rate else f"{value:z.2f}"
    return text.replace("-", MINUS).replace("inf", "\N{INFINITY}")


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
        return NONE
    text = f"{100.0 * share:.{digits}f}"
    step = 10.0**-digits
    if float(text) == 100.0 and share < 1.0 - 1e-9:
        text = f"{100.0 - step:.{digits}f}"
    if float(text) == 0.0 and share > 1e-12:
        return f"under {step:g} %"
    return f"{text} %".replace("-", MINUS)


def listed(parts: list[str]) -> str:
    """Return parts as a list in a sentence, with "and" before the last.

    Args:
        parts: at least one.
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def less_or_more(difference: float, quantity: Quantity) -> str:
    """Return a difference in words, as in ``0.03 dB less`` or ``under 0.01 dB more``.

    Args:
        difference: in the quantity's unit.
        quantity: whose it is.
    """
    size = with_unit(abs(difference), quantity)
    if not quantity.is_rate and abs(difference) < 0.01:
        size = f"under 0.01 {quantity.unit}"
    return f"{size} {'less' if difference <= 0.0 else 'more'}"


def count_of(count: int, noun: str, nouns: str = "") -> str:
    """Return a count with its noun, thousands apart, as in "2,000 scenes".

    Args:
        count: how many.
        noun: of one.
        nouns: of several, if it is not formed with an s.
    """
    return f"{count:,} {noun if count == 1 else nouns or noun + 's'}"


def value_words(objective: Objective) -> str:
    """Return the objective's value in words, as in ``0.98 dB (1.25)``.

    Args:
        objective: value and bound.
    """
    quantity, value = objective.quantity, objective.value
    told = f"{quantity.in_unit(value):.7g} {quantity.unit}"
    return told if quantity.is_rate else f"{told} ({value:.7g})"


def bound_words(objective: Objective) -> str:
    """Return the bound and the gap in words, empty if nothing is proved.

    Args:
        objective: value and bound.
    """
    if objective.upper_bound is None or objective.relative_gap is None:
        return ""
    unit = objective.quantity.unit
    return f"upper bound {bound_text(objective)} {unit} (relative gap {objective.relative_gap:.1e})"


def bound_text(objective: Objective, digits: int = 0) -> str:
    """Return the bound in its unit, rounded up; a dash if nothing is proved.

    Args:
        objective: value and bound.
        digits: decimals; 0 for as many as tell the bound from the value.
    """
    if objective.upper_bound is None:
        return "-"
    quantity = objective.quantity
    bound = quantity.in_unit(objective.upper_bound)
    if not math.isfinite(bound):
        return number(bound, quantity)
    if not digits:
        apart = min(max(bound - quantity.in_unit(objective.value), 1e-12), 1.0)
        digits = min(12, max(2, math.ceil(-math.log10(apart)) + 1))
    return f"{math.ceil(bound * 10**digits) / 10**digits:.{digits}f}"


def escaped(text: str) -> str:
    """Return a text that Markdown shows as it is.

    Args:
        text: a title, a name or a reason, on one line.
    """
    return "".join(f"\\{letter}" if letter in "\\`*|<>[]#$" else letter for letter in " ".join(text.split()))


def unit_of(path: str) -> str:
    """Return the unit of a setting by the end of its name, as in ``power_w``; empty if it has none.

    Args:
        path: of the setting.
    """
    leaf = path.rsplit(".", 1)[-1].split("[", 1)[0]
    return _UNITS.get(leaf.rsplit("_", 1)[-1].lower(), "") if "_" in leaf else ""


def axis_label(path: str) -> str:
    """Return what an axis of a swept setting is labelled, as in ``Power of jammer M  (W)``.

    Args:
        path: of the setting, as in ``jammers.M.power_w``.
    """
    *tables, leaf = path.split(".")
    key, _, place = leaf.partition("[")
    unit, words = unit_of(path), _KEY_WORDS.get(key, "")
    if not words:
        words = key.rpartition("_")[0] if unit else key
    part = _PARTS.get((key, place[:1]), "")
    group = tables[0].partition("[")[0].removesuffix("s") if tables else ""
    whose = " ".join((group, *tables[1:])) if len(tables) > 1 else group and f"the {group}"
    label = begun(f"{words} of {whose}" if whose else words).replace("_", " ") + part
    return f"{label}  ({unit})" if unit else label
