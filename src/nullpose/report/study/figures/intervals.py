"""Cases in rows: what each gains, how often it is best, and what robustness costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from nullpose.report.figures.style import INK, Curve
from nullpose.report.numbers import percent
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.figures.panels import (
    QUARTERS,
    looks_of,
    panel_titles,
    points_with,
    side_by_side,
)
from nullpose.report.study.statistics import CONFIDENCE
from nullpose.report.study.summary import Summary, three_of

_ROW = 0.27  # inches
_CONFIDENT = f"{percent(CONFIDENCE)} confidence"
_DISC: dict[str, Any] = {"marker": "o", "markersize": 5.0, "markeredgecolor": INK, "markeredgewidth": 0.6}
_DIAMOND: dict[str, Any] = {
    "marker": "D",
    "markersize": 4.2,
    "markerfacecolor": "white",
    "markeredgewidth": 1.2,
}
_BAR: dict[str, Any] = {"linewidth": 5.0, "alpha": 0.3, "solid_capstyle": "butt"}


def draw_gains(summary: Summary) -> Figure | None:
    """Return what each case gains over its reference, by combination; None if there is nothing to compare.

    Args:
        summary: of a study.
    """
    compared, quantity = summary.compared, summary.quantity

    def draw(axes: Axes, place: int, row: Any, look: Curve) -> None:
        _bar(axes, place - 0.14, row, ("gain_worst_tenth", "gain_best_tenth"), look)
        _estimate(axes, place - 0.14, row, "gain_median", look, _DISC)
        _estimate(axes, place + 0.2, row, "shift_worst_tenth", look, _DIAMOND)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=1.4)

    names = sorted({summary.cases[case.reference].name for case in compared})
    references = " or ".join(names) if len(names) <= 2 else "its reference"
    label = f"gain in the {quantity.smallest} over {references}  ({quantity.unit})"
    marks = {
        "median of the gains on the same scenes": _DISC,
        "difference of the 10th percentiles": _DIAMOND,
        _CONFIDENT: {"linewidth": 1.1},
        "10th to 90th percentile of the gains": _BAR,
    }
    return _rows(summary, compared, draw, label, marks)


def draw_shares(summary: Summary) -> Figure | None:
    """Return in what share of scenes each case is as good as the best, by combination.

    Args:
        summary: of a study.
    """

    def draw(axes: Axes, place: int, row: Any, look: Curve) -> None:
        share, *ends = three_of(row, "best_share")
        if math.isnan(share):
            return
        axes.barh(place, share, height=0.6, color=look.colour, alpha=0.75, zorder=2.0)
        axes.plot(ends, [place, place], color=INK, linewidth=1.1, marker="|", markersize=5.0, zorder=3.0)
        beside: dict[str, Any] = {"xytext": (4, 0), "textcoords": "offset points"}
        axes.annotate(percent(share), (max(ends[1], share), place), va="center", fontsize=7.5, **beside)
        axes.set_xlim(0.0, 1.18)
        axes.set_xticks(*QUARTERS)

    cases = summary.cases if len(summary.cases) > 1 else ()
    return _rows(summary, cases, draw, f"scenes in which no case is better  (lines: {_CONFIDENT})", {})


def draw_costs(summary: Summary) -> Figure | None:
    """Return what each robust case gives up of the nominal one, by combination; None if there is none.

    Args:
        summary: of a study.
    """

    def draw(axes: Axes, place: int, row: Any, look: Curve) -> None:
        _bar(axes, place, row, ("cost_median", "cost_worst_tenth"), look)
        _estimate(axes, place, row, "cost_median", look, _DISC)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=1.4)

    label = f"nominal less guaranteed {summary.quantity.smallest}  ({summary.quantity.unit})"
    marks = {"median": _DISC, _CONFIDENT: {"linewidth": 1.1}, "up to the worst tenth": _BAR}
    return _rows(summary, summary.paired, draw, label, marks)


def _rows(
    summary: Summary,
    cases: Sequence[ReportCase],
    draw: Callable[[Axes, int, Any, Curve], None],
    xlabel: str,
    marks: dict[str, dict[str, Any]],
) -> Figure | None:
    """Return panels with a row for each case, the first on top, or None if no case has a value."""
    points = points_with(summary, cases)
    if not points:
        return None
    looks = looks_of(summary.cases)

    def draw_rows(axes: Axes, panel: int) -> None:
        axes.set_yticks(range(len(cases)), [case.name for case in cases])
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(len(cases) - 0.4, -0.6)
        axes.grid(visible=False, axis="y")
        for place, case in enumerate(cases):
            draw(axes, place, summary.row(points[panel], case), looks[case.name])

    handles = [
        Line2D([], [], color=INK, label=label, linestyle="" if "marker" in mark else "-", **mark)
        for label, mark in marks.items()
    ]
    height = 0.35 + _ROW * (len(cases) + 1)
    return side_by_side(panel_titles(summary, points), draw_rows, handles, across=xlabel, height=height)


def _bar(axes: Axes, place: float, row: Any, names: tuple[str, str], look: Curve) -> None:
    ends = [float(row[name]) for name in names]
    if all(map(math.isfinite, ends)):
        axes.plot(ends, [place, place], color=look.colour, zorder=2.0, **_BAR)


def _estimate(axes: Axes, place: float, row: Any, name: str, look: Curve, mark: dict[str, Any]) -> None:
    value, *ends = three_of(row, name)
    if not math.isfinite(value):
        return
    if all(map(math.isfinite, ends)):
        axes.plot(ends, [place, place], color=INK, linewidth=1.1, zorder=2.6)
    axes.plot([value], [place], color=look.colour, linestyle="", zorder=3.0, **mark)
