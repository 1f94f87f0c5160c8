"""The number formats that every report shares."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, Context, Decimal
from typing import TYPE_CHECKING

from nullpose.objectives import Quantity

if TYPE_CHECKING:
    from nullpose.solver import Objective

MINUS = "\N{MINUS SIGN}"
NONE = "\N{EN DASH}"
_UNITS = {"w": "W", "dbm": "dBm", "db": "dB", "hz": "Hz", "m": "m", "deg": "degrees", "m2": "per m²"}
_KEY_WORDS = {
    "noise_w": "noise power",
    "noise_dbm": "noise power",
    "noise_figure_db": "noise figure",
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


def capitalised(text: str) -> str:
    """Give a text a capital letter first, and leave its other letters as they are."""
    return text[:1].upper() + text[1:]


def rounded_up(number: float, digits: int = 2) -> str:
    """Round a number up to so many significant digits; small and large ones are written as in ``1e-6``."""
    exact = Decimal(f"{number:.9g}")  # what is behind the ninth digit is rounding
    rounded = float(Context(prec=digits, rounding=ROUND_CEILING).plus(exact))
    text = f"{rounded:.{digits - 1}e}" if 0.0 < abs(rounded) <= 1e-3 else f"{rounded:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    return f"{float(mantissa):g}e{int(exponent)}" if exponent else mantissa


def number(value: float, quantity: Quantity | None = None) -> str:
    """Write decibels with two decimals, a rate with three digits, and a dash for no number."""
    if math.isnan(value):
        return NONE
    text = f"{value:z.3g}" if quantity is not None and quantity.is_rate else f"{value:z.2f}"
    return text.replace("-", MINUS).replace("inf", "\N{INFINITY}")


def with_unit(value: float, quantity: Quantity) -> str:
    """Write a number with its unit, for a sentence."""
    return f"{number(value, quantity)} {quantity.unit}"


def value_words(objective: Objective) -> str:
    """Write the objective's value, as in ``0.98 dB (1.25)`` or ``2.1 bits/s/Hz (42 Mbit/s)``."""
    quantity, value = objective.quantity, objective.value
    words = f"{round(quantity.in_unit(value), 7):.7g} {quantity.unit}"
    rate = "" if objective.value_mbps is None else f" ({round(objective.value_mbps, 7):.7g} Mbit/s)"
    return f"{words}{rate}" if quantity.is_rate else f"{words} ({value:.7g})"


def bound_words(objective: Objective) -> str:
    """Write the bound and the gap, nothing if nothing is proved."""
    if objective.upper_bound is None or objective.relative_gap is None:
        return ""
    unit, factor = objective.quantity.unit, objective.quantity.mbps
    rate = "" if factor is None else f"{bound_text(objective, factor=factor)} Mbit/s; "
    return f"upper bound {bound_text(objective)} {unit} ({rate}relative gap {objective.relative_gap:.1e})"


def bound_text(objective: Objective, digits: int = 0, factor: float = 1.0) -> str:
    """Round the bound up to so many decimals of its unit; 0 for as many as tell it from the value.

    Args:
        objective: with its bound.
        digits: how many decimals.
        factor: of another unit, such as Mbit/s, to the quantity's.
    """
    if objective.upper_bound is None:
        return "-"
    quantity = objective.quantity
    if not math.isfinite(bound := factor * quantity.in_unit(objective.upper_bound)):
        return number(bound, quantity)
    if not digits:
        apart = min(max(bound - factor * quantity.in_unit(objective.value), 1e-12), 1.0)
        digits = min(12, max(2, math.ceil(-math.log10(apart)) + 1))
    return f"{math.ceil(bound * 10**digits) / 10**digits:.{digits}f}"


def unit_of(path: str) -> str:
    """Read the unit of a setting off the end of its name, as in ``power_w``; nothing if it has none."""
    leaf = path.rsplit(".", 1)[-1].split("[", 1)[0]
    return _UNITS.get(leaf.rsplit("_", 1)[-1].lower(), "") if "_" in leaf else ""


def axis_label(path: str) -> str:
    """Name a swept setting such as ``jammers.M.power_w`` in words: ``Power of jammer M (W)``."""
    *tables, leaf = path.split(".")
    key, _, place = leaf.partition("[")
    unit = unit_of(path)
    words = _KEY_WORDS.get(key) or (key.rpartition("_")[0] if unit else key)
    part = _PARTS.get((key, place[:1]), "")
    group = tables[0].partition("[")[0].removesuffix("s") if tables else ""
    whose = " ".join((group, *tables[1:])) if len(tables) > 1 else group and f"the {group}"
    label = capitalised(f"{words} of {whose}" if whose else words).replace("_", " ") + part
    return f"{label} ({unit})" if unit else label


def percent(share: float, digits: int = 0) -> str:
    """Write a share in per cent, never rounded to all or nothing unless it is."""
    if math.isnan(share):
        return NONE
    text, step = f"{100.0 * share:.{digits}f}", 10.0**-digits
    if float(text) == 0.0 and share > 1e-12:
        return f"under {step:g} %"
    if float(text) == 100.0 and share < 1.0 - 1e-9:
        text = f"{100.0 - step:.{digits}f}"
    return f"{text} %".replace("-", MINUS)
