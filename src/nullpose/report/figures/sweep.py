"""The figure of any sweep: the smallest SINR, margin or rate of each scheme against the swept setting."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING

import numpy as np

from nullpose.physics.quantity import Quantity
from nullpose.report.certainty import certainty_lines
from nullpose.report.figures.style import CURVES, GREY, Curve, house_style
from nullpose.study import SweepRow, SweepTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_bounds", "draw_caption", "draw_curve", "draw_sweep", "finite_or_gap", "quantity_of"]

_UNITS = {"w": "W", "dbm": "dBm", "db": "dB", "hz": "Hz", "m": "m", "deg": "degrees"}
_VISIBLE = 0.02  # a bound closer to its value, in dB, lies within the width of the line
_ROOM = 3.0  # at least so many dB above the curves are shown
_CARET_DOWN = 7  # Matplotlib's name for it
_CAPTION_LETTERS = 125  # letters in a line of the caption
_ABOVE_CURVES = 5.0
_MARKERS = 13  # at most so many markers on a curve, so that they do not merge into a band


def finite_or_gap(numbers: list[float]) -> list[float]:
    """Return the numbers with infinities turned into NaN, which Matplotlib draws as a gap.

    Args:
        numbers: dB; minus infinity stands for no signal.
    """
    return [number if math.isfinite(number) else math.nan for number in numbers]


def quantity_of(table: SweepTable) -> Quantity:
    """Return what a sweep made as large as it can be.

    Args:
        table: the sweep, with at least one row.
    """
    return Quantity.named(table.rows[0].objective.name)


def _value(row: SweepRow) -> float:
    return row.objective.quantity.in_unit(row.objective.value)


def _bound(row: SweepRow) -> float | None:
    bound = row.objective.upper_bound
    return None if bound is None else row.objective.quantity.in_unit(bound)


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
        finite_or_gap([_value(row) for row in rows]),
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
    levels = [row.value for row in rows]
    values = np.array(finite_or_gap([_value(row) for row in rows]))
    bounds = np.array(finite_or_gap([_bound(row) or 0.0 for row in rows]))
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


def _axis_label(path: str) -> str:
    leaf = path.rsplit(".", 1)[-1].split("[", 1)[0]
    unit = _UNITS.get(leaf.rsplit("_", 1)[-1].lower())
    return f"{path}  ({unit})" if unit else path


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
    if any(_gap(row) > _visible(table) for row in table.rows):
        lines.append(
            "Bands reach from the value found up to the bound, a small triangle above which no pose is."
        )
    return lines


def _gap(row: SweepRow) -> float:
    bound = _bound(row)
    return 0.0 if bound is None else bound - _value(row)


def _visible(table: SweepTable) -> float:
    """Return the gap that is wider than a line: of a rate, a hundredth of the greatest."""
    if not quantity_of(table).is_rate:
        return _VISIBLE
    return 0.01 * max(_value(row) for row in table.rows)


def _keep_curves_large(axes: Axes, table: SweepTable) -> None:
    """Let bounds that are far above every curve leave the picture, rather than flatten the curves."""
    values = [value for value in map(_value, table.rows) if math.isfinite(value)]
    bounds = [bound for bound in map(_bound, table.rows) if bound is not None]
    if not values or not bounds:
        return
    low, high = min(values), max(values)
    least = max(0.5 * high, 1e-3) if quantity_of(table).is_rate else _ROOM
    room = max(least, high - low)
    if max(bounds) > high + room:
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
        axes.set_xlabel(_axis_label(table.path))
        quantity = quantity_of(table)
        axes.set_ylabel(f"{quantity.smallest} over the nodes  ({quantity.unit})")
        axes.margins(x=0.02)
        figure.legend(loc="outside upper center", ncols=4, frameon=False, handlelength=3.2, columnspacing=1.4)
        draw_caption(figure, _caption(table))
    return figure
