"""The paper's Figure 2, recomputed: the smallest SINR of the four cases against P_M/P."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from nullpose.paper.printed import PrintedPoint
from nullpose.problem.schemes import Scheme
from nullpose.report.certainty import labelled_certainty
from nullpose.report.document import grouped
from nullpose.report.figures.style import CURVES, Curve, draw_curve, house_style
from nullpose.report.figures.sweep import draw_caption, draw_curves
from nullpose.report.numbers import MINUS, capitalised
from nullpose.study import ResultTable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SINR_DB = (-3.6, 2.15)  # the four cases fill it; the printed form leaves it at the bottom
_LABELS = ((0.3, 1.38), (3e2, 0.53), (3e2, -0.97), (3e2, -2.02))
"""P_M/P and smallest SINR [dB] of the left end of each case's label, beside its own curve alone."""

_PRINTED = Curve("maximum gain, eq. 3.5 as printed", "#9a6060", (0, (1.2, 1.8)), "", 1.6, 2.0)
_PRINTED_LABEL = (3.2, -2.95)


def figure2_lines(table: ResultTable) -> list[str]:
    """Write how certain the curves of Figure 2 are, of a sweep over the jammer's power."""
    searched = ("Maximum gain, as printed", "best found by search, no upper bound")
    return [f"{capitalised(line)}." for line in grouped([*labelled_certainty(table), searched])]


def draw_figure2(table: ResultTable, printed: Sequence[PrintedPoint]) -> Figure:
    """Draw the paper's Figure 2: the four curves of a sweep, and maximum gain as eq. 3.5 is printed."""
    from matplotlib.figure import Figure

    last_db = printed[-1].min_sinr_db
    words = f"{_PRINTED.label}: it never saturates,\nand reaches {last_db:.0f} dB at the right edge"
    with house_style():
        figure = Figure(figsize=(7.0, 4.7), layout="constrained")
        axes = figure.add_subplot()
        draw_curves(axes, table)
        levels, values_db = [point.level for point in printed], [point.min_sinr_db for point in printed]
        draw_curve(axes, _PRINTED, levels, values_db)
        axes.set(xscale="log", ylim=_SINR_DB)
        axes.set_xlim(0.8 * table.values[0], 1.25 * table.values[-1])  # no marker is cut in half
        axes.set_xlabel("jamming-to-transmission power ratio  $P_M/P$")
        axes.set_ylabel("smallest SINR over the nodes  (dB)")
        for scheme, place in zip(Scheme, _LABELS, strict=True):
            axes.text(*place, CURVES[scheme].label, color=CURVES[scheme].colour, fontweight="bold")
        axes.text(
            *_PRINTED_LABEL,
            words.replace("-", MINUS),
            color=_PRINTED.colour,
            fontsize=8.5,
            verticalalignment="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
        )
        draw_caption(figure, figure2_lines(table))
    return figure
