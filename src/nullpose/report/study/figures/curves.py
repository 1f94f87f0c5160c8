"""Curves along a swept parameter, and how gaps and seconds are distributed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import Curve, house_style
from nullpose.report.numbers import percent
from nullpose.report.study.figures.panels import finish, looks_of, step_curve, style_of
from nullpose.report.study.statistics import CONFIDENCE
from nullpose.report.study.summary import Summary
from nullpose.report.study.values import STATUSES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_along", "draw_effort"]

_LEAST_GAP = 1e-12  # a gap of nothing is drawn here
_SPREAD = 20.0  # values this many times apart are drawn on a logarithmic axis


def draw_along(summary: Summary) -> Figure | None:
    """Return median and worst tenth of each case along the longest sweep; None if nothing is swept.

    Args:
        summary: of a study.
    """
    from matplotlib.figure import Figure

    path, points = summary.points.longest, summary.points.along
    if len(points) < 2 or np.all(np.isnan(summary.values.value[:, list(points)])):
        return None
    quantity = summary.quantity
    across = np.array([summary.points.number(point, path) for point in points])
    order = np.argsort(across)
    with house_style():
        figure = Figure(figsize=(7.0, 3.6), layout="constrained")
        panels = figure.subplots(1, 2, sharey=True)
        for axes, name, title in zip(
            panels, ("median", "worst_tenth"), ("median", "worst tenth (10th percentile)"), strict=True
        ):
            axes.set_title(title, loc="left", fontsize=9.0)
            _along(axes, summary, points, across, order, name)
        handles, _ = panels[0].get_legend_handles_labels()
        last = summary.spec.points[-1]
        fixed = [f"{each} = {last[each]:g}" for each in summary.spec.swept if each != path]
        note = f"Bands: {percent(CONFIDENCE)} confidence for each point (order statistics)."
        note += f" At {', '.join(fixed)}." if fixed else ""
        finish(
            figure, handles, summary.points.axis_label(path), f"{quantity.smallest}  ({quantity.unit})", note
        )
    return figure


def _along(
    axes: Axes,
    summary: Summary,
    points: tuple[int, ...],
    across: FloatArray,
    order: NDArray[np.intp],
    name: str,
) -> None:
    looks = looks_of(summary.cases)
    for case in summary.cases:
        look = looks[case.name]
        rows = [summary.row(point, case) for point in points]
        middle, low, high = (
            np.array([float(row[key]) for row in rows])[order]
            for key in (name, f"{name}_low", f"{name}_high")
        )
        middle = np.where(np.isfinite(middle), middle, np.nan)
        axes.plot(
            across[order],
            middle,
            markersize=4.4,
            **style_of(look, look.marker),
        )
        known = np.isfinite(low) & np.isfinite(high)
        axes.fill_between(
            across[order], low, high, where=known, color=look.colour, alpha=0.12, linewidth=0.0, zorder=1.0
        )
    if np.min(across) > 0.0 and np.max(across) >= _SPREAD * np.min(across):
        axes.set_xscale("log")


def draw_effort(summary: Summary) -> Figure | None:
    """Return how seconds and gaps are distributed, by case over all combinations; None without a pose.

    Args:
        summary: of a study.
    """
    from matplotlib.figure import Figure

    values = summary.values
    solved = values.status != STATUSES.index("failed")
    if not np.any(solved):
        return None
    looks = looks_of(summary.cases)
    columns = [(values.seconds, "time of a solve  (s)", 1e-6)]
    if not np.all(np.isnan(values.gap)):
        columns.append((values.gap, "relative gap of the proof", _LEAST_GAP))
    with house_style():
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        panels = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
        for axes, (numbers, label, least) in zip(panels, columns, strict=True):
            for case in summary.cases:
                kept = numbers[:, :, case.place][solved[:, :, case.place]].astype(float)
                _step(axes, kept[~np.isnan(kept)], looks[case.name], least)
            axes.set_xscale("log")
            axes.set_xlabel(label)
            axes.set_ylim(0.0, 1.02)
        panels[0].set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])
        panels[0].set_ylabel("solves with no more")
        handles, _ = panels[0].get_legend_handles_labels()
        finish(figure, handles, "", "")
    return figure


def _step(axes: Axes, numbers: FloatArray, look: Curve, least: float) -> None:
    if len(numbers):
        across, shares = step_curve(np.maximum(numbers, least))
        axes.step(
            np.concatenate([across[:1], across]),
            np.concatenate([[0.0], shares]),
            where="post",
            **style_of(look),
        )
