"""Figures of comparisons: a dot at the value of each case or vehicle, and a tick at its bound."""

from __future__ import annotations

import math
from itertools import compress

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.answer import answer_lines
from nullpose.report.comparison import numbers_of
from nullpose.report.figures.style import CURVES, GREY, INK, VEHICLES, Look, house_figure, inches
from nullpose.report.figures.sweep import draw_caption
from nullpose.report.numbers import bound_text, capitalised, number
from nullpose.study import ResultTable
from nullpose.study.case import OMNIDIRECTIONAL

_ROW_INCH, _SENTENCE_INCH, _PRINTED = 0.33, 0.3, 0.66  # on a screen; height in print over that
_AT_EDGE: Look = {
    "fontsize": "small",
    "xytext": (-4.0, 1.0),
    "textcoords": "offset points",
    "ha": "right",
    "va": "bottom",
}
_GAP = 0.6  # between dipoles and arrays, in rows
_WIDEST_DB, _NEAR_DB = 25.0, 3.0  # from the best dipole, arrows beyond; bounds so near widen the axis
_BESIDE = 0.08  # of the width drawn, free at both ends


def draw_comparison(comparison: ResultTable, width: str | None = None) -> Figure:
    """Draw cases or vehicles compared: dots and answer, in print (a key of ``WIDTHS_MM``) dots alone."""
    lines = answer_lines(comparison) if OMNIDIRECTIONAL in comparison.names else []
    high = 1.6 + _ROW_INCH * len(comparison.rows)
    high = high + _SENTENCE_INCH * len(lines) if width is None else _PRINTED * high
    with house_figure((inches((7.0, high), width, 0.0)[0], high), width) as figure:
        axes = figure.add_subplot()
        draw_dots(axes, comparison)
        figure.legend(
            loc="outside upper center",
            ncols=3 if len(axes.get_legend_handles_labels()[0]) == 3 else 2,
            handlelength=1.2,
        )
        if width is None:
            axes.set_title(
                comparison.rows[0].scenario.name, loc="left", fontweight="bold", parse_math=False, wrap=True
            )
            draw_caption(figure, lines)
    return figure


def draw_dots(axes: Axes, comparison: ResultTable) -> None:
    """Draw a dot for each row, a tick at its bound, and what it guarantees under errors.

    At the right stand the values, and with vehicles their difference from the omnidirectional one's. A bound
    far above all values is an arrow at the edge, with its number.
    """
    found, quantity = comparison.rows, comparison.rows[0].objective.quantity
    is_array = np.array([row.case.array is not None for row in found])
    places = np.arange(len(found)) + _GAP * is_array
    values, bounds, nominal, robust, _ = numbers_of(comparison)
    low, high = _frame(axes, quantity, places, np.array([values, nominal, robust]), bounds, is_array)
    left, right = axes.get_xlim()
    shown = np.clip(np.nan_to_num(values, nan=low), low, high)
    is_far = bounds > high
    axes.hlines(places, left, right, color="#cccccc", linewidth=0.7, linestyle=(0, (1, 2)), zorder=1.0)
    axes.hlines(
        places, shown, np.where(is_far, right, np.fmax(bounds, shown)), color=INK, linewidth=1.0, zorder=2.0
    )
    dots: Look = {"linestyle": "", "clip_on": False, "zorder": 3.0}
    axes.plot([], [], "o", color=GREY, label="value found")
    for place, row, value, at in zip(places, found, values, shown, strict=True):
        mark, at = (">", 0.5 * (high + right)) if value > high else ("o", at) if value >= low else ("<", left)
        curve = {**CURVES, **VEHICLES}.get("array" if row.case.array else row.name)
        axes.plot(at, place, mark, color=curve.colour if curve else INK, **dots)
    marks: dict[str, tuple[FloatArray, Look]] = {
        "upper bound": (
            np.where(is_far, math.nan, bounds),
            {"marker": "|", "color": INK, "markersize": 13.0},
        ),
        "upper bound far above": (
            np.where(is_far, right, math.nan),
            {"marker": ">", "color": INK, "markersize": 4.5},
        ),
        "guaranteed, robust pose": (robust, {"marker": "d", "color": INK, "markersize": 5.0}),
        "guaranteed, pose shown": (
            nominal,
            {"marker": "d", "color": "white", "markeredgecolor": INK, "markersize": 5.0},
        ),
    }
    for label, (numbers, look) in marks.items():
        if np.any(np.isfinite(numbers)):
            is_seen = (numbers >= low) & (numbers <= right)
            axes.plot(np.where(is_seen, numbers, math.nan), places, label=label, **look | dots)
    for place, row in zip(places[is_far], compress(found, is_far), strict=True):
        axes.annotate(bound_text(row.objective, 1), (right, place), **_AT_EDGE)
    if np.any(shown != np.nan_to_num(values, nan=low)):
        axes.plot([], [], ">", color=GREY, label="beyond the axis")
    whole = dict(zip(comparison.names, values.tolist(), strict=True)).get(OMNIDIRECTIONAL, math.nan)
    if math.isfinite(whole):
        look = {"color": VEHICLES[OMNIDIRECTIONAL].colour, "linewidth": 0.9, "zorder": 1.5}
        axes.axvline(whole, label=OMNIDIRECTIONAL, **look)
    axes.set_yticks(places, [row.label for row in found])
    beside = axes.secondary_yaxis("right")
    beside.set_yticks(places, [_difference_words(value, whole, quantity) for value in values.tolist()])
    beside.tick_params(axis="y", length=0, pad=7.0)
    beside.spines["right"].set_visible(False)


def _frame(
    axes: Axes,
    quantity: Quantity,
    places: FloatArray,
    numbers: FloatArray,
    bounds: FloatArray,
    is_array: NDArray[np.bool_],
) -> tuple[float, float]:
    """Set limits and names of the axes; return the lowest and the highest number in view.

    All numbers that poses reach choose them, decibels up to 25 from the best dipole, then bounds near these.
    """
    finite, dipoles = (each[np.isfinite(each)] for each in (numbers, numbers[:, ~is_array]))
    finite = finite if finite.size else np.zeros(1)
    low, high = min(0.0, finite.min()), max(1e-3, finite.max())
    least = near = 1e-3
    if not quantity.is_rate:  # decibels have no natural zero
        best = dipoles.max() if dipoles.size else finite.max()
        low, high = max(finite.min(), best - _WIDEST_DB), finite.max()
        high, least, near = high if high <= best + _WIDEST_DB else best, 0.5, _NEAR_DB
    high = np.fmax.reduce(bounds, where=bounds <= high + max(near, high - low), initial=high)
    beside = _BESIDE * max(high - low, least)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    axes.set(
        xlim=(low - beside, high + beside),
        ylim=(places[-1] + 0.6, -0.6),
        xlabel=f"{capitalised(quantity.smallest_over)} ({quantity.unit})",
    )
    return float(low), float(high)


def _difference_words(value: float, whole: float, quantity: Quantity) -> str:
    """Write a value, and its difference from the omnidirectional vehicle's."""
    if math.isnan(value):
        return "no pose reaches every node"
    if not math.isfinite(difference := value - whole) or difference == 0.0:
        return number(value, quantity)
    return f"{number(value, quantity)}  ({'+' if difference > 0.0 else ''}{number(difference, quantity)})"
