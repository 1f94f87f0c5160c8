"""The layout of figures of scenes: a panel in 3-D for each pose, a plan beside them, and a legend."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import Axes3D

from nullpose.physics import Pose
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.scene import draw_panel
from nullpose.report.figures.stage import SURFACE, Stage
from nullpose.report.figures.style import house_style, inches

_PLAN_INCH = 3.4  # width of a plan on a screen
_PLAN_SHARE = 0.31 / 0.57  # width of a plan over that of the scene beside it
_PLAN_LEFT = 0.13  # for numbers and name of a plan's left axis in a column
_PANEL_INCH = {"column": 2.45, "page": 3.3}  # height of a panel in print
_TITLE_INCH, _AXIS_INCH = 0.25, 0.45  # heights of a title, and of numbers and name of a plan's lower axis
_LEGEND_INCH = {"column": 0.88, "page": 0.42}  # height of the legend in print
_LEGEND_COLUMNS = {"column": 2, "page": 4}
_LEGEND_COLUMN_INCH = 2.3  # on a screen
_LEGEND_LETTERS = 28  # in a line of it, in a column
_PRINT_ZOOM = {"column": 1.03, "page": 0.93}  # letters are larger there against the scene
_BESIDE_ZOOM = 0.88  # where one scene's names stand beside the next scene
_PRINT_PAD = 3.0


def draw_panels(
    stage: Stage,
    draw_vehicle: Callable[[Axes3D, Stage, Pose], None],
    *,
    surface: str,
    head: str = "",
    titles: Sequence[str] = (),
    plan: bool = False,
    width: str | None = None,
) -> Figure:
    """Draw a panel for each pose: the scene, the vehicle, and the names of points.

    Args:
        stage: what each panel has to show.
        draw_vehicle: draws the vehicle at a pose.
        surface: what its pattern is called in the legend.
        head: title of the figure; empty for none. In print there is none.
        titles: of the panels; none for no titles.
        plan: whether the first pose is drawn from above too.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    count = len(stage.poses)
    with house_style(width):
        if width is not None:
            zoom = _PRINT_ZOOM[width] * (_BESIDE_ZOOM if count > 1 and width == "page" else 1.0)
            stage = replace(stage, view=replace(stage.view, zoom=zoom, pad_pt=_PRINT_PAD))
        figure, grid = _laid_out(stage, plan, width, bool(titles))
        for index, pose in enumerate(stage.poses):
            axes: Any = figure.add_subplot(grid[index], projection="3d")
            axes.patch.set_visible(False)  # it would cover what another panel has at its edge
            draw_panel(axes, stage, pose, draw_vehicle)
            axes.set_title(titles[index] if titles else "", fontsize="medium", y=0.96)
        if plan:
            flat = figure.add_subplot(grid[-1])
            box, axis = flat.get_position(), _AXIS_INCH / figure.get_figheight()
            above = 0.7 * axis if head and width is None else 0.2 * axis
            beside = _PLAN_LEFT if width == "column" else 0.0
            flat.set_position((box.x0 + beside, box.y0 + axis, box.width - beside, box.height - axis - above))
            draw_plan(flat, stage, stage.poses[0])
        if width is None:
            figure.suptitle(head, fontsize=10, parse_math=False)
        _draw_legend(figure, surface, width)
    return figure


def _laid_out(stage: Stage, plan: bool, width: str | None, titled: bool) -> tuple[Figure, GridSpec]:
    """Lay out the panels beside each other, the plan last; in a column of print below each other."""
    view, count = stage.view, len(stage.poses)
    shares = [1.0] * count + [_PLAN_SHARE] * plan
    if width is None:
        figure = Figure(figsize=(view.inches[0] * count + _PLAN_INCH * plan, view.inches[1]))
        low, top = view.edges
    else:
        wide, panel, legend = inches((0.0, 0.0), width, 0.0)[0], _PANEL_INCH[width], _LEGEND_INCH[width]
        if width == "page":
            high = min(panel, 0.95 * wide / count) + legend
        else:
            high = (panel + _TITLE_INCH * titled) * count + panel * plan + legend
        figure = Figure(figsize=(wide, high))
        low, top = legend / high, 1.0 - max(0.02, _TITLE_INCH * titled / high)
    if width == "column":
        return figure, figure.add_gridspec(count + plan, 1, left=0.02, right=0.96, bottom=low, top=top)
    look: dict[str, Any] = {"width_ratios": shares, "wspace": 0.2 if plan else 0.08}
    return figure, figure.add_gridspec(
        1, count + plan, left=0.01, right=0.98 if plan else 0.962, bottom=low, top=top, **look
    )


def _draw_legend(figure: Figure, surface: str, width: str | None) -> None:
    """Draw the legend of all panels below them, each name once."""
    once: dict[str, Any] = {}
    for handles, names in (axes.get_legend_handles_labels() for axes in figure.axes):
        once = dict(zip(names, handles, strict=True)) | once
    if width == "column":
        surface = textwrap.fill(surface, _LEGEND_LETTERS)
    once[surface] = Patch(color=SURFACE, alpha=0.8)
    columns = _LEGEND_COLUMNS.get(width or "", int(figure.get_figwidth() / _LEGEND_COLUMN_INCH))
    look: dict[str, Any] = {"handlelength": 2.6 if width is None else 1.8, "columnspacing": 1.2}
    look |= {"loc": "lower center", "ncols": min(len(once), columns), "borderaxespad": 0.1}
    legend = figure.legend(once.values(), once.keys(), frameon=False, **look)
    for text in legend.get_texts():
        text.set_parse_math(False)
