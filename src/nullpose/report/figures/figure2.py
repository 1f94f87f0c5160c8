"""The paper's Figure 2, recomputed: the smallest SINR of the four cases against P_M/P."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.report.certainty import Certainty
from nullpose.report.figures.style import CURVES, house_style
from nullpose.report.figures.sweep import draw_bounds, draw_caption, draw_curve
from nullpose.report.numbers import MINUS, short
from nullpose.schemes import Scheme
from nullpose.study import SweepTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_figure2"]

_SINR_DB = (-3.6, 2.15)  # the four cases fill it; the printed form leaves it at the bottom
_LABELS = {  # scheme: (P_M/P, smallest SINR in dB) of the label's left end, beside its own curve alone
    Scheme.OPTIMUM: (0.3, 1.38),
    Scheme.ZERO_INTERFERENCE: (3e2, 0.53),
    Scheme.MAXIMUM_GAIN: (3e2, -0.97),
    Scheme.VERTICAL: (3e2, -2.02),
}


def draw_figure2(table: SweepTable) -> Figure:
    """Return the paper's Figure 2 with its four curves, and maximum gain as eq. 3.5 is printed.

    Args:
        table: a sweep of the paper's scenario over the jammer's power.
    """
    from matplotlib.figure import Figure

    with house_style():
        figure = Figure(figsize=(7.0, 4.7), layout="constrained")
        axes = figure.add_subplot()
        for scheme in table.schemes:
            draw_curve(axes, table, scheme)
            draw_bounds(axes, table, scheme)
        axes.set_xscale("log")
        axes.set_xlim(0.8 * table.values[0], 1.25 * table.values[-1])  # no marker is cut in half
        axes.set_ylim(*_SINR_DB)
        axes.set_xlabel("jamming-to-transmission power ratio  $P_M/P$")
        axes.set_ylabel("smallest SINR over the nodes  (dB)")
        for scheme, (level, sinr_db) in _LABELS.items():
            axes.text(level, sinr_db, CURVES[scheme].label, color=CURVES[scheme].colour, fontweight="bold")
        _mark_printed_form(axes, table)
        draw_caption(figure, [_certainty(table)])
    return figure


def _certainty(table: SweepTable) -> str:
    """Return what is proved of the four curves, and of the printed form."""
    found = Certainty.of(row for scheme in _LABELS for row in table.of(scheme))
    gap = found.largest_relative_gap
    if not found.complete or gap is None:
        share = f"{found.certified} of {found.values}"
        return f"{share} points of the four curves are certified; bands reach up to the bounds there are."
    return (
        f"Every point of the four curves is certified: proved to be within {short(gap)} of its case's global "
        "optimum, so that the band from value to bound is thinner than the line. "
        "Eq. 3.5 as printed is searched, not bounded."
    )


def _mark_printed_form(axes: Axes, table: SweepTable) -> None:
    curve = CURVES[Scheme.MAXIMUM_GAIN_PRINTED]
    last_db = table.of(Scheme.MAXIMUM_GAIN_PRINTED)[-1].min_sinr_db
    axes.text(
        3.2,
        -2.95,
        f"{curve.label}: it never saturates,\nand reaches {last_db:.0f} dB at the right edge".replace(
            "-", MINUS
        ),
        color=curve.colour,
        fontsize=8.5,
        verticalalignment="center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
    )
