"""Curves: distribution functions of what is reached and needed, outage, and the course along a sweep."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK, draw_curve
from nullpose.report.numbers import percent
from nullpose.report.study.figures.panels import (
    QUARTERS,
    handles_of,
    looks_of,
    panel_titles,
    points_with,
    side_by_side,
)
from nullpose.report.study.statistics import CONFIDENCE, WORST_TENTH, band_half_width
from nullpose.report.study.summary import Summary, three_of
from nullpose.report.study.values import FAILED

_DEEPEST = 40.0  # dB below the median of the lowest curve: what lies deeper leaves the picture
_LEAST = 1e-12  # times and gaps of nothing are drawn here
_SPREAD = 20.0  # values this many times apart are drawn on a logarithmic axis
_STEPS = 500  # of a curve, about; more are not seen, and make a heavy file

Ends = tuple[float, float]


def draw_distributions(summary: Summary) -> Figure | None:
    """Return the distribution functions of all cases with their bands; None if there is no value at all.

    Args:
        summary: of a study.
    """

    def dress(axes: Axes) -> None:
        axes.set_ylim(0.0, 1.0)
        axes.axhline(WORST_TENTH, color=INK, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1.5)
        axes.set_yticks([0.0, 0.1, *QUARTERS[0][1:]], ["0", "10 %", *QUARTERS[1][1:]])

    quantity = summary.quantity
    note = f"Bands: {percent(CONFIDENCE)} confidence (Dvoretzky-Kiefer-Wolfowitz). Dotted: the worst tenth."
    across = f"{quantity.smallest} over the nodes  ({quantity.unit})"
    return _distributions(summary, dress, across, "CDF over scenes", note, banded=True)


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

    note = "" if required is None else "Dashed: the requirement."
    across = f"required {summary.quantity.noun}  ({summary.quantity.unit})"
    return _distributions(summary, dress, across, "outage probability", note, banded=False)


def _distributions(
    summary: Summary, dress: Callable[[Axes], None], across: str, up: str, note: str, *, banded: bool
) -> Figure | None:
    """Return panels with a curve for each case, or None if no case has a value."""
    points, looks = points_with(summary, summary.cases), looks_of(summary.cases)
    if not points:
        return None
    low, high = _range(summary, points)
    if summary.requirement is not None and not banded:
        low, high = min(low, summary.requirement - 1.0), max(high, summary.requirement + 1.0)

    def draw(axes: Axes, place: int) -> None:
        for case in summary.cases:
            column = summary.values.value[:, points[place], case.place]
            column = column[~np.isnan(column)]
            if len(column):
                places, shares = step_curve(column, (low, high))
                band = _band(column, places, shares) if banded else None
                every = max(1, len(places) // 7)
                start = 1 + int(every * case.place / len(summary.cases))  # markers of two curves stand apart
                look = looks[case.name]
                draw_curve(axes, look, places, shares, band, steps=True, every=(start, every))
        axes.set_xlim(low, high)
        dress(axes)

    height = 2.9 if len(points) == 1 else 2.2
    titles, handles = panel_titles(summary, points), handles_of(summary.cases)
    return side_by_side(titles, draw, handles, across=across, up=up, note=note, height=height)


def _range(summary: Summary, points: tuple[int, ...]) -> Ends:
    """Return the ends of the axis across: from the deepest number that is still of interest."""
    numbers = summary.values.value[:, list(points)]
    finite = numbers[np.isfinite(numbers)]
    if not len(finite):
        return -1.0, 1.0
    low, high = float(np.min(finite)), float(np.max(finite))
    medians = summary.frame.loc[summary.frame["point"].isin(points), "median"]
    if not summary.quantity.is_rate and np.any(np.isfinite(medians)):
        low = max(low, float(np.min(medians[np.isfinite(medians)])) - _DEEPEST)
    margin = 0.03 * (high - low) or 0.5
    return low - margin, high + margin


def _band(column: FloatArray, across: FloatArray, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the ends of the band around a distribution function; beyond its numbers it says little."""
    half = band_half_width(len(column))
    own = np.where((across >= np.min(column)) & (across <= np.max(column)), shares, np.nan)
    return np.clip(own - half, 0.0, 1.0), np.clip(own + half, 0.0, 1.0)


def step_curve(numbers: FloatArray, ends: Ends = (-np.inf, np.inf)) -> tuple[FloatArray, FloatArray]:
    """Return the corners of an empirical distribution function, thinned if there are very many.

    The first corner is at a height of nothing, or at the left end of the picture.

    Args:
        numbers: shape ``(n,)``, at least one, none NaN; infinities count and are drawn outside.
        ends: of the picture.
    """
    ordered = np.sort(numbers)
    shares = np.arange(1, len(ordered) + 1) / len(ordered)
    if len(ordered) > 2 * _STEPS:
        evenly = np.linspace(0, len(ordered) - 1, _STEPS)
        tail = np.geomspace(1, len(ordered), _STEPS // 2) - 1  # outage is read where it is rare
        kept = np.unique(np.concatenate([evenly, tail]).round().astype(int))
        ordered, shares = ordered[kept], shares[kept]
    inside = (ordered > ends[0]) & (ordered < ends[1])
    before = shares[ordered <= ends[0]]
    start = ends[0] if len(before) or not np.any(inside) else ordered[inside][0]
    height = float(before[-1]) if len(before) else 0.0
    return np.concatenate([[start], ordered[inside]]), np.concatenate([[height], shares[inside]])


def draw_along(summary: Summary) -> Figure | None:
    """Return median and worst tenth of each case along the longest sweep; None if nothing is swept.

    Args:
        summary: of a study.
    """
    path = summary.points.longest
    points = sorted(summary.points.along, key=lambda point: summary.points.number(point, path) if path else 0)
    if len(points) < 2 or np.all(np.isnan(summary.values.value[:, points])):
        return None
    across = np.array([summary.points.number(point, path) for point in points])
    titles = {"median": "median", "worst_tenth": "worst tenth (10th percentile)"}
    looks = looks_of(summary.cases)

    def draw(axes: Axes, place: int) -> None:
        for case in summary.cases:
            rows = [three_of(summary.row(point, case), list(titles)[place]) for point in points]
            heights, low, high = np.array(rows).T
            draw_curve(axes, looks[case.name], across, heights, (low, high))
        if across[0] > 0.0 and across[-1] >= _SPREAD * across[0]:
            axes.set_xscale("log")

    last, quantity = summary.spec.points[-1], summary.quantity
    fixed = [f"{each} = {last[each]:g}" for each in summary.spec.swept if each != path]
    note = f"Bands: {percent(CONFIDENCE)} confidence for each point (order statistics)."
    note += f" At {', '.join(fixed)}." if fixed else ""
    return side_by_side(
        list(titles.values()),
        draw,
        handles_of(summary.cases),
        across=summary.points.axis_label(path),
        up=f"{quantity.smallest}  ({quantity.unit})",
        note=note,
        height=2.3,
    )


def draw_effort(summary: Summary) -> Figure | None:
    """Return how seconds and gaps are distributed, by case over all combinations; None without a pose.

    Args:
        summary: of a study.
    """
    values, looks = summary.values, looks_of(summary.cases)
    if np.all(values.status == FAILED):
        return None
    columns = {"time of a solve  (s)": values.seconds, "relative gap of the proof": values.gap}
    drawn = [label for label, numbers in columns.items() if not np.all(np.isnan(numbers))]

    def draw(axes: Axes, place: int) -> None:
        for case in summary.cases:
            numbers = columns[drawn[place]][:, :, case.place].astype(float)
            numbers = np.maximum(numbers[~np.isnan(numbers)], _LEAST)
            if len(numbers):
                draw_curve(axes, looks[case.name], *step_curve(numbers), steps=True, every=0.2)
        axes.set(xscale="log", xlabel=drawn[place], ylim=(0.0, 1.02))
        axes.set_yticks(*QUARTERS)

    titles, handles, up = [""] * len(drawn), handles_of(summary.cases), "CDF over solves"
    return side_by_side(titles, draw, handles, up=up, height=1.9, share_x=False)
