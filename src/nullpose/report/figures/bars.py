"""Figures of comparisons: a bar for each case or vehicle, with its bound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.airframes import answer_lines, case_of, numbers_of
from nullpose.report.comparison import Comparison
from nullpose.report.figures.style import CURVES, GREY, INK, VEHICLES, house_style, inches
from nullpose.report.figures.sweep import draw_caption
from nullpose.report.numbers import capitalised, number
from nullpose.solver import Result
from nullpose.study import ResultTable
from nullpose.study.vehicles import dipoles, omnidirectional

_ROW_INCH, _SENTENCE_INCH = 0.33, 0.3
_GAP = 0.6  # between dipoles and arrays, in rows
_DEEPEST_DB = 25.0  # bars that end farther below the best are cut off
_FREE = 0.28  # beside the longest bar, for its number, of the width drawn


def draw_comparison(comparison: Comparison, width: str | None = None) -> Figure:
    """Draw the figure of the cases of a scenario; in print (a key of ``WIDTHS_MM``) without a title."""
    with house_style(width):
        high = 1.0 + _ROW_INCH * len(comparison.solutions)
        figure = Figure(figsize=(inches((7.0, 0.0), width, 0.0)[0], high), layout="constrained")
        axes = figure.add_subplot()
        draw_cases(axes, comparison.solutions)
        if width is None:
            axes.set_title(comparison.scenario.name, loc="left", fontweight="bold", parse_math=False)
    return figure


def draw_cases(axes: Axes, results: Sequence[Result]) -> None:
    """Draw a bar for each result of a scenario, with a mark at the bound that no pose of the case exceeds."""
    quantity = results[0].objective.quantity
    values = np.array([quantity.in_unit(result.objective.value) for result in results])
    bounds = np.array([quantity.in_unit(result.objective.upper_bound or math.nan) for result in results])
    colours = [CURVES[str(each.scheme)].colour if str(each.scheme) in CURVES else INK for each in results]
    words = [number(value, quantity) for value in values.tolist()]
    places = np.arange(len(results), dtype=float)
    _draw_bars(axes, quantity, places, values, bounds, colours, words)
    axes.set_yticks(places, [result.label for result in results])
    if np.any(np.isfinite(bounds)):
        axes.legend(loc="lower right", frameon=False, handlelength=1.0)


def draw_airframes(comparison: ResultTable, width: str | None = None) -> Figure:
    """Draw the figure of the vehicles compared: bars and answer, in print (``WIDTHS_MM``) bars alone."""
    lines = answer_lines(comparison)
    with house_style(width):
        height = 1.6 + _ROW_INCH * len(comparison.rows)
        size = (7.0, height + _SENTENCE_INCH * len(lines))
        if width is not None:
            size = (inches(size, width, 0.0)[0], 0.7 * height)
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.add_subplot()
        draw_airframe_bars(axes, comparison)
        columns = 1 if width == "column" else 3
        figure.legend(loc="outside upper center", ncols=columns, frameon=False, handlelength=1.6)
        if width is None:
            axes.set_title(comparison.rows[0].scenario.name, loc="left", fontweight="bold", parse_math=False)
            draw_caption(figure, lines)
    return figure


def draw_airframe_bars(axes: Axes, comparison: ResultTable) -> None:
    """Draw a bar for each vehicle, a line from it up to its bound, and what it guarantees under errors."""
    results, quantity = comparison.rows, comparison.rows[0].objective.quantity
    places = np.arange(len(results)) + _GAP * (np.arange(len(results)) >= len(dipoles(comparison)))
    values, bounds, nominal, robust, _ = numbers_of(comparison)
    whole = quantity.in_unit(omnidirectional(comparison).objective.value)
    words = [_difference_words(value, whole, quantity) for value in values.tolist()]
    names = ["array" if case_of(row).array else row.name for row in results]
    colours = [VEHICLES[name].colour for name in names]
    low = _draw_bars(axes, quantity, places, values, bounds, colours, words, others=(nominal, robust))
    axes.axvline(whole, color=VEHICLES["omnidirectional"].colour, linewidth=0.9, zorder=2.5)
    axes.set_yticks(places, [case_of(row).label for row in results])
    if results[0].scenario.is_uncertain:
        lengths = np.nan_to_num(np.maximum(robust, low) - low)
        thin: dict[str, Any] = {"left": low, "height": 0.22, "color": INK, "zorder": 2.2}
        axes.barh(places, lengths, label="guaranteed, robust pose", **thin)
        diamonds: dict[str, Any] = {"color": "white", "markeredgecolor": INK, "markersize": 5.0}
        seen = np.where(nominal >= low, nominal, math.nan)
        axes.plot(seen, places, "d", label="guaranteed, pose shown", zorder=2.4, **diamonds)


def _draw_bars(
    axes: Axes,
    quantity: Quantity,
    places: FloatArray,
    values: FloatArray,
    bounds: FloatArray,
    colours: Sequence[str],
    words: Sequence[str],
    others: Sequence[FloatArray] = (),
) -> float:
    """Draw bars with their bounds and words; return where they begin, which makes space for others too."""
    numbers = np.array([values, bounds, *others])
    finite = numbers[np.isfinite(numbers)]
    low, high = 0.0, max(float(finite.max(initial=0.0)), 1e-3)  # a rate is drawn from nothing
    if not quantity.is_rate:  # decibels have no natural zero
        high = float(finite.max())
        lowest = max(float(finite.min()), high - _DEEPEST_DB)
        low = lowest - 0.1 * max(high - lowest, 1.0) - 0.5
    ends = np.nan_to_num(np.maximum(values, low), nan=low)
    axes.barh(places, ends - low, left=low, height=0.6, color=colours, zorder=2.0)
    axes.hlines(places, ends, bounds, color=INK, linewidth=1.0, zorder=3.0)
    axes.plot(bounds, places, "|", color=INK, markersize=9.0, zorder=3.0, label="upper bound")
    for place in places[values < low]:
        axes.plot([low], [place], "<", color=GREY, clip_on=False, zorder=3.0)
    look: dict[str, Any] = {"xytext": (5, 0), "textcoords": "offset points", "va": "center", "zorder": 4.0}
    white = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
    for place, end, text in zip(places, np.fmax(ends, bounds), words, strict=True):
        axes.annotate(text, (end, place), fontsize="small", bbox=white, **look)
    axes.tick_params(axis="y", length=0)
    axes.set(xlim=(low, high + _FREE * (high - low)), ylim=(places[-1] + 0.6, -0.6))
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(f"{capitalised(quantity.smallest)} over the nodes  ({quantity.unit})")
    return low


def _difference_words(value: float, whole: float, quantity: Quantity) -> str:
    """Write a vehicle's value, and its difference from the omnidirectional one's."""
    if math.isnan(value):
        return "no pose reaches every node"
    difference = value - whole
    if not math.isfinite(difference) or difference == 0.0:
        return number(value, quantity)
    return f"{number(value, quantity)}  ({'+' if difference > 0.0 else ''}{number(difference, quantity)})"
