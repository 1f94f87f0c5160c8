"""Figures for notebooks: each function returns Matplotlib axes, new ones or those that it is given as ``ax``.

Example:
    ``nullpose.plot.plan(nullpose.solve(scenario))``
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from nullpose.errors import checked, require_usage
from nullpose.report.figures.dots import draw_dots
from nullpose.report.figures.names import place_names
from nullpose.report.figures.plan import draw_field, draw_plan
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.style import house_style
from nullpose.report.figures.sweep import draw_sweep_axes
from nullpose.solver import Result
from nullpose.study import Field, ResultRow, ResultTable, value_map

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["comparison", "heat_map", "plan", "sweep"]

_CELLS = 121  # of a map, along its longer side


@contextmanager
def _axes(ax: Axes | None, size_inch: tuple[float, float]) -> Iterator[Axes]:
    """Yield axes to draw on: the caller's in the caller's style, or new ones in the house's.

    Raises:
        UsageError: the caller's axes are in 3-D.
    """
    if ax is not None:
        require_usage(
            getattr(ax, "name", "") != "3d", "ax: given axes in 3-D; allowed: axes without a projection"
        )
        yield ax
        return
    import matplotlib
    from matplotlib import pyplot

    with house_style():
        figure = pyplot.figure(figsize=size_inch, layout="constrained")
        shows_by_itself = matplotlib.is_interactive()  # which a notebook turns on with its first figure
        yield figure.add_subplot()
    matplotlib.interactive(shows_by_itself)


@checked
def plan(result: Result, ax: Axes | None = None) -> Axes:
    """Draw a scene from above: points, zones, the drone and its antenna's axis.

    Args:
        result: of any kind.
        ax: axes to draw on; new ones if left out.

    Raises:
        UsageError: the axes are in 3-D.

    Example:
        >>> import nullpose
        >>> nullpose.plot.plan(nullpose.solve(nullpose.load("examples/paper.toml"))).get_xlabel()
        'East x (m)'
    """
    with _axes(ax, (5.0, 5.0)) as axes:
        draw_plan(axes, PlanScene.of(result), result.pose)
        place_names(axes)
    return axes


@checked
def heat_map(result: Result, ax: Axes | None = None, *, field: Field | None = None) -> Axes:
    """Draw a map of what each place gives with the best axis there, and the scene on it.

    Args:
        result: of a solve.
        ax: axes to draw on; new ones if left out.
        field: the map; that of :func:`nullpose.study.value_map` if left out.

    Raises:
        UsageError: the axes are in 3-D, or the result is of an array.

    Example:
        >>> import nullpose
        >>> nullpose.plot.heat_map(nullpose.solve(nullpose.load("examples/paper.toml"))).get_ylabel()
        'North y (m)'
    """
    field = value_map(result, cells=_CELLS) if field is None else field
    with _axes(ax, (6.0, 6.0)) as axes:
        draw_field(axes, result, field)
        place_names(axes)
    return axes


@checked
def sweep(table: ResultTable, ax: Axes | None = None, *, log: bool = False, bounds: bool = False) -> Axes:
    """Draw a curve for each scheme of a sweep.

    Args:
        table: what the sweep found.
        ax: axes to draw on; new ones if left out.
        log: draw the swept setting on a logarithmic axis.
        bounds: draw a band from each curve up to its upper bounds.

    Raises:
        UsageError: the axes are in 3-D.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> table = nullpose.sweep(scenario, "jammers.M.power_w", [0.1, 1.0, 10.0])
        >>> axes = nullpose.plot.sweep(table, log=True)
        >>> axes.get_xscale()
        'log'
    """
    with _axes(ax, (7.0, 4.2)) as axes:
        draw_sweep_axes(axes, table, log=log, bounds=bounds)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False, handlelength=3.2)
    return axes


@checked
def comparison(found: ResultTable | Sequence[Result], ax: Axes | None = None) -> Axes:
    """Draw a dot for each case or vehicle, and a tick at its bound.

    Args:
        found: by ``nullpose.compare`` or ``nullpose.compare_airframes``.
        ax: axes to draw on; new ones if left out.

    Raises:
        UsageError: the axes are in 3-D.

    Example:
        >>> import nullpose
        >>> axes = nullpose.plot.comparison(nullpose.compare(nullpose.load("examples/paper.toml")))
        >>> [text.get_text() for text in axes.child_axes[0].get_yticklabels()]  # dB
        ['0.98', '0.81', '−0.70', '−2.16']
    """
    if not isinstance(found, ResultTable):
        found = ResultTable("", tuple(ResultRow.of(math.nan, result) for result in found))
    with _axes(ax, (7.0, 3.6)) as axes:
        draw_dots(axes, found)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower right", frameon=False, handlelength=1.0)
    return axes
