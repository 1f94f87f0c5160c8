"""Small multiples that a report's figures share: a panel for each combination of swept values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import GREY, VEHICLES, Curve
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.summary import Summary

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["finish", "looks_of", "new_panels", "points_with", "row_axis", "step_curve", "style_of"]

_WIDTH = 7.0  # inches: the text of a page
_LETTERS = 92  # of a legend's row, a handle being as wide as six
_STEPS = 500  # of a curve, about; more are not seen, and make a heavy file

_FALLBACK = ("#d55e00", "#000000", "#8c564b", "#7f7f00", "#6a3d9a", "#8c8c8c")
_LINES: tuple[Any, ...] = ("-", (0, (5, 1.6)), (0, (3, 1.2, 1, 1.2)), (0, (1.2, 1.2)))
_MARKERS = ("X", "P", "h", "<", ">", "d")


def looks_of(cases: Sequence[ReportCase]) -> dict[str, Curve]:
    """Return how each case is drawn: known vehicles as everywhere, what is guaranteed dotted.

    Args:
        cases: of the study.
    """
    looks: dict[str, Curve] = {}
    taken: set[tuple[str, bool]] = set()
    others = 0
    for case in cases:
        if case.role in VEHICLES and (case.role, case.robust) not in taken:
            taken.add((case.role, case.robust))
            look = replace(VEHICLES[case.role], label=case.name)
            if case.robust:
                look = replace(look, line=(0, (1.0, 1.2)), width=look.width + 0.3, order=look.order + 0.5)
        else:
            colour, marker = (each[others % len(each)] for each in (_FALLBACK, _MARKERS))
            look = Curve(case.name, colour, _LINES[others % len(_LINES)], marker, 1.6, 3.5)
            others += 1
        looks[case.name] = look
    return looks


def style_of(look: Curve, marker: str = "") -> dict[str, Any]:
    """Return how a case's line is drawn, as Matplotlib's arguments.

    Args:
        look: of the case.
        marker: of its points; empty for none.
    """
    style: dict[str, Any] = {"color": look.colour, "linestyle": look.line, "linewidth": look.width}
    return style | {"marker": marker, "markerfacecolor": "white", "zorder": look.order, "label": look.label}


def points_with(summary: Summary, cases: Iterable[ReportCase]) -> tuple[int, ...]:
    """Return the combinations that are shown and have values of some of the cases.

    Args:
        summary: of a study.
        cases: which of its cases are to be drawn.
    """
    places = [case.place for case in cases]
    value = summary.values.value
    return tuple(
        point for point in summary.points.shown if places and not np.all(np.isnan(value[:, point, places]))
    )


def new_panels(
    summary: Summary, points: Sequence[int], *, height: float, share_y: bool = True
) -> tuple[Figure, list[Axes]]:
    """Return a figure with a panel for each combination, its values as title.

    Args:
        summary: of a study.
        points: numbers of the combinations, at least one.
        height: of a panel, inches.
        share_y: whether all have the same vertical axis, named on the left only.
    """
    from matplotlib.figure import Figure

    across = 1 if len(points) == 1 else 2
    down = -(-len(points) // across)
    figure = Figure(figsize=(_WIDTH, (1.3 if down == 1 else 0.9) + height * down), layout="constrained")
    grid = figure.subplots(down, across, sharex=True, sharey=share_y, squeeze=False)
    panels: list[Axes] = list(grid.flat)
    for axes, point in zip(panels, points, strict=False):
        words = summary.points.words(point).replace("P_M/P", "$P_M / P$").replace(", ", "\n")
        axes.set_title(words, loc="left", fontsize=9.0)
    for axes in panels[len(points) :]:
        axes.set_visible(False)
        panels[len(points) - across].tick_params(labelbottom=True)
    return figure, panels[: len(points)]


def finish(figure: Figure, handles: Sequence[Any], xlabel: str, ylabel: str, note: str = "") -> None:
    """Put the legend above the panels and the labels around them.

    Args:
        figure: with its panels.
        handles: of the legend; none for no legend.
        xlabel: what is across, with its unit.
        ylabel: what is up, with its unit; empty where rows have names.
        note: a line below, about what is drawn.
    """
    if handles:
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
    if ylabel:
        figure.supylabel(ylabel, fontsize=9.5)
    if note:
        xlabel = f"{xlabel}\n"
        figure.text(0.012, 0.008, note, fontsize=7.5, color=GREY, va="bottom", ha="left")
    figure.supxlabel(xlabel, fontsize=9.5)


def step_curve(numbers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the corners of an empirical distribution function, thinned if there are very many.

    Args:
        numbers: shape ``(n,)``, at least one, none NaN; infinities count and are drawn outside.
    """
    ordered = np.sort(numbers)
    shares = np.arange(1, len(ordered) + 1) / len(ordered)
    if len(ordered) > 2 * _STEPS:
        evenly = np.linspace(0, len(ordered) - 1, _STEPS)
        tail = np.geomspace(1, len(ordered), _STEPS // 2) - 1  # outage is read where it is rare
        kept = np.unique(np.concatenate([evenly, tail]).round().astype(int))
        ordered, shares = ordered[kept], shares[kept]
    return ordered, shares


def row_axis(axes: Axes, names: Sequence[str]) -> None:
    """Give a panel a row for each case, the first on top.

    Args:
        axes: the panel.
        names: of the cases.
    """
    axes.set_yticks(range(len(names)), list(names))
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
