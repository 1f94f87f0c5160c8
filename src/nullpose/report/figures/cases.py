"""The figure of a comparison of cases: a bar for each, with its bound."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.report.comparison import Comparison
from nullpose.report.figures.style import CURVES, INK, house_style, inches
from nullpose.report.numbers import begun, number
from nullpose.solver import Result

_ROW_INCH = 0.36
_ROOM = 0.3  # beside the longest bar, for its number, of the width drawn


def draw_comparison(comparison: Comparison, width: str | None = None) -> Figure:
    """Return the figure of the cases of a scenario.

    Args:
        comparison: what each scheme makes of a scenario.
        width: in print, where there is no title, a key of ``WIDTHS_MM``; None for a screen.
    """
    with house_style(width):
        high = 1.0 + _ROW_INCH * len(comparison.solutions)
        figure = Figure(figsize=(inches((7.0, 0.0), width, 0.0)[0], high), layout="constrained")
        axes = figure.add_subplot()
        draw_cases(axes, comparison.solutions)
        if width is None:
            axes.set_title(comparison.scenario.name, loc="left", fontweight="bold", parse_math=False)
    return figure


def draw_cases(axes: Axes, results: Sequence[Result]) -> None:
    """Draw a bar for each result, with a mark at the bound that no pose of the case exceeds.

    Args:
        axes: where to draw.
        results: of several cases of one scenario.
    """
    quantity = results[0].objective.quantity
    values = np.array([quantity.in_unit(one.objective.value) for one in results])
    bounds = np.array([quantity.in_unit(one.objective.upper_bound or np.nan) for one in results])
    high, low = float(np.fmax.reduce([*values, *bounds])), 0.0
    if not quantity.is_rate:  # decibels have no natural zero: the shortest bar is a quarter of the longest
        known = values[np.isfinite(values)]
        low = float(known.min()) - max(1.0, float(np.ptp(known)) / 3.0)
    places = np.arange(len(results))
    colours = [CURVES[str(one.scheme)].colour if str(one.scheme) in CURVES else INK for one in results]
    axes.barh(
        places, np.nan_to_num(values - low, neginf=0.0), left=low, height=0.6, color=colours, zorder=2.0
    )
    axes.plot(bounds, places, "|", color=INK, markersize=11.0, zorder=3.0, label="upper bound")
    look: dict[str, Any] = {"xytext": (6, 0), "textcoords": "offset points", "va": "center"}
    for place, value, bound in zip(places, values, bounds, strict=True):
        axes.annotate(number(float(value), quantity), (float(np.fmax(max(value, low), bound)), place), **look)
    if np.any(np.isfinite(bounds)):
        axes.legend(loc="lower right", frameon=False, handlelength=1.0)
    axes.set_yticks(places, [one.label for one in results])
    axes.tick_params(axis="y", length=0)
    axes.set(xlim=(low, high + _ROOM * (high - low)), ylim=(len(results) - 0.4, -0.6))
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(f"{begun(quantity.smallest)} over the nodes  ({quantity.unit})")
