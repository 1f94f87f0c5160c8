"""The figure of any sweep: the smallest SINR, margin or rate of each scheme against the swept setting."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.certainty import certainty_lines
from nullpose.report.figures.style import (
    CURVES,
    GREY,
    Look,
    curve_of,
    draw_curve,
    house_style,
    inches,
    is_column,
)
from nullpose.report.numbers import axis_label, capitalised
from nullpose.study import ResultRow, ResultTable

_VISIBLE = 0.02  # a bound closer to its value, in dB, lies within the width of the line
_FREE = 3.0  # at least so many dB above the curves are shown
_CARET_DOWN = 7  # Matplotlib's name for it
_CAPTION_LETTERS = 125  # letters in a line of the caption
_ABOVE_CURVES = 5.0
_MARKERS = 13  # at most so many markers on a curve, so that they do not merge into a band


def quantity_of(table: ResultTable) -> Quantity:
    """Look up the quantity that a sweep of at least one row maximised."""
    return table.rows[0].objective.quantity


def _numbers(rows: Iterable[ResultRow]) -> FloatArray:
    """List values and bounds in their unit, (2, n); NaN, which Matplotlib draws as a gap, for no number."""
    pairs = [(row.objective.quantity, row.objective.value, row.objective.upper_bound) for row in rows]
    found = [[math.nan if x is None else unit.in_unit(x) for x in pair] for unit, *pair in pairs]
    return np.where(np.isfinite(found), found, math.nan).T


def draw_curves(axes: Axes, table: ResultTable) -> bool:
    """Draw curves and bounds; return whether bounds can be seen apart from their values."""
    apart = _VISIBLE
    if quantity_of(table).is_rate:
        apart = 0.01 * float(np.max(_numbers(table.rows)[0]))
    seen = [_draw_scheme(axes, table, scheme, apart) for scheme in table.names]
    return any(seen)


def _draw_scheme(axes: Axes, table: ResultTable, scheme: str, apart: float) -> bool:
    """Draw a curve with a band up to its bounds; return whether they can be seen apart."""
    look, rows = curve_of(scheme), table.of(scheme)
    values, bounds = _numbers(rows)
    levels = [row.value for row in rows]
    first = [*CURVES, scheme].index(scheme)  # staggered, so that curves which coincide both stay visible
    step = math.ceil(len(rows) / _MARKERS)
    every = 1 if step == 1 else (first, max(len(CURVES), step))
    draw_curve(axes, look, levels, values, (values, bounds), every=every)
    seen = bounds - values > apart
    marks: Look = {"marker": _CARET_DOWN, "markersize": 3.5, "alpha": 0.7, "zorder": _ABOVE_CURVES}
    if np.any(seen):  # no line: between two points nothing is proved
        axes.plot(levels, np.where(seen, bounds, math.nan), color=look.colour, linestyle="", **marks)
    return bool(np.any(seen))


def draw_caption(figure: Figure, lines: Iterable[str]) -> None:
    """Write sentences in small letters under the axes, broken into lines."""
    text = "\n".join(wrapped for line in lines for wrapped in textwrap.wrap(line, _CAPTION_LETTERS))
    figure.supxlabel(text, x=0.01, ha="left", fontsize=7.5, color=GREY, linespacing=1.35)


def _keep_curves_large(axes: Axes, table: ResultTable) -> None:
    """Let bounds that are far above every curve leave the picture, rather than flatten the curves."""
    values, bounds = _numbers(table.rows)
    low, high = np.fmin.reduce(values), np.fmax.reduce(values)  # unlike the maximum, they pass over NaN
    least = max(0.5 * high, 1e-3) if quantity_of(table).is_rate else _FREE
    free = max(least, high - low)
    if np.fmax.reduce(bounds) > high + free:
        axes.set_ylim(low - 0.05 * free, high + free)


def draw_sweep(table: ResultTable, *, log: bool = False, width: str | None = None) -> Figure:
    """Draw a sweep, its legend above the axes and, but in print (``WIDTHS_MM``), what is proved below."""
    lines = [f"{line}." for line in certainty_lines(table)]
    with house_style(width):
        size = inches((7.0, 4.6), width, 0.8 if is_column(width) else 0.5)
        figure = Figure(figsize=size, layout="constrained")
        if draw_sweep_axes(figure.add_subplot(), table, log=log):
            lines.append("Each band ends at the upper bound, a small triangle.")
        columns = 2 if is_column(width) else 4
        look: Look = {"handlelength": 3.2, "columnspacing": 1.4, "frameon": False}
        figure.legend(loc="outside upper center", ncols=columns, **look)
        if width is None:
            draw_caption(figure, lines)
    return figure


def draw_sweep_axes(axes: Axes, table: ResultTable, *, log: bool = False) -> bool:
    """Draw a sweep with the names of its axes; return whether bounds can be seen apart."""
    quantity = quantity_of(table)
    seen = draw_curves(axes, table)
    _keep_curves_large(axes, table)
    axes.set(xlabel=axis_label(table.path), xscale="log" if log else "linear")
    axes.set_ylabel(f"{capitalised(quantity.smallest)} over the nodes  ({quantity.unit})")
    axes.margins(x=0.02)
    return seen
