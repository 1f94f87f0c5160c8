"""The layout of figures of scenes: a panel in 3-D for each pose, a plan beside them, and a legend."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import Axes3D

from nullpose.physics import Pose
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.scene import draw_panel
from nullpose.report.figures.stage import SURFACE, Stage
from nullpose.report.figures.style import house_style, inches

_PLAN_INCH = 3.4  # width of a plan on a screen
_PLAN_SHARE = 0.31 / 0.57  # width of a plan over that of the scene beside it
_PANEL_INCH = {"column": 2.6, "page": 3.3}  # height of a panel in print
_LEGEND_COLUMN_INCH = 1.7
_LEGEND_LETTERS = 28  # in a line of it, in a column


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
    shares = [1.0] * count + [_PLAN_SHARE] * plan
    wide, high = stage.view.inches[0] * count + _PLAN_INCH * plan, stage.view.inches[1]
    across, down = len(shares), 1
    if width is not None:
        wide, high = inches((0.0, 0.0), width, 0.0)[0], _PANEL_INCH[width]
    if width == "column":
        across, down, shares = 1, len(shares), [1.0]
    with house_style(width):
        layout = ConstrainedLayoutEngine(rect=(0.0, 0.0, 0.98, 1.0))  # the name of z is beyond its panel
        figure = Figure(figsize=(wide, high * down), layout=layout)
        grid = figure.add_gridspec(down, across, width_ratios=shares)
        for index, pose in enumerate(stage.poses):
            axes: Any = figure.add_subplot(grid[index], projection="3d")
            axes.patch.set_visible(False)  # it would cover what another panel has at its edge
            draw_panel(axes, stage, pose, draw_vehicle)
            axes.set_title(titles[index] if titles else "", fontsize="medium", y=0.96)
        if plan:
            draw_plan(figure.add_subplot(grid[-1]), stage, stage.poses[0])
        if width is None:
            figure.suptitle(head, fontsize=10, parse_math=False)
        once: dict[str, Any] = {}
        for handles, names in (axes.get_legend_handles_labels() for axes in figure.axes):
            once = dict(zip(names, handles, strict=True)) | once
        once[textwrap.fill(surface, _LEGEND_LETTERS) if width == "column" else surface] = Patch(
            color=SURFACE, alpha=0.8
        )
        columns = min(len(once), int(wide / _LEGEND_COLUMN_INCH))
        look: dict[str, Any] = {"handlelength": 1.8, "columnspacing": 1.2, "borderaxespad": 0.1}
        legend = figure.legend(
            once.values(), once.keys(), frameon=False, loc="outside lower center", ncols=columns, **look
        )
        for text in legend.get_texts():
            text.set_parse_math(False)
    return figure
