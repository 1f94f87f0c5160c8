"""The paper's Figure 2, recomputed: the smallest SINR of the four cases against P_M/P."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.report.certainty import certainty_lines
from nullpose.report.figures.style import CURVES, house_style
from nullpose.report.figures.sweep import draw_caption, draw_curves
from nullpose.report.numbers import MINUS
from nullpose.schemes import PAPER_SCHEMES, Scheme
from nullpose.study import SweepTable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SINR_DB = (-3.6, 2.15)  # the four cases fill it; the printed form leaves it at the bottom
_LABELS = ((0.3, 1.38), (3e2, 0.53), (3e2, -0.97), (3e2, -2.02))
"""P_M/P and smallest SINR [dB] of the left end of each case's label, beside its own curve alone."""

_PRINTED_LABEL = (3.2, -2.95)


def draw_figure2(table: SweepTable) -> Figure:
    """Return the paper's Figure 2 with its four curves, and maximum gain as eq. 3.5 is printed.

    Args:
        table: a sweep of the paper's scenario over the jammer's power.
    """
    from matplotlib.figure import Figure

    printed = CURVES[Scheme.MAXIMUM_GAIN_PRINTED]
    last_db = table.of(Scheme.MAXIMUM_GAIN_PRINTED)[-1].min_sinr_db
    words = f"{printed.label}: it never saturates,\nand reaches {last_db:.0f} dB at the right edge"
    with house_style():
        figure = Figure(figsize=(7.0, 4.7), layout="constrained")
        axes = figure.add_subplot()
        draw_curves(axes, table)
        axes.set(xscale="log", ylim=_SINR_DB)
        axes.set_xlim(0.8 * table.values[0], 1.25 * table.values[-1])  # no marker is cut in half
        axes.set_xlabel("jamming-to-transmission power ratio  $P_M/P$")
        axes.set_ylabel("smallest SINR over the nodes  (dB)")
        for scheme, place in zip(PAPER_SCHEMES, _LABELS, strict=True):
            axes.text(*place, CURVES[scheme].label, color=CURVES[scheme].colour, fontweight="bold")
        axes.text(
            *_PRINTED_LABEL,
            words.replace("-", MINUS),
            color=printed.colour,
            fontsize=8.5,
            verticalalignment="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
        )
        draw_caption(figure, [f"{line}." for line in certainty_lines(table)])
    return figure
