"""Cases in rows: what each gains, how often it is best, and what robustness costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from nullpose.report.figures.style import INK, Curve, house_style
from nullpose.report.numbers import percent
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.figures.panels import finish, looks_of, new_panels, points_with, row_axis
from nullpose.report.study.statistics import CONFIDENCE
from nullpose.report.study.summary import Summary, three_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_costs", "draw_gains", "draw_shares"]

_ROW = 0.27  # inches
_CONFIDENT = f"{percent(CONFIDENCE)} confidence"


def draw_gains(summary: Summary) -> Figure | None:
    """Return what each case gains over its reference, by combination; None if there is nothing to compare.

    Args:
        summary: of a study.
    """
    compared, unit = summary.compared, summary.quantity.unit

    def draw(axes: Axes, place: int, row: Any, look: Curve) -> None:
        _reach(axes, place, row, "gain_worst_tenth", "gain_best_tenth", look)
        _estimate(axes, place - 0.14, row, "gain_median", look, filled=True)
        _estimate(axes, place + 0.2, row, "shift_worst_tenth", look, filled=False)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=1.4)

    return _rows(
        summary,
        compared,
        draw,
        f"gain in the {summary.quantity.smallest} over {_references(summary, compared)}  ({unit})",
        _marks(
            "median of the gains on the same scenes",
            "gain of the worst tenth",
            "10th to 90th percentile of the gains",
        ),
    )


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
        axes.annotate(
            percent(share),
            (max(ends[1], share), place),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.5,
        )
        axes.set_xlim(0.0, 1.18)
        axes.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])

    if len(summary.cases) < 2:
        return None
    label = f"scenes in which no case is better  (lines: {_CONFIDENT})"
    return _rows(summary, list(summary.cases), draw, label, [])


def draw_costs(summary: Summary) -> Figure | None:
    """Return what each robust case gives up of the nominal one, by combination; None if there is none.

    Args:
        summary: of a study.
    """

    def draw(axes: Axes, place: int, row: Any, look: Curve) -> None:
        if not math.isnan(row["cost_median"]) and not math.isnan(row["cost_worst_tenth"]):
            ends = [float(row["cost_median"]), float(row["cost_worst_tenth"])]
            axes.plot(ends, [place, place], color=look.colour, linewidth=4.0, alpha=0.35, zorder=2.0)
        _estimate(axes, place, row, "cost_median", look, filled=True)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=1.4)

    unit = summary.quantity.unit
    label = f"nominal less guaranteed {summary.quantity.smallest}  ({unit})"
    return _rows(summary, summary.paired, draw, label, _marks("median", "", "up to the worst tenth"))


def _rows(
    summary: Summary,
    cases: Sequence[ReportCase],
    draw: Callable[[Axes, int, Any, Curve], None],
    xlabel: str,
    handles: list[Any],
) -> Figure | None:
    """Return panels with a row for each case, or None if no case has a value."""
    points = points_with(summary, cases)
    if not points:
        return None
    looks = looks_of(summary.cases)
    with house_style():
        figure, panels = new_panels(summary, points, height=0.35 + _ROW * (len(cases) + 1))
        for axes, point in zip(panels, points, strict=True):
            row_axis(axes, [case.name for case in cases])
            for place, case in enumerate(cases):
                draw(axes, place, summary.row(point, case), looks[case.name])
        finish(figure, handles, xlabel, "")
    return figure


def _reach(axes: Axes, place: float, row: Any, low: str, high: str, look: Curve) -> None:
    ends = [float(row[low]), float(row[high])]
    if all(map(math.isfinite, ends)):
        axes.plot(
            ends,
            [place - 0.14] * 2,
            color=look.colour,
            linewidth=5.0,
            alpha=0.3,
            solid_capstyle="butt",
            zorder=2.0,
        )


def _estimate(axes: Axes, place: float, row: Any, name: str, look: Curve, *, filled: bool) -> None:
    value, *ends = three_of(row, name)
    if not math.isfinite(value):
        return
    if all(map(math.isfinite, ends)):
        axes.plot(ends, [place, place], color=INK, linewidth=1.1, zorder=2.6)
    axes.plot(
        [value],
        [place],
        marker="o" if filled else "D",
        markersize=5.0 if filled else 4.2,
        color=look.colour,
        markerfacecolor=look.colour if filled else "white",
        markeredgecolor=INK if filled else look.colour,
        markeredgewidth=0.6 if filled else 1.2,
        linestyle="",
        zorder=3.0,
    )


def _references(summary: Summary, cases: Sequence[ReportCase]) -> str:
    names = {reference.name for case in cases if (reference := summary.reference(case)) is not None}
    return " or ".join(sorted(names)) if len(names) <= 2 else "its reference"


def _marks(filled: str, hollow: str, bar: str) -> list[Any]:
    from matplotlib.lines import Line2D

    common: dict[str, Any] = {"linestyle": "", "markeredgecolor": INK}
    handles = [Line2D([], [], marker="o", markersize=5.0, color=INK, label=filled, **common)]
    if hollow:
        handles.append(
            Line2D([], [], marker="D", markersize=4.2, markerfacecolor="white", label=hollow, **common)
        )
    handles.append(Line2D([], [], color=INK, linewidth=1.1, label=_CONFIDENT))
    handles.append(Line2D([], [], color=INK, linewidth=5.0, alpha=0.3, label=bar))
    return handles
