"""Poses in 3-D with the pattern: of one result, at several jamming levels, under errors, of an array."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import NDArray

from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.physics.array import placed_elements
from nullpose.physics.types import FloatArray
from nullpose.report.figures.names import place_names
from nullpose.report.figures.pattern import beam_surface_m, draw_surface, pattern_surface_m
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.scene import NULL_LINE, draw_line, draw_panel
from nullpose.report.figures.stage import ALONE, AXIS, PAIR, PANELS, Stage, limits_m
from nullpose.report.figures.style import (
    DRONE,
    INK,
    SURFACE,
    Look,
    house_style,
    inches,
    is_column,
)
from nullpose.report.geometry import axis_angle_rad
from nullpose.report.numbers import MINUS, with_unit
from nullpose.report.sensitivity import sensitivity_caption
from nullpose.report.words import error_words
from nullpose.scenario import Scenario
from nullpose.solver import Objective, Result
from nullpose.solver.array import ArrayDetails
from nullpose.solver.robust import RobustDetails
from nullpose.study import ResultRow

_PLAN_INCH = 4.2  # width of a plan on a screen
_PLAN_SHARES, _KEYED_SHARE = (0.64, 1.65), 1.7  # of a plan over a panel beside it; in a column with a key
_ROWS = 1.2, 1.0  # of a panel in a column, over the legend below it
_PAGE_SHARE, _COLUMN_SHARES = 0.46, (0.84, 0.71)  # heights over widths; in a column without a plan, and with
_LEGEND_COLUMN_INCH = 1.7
_KEY_PT, _WIDEST = (6.5, 6.0), 0.985  # letters of a key; its width over the figure's
_KEY_LETTERS = 48  # in a line of it: a column holds so many in bold
_PLAN_WIDTH, _AXIS_INCH = 0.5, 0.5  # of a plan with a key, over the figure's; name of the axis below it
_LOWEST_INCH, _HIGHEST_INCH = 1.0, 75.0 / 25.4  # of such a plan, and of the figure if the key has space


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
    count, is_narrow = len(stage.poses), is_column(width)
    is_solid = plan or not is_narrow
    usual = (stage.view.inches[0] * count + _PLAN_INCH * plan, stage.view.inches[1])
    stage = replace(stage, view=replace(stage.view, is_small=is_narrow))
    with house_style(width), rc_context({"text.parse_math": False}):
        # the name of z is beyond its panel
        layout = ConstrainedLayoutEngine(rect=(0.0, 0.0, 1.0 if is_narrow else 0.98, 1.0))
        figure = Figure(
            figsize=inches(usual, width, _COLUMN_SHARES[plan] if is_narrow else _PAGE_SHARE), layout=layout
        )
        shares = [_PLAN_SHARES[is_narrow] if not stage.key else _KEYED_SHARE] * plan + [1.0] * count
        grid = figure.add_gridspec(2, len(shares), width_ratios=shares, height_ratios=_ROWS)
        rows = slice(1 if is_narrow and plan and not stage.key else 2)  # the legend has the corner below
        for index, (pose, title) in enumerate(zip(stage.poses, titles or [""] * count, strict=True)):
            axes = figure.add_subplot(
                grid[rows, plan + index], projection="3d" if is_solid else None, facecolor="none"
            )
            if is_solid:
                draw_panel(axes, stage, pose, draw_vehicle)
            else:
                draw_plan(axes, stage, pose)
            axes.set_title(
                title.replace(", ", "\n") if is_narrow else title,
                fontsize="small" if is_narrow else "medium",
                y=0.96,
                parse_math=True,
            )
        if plan:
            draw_plan(figure.add_subplot(grid[:, 0]), stage, stage.poses[0])
        if width is None:
            figure.suptitle(head, fontsize=10, wrap=True)
        _draw_legend(figure, stage, surface)
        for axes in figure.axes:
            place_names(axes)
    return figure


def _draw_legend(figure: Figure, stage: Stage, surface: str) -> None:
    """Draw the legend of all panels: below them, or in a column in the corner beside the plan."""
    marks: dict[str, dict[type, Any]] = {}
    for axes in figure.axes:  # the plan, if there is one, is the last
        drawn = [*zip(*axes.get_legend_handles_labels(), strict=True)]
        marks |= {name: {type(mark): mark for mark, label in drawn if label == name} for _, name in drawn}
    columns = figure.get_figwidth() / _LEGEND_COLUMN_INCH
    look: Look = {"loc": "outside lower center", "title": stage.note.replace("\n", " ")}
    if stage.view.is_small:
        marks.pop("drone", None)  # it has its name in the plan, or below it in the key
        if stage.key:
            columns = 3.0
            look |= {"labelspacing": 0.25, "columnspacing": 0.8}
        elif len(stage.poses) == 1:
            columns, look = 1.0, {"loc": "lower right", "title": stage.note}
    if stage.key or not stage.view.is_small:
        marks[surface] = {Patch: Patch(color=SURFACE, alpha=0.8)}
    entries = [(name, "", name) for name in marks]
    if stage.key:
        kinds = {kind for kind, _, _ in stage.keyed}
        entries = stage.keyed + [entry for entry in entries if entry[0] not in kinds]
    handles: Any = [tuple(marks[kind].values()) for kind, _, _ in entries]
    lines = [textwrap.fill(words, _KEY_LETTERS) for _, _, words in entries]
    look |= {"alignment": "left", "borderaxespad": 0.1, "handlelength": 1.3 if stage.key else 1.7}
    for count, points in product(
        range(max(1, math.floor(columns)), 0, -1), _KEY_PT if stage.key else (None,)
    ):
        legend = figure.legend(handles, lines, ncols=count, fontsize=points, **look)
        for text, (_, name, _) in zip(legend.get_texts(), entries, strict=True):
            text.set_fontweight("bold" if name in stage.worst else "normal")
        width_px, height_px = legend.get_window_extent().size
        if not stage.key or width_px <= _WIDEST * figure.bbox.width or (count, points) == (1, _KEY_PT[-1]):
            break
        legend.remove()
    if stage.key:
        figure.set_figheight(_keyed_height(stage, figure.get_figwidth(), height_px / figure.dpi))


def _keyed_height(stage: Stage, wide_inch: float, key_inch: float) -> float:
    """Compute the height of a column's figure with a key below its plan."""
    low, high = limits_m(stage)
    below_inch, shape = key_inch + _AXIS_INCH, (high - low)[1] / (high - low)[0]
    most_inch = max(_LOWEST_INCH, _HIGHEST_INCH - below_inch)
    return below_inch + float(np.clip(shape * _PLAN_WIDTH * wide_inch, _LOWEST_INCH, most_inch))


_CUT_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_SURFACE = "radiation pattern"

# Lengths drawn, as shares of the scene's extent.
_ARRAY = 0.10  # from the middle to the outermost element
_UPRIGHT = 0.018  # half of an element
_BEAM = 0.20  # the heading's arrow, and the beam where the gain is largest
_ELSEWHERE_DEG = ALONE.azimuth_deg + 27.0  # where the camera stands if the array would be seen end on


def draw_poses(scenario: Scenario, rows: Sequence[ResultRow]) -> Figure:
    """Draw several best poses side by side, each at its own jamming level, in a scene with a jammer."""
    titles = [f"$P_M/P$ = {row.value:g}\n{_words(scenario, row.objective, row.pose)}" for row in rows]
    stage = Stage(scenario=scenario, poses=tuple(row.pose for row in rows), view=PANELS)
    return draw_panels(stage, draw_dipole, surface=_SURFACE, titles=titles)


def draw_result(result: Result, width: str | None = None) -> Figure:
    """Draw the figure of a result of any kind: in print, ``width`` is a key of ``WIDTHS_MM``."""
    drawings = {RobustDetails: draw_robust, ArrayDetails: draw_array}
    return drawings.get(type(result.details), draw_pose)(result, width)


def draw_pose(result: Result, width: str | None = None) -> Figure:
    """Draw the scene, its fence and its no-fly zones, the pose and the antenna's pattern."""
    scenario, pose = result.scenario, result.pose
    words = filter(None, (_words(scenario, result.objective, pose), sensitivity_caption(result)))
    return draw_panels(
        Stage.of(result, is_narrow=is_column(width)),
        draw_dipole,
        surface=_SURFACE,
        head=f"{scenario.name}\n{'; '.join(words)}",
        plan=True,
        width=width,
    )


def draw_robust(result: Result, width: str | None = None) -> Figure:
    """Draw the robust pose, and beside it the one that is best without errors.

    Both panels show the same space, with the sets that jammers and eavesdroppers may be anywhere in.
    """
    scenario, quantity, details = result.scenario, Quantity.of(result.scenario), result.details
    assert isinstance(details, RobustDetails), "the caller asks"

    def words(value: float) -> str:
        return with_unit(quantity.in_unit(value), quantity)

    poses = {"robust pose": details.robust, "best pose without errors": details.nominal}
    titles = [
        f"{name}\n{words(pose.guaranteed)} guaranteed, {words(pose.nominal)} without errors"
        for name, pose in poses.items()
    ]
    head = f"{scenario.name}\n{quantity.smallest}; errors: {error_words(scenario)}"
    stage = Stage(
        scenario=scenario, poses=(details.robust.pose, details.nominal.pose), view=PAIR, uncertain=True
    )
    return draw_panels(stage, draw_dipole, surface=_SURFACE, head=head, titles=titles, width=width)


def _words(scenario: Scenario, objective: Objective, pose: Pose) -> str:
    """Write the value at a pose, and how far a dipole's null is off the jammers, or the eavesdroppers."""
    quantity = objective.quantity
    nulls = [
        f"{math.degrees(axis_angle_rad(pose, each.position_m)):.1f}° off {each.name}"
        for each in scenario.interferers
    ]
    value = f"{quantity.smallest} {with_unit(quantity.in_unit(objective.value), quantity)}"
    return f"{value}, null {', '.join(nulls)}" if nulls and scenario.antenna_record.is_quadratic else value


def draw_dipole(axes: Axes3D, stage: Stage, pose: Pose) -> None:
    """Draw the axis, and the doughnut with its near side cut away, so that the null can be seen."""
    radius_m, position = stage.view.pattern * stage.extent_m, pose.position_m
    reach = AXIS * radius_m * pose.antenna_axis
    antenna = stage.scenario.antenna_record
    label = "antenna axis (null)" if antenna.is_quadratic else "antenna's z axis"
    draw_line(axes, position - reach, position + reach, label=label, zorder=6.5, **NULL_LINE)
    around = np.linspace(0.5 * _CUT_RAD, math.tau - 0.5 * _CUT_RAD, 49)
    surface = pattern_surface_m(antenna, pose, radius_m, around, stage.view.camera)
    draw_surface(axes, surface, SURFACE, (surface[:, :, 0], surface[:, :, -1]), DRONE)
    axes.scatter(*position, color=DRONE, s=26, zorder=7, depthshade=False, label="drone")


def draw_array(result: Result, width: str | None = None) -> Figure:
    """Draw an array: the scene, its elements not to scale, its heading and its beam.

    There is a beam for each node; the one drawn is that of the node with the smallest value.
    """
    details, quantity, yaw_rad = result.details, result.objective.quantity, result.pose.yaw_rad
    assert isinstance(details, ArrayDetails), "the caller asks"
    elements = placed_elements(result.scenario, result.pose)
    weights = details.weights[[link.node for link in result.links].index(result.binding_node)]
    sides_deg = (ALONE.azimuth_deg, _ELSEWHERE_DEG)  # a linear array is seen from that where it is longer
    azimuth_deg = max(sides_deg, key=lambda deg: abs(math.sin(yaw_rad - math.radians(deg))))
    value = with_unit(quantity.in_unit(result.objective.value), quantity)
    yaw = f"yaw {math.degrees(yaw_rad):.1f}°".replace("-", MINUS)
    return draw_panels(
        Stage.of(result, replace(ALONE, azimuth_deg=azimuth_deg, pattern=_BEAM), is_narrow=is_column(width)),
        lambda axes, stage, pose: _draw_elements(axes, stage, pose, elements, weights),
        surface=f"gain of the beam for {result.binding_node}, horizontal cut as a line",
        head=f"{result.scenario.name}\n{result.label}: {quantity.smallest} {value}, {yaw}; "
        f"{sensitivity_caption(result)}",
        plan=True,
        width=width,
    )


def _draw_elements(
    axes: Axes3D, stage: Stage, pose: Pose, elements: FloatArray, weights: NDArray[np.complex128]
) -> None:
    """Draw an array's beam with its horizontal cut, its heading, and its elements as upright lines."""
    extent_m, position = stage.extent_m, pose.position_m
    surface = beam_surface_m(position, elements, weights, _BEAM * extent_m)
    draw_surface(axes, surface, SURFACE, [surface[:, surface.shape[1] // 2]], DRONE)
    ahead = _BEAM * extent_m * np.array([math.cos(pose.yaw_rad), math.sin(pose.yaw_rad), 0.0])
    arrow = {"linewidth": 1.2, "arrow_length_ratio": 0.16, "zorder": 7.1, "label": "heading (yaw)"}
    axes.quiver(*position, *ahead, color=INK, **arrow)
    reach = max(float(np.linalg.norm(elements, axis=1).max()), 1e-9)
    places = position + _ARRAY * extent_m / reach * elements
    up = np.array([0.0, 0.0, _UPRIGHT * extent_m])
    for place in places:
        draw_line(axes, place - up, place + up, color=DRONE, linewidth=1.4, zorder=7.2)
    axes.scatter(
        *places.T,
        s=22,
        color=DRONE,
        edgecolors="white",
        linewidths=0.5,
        depthshade=False,
        zorder=7.3,
        label="elements, not to scale",
    )
