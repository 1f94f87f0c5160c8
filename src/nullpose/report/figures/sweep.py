"""The figure of any sweep: the smallest SINR of each scheme against the swept setting."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nullpose.report.figures.style import CURVES, Curve, house_style
from nullpose.study import SweepTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_curve", "draw_sweep", "finite_or_gap"]

_UNITS = {"w": "W", "dbm": "dBm", "db": "dB", "hz": "Hz", "m": "m"}
_MARKERS = 13  # at most so many markers on a curve, so that they do not merge into a band


def finite_or_gap(numbers_db: list[float]) -> list[float]:
    """Return the numbers with infinities turned into NaN, which Matplotlib draws as a gap.

    Args:
        numbers_db: dB; minus infinity stands for no signal.
    """
    return [number if math.isfinite(number) else math.nan for number in numbers_db]


def draw_curve(axes: Axes, table: SweepTable, scheme: str) -> Curve:
    """Return the look of one scheme's curve after drawing it.

    Args:
        axes: where to draw.
        table: the sweep.
        scheme: one of the table's schemes.
    """
    curve = CURVES[scheme]
    rows = table.of(scheme)
    first = list(CURVES).index(scheme)  # staggered, so that curves which coincide both stay visible
    axes.plot(
        [row.value for row in rows],
        finite_or_gap([row.min_sinr_db for row in rows]),
        color=curve.colour,
        linestyle=curve.line,
        linewidth=curve.width,
        marker=curve.marker,
        markersize=4.2,
        markerfacecolor="white",
        markevery=(first, max(1, len(CURVES), math.ceil(len(rows) / _MARKERS))),
        zorder=curve.order,
        label=curve.label,
    )
    return curve


def _axis_label(path: str) -> str:
    leaf = path.rsplit(".", 1)[-1].split("[", 1)[0]
    unit = _UNITS.get(leaf.rsplit("_", 1)[-1].lower())
    return f"{path}  ({unit})" if unit else path


def draw_sweep(table: SweepTable, *, log: bool = False) -> Figure:
    """Return the figure of a sweep, its legend above the axes.

    Args:
        table: what the sweep found.
        log: draw the swept setting on a logarithmic axis.
    """
    from matplotlib.figure import Figure

    with house_style():
        figure = Figure(figsize=(7.0, 4.4), layout="constrained")
        axes = figure.add_subplot()
        for scheme in table.schemes:
            draw_curve(axes, table, scheme)
        if log:
            axes.set_xscale("log")
        axes.set_xlabel(_axis_label(table.path))
        axes.set_ylabel("smallest SINR over the nodes  (dB)")
        axes.margins(x=0.02)
        figure.legend(loc="outside upper center", ncols=4, frameon=False, handlelength=3.2, columnspacing=1.4)
    return figure
