"""The live Figure 2: the schemes' values against the jamming power, as a drawing inside the page (SVG)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from html import escape
from typing import NamedTuple

from nullpose.problem.schemes import Scheme
from nullpose.report.figures.style import CURVES, Curve
from nullpose.studio.colours import round_steps
from nullpose.studio.events import PowerCurve
from nullpose.studio.look import either, lit
from nullpose.studio.view import POWER_DB

_WIDTH, _HEIGHT = 340, 214
_LEFT, _RIGHT, _TOP, _BOTTOM = 42, 332, 30, 180
_MOST_SPAN = 30.0
_INK = either("#111", "#ddd")
_GRID = either("#ddd", "#444")
_HERE = either("#d55e00", "#ff8a3c")
_INSIDE = (  # a drawing of its own, which cuts off what leaves it
    f'x="{_LEFT}" y="{_TOP}" width="{_RIGHT - _LEFT}" height="{_BOTTOM - _TOP}" '
    f'viewBox="{_LEFT} {_TOP} {_RIGHT - _LEFT} {_BOTTOM - _TOP}"'
)


class _Frame(NamedTuple):
    """The values at the lower and the upper edge of the drawing."""

    low: float
    high: float

    def at(self, power_db: float, value: float) -> tuple[float, float]:
        """Return where a power and a value are drawn, which is outside the drawing if they are beyond it."""
        low_db, high_db = POWER_DB
        across = (power_db - low_db) / (high_db - low_db)
        up = (value - self.low) / (self.high - self.low)
        return _LEFT + across * (_RIGHT - _LEFT), _BOTTOM - up * (_BOTTOM - _TOP)


def power_plot_svg(
    curve: PowerCurve | None, *, version: int, power_db: float | None, value: float | None, unit: str
) -> str:
    """Return the drawing, with a ring at the present power and value; greyed while it is of an older scene.

    The view reaches 30 below the largest value, or down to the present one. Curves below it are cut off.
    Where the present power is beyond the drawing there is no ring.

    Args:
        curve: what is known of the schemes, or None.
        version: the version of the scene now.
        power_db: the jamming power now, dB; None without one.
        value: the present value in the unit shown; None if there is none that is current.
        unit: as in "dB".
    """
    if power_db is None:
        style = "padding:2px 10px;font-size:12px"
        return f'<div data-np="plot" style="{style}">No jammer has a power to vary.</div>'
    lines = {} if curve is None else _lines(curve)
    here = [] if value is None or not math.isfinite(value) else [value]
    frame = _frame_around([y for points in lines.values() for _, y in points], here)
    stale = curve is None or curve.version != version
    state = "outdated" if stale else "current" if curve is not None and curve.complete else "growing"
    drawn = "".join(_polyline(CURVES[scheme], points, frame) for scheme, points in lines.items())
    now = _now(frame, power_db, here) if POWER_DB[0] <= power_db <= POWER_DB[1] else ""
    return (
        f'<div data-np="plot" data-state="{state}" style="padding:0 6px">'
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="100%" font-family="sans-serif" font-size="10.5" '
        f'role="img" aria-label="value against jamming power">{"".join(_axes(frame, unit))}'
        f'<g opacity="{0.35 if stale else 1.0}"><svg {_INSIDE}>{drawn}</svg></g>'
        f"{''.join(_legend(lines))}{now}</svg></div>"
    )


def _lines(curve: PowerCurve) -> dict[str, list[tuple[float, float]]]:
    lines: dict[str, list[tuple[float, float]]] = {}
    for row in curve.table.rows:
        value = row.objective.quantity.in_unit(row.objective.value)
        if math.isfinite(value):
            lines.setdefault(row.scheme, []).append((row.value, value))
    return {scheme: lines[scheme] for scheme in CURVES if scheme in lines}


def _now(frame: _Frame, power_db: float, here: list[float]) -> str:
    """Return a line at the present power, and a ring on it at the present value if there is one."""
    x, top = frame.at(power_db, frame.high)
    now = f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{_BOTTOM}" stroke="#888" stroke-dasharray="1 3"/>'
    for height in here:
        now += (
            f'<circle data-np="now" cx="{x:.1f}" cy="{frame.at(power_db, height)[1]:.1f}" r="5" fill="none" '
            f'stroke="{_HERE}" stroke-width="2.5"/>'
        )
    return now


def _frame_around(curves: list[float], here: list[float]) -> _Frame:
    values = curves + here
    high = max(values, default=5.0)
    low = min([max(min(values, default=-5.0), high - _MOST_SPAN), *here])
    margin = max(0.5, 0.08 * (high - low))
    return _Frame(low - margin, high + margin)


def _axes(frame: _Frame, unit: str) -> Iterator[str]:
    for value in round_steps(*frame, 6)[1:-1]:
        y = frame.at(0.0, value)[1]
        yield f'<line x1="{_LEFT}" y1="{y:.1f}" x2="{_RIGHT}" y2="{y:.1f}" stroke="{_GRID}"/>'
        yield _text(_LEFT - 5, y + 3.5, "end", f"{value:g}")
    for power_db in range(int(POWER_DB[0]), int(POWER_DB[1]) + 1, 10):
        yield _text(frame.at(power_db, 0.0)[0], _BOTTOM + 14, "middle", f"{power_db}")
    yield _text(0.5 * (_LEFT + _RIGHT), _HEIGHT - 5, "middle", "strongest jammer over strongest node, dB")
    turned = f'transform="translate(10 {0.5 * (_TOP + _BOTTOM):.0f}) rotate(-90)"'
    yield f'<text {turned} text-anchor="middle" fill="{_INK}">{escape(unit)}</text>'


def _text(x: float, y: float, anchor: str, text: str) -> str:
    minus = escape(text).replace("-", "&#8722;")
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{_INK}">{minus}</text>'


def _polyline(curve: Curve, points: Iterable[tuple[float, float]], frame: _Frame) -> str:
    path = " ".join("{:.1f},{:.1f}".format(*frame.at(*point)) for point in points)
    return f'<polyline points="{path}" fill="none" {_look(curve)} stroke-width="{curve.width}"/>'


def _look(curve: Curve) -> str:
    dashes = "" if isinstance(curve.line, str) else " ".join(f"{length:g}" for length in curve.line[1])
    return f'stroke="{lit(curve.colour)}" stroke-dasharray="{dashes}"'


def _legend(lines: Iterable[str]) -> Iterator[str]:
    x = 4.0
    for scheme in lines:
        short, look = Scheme(scheme).record.short, _look(CURVES[scheme])
        yield f'<line x1="{x:.0f}" y1="10" x2="{x + 20:.0f}" y2="10" {look} stroke-width="2.4"/>'
        yield _text(x + 24, 14, "start", short)
        x += 30 + 5.6 * len(short)
