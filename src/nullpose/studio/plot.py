"""The live Figure 2: the schemes' values against the jamming power, as a drawing inside the page (SVG)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from nullpose.report.figures.style import CURVES
from nullpose.schemes import Curve, Scheme
from nullpose.studio.colours import css, scale_colour
from nullpose.studio.events import PowerCurve
from nullpose.studio.view import POWER_DB

__all__ = ["power_plot_svg", "scale_svg"]

_WIDTH, _HEIGHT = 340, 214
_LEFT, _RIGHT, _TOP, _BOTTOM = 42, 8, 30, 34


def power_plot_svg(
    curve: PowerCurve | None, *, version: int, power_db: float | None, value: float | None, unit: str
) -> str:
    """Return the drawing, with a ring at the present power and value; greyed while it is of an older scene.

    Args:
        curve: what is known of the schemes, or None.
        version: the version of the scene now.
        power_db: the jamming power now, dB; None without one.
        value: the present value in the unit shown; None if there is none that is current.
        unit: as in "dB".
    """
    if power_db is None:
        return (
            '<div data-np="plot" style="padding:2px 10px;font-size:12px">No jammer has a power to vary.</div>'
        )
    lines = {} if curve is None else _lines(curve)
    here = [] if value is None or not math.isfinite(value) else [value]
    low, high = _limits([y for points in lines.values() for _, y in points] + here)
    step = _step(high - low)
    stale = curve is None or curve.version != version
    parts = [_frame(low, high, step, unit)]
    parts.append(f'<g opacity="{0.35 if stale else 1.0}">')
    parts += [_polyline(scheme, points, low, high) for scheme, points in lines.items()]
    parts.append("</g>")
    parts += _legend(lines)
    x = _x(min(max(power_db, POWER_DB[0]), POWER_DB[1]))
    parts.append(
        f'<line x1="{x:.1f}" y1="{_TOP}" x2="{x:.1f}" y2="{_HEIGHT - _BOTTOM}" stroke="#888" '
        'stroke-dasharray="1 3"/>'
    )
    if here:
        parts.append(
            f'<circle data-np="now" cx="{x:.1f}" cy="{_y(here[0], low, high):.1f}" r="5" fill="#fff" '
            'fill-opacity=".6" stroke="#d55e00" stroke-width="2.5"/>'
        )
    state = "outdated" if stale else "current" if curve is not None and curve.complete else "growing"
    return (
        f'<div data-np="plot" data-state="{state}" style="padding:0 6px">'
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="100%" font-family="sans-serif" font-size="10.5" '
        f'role="img" aria-label="value against jamming power">{"".join(parts)}</svg></div>'
    )


def _lines(curve: PowerCurve) -> dict[str, list[tuple[float, float]]]:
    lines: dict[str, list[tuple[float, float]]] = {}
    for row in curve.table.rows:
        value = row.objective.quantity.in_unit(row.objective.value)
        if math.isfinite(value):
            lines.setdefault(row.scheme, []).append((row.value, value))
    return {scheme: lines[scheme] for scheme in CURVES if scheme in lines}


def _limits(values: Sequence[float]) -> tuple[float, float]:
    if not values:
        return -5.0, 5.0
    low, high = min(values), max(values)
    low = max(low, high - 30.0)
    room = max(0.5, 0.08 * (high - low))
    return low - room, high + room


def _step(span: float) -> float:
    return next((step for step in (0.5, 1.0, 2.0, 5.0) if span / step <= 6.0), 10.0)


def _x(power_db: float) -> float:
    share = (power_db - POWER_DB[0]) / (POWER_DB[1] - POWER_DB[0])
    return _LEFT + share * (_WIDTH - _LEFT - _RIGHT)


def _y(value: float, low: float, high: float) -> float:
    share = (min(max(value, low), high) - low) / (high - low)
    return _HEIGHT - _BOTTOM - share * (_HEIGHT - _BOTTOM - _TOP)


def _frame(low: float, high: float, step: float, unit: str) -> str:
    parts = []
    for i in range(math.ceil(low / step), math.floor(high / step) + 1):
        y = _y(i * step, low, high)
        text = f"{i * step:g}".replace("-", "&#8722;")
        parts.append(f'<line x1="{_LEFT}" y1="{y:.1f}" x2="{_WIDTH - _RIGHT}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{_LEFT - 5}" y="{y + 3.5:.1f}" text-anchor="end" fill="#333">{text}</text>')
    for power_db in range(int(POWER_DB[0]), int(POWER_DB[1]) + 1, 10):
        text = f"{power_db}".replace("-", "&#8722;")
        parts.append(
            f'<text x="{_x(power_db):.1f}" y="{_HEIGHT - _BOTTOM + 14}" text-anchor="middle" '
            f'fill="#333">{text}</text>'
        )
    middle = 0.5 * (_TOP + _HEIGHT - _BOTTOM)
    parts.append(
        f'<text x="{_LEFT + 0.5 * (_WIDTH - _LEFT - _RIGHT):.0f}" y="{_HEIGHT - 5}" text-anchor="middle" '
        'fill="#111">jamming power over node power, dB</text>'
        f'<text transform="translate(10 {middle:.0f}) rotate(-90)" text-anchor="middle" fill="#111">'
        f"{escape(unit)}</text>"
    )
    return "".join(parts)


def _polyline(scheme: str, points: list[tuple[float, float]], low: float, high: float) -> str:
    path = " ".join(f"{_x(x):.1f},{_y(y, low, high):.1f}" for x, y in points)
    curve = CURVES[scheme]
    return (
        f'<polyline points="{path}" fill="none" stroke="{curve.colour}" stroke-width="{curve.width}" '
        f'stroke-dasharray="{_dashes(curve)}"/>'
    )


def _dashes(curve: Curve) -> str:
    return "" if isinstance(curve.line, str) else " ".join(f"{length:g}" for length in curve.line[1])


def _legend(lines: dict[str, list[tuple[float, float]]]) -> list[str]:
    parts, x = [], 4.0
    for scheme in lines:
        curve, short = CURVES[scheme], Scheme(scheme).record.short
        parts.append(
            f'<line x1="{x:.0f}" y1="10" x2="{x + 20:.0f}" y2="10" stroke="{curve.colour}" '
            f'stroke-width="2.4" stroke-dasharray="{_dashes(curve)}"/>'
            f'<text x="{x + 24:.0f}" y="14" fill="#111">{short}</text>'
        )
        x += 30 + 5.6 * len(short)
    return parts


def scale_svg(low: float, high: float, title: str, unit: str) -> str:
    """Return a colour scale with its numbers.

    Args:
        low: value of the dark end.
        high: value of the bright end.
        title: what it is a scale of.
        unit: as in "dB".
    """
    stops = "".join(
        f'<stop offset="{share:.2f}" stop-color="{css(scale_colour(share, 0.0, 1.0))}"/>'
        for share in (i / 8 for i in range(9))
    )
    texts = "".join(
        f'<text x="{10 + 320 * share:.0f}" y="40" text-anchor="{anchor}">'
        f"{low + share * (high - low):g}{' ' + escape(unit) if share == 1 else ''}</text>".replace(
            "-", "&#8722;"
        ).replace("text&#8722;anchor", "text-anchor")
        for share, anchor in ((0.0, "start"), (0.5, "middle"), (1.0, "end"))
    )
    return (
        '<div data-np="scale" style="padding:0 6px"><svg viewBox="0 0 340 44" width="100%" '
        'font-family="sans-serif" font-size="11"><defs><linearGradient id="np-scale">'
        f'{stops}</linearGradient></defs><text x="10" y="11">{escape(title)}</text>'
        f'<rect x="10" y="15" width="320" height="12" fill="url(#np-scale)"/>{texts}</svg></div>'
    )
