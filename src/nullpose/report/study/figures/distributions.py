"""Distribution functions of what is reached, and the same as outage against what is required."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK, house_style
from nullpose.report.numbers import percent
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.figures.panels import (
    finish,
    looks_of,
    new_panels,
    points_with,
    step_curve,
    style_of,
)
from nullpose.report.study.statistics import CONFIDENCE, WORST_TENTH, band_half_width
from nullpose.report.study.summary import Summary

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_distributions", "draw_outage"]

_DEEPEST = 40.0  # dB below the median of the lowest curve: what lies deeper leaves the picture


def draw_distributions(summary: Summary) -> Figure | None:
    """Return the distribution functions of all cases with their bands; None if there is no value at all.

    Args:
        summary: of a study.
    """

    def dress(axes: Axes) -> None:
        axes.set_ylim(0.0, 1.0)
        axes.axhline(WORST_TENTH, color=INK, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1.5)
        axes.set_yticks([0.0, 0.1, 0.25, 0.5, 0.75, 1.0], ["0", "10 %", "25 %", "50 %", "75 %", "100 %"])

    quantity = summary.quantity
    note = f"Bands: {percent(CONFIDENCE)} confidence (Dvoretzky-Kiefer-Wolfowitz). Dotted: the worst tenth."
    labels = (f"{quantity.smallest} over the nodes  ({quantity.unit})", "scenes with no more", note)
    return _draw(summary, dress, labels, banded=True)


def draw_outage(summary: Summary) -> Figure | None:
    """Return the outage of all cases against what is required, a requirement marked; None without values.

    Args:
        summary: of a study.
    """
    required = summary.requirement

    def dress(axes: Axes) -> None:
        axes.set_yscale("log")
        axes.set_ylim(max(0.7 / summary.values.scenes, 1e-6), 1.15)
        if required is not None:
            axes.axvline(required, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), zorder=1.8)

    note = "" if required is None else "Dashed upright: the requirement."
    labels = (f"required {summary.quantity.noun}  ({summary.quantity.unit})", "outage probability", note)
    return _draw(summary, dress, labels, banded=False)


def _draw(
    summary: Summary, dress: Callable[[Axes], None], labels: tuple[str, str, str], *, banded: bool
) -> Figure | None:
    """Return panels with a curve for each case, or None if no case has a value."""
    points = points_with(summary, summary.cases)
    if not points:
        return None
    with house_style():
        figure, panels = new_panels(summary, points, height=2.9 if len(points) == 1 else 2.2)
        low, high = _range(summary, points)
        if summary.requirement is not None and not banded:
            low, high = min(low, summary.requirement - 1.0), max(high, summary.requirement + 1.0)
        for axes, point in zip(panels, points, strict=True):
            handles = [
                _curve(axes, summary, point, case, (low, high), banded=banded) for case in summary.cases
            ]
            axes.set_xlim(low, high)
            dress(axes)
        finish(figure, handles, *labels)
    return figure


def _range(summary: Summary, points: tuple[int, ...]) -> tuple[float, float]:
    """Return the ends of the axis across: from the deepest number that is still of interest."""
    numbers = summary.values.value[:, list(points)]
    finite = numbers[np.isfinite(numbers)]
    if not len(finite):
        return -1.0, 1.0
    low, high = float(np.min(finite)), float(np.max(finite))
    if not summary.quantity.is_rate:
        medians = [float(summary.row(point, case)["median"]) for point in points for case in summary.cases]
        low = max(low, min((each for each in medians if math.isfinite(each)), default=low) - _DEEPEST)
    room = 0.03 * (high - low) or 0.5
    return low - room, high + room


def _curve(
    axes: Axes, summary: Summary, point: int, case: ReportCase, ends: tuple[float, float], *, banded: bool
) -> Any:
    """Draw a case's curve and its band if there are values; return what stands for it in the legend."""
    from matplotlib.lines import Line2D

    look = looks_of(summary.cases)[case.name]
    style = style_of(look, look.marker) | {"markersize": 4.0}
    column = summary.values.value[:, point, case.place]
    column = column[~np.isnan(column)]
    if len(column):
        across, shares = _closed(*step_curve(column), ends)
        every = max(1, len(across) // 7)
        start = 1 + int(every * case.place / max(1, len(summary.cases)))
        axes.step(across, shares, where="post", markevery=(start, every), **style)
        if banded:
            half = band_half_width(len(column))
            own = (across >= np.min(column)) & (across <= np.max(column))  # beyond them it says little
            axes.fill_between(
                across[own],
                np.clip(shares[own] - half, 0.0, 1.0),
                np.clip(shares[own] + half, 0.0, 1.0),
                step="post",
                color=look.colour,
                alpha=0.11,
                linewidth=0.0,
                zorder=1.0,
            )
    return Line2D([], [], **style)


def _closed(
    across: FloatArray, shares: FloatArray, ends: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Return the corners within the picture, from nothing or from the height at its left end."""
    inside = (across > ends[0]) & (across < ends[1])
    before = shares[across <= ends[0]]
    start = ends[0] if len(before) or not np.any(inside) else across[inside][0]
    height = float(before[-1]) if len(before) else 0.0
    return np.concatenate([[start], across[inside]]), np.concatenate([[height], shares[inside]])
