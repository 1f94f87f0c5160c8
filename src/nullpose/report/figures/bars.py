"""Figures of comparisons: a bar for each case or vehicle, with its bound."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.answer import answer_lines
from nullpose.report.comparison import numbers_of
from nullpose.report.figures.style import CURVES, GREY, INK, VEHICLES, Look, house_style, inches
from nullpose.report.figures.sweep import draw_caption
from nullpose.report.numbers import capitalised, number
from nullpose.study import ResultRow, ResultTable
from nullpose.study.case import OMNIDIRECTIONAL

_ROW_INCH, _SENTENCE_INCH = 0.33, 0.3
_GAP = 0.6  # between dipoles and arrays, in rows
_DEEPEST_DB = 25.0  # bars that end farther below the best are cut off
_FREE = 0.28  # beside the longest bar, for its number, of the width drawn


def draw_comparison(comparison: ResultTable, width: str | None = None) -> Figure:
    """Draw cases or vehicles compared: bars and answer, in print (a key of ``WIDTHS_MM``) bars alone."""
    lines = answer_lines(comparison) if OMNIDIRECTIONAL in comparison.names else []
    with house_style(width):
        height = 1.6 + _ROW_INCH * len(comparison.rows)
        size = (7.0, height + _SENTENCE_INCH * len(lines))
        if width is not None:
            size = (inches(size, width, 0.0)[0], 0.7 * height)
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.add_subplot()
        draw_bars(axes, comparison)
        columns = 1 if width == "column" else 3
        if axes.get_legend_handles_labels()[0]:
            figure.legend(loc="outside upper center", ncols=columns, frameon=False, handlelength=1.6)
        if width is None:
            axes.set_title(comparison.rows[0].scenario.name, loc="left", fontweight="bold", parse_math=False)
            draw_caption(figure, lines)
    return figure


def draw_bars(axes: Axes, comparison: ResultTable) -> None:
    """Draw a bar for each row, a line from it up to its bound, and what it guarantees under errors.

    Beside vehicles their difference from the omnidirectional one is written.
    """
    found, quantity = comparison.rows, comparison.rows[0].objective.quantity
    places = np.arange(len(found)) + _GAP * np.array([row.case.array is not None for row in found])
    values, bounds, nominal, robust, _ = numbers_of(comparison)
    low = _frame(axes, quantity, places, np.array([values, bounds, nominal, robust]))
    ends = np.nan_to_num(np.maximum(values, low), nan=low)
    colours = [_colour(row) for row in found]
    axes.barh(places, ends - low, left=low, height=0.6, color=colours, zorder=2.0)
    axes.hlines(places, ends, bounds, color=INK, linewidth=1.0, zorder=3.0)
    if np.any(np.isfinite(bounds)):
        axes.plot(bounds, places, "|", color=INK, markersize=9.0, zorder=3.0, label="upper bound")
    for place in places[values < low]:
        axes.plot([low], [place], "<", color=GREY, clip_on=False, zorder=3.0)
    whole = math.nan
    if OMNIDIRECTIONAL in comparison.names:
        whole = float(values[comparison.names.index(OMNIDIRECTIONAL)])
        axes.axvline(whole, color=VEHICLES[OMNIDIRECTIONAL].colour, linewidth=0.9, zorder=2.5)
    look: Look = {"xytext": (5, 0), "textcoords": "offset points", "va": "center", "zorder": 4.0}
    white = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
    for place, end, value in zip(places, np.fmax(ends, bounds), values.tolist(), strict=True):
        text = _difference_words(value, whole, quantity)
        axes.annotate(text, (end, place), fontsize="small", bbox=white, **look)
    axes.set_yticks(places, [row.label for row in found])
    if np.any(np.isfinite(nominal)):
        lengths = np.nan_to_num(np.maximum(robust, low) - low)
        thin: Look = {"left": low, "height": 0.22, "color": INK, "zorder": 2.2}
        axes.barh(places, lengths, label="guaranteed, robust pose", **thin)
        diamonds: Look = {"color": "white", "markeredgecolor": INK, "markersize": 5.0}
        seen = np.where(nominal >= low, nominal, math.nan)
        axes.plot(seen, places, "d", label="guaranteed, pose shown", zorder=2.4, **diamonds)


def _frame(axes: Axes, quantity: Quantity, places: FloatArray, numbers: FloatArray) -> float:
    """Set limits and names of the axes, with space for all numbers; return where the bars begin."""
    finite = numbers[np.isfinite(numbers)]
    low, high = 0.0, max(float(finite.max(initial=0.0)), 1e-3)  # a rate is drawn from nothing
    if not quantity.is_rate:  # decibels have no natural zero
        high = float(finite.max())
        lowest = max(float(finite.min()), high - _DEEPEST_DB)
        low = lowest - 0.1 * max(high - lowest, 1.0) - 0.5
    axes.tick_params(axis="y", length=0)
    axes.set(xlim=(low, high + _FREE * (high - low)), ylim=(places[-1] + 0.6, -0.6))
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(f"{capitalised(quantity.smallest)} over the nodes  ({quantity.unit})")
    return low


def _colour(row: ResultRow) -> str:
    looks = {**CURVES, **VEHICLES}
    name = "array" if row.case.array else row.name
    return looks[name].colour if name in looks else INK


def _difference_words(value: float, whole: float, quantity: Quantity) -> str:
    """Write a value, and its difference from the omnidirectional vehicle's."""
    if math.isnan(value):
        return "no pose reaches every node"
    difference = value - whole
    if not math.isfinite(difference) or difference == 0.0:
        return number(value, quantity)
    return f"{number(value, quantity)}  ({'+' if difference > 0.0 else ''}{number(difference, quantity)})"
