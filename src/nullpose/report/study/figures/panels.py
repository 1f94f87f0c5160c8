"""What a report's figures share: panels side by side with a legend above, and how cases are drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from nullpose.report.figures.style import GREY, VEHICLES, Curve, house_style, line_style
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.summary import Summary

QUARTERS = ([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])  # ticks of an axis of shares

_WIDTH = 7.0  # inches: the text of a page
_LETTERS = 92  # of a legend's row, a handle being as wide as six

_FALLBACK = ("#d55e00", "#000000", "#8c564b", "#7f7f00", "#6a3d9a", "#8c8c8c")
_LINES: tuple[Any, ...] = ("-", (0, (5, 1.6)), (0, (3, 1.2, 1, 1.2)), (0, (1.2, 1.2)))
_MARKERS = ("X", "P", "h", "<", ">", "d")


def looks_of(cases: Sequence[ReportCase]) -> dict[str, Curve]:
    """Return how each case is drawn: known vehicles as everywhere, what is guaranteed dotted.

    Args:
        cases: of the study.
    """
    looks: dict[str, Curve] = {}
    others = zip(cycle(_FALLBACK), cycle(_LINES), cycle(_MARKERS), strict=False)
    taken: set[tuple[str, bool]] = set()
    for case in cases:
        if case.role in VEHICLES and (case.role, case.robust) not in taken:
            taken.add((case.role, case.robust))
            look = VEHICLES[case.role]
            if case.robust:
                look = replace(look, line=(0, (1.0, 1.2)), width=look.width + 0.3, order=look.order + 0.5)
        else:
            look = Curve("", *next(others), width=1.6, order=3.5)
        looks[case.name] = replace(look, label=case.name)
    return looks


def handles_of(cases: Sequence[ReportCase]) -> list[Any]:
    """Return what stands for the cases' curves in a legend.

    Args:
        cases: of the study.
    """
    return [Line2D([], [], **line_style(look)) for look in looks_of(cases).values()]


def points_with(summary: Summary, cases: Iterable[ReportCase]) -> tuple[int, ...]:
    """Return the combinations that are shown and have values of some of the cases.

    Args:
        summary: of a study.
        cases: which of its cases are to be drawn.
    """
    places = [case.place for case in cases]
    value = summary.values.value
    return tuple(point for point in summary.points.shown if not np.all(np.isnan(value[:, point, places])))


def panel_titles(summary: Summary, points: Sequence[int]) -> list[str]:
    """Return the swept values of some combinations, as the titles of their panels.

    Args:
        summary: of a study.
        points: numbers of the combinations.
    """
    words = map(summary.points.words, points)
    return [each.replace("P_M/P", "$P_M / P$").replace(", ", "\n") for each in words]


def side_by_side(
    titles: Sequence[str],
    draw: Callable[[Axes, int], None],
    handles: Sequence[Any],
    *,
    across: str = "",
    up: str = "",
    note: str = "",
    height: float,
    share_x: bool = True,
) -> Figure:
    """Return a figure with a panel for each title, two in a row, and a legend above them.

    Args:
        titles: of the panels, at least one.
        draw: draws what is in a panel, given the place of its title.
        handles: of the legend; none for no legend.
        across: what is across, with its unit.
        up: what is up, with its unit; empty where rows have names.
        note: a line below, about what is drawn.
        height: of a panel, inches.
        share_x: whether all have the same horizontal axis.
    """
    columns = min(2, len(titles))
    down = -(-len(titles) // columns)
    with house_style():
        figure = Figure(figsize=(_WIDTH, (1.3 if down == 1 else 0.9) + height * down), layout="constrained")
        panels = list(figure.subplots(down, columns, sharex=share_x, sharey=True, squeeze=False).flat)
        for place, axes in enumerate(panels):
            if place < len(titles):
                axes.set_title(titles[place], loc="left", fontsize=9.0)
                draw(axes, place)
            else:
                axes.remove()
                panels[place - columns].tick_params(labelbottom=True)
        if handles:
            _add_legend(figure, handles)
        figure.supylabel(up, fontsize=9.5)
        figure.supxlabel(f"{across}\n" if note else across, fontsize=9.5)
        figure.text(0.012, 0.008, note, fontsize=7.5, color=GREY, va="bottom", ha="left")
    return figure


def _add_legend(figure: Figure, handles: Sequence[Any]) -> None:
    letters = [len(str(handle.get_label())) for handle in handles]
    in_one_row = sum(letters) + 6 * len(letters) <= _LETTERS
    figure.legend(
        handles=list(handles),
        loc="outside upper center",
        ncols=len(letters) if in_one_row else max(1, min(4, _LETTERS // (max(letters) + 8))),
        frameon=False,
        fontsize=8.5,
        handlelength=2.6,
        columnspacing=1.2,
    )
