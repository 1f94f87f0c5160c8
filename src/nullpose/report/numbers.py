"""The number formats that every report shares, and how many decimals a pose needs to be typed again."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import ROUND_CEILING, Context, Decimal
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.scenario import Scenario
from nullpose.study.evaluation import pose_faults

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


METRES, DEGREES, COMPONENTS = 4, 3, 6
"""The fewest decimals of a position in metres, of angles in degrees, and of components of unit length."""
_MOST = 10


def more_decimals(scenario: Scenario, pose: Pose) -> int:
    """Count the decimals beyond the fewest with which a printed pose is worth the printed value.

    Near a deep null or on a border they are more than elsewhere. Typed are the position with the attitude,
    which must be allowed if the pose is, and with the axis as angles or as a vector.

    Args:
        scenario: what the pose is evaluated in; with an array none are counted.
        pose: as reported.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> more_decimals(scenario, nullpose.Pose([0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=-0.5))
        2
    """
    if scenario.array is not None:
        return 0
    quantity, is_allowed = Quantity.of(scenario), not any(pose_faults(scenario, pose))

    def value(typed: Pose) -> float:
        return quantity.in_unit(objective_of_links(scenario, evaluate(scenario, typed)))

    exact = value(pose)
    last_digit = 10.0 ** (math.floor(math.log10(min(max(abs(exact), 0.1), 1e9))) - 6)  # of seven
    for more in range(_MOST):
        attitude, *axes = _typed(scenario, pose, more)
        is_off = any(abs(value(each) - exact) > 0.5 * last_digit for each in (attitude, *axes))
        if not (is_off or (is_allowed and any(pose_faults(scenario, attitude)))):
            return more
    return _MOST


def _typed(scenario: Scenario, pose: Pose, more: int) -> Iterator[Pose]:
    """Yield a pose with so many more decimals: by its attitude, then by its axis where that is all."""
    position_m, axis = (
        np.round(pose.position_m, METRES + more),
        np.round(pose.antenna_axis, COMPONENTS + more),
    )
    angles = [pose.roll_rad, pose.pitch_rad, pose.yaw_rad, tilt_rad(pose), azimuth_rad(pose)]
    roll, pitch, yaw, tilt, azimuth = np.radians(np.round(np.degrees(angles), DEGREES + more)).tolist()
    yield Pose(position_m, roll, pitch, yaw, pose.mount_rad)
    if scenario.antenna_record.is_quadratic:
        yield Pose.from_axis(position_m, axis)
        level = math.sin(tilt)
        yield Pose.from_axis(
            position_m, (level * math.cos(azimuth), level * math.sin(azimuth), math.cos(tilt))
        )
