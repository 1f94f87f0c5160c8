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
from nullpose.report.figures.style import CURVES, GREY, Curve, house_style
from nullpose.report.numbers import axis_label
from nullpose.study import SweepRow, SweepTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_bounds", "draw_caption", "draw_curve", "draw_sweep", "quantity_of"]

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
    return Quantity.named(table.rows[0].objective.name)


def _values(rows: Iterable[SweepRow]) -> FloatArray:
    return _in_unit((row, row.objective.value) for row in rows)


def _bounds(rows: Iterable[SweepRow]) -> FloatArray:
    return _in_unit((row, row.objective.upper_bound) for row in rows)


def _in_unit(numbers: Iterable[tuple[SweepRow, float | None]]) -> FloatArray:
    """Return numbers in dB, or rates as they are; NaN, which Matplotlib draws as a gap, for no number."""
    found = [math.nan if value is None else row.objective.quantity.in_unit(value) for row, value in numbers]
    return np.where(np.isfinite(found), found, math.nan)


def draw_curve(axes: Axes, table: SweepTable, scheme: str) -> Curve:
    """Return the look of one scheme's curve after drawing it.

    Args:
        axes: where to draw.
        table: the sweep.
        scheme: one of the table's schemes.
    """
    curve = CURVES[scheme]
    rows = table.of(scheme)
    first = list(CURVES).index(scheme)  # staggered, so that curves which coincide both stay visible
    axes.plot(
        [row.value for row in rows],
        _values(rows),
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
    return curve


def draw_bounds(axes: Axes, table: SweepTable, scheme: str) -> None:
    """Draw the band between one scheme's values and their upper bounds, where it is wider than a line.

    Args:
        axes: where to draw.
        table: the sweep.
        scheme: one of the table's schemes.
    """
    curve = CURVES[scheme]
    rows = [row for row in table.of(scheme) if row.upper_bound is not None]
    if not rows:
        return
    levels, values, bounds = [row.value for row in rows], _values(rows), _bounds(rows)
    axes.fill_between(
        levels, values, bounds, color=curve.colour, alpha=0.10, linewidth=0.0, zorder=curve.order - 2.0
    )
    seen = np.where(bounds - values > _visible(table), bounds, math.nan)
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


def draw_caption(figure: Figure, lines: list[str]) -> None:
    """Write what is proved of the curves under the axes, broken into lines.

    Args:
        figure: with its axes.
        lines: sentences.
    """
    text = "\n".join(wrapped for line in lines for wrapped in textwrap.wrap(line, _CAPTION_LETTERS))
    figure.supxlabel(text, x=0.01, ha="left", fontsize=7.5, color=GREY, linespacing=1.35)


def _caption(table: SweepTable) -> list[str]:
    lines = [f"{line}." for line in certainty_lines(table)]
    if np.any(_bounds(table.rows) - _values(table.rows) > _visible(table)):
        lines.append(
            "Bands reach from the value found up to the bound, a small triangle above which no pose is."
        )
    return lines


def _visible(table: SweepTable) -> float:
    """Return the gap that is wider than a line: of a rate, a hundredth of the greatest."""
    return 0.01 * float(np.max(_values(table.rows))) if quantity_of(table).is_rate else _VISIBLE


def _keep_curves_large(axes: Axes, table: SweepTable) -> None:
    """Let bounds that are far above every curve leave the picture, rather than flatten the curves."""
    values, bounds = _values(table.rows), _bounds(table.rows)
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

    with house_style():
        figure = Figure(figsize=(7.0, 4.6), layout="constrained")
        axes = figure.add_subplot()
        for scheme in table.schemes:
            draw_curve(axes, table, scheme)
            draw_bounds(axes, table, scheme)
        _keep_curves_large(axes, table)
        if log:
            axes.set_xscale("log")
        axes.set_xlabel(axis_label(table.path))
        quantity = quantity_of(table)
        axes.set_ylabel(f"{quantity.smallest} over the nodes  ({quantity.unit})")
        axes.margins(x=0.02)
        figure.legend(loc="outside upper center", ncols=4, frameon=False, handlelength=3.2, columnspacing=1.4)
        draw_caption(figure, _caption(table))
    return figure
