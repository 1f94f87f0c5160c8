"""Poses from above: of one result, at several jamming levels, under errors."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.report.figures.names import place_names
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.style import GREY, INK, Look, house_figure, inches, is_column
from nullpose.report.geometry import axis_angle_rad
from nullpose.report.numbers import MINUS, capitalised, with_unit
from nullpose.report.sensitivity import sensitivity_caption
from nullpose.report.words import error_words
from nullpose.scenario import Scenario
from nullpose.solver import Objective, Result
from nullpose.solver.array import ArrayDetails
from nullpose.solver.hover import HoverDetails
from nullpose.solver.robust import RobustDetails
from nullpose.study import ResultRow

_ALONE_INCH, _EACH_INCH = (7.0, 5.4), (4.0, 4.4)  # of one plan, and of each of several
_PAGE_SHARES, _COLUMN_SHARES = (0.6, 0.5), (0.95, 0.75)  # heights over widths of one plan, and of several
_COLUMNS, _WIDEST = (6, 3), 0.985  # of a legend and of a key at most; their width over the figure's
_KEY_PT, _KEY_LETTERS = (6.5, 6.0), 48  # letters; in a line: a column holds so many in bold
_PLAN_WIDTH, _AXIS_INCH = 0.8, 0.5  # of a plan with a key, over the figure's; name of the axis below it
_LOWEST_INCH, _HIGHEST_INCH = 1.0, 75.0 / 25.4  # of such a plan, and of the figure if the key has space


def draw_panels(
    scene: PlanScene,
    *,
    head: str = "",
    titles: Sequence[str] = ("",),
    width: str | None = None,
    beside: Callable[[Axes], None] | None = None,
) -> Figure:
    """Draw each pose from above, several side by side.

    Args:
        scene: what is to be seen in each.
        head: title of the figure; empty for none. In print there is none.
        titles: of the plans.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
        beside: draws what stands beside the plans; None for nothing.
    """
    count, is_narrow = len(scene.poses) + (beside is not None), is_column(width)
    usual = _ALONE_INCH if count == 1 else (_EACH_INCH[0] * count, _EACH_INCH[1])
    share = (_COLUMN_SHARES if is_narrow else _PAGE_SHARES)[count > 1]
    with house_figure(inches(usual, width, share), width) as figure, rc_context({"text.parse_math": False}):
        panels = figure.subplots(1, count, squeeze=False)[0]
        plans = panels[: len(scene.poses)]
        for axes, pose, title in zip(plans, scene.poses, titles, strict=True):
            axes.set_title(
                title.replace(", ", "\n") if is_narrow else title,
                fontsize="small" if is_narrow else "medium",
                parse_math=True,
            )
            draw_plan(axes, scene, pose)
        if beside is not None:
            beside(panels[-1])
        if width is None:
            figure.suptitle(head, fontsize=10, wrap=True)
        _draw_legend(figure, scene)
        for axes in plans:
            place_names(axes)
    return figure


def _draw_legend(figure: Figure, scene: PlanScene) -> None:
    """Draw the legend below all, with the key if there is one, in as many columns as there is space for."""
    marks: dict[str, dict[type, Any]] = {}
    for axes in figure.axes:
        drawn = [*zip(*axes.get_legend_handles_labels(), strict=True)]
        marks |= {name: {type(mark): mark for mark, label in drawn if label == name} for _, name in drawn}
    keyed = scene.keyed if scene.key else []
    entries = keyed + [(name, "", name) for name in marks if name not in {kind for kind, _, _ in keyed}]
    handles: Any = [tuple(marks[kind].values()) for kind, _, _ in entries]
    lines = [textwrap.fill(words, _KEY_LETTERS) for _, _, words in entries]
    look: Look = {"loc": "outside lower center", "title": scene.note, "alignment": "left"}
    look |= {"borderaxespad": 0.1, "labelspacing": 0.25, "handlelength": 1.3, "columnspacing": 0.8}
    sizes = _KEY_PT if keyed else (None,)
    for count, points in product(range(_COLUMNS[bool(keyed)], 0, -1), sizes):
        legend = figure.legend(handles, lines, ncols=count, fontsize=points, **look)
        for text, (_, name, _) in zip(legend.get_texts(), entries, strict=True):
            text.set_fontweight("bold" if name in scene.worst else "normal")
        width_px, height_px = legend.get_window_extent().size
        if width_px <= _WIDEST * figure.bbox.width or (count, points) == (1, sizes[-1]):
            break
        legend.remove()
    if keyed:
        below_inch, (across_m, along_m) = height_px / figure.dpi + _AXIS_INCH, np.ptp(scene.box_m, axis=0)
        high_inch = _PLAN_WIDTH * figure.get_figwidth() * along_m / across_m
        most_inch = max(_LOWEST_INCH, _HIGHEST_INCH - below_inch)
        figure.set_figheight(below_inch + float(np.clip(high_inch, _LOWEST_INCH, most_inch)))


def draw_poses(scenario: Scenario, rows: Sequence[ResultRow]) -> Figure:
    """Draw several best poses side by side, each at its own jamming level, in a scenario with a jammer."""
    return draw_panels(
        PlanScene(scenario=scenario, poses=tuple(row.pose for row in rows)),
        titles=[f"$P_M/P$ = {row.value:g}\n{_words(scenario, row.objective, row.pose)}" for row in rows],
    )


def draw_result(result: Result, width: str | None = None) -> Figure:
    """Draw the scene, its fence and its no-fly zones, and the pose.

    With errors there are two poses, and a hover has its values over time beside it.

    Args:
        result: of any kind.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
    """
    if isinstance(result.details, RobustDetails):
        return _draw_robust(result, result.details, width)
    words = _words(result.scenario, result.objective, result.pose)
    beside = partial(_draw_instants, result) if isinstance(result.details, HoverDetails) else None
    if isinstance(result.details, ArrayDetails):
        yaw = f"{math.degrees(result.pose.yaw_rad):.1f}°".replace("-", MINUS)
        words = f"{result.label}: {words}, yaw {yaw}"
    words = "\n".join(filter(None, (words, sensitivity_caption(result))))
    return draw_panels(
        PlanScene.of(result, is_narrow=is_column(width)),
        head=f"{result.scenario.name}\n{words}",
        width=width,
        beside=beside,
    )


def _draw_instants(result: Result, axes: Axes) -> None:
    """Draw what a pose gives at every instant, and the bound on the smallest of them."""
    assert isinstance(result.details, HoverDetails)
    quantity, bound = result.objective.quantity, result.objective.upper_bound
    values = [quantity.in_unit(value) for value in result.details.values.tolist()]
    ring: Look = {"color": INK, "markerfacecolor": "white", "markersize": 6.0}
    axes.plot(result.details.times_s, values, color=INK, marker=".", markersize=3.0, label="at each instant")
    axes.plot(result.details.worst_s, min(values), "o", **ring, label="the worst, in the plan")
    if bound is not None:
        look: Look = {"color": GREY, "linestyle": "--", "linewidth": 0.9}
        axes.axhline(quantity.in_unit(bound), label="no pose has its worst above", **look)
    axes.set(xlabel="Time (s)", ylabel=f"{capitalised(quantity.smallest)} ({quantity.unit})")


def _draw_robust(result: Result, details: RobustDetails, width: str | None) -> Figure:
    """Draw the robust pose, and beside it the one that is best without errors.

    Both plans show the same space, with the sets that jammers and eavesdroppers may be anywhere in.
    """
    scenario, quantity = result.scenario, Quantity.of(result.scenario)
    words = [
        [with_unit(quantity.in_unit(value), quantity) for value in (each.guaranteed, each.nominal)]
        for each in (details.robust, details.nominal)
    ]
    titles = [
        f"{name}\n{guaranteed} guaranteed, {nominal} without errors"
        for name, (guaranteed, nominal) in zip(
            ("robust pose", "best pose without errors"), words, strict=True
        )
    ]
    head = f"{scenario.name}\n{quantity.smallest}; errors: {error_words(scenario)}"
    scene = PlanScene(scenario=scenario, poses=(details.robust.pose, details.nominal.pose), uncertain=True)
    return draw_panels(scene, head=head, titles=titles, width=width)


def _words(scenario: Scenario, objective: Objective, pose: Pose) -> str:
    """Write the value at a pose, and how far a dipole's null is off the jammers, or the eavesdroppers."""
    quantity = objective.quantity
    nulls = [
        f"{math.degrees(axis_angle_rad(pose, each.position_m)):.1f}° off {each.name}"
        for each in scenario.interferers
    ]
    value = f"{quantity.smallest} {with_unit(quantity.in_unit(objective.value), quantity)}"
    has_null = nulls and scenario.array is None and scenario.antenna_record.is_quadratic
    return f"{value}, null {', '.join(nulls)}" if has_null else value
