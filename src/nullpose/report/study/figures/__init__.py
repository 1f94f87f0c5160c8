"""The figures of a study's report, by the names of their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from matplotlib.figure import Figure

from nullpose.report.study.figures.curves import draw_along, draw_distributions, draw_effort, draw_outage
from nullpose.report.study.figures.intervals import draw_costs, draw_gains, draw_shares
from nullpose.report.study.summary import Summary

__all__ = ["FIGURES", "figures_of"]

# What draws each figure, in the order of the report; None where there is nothing to draw.
FIGURES: dict[str, Callable[[Summary], Figure | None]] = {
    "distribution": draw_distributions,
    "gain": draw_gains,
    "sweep": draw_along,
    "best": draw_shares,
    "outage": draw_outage,
    "robustness": draw_costs,
    "effort": draw_effort,
}


def figures_of(summary: Summary) -> Iterator[tuple[str, Figure]]:
    """Return the figures, drawn one by one, that a study has something for, each with the name of its file.

    Args:
        summary: of a study.
    """
    drawn = ((name, draw(summary)) for name, draw in FIGURES.items())
    return ((name, figure) for name, figure in drawn if figure is not None)
