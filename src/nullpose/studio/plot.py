"""The live Figure 2: the schemes' values against the jamming power, as a drawing inside the page (SVG)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape
from typing import NamedTuple

from nullpose.problem.schemes import Scheme
from nullpose.report.figures.style import CURVES, Curve, curve_of
from nullpose.studio.answer import PowerCurve
from nullpose.studio.look import either, lit, round_steps
from nullpose.studio.state import POWER_DB

_WIDTH, _HEIGHT = 340, 214
_LEFT, _RIGHT, _TOP, _BOTTOM = 42, 332, 30, 180
_MOST_SPAN = 30.0
_INK = either("#111", "#ddd")
_GRID = either("#ddd", "#444")
_RING = either("#d55e00", "#ff8a3c")
_INSIDE = (  # a drawing of its own, which cuts off what leaves it
    f'x="{_LEFT}" y="{_TOP}" width="{_RIGHT - _LEFT}" height="{_BOTTOM - _TOP}" '
    f'viewBox="{_LEFT} {_TOP} {_RIGHT - _LEFT} {_BOTTOM - _TOP}"'
)


class _Frame(NamedTuple):
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
    if power_db is None:
        style = "padding:2px 10px;font-size:12px"
        return f'<div data-np="plot" style="{style}">No jammer has a power to vary.</div>'
    lines = {} if curve is None else _lines(curve)
    now = [] if value is None or not math.isfinite(value) else [value]
    values = [y for points in lines.values() for _, y in points] + now
    high = max(values, default=5.0)
    low = min([max(min(values, default=-5.0), high - _MOST_SPAN), *now])
    margin = max(0.5, 0.08 * (high - low))
    frame = _Frame(low - margin, high + margin)
    is_old = curve is None or curve.version != version
    state = "outdated" if is_old else "current" if curve is not None and curve.complete else "growing"
    curves = "".join(_polyline(curve_of(scheme), points, frame) for scheme, points in lines.items())
    ring = _ring(frame, power_db, now) if POWER_DB[0] <= power_db <= POWER_DB[1] else ""
    return (
        f'<div data-np="plot" data-state="{state}" style="padding:0 6px">'
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="100%" font-family="sans-serif" font-size="10.5" '
        f'role="img" aria-label="value against jamming power">{_axes(frame, unit)}'
        f'<g opacity="{0.35 if is_old else 1.0}"><svg {_INSIDE}>{curves}</svg></g>'
        f"{_legend(lines)}{ring}</svg></div>"
    )


def _lines(curve: PowerCurve) -> dict[str, list[tuple[float, float]]]:
    """Return each scheme's powers and values, in the order of the legend."""
    lines: dict[str, list[tuple[float, float]]] = {scheme: [] for scheme in CURVES}
    for row in curve.table.rows:
        value = row.objective.quantity.in_unit(row.objective.value)
        if math.isfinite(value):
            lines.setdefault(row.scheme, []).append((row.value, value))
    return {scheme: points for scheme, points in lines.items() if points}


def _ring(frame: _Frame, power_db: float, now: Iterable[float]) -> str:
    """Draw a line at the present power, and a ring on it at the present value if there is one."""
    x, top = frame.at(power_db, frame.high)
    rings = "".join(
        f'<circle data-np="now" cx="{x:.1f}" cy="{frame.at(power_db, value)[1]:.1f}" r="5" fill="none" '
        f'stroke="{_RING}" stroke-width="2.5"/>'
        for value in now
    )
    line = f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{_BOTTOM}" stroke="#888" stroke-dasharray="1 3"/>'
    return line + rings


def _axes(frame: _Frame, unit: str) -> str:
    parts = [_text(0.5 * (_LEFT + _RIGHT), _HEIGHT - 5, "middle", "strongest jammer over strongest node, dB")]
    for value in round_steps(*frame, 6)[1:-1]:
        y = frame.at(0.0, value)[1]
        parts.append(f'<line x1="{_LEFT}" y1="{y:.1f}" x2="{_RIGHT}" y2="{y:.1f}" stroke="{_GRID}"/>')
        parts.append(_text(_LEFT - 5, y + 3.5, "end", f"{value:g}"))
    powers_db = range(int(POWER_DB[0]), int(POWER_DB[1]) + 1, 10)
    parts += [
        _text(frame.at(power_db, 0.0)[0], _BOTTOM + 14, "middle", f"{power_db}") for power_db in powers_db
    ]
    turned = f'transform="translate(10 {0.5 * (_TOP + _BOTTOM):.0f}) rotate(-90)"'
    return "".join(parts) + f'<text {turned} text-anchor="middle" fill="{_INK}">{escape(unit)}</text>'


def _text(x: float, y: float, anchor: str, text: str) -> str:
    minus = escape(text).replace("-", "&#8722;")
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{_INK}">{minus}</text>'


def _polyline(curve: Curve, points: Iterable[tuple[float, float]], frame: _Frame) -> str:
    path = " ".join("{:.1f},{:.1f}".format(*frame.at(*point)) for point in points)
    return f'<polyline points="{path}" fill="none" {_stroke(curve)} stroke-width="{curve.width}"/>'


def _stroke(curve: Curve) -> str:
    dashes = "" if isinstance(curve.line, str) else " ".join(f"{length:g}" for length in curve.line[1])
    return f'stroke="{lit(curve.colour)}" stroke-dasharray="{dashes}"'


def _legend(schemes: Iterable[str]) -> str:
    x, parts = 4.0, []
    for scheme in schemes:
        short, stroke = Scheme(scheme).record.short, _stroke(curve_of(scheme))
        parts.append(f'<line x1="{x:.0f}" y1="10" x2="{x + 20:.0f}" y2="10" {stroke} stroke-width="2.4"/>')
        parts.append(_text(x + 24, 14, "start", short))
        x += 30 + 5.6 * len(short)
    return "".join(parts)
