"""The figures of a study's report: distribution functions, and gains with their intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import GREY, INK, VEHICLES, Curve, draw_curve, house_style, line_style
from nullpose.report.numbers import percent
from nullpose.report.study.cases import point_words, shown_points
from nullpose.report.study.summary import CONFIDENCE, WORST_TENTH, Summary, band_half_width

if TYPE_CHECKING:
    import pandas as pd

Line: TypeAlias = str | tuple[int, tuple[float, ...]]

_SHARES = ([0.0, 0.1, 0.25, 0.5, 0.75, 1.0], ["0", "10 %", "25 %", "50 %", "75 %", "100 %"])
_WIDTH, _NOTE = 7.0, 0.2  # inches: the text of a page, and each of two lines below
_DEEPEST = 40.0  # dB below the median of the lowest curve: deeper values leave the picture
_STEPS = 1000  # of a curve; more are not seen, and make a heavy file
_COLOURS = ("#d55e00", "#000000", "#8c564b", "#7f7f00", "#6a3d9a", "#8c8c8c")
_LINES: tuple[Line, ...] = ("-", (0, (5, 1.6)), (0, (3, 1.2, 1, 1.2)), (0, (1.2, 1.2)))
_MARKERS = ("X", "P", "h", "<", ">", "d")


def figures_of(summary: Summary) -> dict[str, Figure]:
    """Draw the figures that there are values for, by name."""
    points = [point for point in shown_points(summary.spec) if not np.all(np.isnan(summary.value[:, point]))]
    if not points:
        return {}
    return {"distribution": _distributions(summary, points)} | (
        {"gain": _gains(summary, points)} if summary.compared else {}
    )


def step_curve(numbers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Make the corners of an empirical distribution function, thinned if there are very many.

    Args:
        numbers: shape ``(n,)``, at least one, none NaN.
    """
    ordered = np.sort(numbers)
    ranks = np.unique(np.linspace(0, len(ordered) - 1, min(len(ordered), _STEPS)).round().astype(int))
    heights = (ranks + 1.0) / len(ordered)
    return np.concatenate([ordered[:1], ordered[ranks]]), np.concatenate([[0.0], heights])


def _distributions(summary: Summary, points: Sequence[int]) -> Figure:
    ends, looks = _range(summary, points), _looks(summary.cases)

    def draw(axes: Axes, point: int) -> None:
        for place, (look, column) in enumerate(zip(looks, summary.value[:, point].T, strict=True)):
            if len(column := column[~np.isnan(column)]):
                across, heights = step_curve(np.clip(column, *ends))
                half = band_half_width(len(column))
                band = np.clip(heights - half, 0.0, 1.0), np.clip(heights + half, 0.0, 1.0)
                every = max(1, len(across) // 7)
                start = 1 + every * place // len(looks)  # markers of two curves stand apart
                draw_curve(axes, look, across, heights, band, steps=True, every=(start, every))
        axes.set(xlim=ends, ylim=(0.0, 1.0))
        axes.axhline(WORST_TENTH, color=INK, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1.5)
        axes.set_yticks(*_SHARES)

    note = f"Bands: {percent(CONFIDENCE)} confidence (Dvoretzky-Kiefer-Wolfowitz). Dotted: the worst tenth."
    across = f"{summary.quantity.smallest_over} ({summary.quantity.unit})"
    return _panels(
        summary, points, draw, across=across, up="CDF over scenes", note=note, height=2.2, looks=looks
    )


def _range(summary: Summary, points: Sequence[int]) -> tuple[float, float]:
    """Choose the ends of the horizontal axis: deep values, down to no signal, are outside."""
    numbers = summary.value[:, list(points)]
    if not len(finite := numbers[np.isfinite(numbers)]):
        return -1.0, 1.0
    low, high = float(np.min(finite)), float(np.max(finite))
    if not summary.quantity.is_rate:
        medians = summary.frame.loc[summary.frame["point"].isin(points), "median"]
        low = float(np.fmax(low, medians[np.isfinite(medians)].min() - _DEEPEST))
    margin = 0.03 * (high - low) or 0.5
    return low - margin, high + margin


def _gains(summary: Summary, points: Sequence[int]) -> Figure:
    compared = summary.compared
    looks = {look.label: look.colour for look in _looks(summary.cases)}
    colours, places = [looks[case] for case in compared], np.arange(len(compared))

    def draw(axes: Axes, point: int) -> None:
        rows = summary.at(point).loc[compared].select_dtypes("number")
        rows = rows.where(np.isfinite(rows))
        low, high = rows["gain_worst_tenth"], rows["gain_best_tenth"]
        axes.hlines(places - 0.14, low, high, color=colours, zorder=2.0, linewidth=5.0, alpha=0.3)
        for name, marker, below in (("gain_median", "o", -0.14), ("shift_worst_tenth", "D", 0.2)):
            value, low, high = (rows[f"{name}{end}"] for end in ("", "_low", "_high"))
            axes.hlines(places + below, low, high, color=INK, linewidth=1.1, zorder=2.6)
            axes.scatter(value, places + below, marker=marker, c=colours, s=20.0, zorder=3.0)
        axes.axvline(0.0, color=INK, linewidth=0.8, zorder=1.4)
        axes.set_yticks(places, compared)
        axes.set_ylim(len(compared) - 0.4, -0.6)
        axes.grid(visible=False, axis="y")

    names = " or ".join(sorted(set(summary.cases.loc[compared, "against"])))
    return _panels(
        summary,
        points,
        draw,
        across=f"gain in the {summary.quantity.smallest} over {names} ({summary.quantity.unit})",
        note=f"Disc: median gain. Diamond: gain in the worst tenth. Lines: {percent(CONFIDENCE)} confidence. "
        "Bar: 10th to 90th percentile.",
        height=0.6 + 0.27 * len(compared),
    )


def _looks(cases: pd.DataFrame) -> list[Curve]:
    """Choose the looks of cases: usual vehicles as everywhere, guaranteed values dotted."""
    looks: list[Curve] = []
    others = zip(cycle(_COLOURS), cycle(_LINES), cycle(_MARKERS), strict=False)
    is_repeated = cases.duplicated(["usual", "robust"])
    for name, case in cases.iterrows():
        if case["usual"] in VEHICLES and not is_repeated[name]:
            look = VEHICLES[case["usual"]]
            look = replace(look, line=(0, (1.0, 1.2)), width=look.width + 0.3) if case["robust"] else look
        else:
            look = Curve("", *next(others), width=1.6, order=3.5)
        looks.append(replace(look, label=str(name)))
    return looks


def _panels(
    summary: Summary,
    points: Sequence[int],
    draw: Callable[[Axes, int], None],
    *,
    across: str,
    note: str,
    height: float,
    up: str = "",
    looks: Sequence[Curve] = (),
) -> Figure:
    """Set a panel for each combination of swept values, two in a row, with a legend of looks above them."""
    columns = min(2, len(points))
    down = -(-len(points) // columns)
    with house_style(), rc_context({"text.parse_math": False}):  # names are shown as they are
        high = 1.3 + height * down
        figure = Figure(
            figsize=(_WIDTH, high),
            layout=ConstrainedLayoutEngine(rect=(0.0, 2.0 * _NOTE / high, 1.0, 1.0 - 2.0 * _NOTE / high)),
        )
        panels = list(figure.subplots(down, columns, sharex=True, sharey=True, squeeze=False).flat)
        for axes, point in zip(panels, points, strict=False):
            axes.set_title(point_words(summary.spec, point), loc="left", fontsize=9.0, wrap=True)
            draw(axes, point)
        for axes in panels[len(points) :]:
            axes.remove()
        if looks:
            figure.legend(
                handles=[Line2D([], [], **line_style(look)) for look in looks],
                loc="outside upper center",
                ncols=3,
                fontsize=8.5,
            )
        figure.supylabel(up, fontsize=9.5)
        figure.supxlabel(across, y=_NOTE / high, va="bottom", fontsize=9.5)
        figure.text(0.012, 0.008, note, fontsize=7.5, color=GREY, va="bottom", ha="left")
    return figure
