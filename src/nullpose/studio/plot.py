"""The live Figure 2: the schemes' values against the jamming power, as a drawing inside the page (SVG)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from nullpose.problem.schemes import Scheme
from nullpose.report.figures.style import CURVES, curve_of
from nullpose.report.numbers import MINUS
from nullpose.studio.answer import PowerCurve
from nullpose.studio.look import either, lit, round_steps
from nullpose.studio.readout import macros
from nullpose.studio.state import POWER_DB

_LEFT, _RIGHT, _TOP, _BOTTOM = 42, 332, 30, 180  # as in the template
_MOST_SPAN = 30.0
RING = either("#d55e00", "#ff8a3c")
"""Colour of the ring at the present value."""

_Points = list[tuple[float, float]]


class _ValueRange(NamedTuple):
    """The values at the lower and the upper edge of the drawing."""

    low: float
    high: float

    def at(self, power_db: float, value: float) -> tuple[float, float]:
        """Place a power and a value in the drawing, or outside it if they are beyond it."""
        across = (power_db - POWER_DB[0]) / (POWER_DB[1] - POWER_DB[0])
        up = (value - self.low) / (self.high - self.low)
        return _LEFT + across * (_RIGHT - _LEFT), _BOTTOM - up * (_BOTTOM - _TOP)


def power_plot_svg(
    curve: PowerCurve | None, *, version: int, power_db: float | None, value: float | None, unit: str
) -> str:
    """Draw the plot, with a ring at the present power and value; greyed while it is of an older scene.

    It reaches 30 below the largest value, or down to the present one. Curves below it are cut off.
    Where the present power is beyond the drawing there is no ring.

    Args:
        curve: the schemes' values, or None.
        version: the version of the scene now.
        power_db: the jamming power now, dB; None without one.
        value: the present value in the unit shown; None if there is none that is current.
        unit: as in "dB".
    """
    template = macros("plot.svg.jinja")
    if power_db is None:
        return str(template.no_plot())
    lines, now = {} if curve is None else _lines(curve), None
    frame = _frame([y for points in lines.values() for _, y in points], value)
    if POWER_DB[0] <= power_db <= POWER_DB[1]:
        x, y = frame.at(power_db, math.nan if value is None else value)
        now = x, y if math.isfinite(y) else None
    state = (
        "outdated"
        if curve is None or curve.version != version
        else "current"
        if curve.complete
        else "growing"
    )
    powers = [
        (frame.at(tick_db, 0.0)[0], f"{tick_db:g}".replace("-", MINUS))
        for tick_db in np.arange(POWER_DB[0], POWER_DB[1] + 1.0, 10.0)
    ]
    values = [
        (frame.at(0.0, step)[1], f"{step:g}".replace("-", MINUS)) for step in round_steps(*frame, 6)[1:-1]
    ]
    curves = [_curve(scheme, points, frame) for scheme, points in lines.items()]
    return str(template.plot(state, unit, curves, powers, values, now, RING))


def _frame(values: list[float], value: float | None) -> _ValueRange:
    now = [value] if value is not None and math.isfinite(value) else []
    high = max([*values, *now], default=5.0)
    low = min([max(min([*values, *now], default=-5.0), high - _MOST_SPAN), *now])
    margin = max(0.5, 0.08 * (high - low))
    return _ValueRange(low - margin, high + margin)


def _lines(curve: PowerCurve) -> dict[str, _Points]:
    """Return each scheme's powers and values, in the order of the legend."""
    lines: dict[str, _Points] = {scheme: [] for scheme in CURVES}
    for row in curve.table.rows:
        if math.isfinite(value := row.objective.quantity.in_unit(row.objective.value)):
            lines.setdefault(row.scheme, []).append((row.value, value))
    return {scheme: points for scheme, points in lines.items() if points}


def _curve(scheme: str, points: Iterable[tuple[float, float]], frame: _ValueRange) -> dict[str, object]:
    look = curve_of(scheme)
    return {
        "name": Scheme(scheme).record.short,
        "points": " ".join("{:.1f},{:.1f}".format(*frame.at(*point)) for point in points),
        "colour": lit(look.colour),
        "dashes": "" if isinstance(look.line, str) else " ".join(f"{length:g}" for length in look.line[1]),
        "width": look.width,
    }
