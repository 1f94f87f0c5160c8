"""The figure of any sweep: the smallest SINR, margin or rate of each scheme against the swept setting."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.certainty import certainty_lines
from nullpose.report.figures.style import CURVES, GREY, house_style
from nullpose.report.numbers import axis_label
from nullpose.study import SweepRow, SweepTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_caption", "draw_curves", "draw_sweep", "quantity_of"]

_VISIBLE = 0.02  # a bound closer to its value, in dB, lies within the width of the line
_ROOM = 3.0  # at least so many dB above the curves are shown
_CARET_DOWN = 7  # Matplotlib's name for it
_CAPTION_LETTERS = 125  # letters in a line of the caption
_ABOVE_CURVES = 5.0
_MARKERS = 13  # at most so many markers on a curve, so that they do not merge into a band


def quantity_of(table: SweepTable) -> Quantity:
    """Return what a sweep made as large as it can be.

    Args:
        table: the sweep, with at least one row.
    """
    return table.rows[0].objective.quantity


def _in_unit(rows: Iterable[SweepRow], name: str) -> FloatArray:
    """Return values or bounds in their unit; NaN, which Matplotlib draws as a gap, for no number."""
    numbers = [(row.objective.quantity, getattr(row.objective, name)) for row in rows]
    found = [math.nan if number is None else quantity.in_unit(number) for quantity, number in numbers]
    return np.where(np.isfinite(found), found, math.nan)


def draw_curves(axes: Axes, table: SweepTable) -> bool:
    """Return whether bounds can be seen apart from their values, after drawing curves and bounds.

    Args:
        axes: where to draw.
        table: the sweep.
    """
    apart = _VISIBLE
    if quantity_of(table).is_rate:
        apart = 0.01 * float(np.max(_in_unit(table.rows, "value")))
    for scheme in table.schemes:
        _draw_curve(axes, table, scheme, apart)
    return bool(np.any(_in_unit(table.rows, "upper_bound") - _in_unit(table.rows, "value") > apart))


def _draw_curve(axes: Axes, table: SweepTable, scheme: str, apart: float) -> None:
    """Draw a curve, the band up to its bounds, and marks at bounds that lie apart."""
    curve, rows = CURVES[scheme], table.of(scheme)
    levels, values, bounds = (
        [row.value for row in rows],
        _in_unit(rows, "value"),
        _in_unit(rows, "upper_bound"),
    )
    first = list(CURVES).index(scheme)  # staggered, so that curves which coincide both stay visible
    axes.plot(
        levels,
        values,
        color=curve.colour,
        linestyle=curve.line,
        linewidth=curve.width,
        marker=curve.marker,
        markersize=4.2,
        markerfacecolor="white",
        markevery=(first, max(1, len(CURVES), math.ceil(len(rows) / _MARKERS))),
        zorder=curve.order,
        label=curve.label,
    )
    if np.all(np.isnan(bounds)):
        return
    axes.fill_between(
        levels, values, bounds, color=curve.colour, alpha=0.10, linewidth=0.0, zorder=curve.order - 2.0
    )
    seen = np.where(bounds - values > apart, bounds, math.nan)
    if not np.all(np.isnan(seen)):
        axes.plot(
            levels,
            seen,
            color=curve.colour,
            linestyle="",  # between two points nothing is proved
            marker=_CARET_DOWN,
            markersize=3.5,
            alpha=0.7,
            zorder=_ABOVE_CURVES,
            label=f"_{scheme}: no pose is above",
        )


def draw_caption(figure: Figure, lines: Iterable[str]) -> None:
    """Write sentences in small letters under the axes, broken into lines.

    Args:
        figure: with its axes.
        lines: sentences.
    """
    text = "\n".join(wrapped for line in lines for wrapped in textwrap.wrap(line, _CAPTION_LETTERS))
    figure.supxlabel(text, x=0.01, ha="left", fontsize=7.5, color=GREY, linespacing=1.35)


def _keep_curves_large(axes: Axes, table: SweepTable) -> None:
    """Let bounds that are far above every curve leave the picture, rather than flatten the curves."""
    values, bounds = _in_unit(table.rows, "value"), _in_unit(table.rows, "upper_bound")
    if np.all(np.isnan(values)) or np.all(np.isnan(bounds)):
        return
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    least = max(0.5 * high, 1e-3) if quantity_of(table).is_rate else _ROOM
    room = max(least, high - low)
    if np.nanmax(bounds) > high + room:
        axes.set_ylim(low - 0.05 * room, high + room)


def draw_sweep(table: SweepTable, *, log: bool = False) -> Figure:
    """Return the figure of a sweep, its legend above the axes and what is proved below them.

    Args:
        table: what the sweep found.
        log: draw the swept setting on a logarithmic axis.
    """
    from matplotlib.figure import Figure

    quantity, lines = quantity_of(table), [f"{line}." for line in certainty_lines(table)]
    with house_style():
        figure = Figure(figsize=(7.0, 4.6), layout="constrained")
        axes = figure.add_subplot()
        if draw_curves(axes, table):
            lines.append("Bands reach up to the bound, a small triangle above which no pose is.")
        _keep_curves_large(axes, table)
        axes.set(xlabel=axis_label(table.path), xscale="log" if log else "linear")
        axes.set_ylabel(f"{quantity.smallest} over the nodes  ({quantity.unit})")
        axes.margins(x=0.02)
        figure.legend(loc="outside upper center", ncols=4, frameon=False, handlelength=3.2, columnspacing=1.4)
        draw_caption(figure, lines)
    return figure
