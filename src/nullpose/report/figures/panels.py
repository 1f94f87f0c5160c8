"""Figures of scenes in 3-D: a panel for each pose, the scene from above beside them, and a legend."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from matplotlib import rcParams
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Patch

from nullpose.physics import Pose
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.scene import SURFACE, Stage, draw_panel
from nullpose.report.figures.style import house_style, inches

_GAP = 0.08  # between panels, of their width
_PLAN_INCH = 3.4  # width of a plan on a screen
_PRINT_ZOOM = {"column": 1.03, "page": 0.93}  # letters are larger there against the scene
_BESIDE_ZOOM = 0.88  # where one scene's names stand beside the next scene
_PRINT_PAD = 3.0
_HIGH_INCH = {"column": (2.45, 2.6), "page": (3.3, 3.3)}  # of a panel in 3-D and of a plan, in print
_LEGEND_COLUMNS = {"column": 2, "page": 4}
_LEGEND_COLUMN_INCH = 2.3  # on a screen
_LINE = 1.6  # of the legend, in heights of its letters
_BESIDE = ((0.0, 0.57), (0.67, 0.31))  # left end and width of a scene in 3-D and of its plan beside it
_BELOW = (0.17, 0.79)  # of a plan below it
_MOST_LINES = {"column": 5, "page": 2}  # of the legend
_LEGEND_LETTERS = 28  # in a line of it, in a column
_TITLE_INCH = 0.25
_Rect = tuple[float, float, float, float]
_AXIS_INCH = 0.45  # numbers and name of a plan's lower axis


def draw_panels(
    stage: Stage,
    draw_vehicle: Callable[[Any, Stage, Pose], None],
    *,
    surface: str,
    head: str = "",
    titles: Sequence[str] = (),
    plan: bool = False,
    width: str | None = None,
) -> Figure:
    """Return a figure with a panel for each pose: the scene, the vehicle, and the names of points.

    Args:
        stage: what each panel has to show.
        draw_vehicle: draws the vehicle at a pose.
        surface: what its pattern is called in the legend.
        head: title of the figure; empty for none. In print there is none.
        titles: of the panels; none for no titles.
        plan: whether the first pose is drawn from above too.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    with house_style(width):
        figure, rects = _laid_out(stage, plan, width, bool(titles))
        if width is not None:
            zoom = _PRINT_ZOOM[width] * (_BESIDE_ZOOM if len(rects) > 1 + plan and width == "page" else 1.0)
            stage = replace(stage, view=replace(stage.view, zoom=zoom, pad_pt=_PRINT_PAD))
        for index, (pose, rect) in enumerate(zip(stage.poses, rects, strict=False)):
            axes: Any = figure.add_subplot(projection="3d")
            axes.set_position(rect)
            axes.patch.set_visible(False)  # it would cover what another panel has at its edge
            draw_panel(axes, stage, pose, draw_vehicle)
            axes.set_title(titles[index] if titles else "", fontsize="medium", y=0.96)
        if plan:
            draw_plan(figure.add_axes(rects[-1]), stage, stage.poses[0])
        if width is None:
            figure.suptitle(head, fontsize=10, parse_math=False)
        _draw_legend(figure, surface, width)
    return figure


def _laid_out(stage: Stage, plan: bool, width: str | None, titled: bool) -> tuple[Figure, list[_Rect]]:
    """Return a figure and where its panels are, as shares of it: those in 3-D, and the plan."""
    view, count = stage.view, len(stage.poses)
    if width == "column":
        return _stacked(count, plan, _TITLE_INCH * titled)
    if width is None:
        size = (view.inches[0] * count + _PLAN_INCH * plan, view.inches[1])
        bottom, top = view.edges
    else:
        wide = inches((0.0, 0.0), width, 0.0)[0]
        high = min(_HIGH_INCH[width][0], 0.95 * wide / count) + _legend_inch(width)
        size, bottom, top = (wide, high), _legend_inch(width) / high, 0.99
    if not plan:
        share = 0.946 / (count + _GAP * (count - 1))
        starts = (0.016 + index * (1.0 + _GAP) * share for index in range(count))
        rects = [(start, bottom, share, top - bottom) for start in starts]
        return Figure(figsize=size), rects
    low, up = bottom + _AXIS_INCH / size[1], top - (0.02 if width else 0.06)
    (at, share), (beside, narrow) = _BESIDE
    return Figure(figsize=size), [(at, bottom, share, top - bottom), (beside, low, narrow, up - low)]


def _stacked(count: int, plan: bool, title_inch: float) -> tuple[Figure, list[_Rect]]:
    """Return the same with the panels one below the other, in a column."""
    panel, below = _HIGH_INCH["column"]
    step = panel + title_inch
    legend = _legend_inch("column")
    high = step * count + below * plan + legend
    rects: list[_Rect] = [
        (0.02, (high - step * index) / high, 0.94, panel / high) for index in range(1, count + 1)
    ]
    if plan:
        rects.append((_BELOW[0], (legend + _AXIS_INCH) / high, _BELOW[1], (below - _AXIS_INCH - 0.1) / high))
    return Figure(figsize=inches((0.0, 0.0), "column", high / inches((0.0, 0.0), "column", 0.0)[0])), rects


def _legend_inch(width: str) -> float:
    """Return the height that is kept for the legend in print."""
    letters = FontProperties(size=rcParams["legend.fontsize"]).get_size_in_points() / 72.0
    return 0.1 + _LINE * letters * _MOST_LINES[width]


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
    look["borderaxespad"] = 0.1
    legend = figure.legend(
        once.values(), once.keys(), loc="lower center", ncols=min(len(once), columns), frameon=False, **look
    )
    for text in legend.get_texts():
        text.set_parse_math(False)
