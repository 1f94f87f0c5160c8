"""The figure of a comparison of airframes: a bar for each vehicle, with its bound."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.airframes import answer_lines, numbers_of
from nullpose.report.figures.style import GREY, INK, VEHICLES, house_style, inches
from nullpose.report.figures.sweep import draw_caption
from nullpose.report.numbers import begun, number
from nullpose.study import AirframeComparison, AirframeResult

_ROW_INCH = 0.3
_SENTENCE_INCH = 0.3
_GAP = 0.6  # between dipoles and arrays, in rows
_DEEPEST_DB = 25.0  # bars that end farther below the omnidirectional one are cut off


def draw_airframes(comparison: AirframeComparison, width: str | None = None) -> Figure:
    """Return the figure: a bar for each vehicle, a line from it up to its bound, and what it guarantees.

    Args:
        comparison: what each vehicle makes of a scenario.
        width: in print, where nothing is said around the axes, a key of ``WIDTHS_MM``; None for a screen.
    """
    lines = answer_lines(comparison)
    with house_style(width):
        height = 1.6 + _ROW_INCH * len(comparison.results)
        size = (7.0, height + _SENTENCE_INCH * len(lines))
        if width is not None:
            size = (inches(size, width, 0.0)[0], 0.7 * height)
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.add_subplot()
        draw_airframe_bars(axes, comparison)
        columns = 1 if width == "column" else 3
        figure.legend(loc="outside upper center", ncols=columns, frameon=False, handlelength=1.6)
        if width is None:
            look: dict[str, Any] = {"fontsize": 9.0, "fontweight": "bold", "color": INK, "parse_math": False}
            axes.set_title(comparison.scenario.name, loc="left", **look)
            draw_caption(figure, lines)
    return figure


def draw_airframe_bars(axes: Axes, comparison: AirframeComparison) -> None:
    """Draw a bar for each vehicle, a line from it up to its bound, and what it guarantees.

    Args:
        axes: where to draw.
        comparison: what each vehicle makes of a scenario.
    """
    results, quantity = comparison.results, Quantity.of(comparison.scenario)
    places = np.arange(len(results)) + _GAP * (np.arange(len(results)) >= len(comparison.dipoles))
    _draw_rows(axes, comparison, quantity, places)
    whole = quantity.in_unit(comparison.omnidirectional.value)
    axes.axvline(whole, color=VEHICLES["omnidirectional"].colour, linewidth=0.9, zorder=2.5)
    axes.set_yticks(places, [result.case.label for result in results])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(places[-1] + 0.6, -0.6)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(f"{begun(quantity.smallest)} over the nodes  ({quantity.unit})")


def _draw_rows(axes: Axes, comparison: AirframeComparison, quantity: Quantity, places: FloatArray) -> None:
    numbers = numbers_of(comparison)[:4]
    known = numbers[np.isfinite(numbers)]
    high, low = max(known.max(initial=0.0), 1e-3), 0.0  # a rate is drawn from nothing
    if not quantity.is_rate:
        lowest = max(known.min(), quantity.in_unit(comparison.omnidirectional.value) - _DEEPEST_DB)
        high = known.max()
        low = lowest - 0.08 * max(high - lowest, 1.0) - 0.5
    axes.set_xlim(low, high + 0.2 * (high - low))
    values, bounds, nominal, _ = numbers
    lengths = np.nan_to_num(np.maximum(numbers, low) - low)
    cases = [result.case for result in comparison.results]
    colours = [VEHICLES["array" if case.array else case.name].colour for case in cases]
    axes.barh(places, lengths[0], left=low, height=0.62, zorder=2.0, color=colours)
    axes.hlines(places, low + lengths[0], bounds, color=INK, linewidth=1.0, zorder=3.0)
    axes.plot(bounds, places, "|", color=INK, markersize=7.0, zorder=3.0, label="upper bound")
    if comparison.scenario.is_uncertain:
        label = "guaranteed, robust pose"
        axes.barh(places, lengths[3], left=low, height=0.22, color=INK, zorder=2.2, label=label)
        seen = np.where(nominal >= low, nominal, math.nan)
        diamonds: dict[str, Any] = {
            "color": "white",
            "markeredgecolor": INK,
            "markersize": 5.0,
            "zorder": 2.4,
        }
        axes.plot(seen, places, "d", label="guaranteed, pose shown", **diamonds)
    for place in places[values < low]:
        axes.plot([low], [place], "<", color=GREY, clip_on=False, zorder=3.0)
    ends = low + np.maximum(lengths[0], lengths[1])
    for place, result, value, end in zip(places, comparison.results, values, ends, strict=True):
        axes.annotate(
            _words(comparison, quantity, result, value),
            (end, place),
            xytext=(5, 0),
            textcoords="offset points",
            va="center",
            fontsize="small",
            zorder=4.0,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
        )


def _words(comparison: AirframeComparison, quantity: Quantity, result: AirframeResult, value: float) -> str:
    """Return a vehicle's value, and its difference from the omnidirectional one's."""
    if result.objective is None:
        return "no pose reaches every node"
    difference = comparison.difference(result)
    if not math.isfinite(difference) or result is comparison.omnidirectional:
        return number(value, quantity)
    sign = "+" if difference > 0.0 else ""
    return f"{number(value, quantity)}  ({sign}{number(difference, quantity)})"
