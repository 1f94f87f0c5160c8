"""The figure of a map: colours, contours, and the scene from above."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.scene import ALONE, Stage
from nullpose.report.figures.style import house_style, inches
from nullpose.report.numbers import MINUS, begun
from nullpose.solver import Result
from nullpose.study import Field

_MOST_SPAN = 30.0  # of the colours: what is farther below the best is as dark as it gets
_LEAST_SPAN = 1.0
_LEVELS = 8
_BESIDE_INCH, _BELOW_INCH = 1.6, 1.0  # room for labels and the colour bar
_TALLEST_INCH = 8.0


def draw_value_map(result: Result, field: Field, width: str | None = None) -> Figure:
    """Return the figure of a map.

    Args:
        result: that the map is of.
        field: the map.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    rows, columns = field.values.shape
    wide = inches((6.0, 0.0), width, 0.0)[0]
    high = min((wide - _BESIDE_INCH) * rows / columns + _BELOW_INCH, _TALLEST_INCH)
    with house_style(width):
        figure = Figure(figsize=(wide, high), layout="constrained")
        axes = figure.add_subplot()
        draw_field(axes, result, field)
        if width is None:
            axes.set_title(
                f"{result.scenario.name}\n{result.label}: {field.title}", fontsize=9, parse_math=False
            )
    return figure


def draw_field(axes: Any, result: Result, field: Field) -> None:
    """Draw a map with its colour bar, contours and the scene from above.

    Args:
        axes: where to draw, two-dimensional.
        result: that the map is of.
        field: the map.
    """
    east, north, known = field.east_m, field.north_m, np.ma.masked_invalid(field.values)
    high = field.best[0]
    lowest = float(np.percentile(known.compressed(), 2.0)) if known.count() else 0.0
    low = min(max(lowest, high - _MOST_SPAN), high - _LEAST_SPAN)
    look = {"cmap": "viridis", "vmin": low, "vmax": high, "shading": "nearest", "rasterized": True}
    mesh = axes.pcolormesh(east, north, known, zorder=0.5, **look)
    levels = MaxNLocator(_LEVELS, steps=[1, 2, 5, 10]).tick_values(low, high)[1:-1]
    lines = axes.contour(
        east, north, known, levels, colors="white", linewidths=0.6, linestyles="solid", zorder=0.8
    )
    axes.clabel(lines, fontsize=6.5, fmt=lambda level: f"{level:g}".replace("-", MINUS))
    axes.grid(visible=False)
    stage = Stage(scenario=result.scenario, poses=(result.pose,), view=ALONE)
    box_m = np.array([[east[0], north[0]], [east[-1], north[-1]]])
    draw_plan(axes, stage, result.pose, box_m)
    words = f"{begun(result.objective.quantity.smallest)} {field.altitude_m:.4g} m up  ({field.unit})"
    beside = axes.inset_axes((1.03, 0.0, 0.045, 1.0))  # as high as the map, whatever its shape
    axes.figure.colorbar(
        mesh, cax=beside, label=words, extend="min" if float(known.min()) < low else "neither"
    )
