"""Poses in 3-D with the radiation pattern: of one solution, at several jamming levels, or robust."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.report.figures.pattern import draw_pattern
from nullpose.report.figures.scene import (
    ALONE,
    DRONE,
    PAIR,
    PANELS,
    SURFACE,
    Stage,
    draw_line,
    draw_names,
    draw_scene,
)
from nullpose.report.figures.style import house_style
from nullpose.report.geometry import null_angle_rad
from nullpose.report.numbers import MINUS
from nullpose.report.words import error_words
from nullpose.scenario import Scenario
from nullpose.solve import Objective, Solution
from nullpose.solve.robust import GuardedPose, RobustSolution
from nullpose.study import SweepRow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_pose", "draw_poses", "draw_robust", "draw_stages", "escaped", "plain_name"]

_LETTERS = 100  # in a line of a title


def draw_poses(scenario: Scenario, rows: Sequence[SweepRow]) -> Figure:
    """Return the figure of several best poses side by side, one panel each.

    Args:
        scenario: the scene, with one jammer or more.
        rows: the poses to draw, each at its own jamming level.
    """
    words = [f"{_value_words(row.objective)}, {_angle_words(scenario, row.pose, first=True)}" for row in rows]
    titles = [f"$P_M/P$ = {row.value:g}\n{each}" for row, each in zip(rows, words, strict=True)]
    poses = [row.pose for row in rows]
    return _draw([Stage(scenario=scenario, poses=(pose,), view=PANELS) for pose in poses], poses, titles)


def draw_pose(solution: Solution) -> Figure:
    """Return the figure of one solution: the scene, its fence and its no-fly zones, the pose and its pattern.

    Args:
        solution: what was found.
    """
    scenario, pose = solution.scenario, solution.pose
    angles = _angle_words(scenario, pose)
    words = f"{_value_words(solution.objective)}{f', {angles}' if angles else ''}"
    head = f"{plain_name(scenario)}\n{textwrap.fill(words, _LETTERS)}"
    return _draw([Stage(scenario=scenario, poses=(pose,), view=ALONE)], [pose], [], head.strip())


def draw_robust(solution: RobustSolution) -> Figure:
    """Return the figure of a robust solution: its pose, and beside it the one that is best as stated.

    Both panels show the same space, with the sets that jammers and eavesdroppers may be anywhere in.

    Args:
        solution: what was found.
    """
    scenario, both = solution.scenario, (solution.robust, solution.nominal)
    poses = [one.pose for one in both]
    stage = Stage(scenario=scenario, poses=tuple(poses), view=PAIR, uncertain=True)
    titles = [
        f"{name}\n{_guarantee_words(scenario, one)}"
        for name, one in zip(("robust pose", "best pose as stated"), both, strict=True)
    ]
    errors = f"{Quantity.of(scenario).smallest}; errors: {error_words(scenario)}"
    words = escaped(textwrap.shorten(errors, _LETTERS, placeholder=" ..."))
    return _draw([stage, stage], poses, titles, f"{plain_name(scenario)}\n{words}".strip())


def escaped(text: str) -> str:
    """Return a text that Matplotlib writes as it is, and does not take for a formula.

    Args:
        text: any.
    """
    return text.replace("$", r"\$")


def plain_name(scenario: Scenario) -> str:
    """Return a scenario's name as Matplotlib writes it.

    Args:
        scenario: any.
    """
    return escaped(scenario.name)


def _value_words(objective: Objective) -> str:
    if objective.quantity.is_rate:
        return f"{objective.quantity.smallest} {objective.value:.3f} bits/s/Hz"
    return f"{objective.quantity.smallest} {objective.value_db:.2f} dB".replace("-", MINUS)


def _guarantee_words(scenario: Scenario, one: GuardedPose) -> str:
    """Return what a pose guarantees, and what it gives without errors, in the quantity's unit."""
    quantity = Quantity.of(scenario)
    digits = 3 if quantity.is_rate else 2
    guaranteed, stated = (
        f"{quantity.in_unit(value):.{digits}f}".replace("inf", "\N{INFINITY}").replace("-", MINUS)
        for value in (one.guaranteed, one.nominal)
    )
    return f"{guaranteed} {quantity.unit} guaranteed, {stated} {quantity.unit} without errors"


def _angle_words(scenario: Scenario, pose: Pose, *, first: bool = False) -> str:
    """Return how far the null is off the jammers, or the eavesdroppers; of the first only if asked for."""
    eavesdrop = bool(scenario.eavesdroppers)
    points_m = scenario.eavesdropper_positions_m if eavesdrop else scenario.jammer_positions_m
    names = scenario.eavesdropper_names if eavesdrop else scenario.jammer_names
    kind = "eavesdropper" if eavesdrop else "jammer"
    if not len(points_m):
        return ""
    angles = [f"{math.degrees(null_angle_rad(pose, point)):.1f}°" for point in points_m]
    if first or len(angles) == 1:
        return f"null {angles[0]} off the {kind}"
    each = (f"{angle} off {escaped(name)}" for angle, name in zip(angles, names, strict=True))
    return f"null {', '.join(each)}"


def draw_stages(
    stages: Sequence[Stage],
    poses: Sequence[Pose],
    titles: Sequence[str],
    head: str = "",
    *,
    vehicle: Callable[[Any, Stage, Pose], None],
    radius: float,
    surface: str,
) -> Figure:
    """Return a figure with a panel for each pose: the scene, the vehicle, and the names of points.

    Args:
        stages: what each panel has to show; all have the same view.
        poses: one for each panel.
        titles: of the panels; none for no titles.
        head: title of the figure; empty for none.
        vehicle: draws the vehicle at a pose.
        radius: of its pattern, which names keep off, as a share of the scene's extent.
        surface: what the pattern is called in the legend.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    view = stages[0].view
    with house_style():
        figure = Figure(figsize=(view.width_inch * len(poses), view.height_inch))
        figure.subplots_adjust(left=0.016, right=0.962, bottom=view.bottom, top=view.top, wspace=view.between)
        for index, (stage, pose) in enumerate(zip(stages, poses, strict=True)):
            axes: Any = figure.add_subplot(1, len(poses), index + 1, projection="3d", computed_zorder=False)
            draw_scene(axes, stage, pose)
            vehicle(axes, stage, pose)
            draw_names(axes, stage, pose, radius * stage.extent_m)
            if titles:
                axes.set_title(titles[index], fontsize=10, y=0.96)
        if head:
            figure.suptitle(head, fontsize=10)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        once = dict(zip(labels, handles, strict=True))
        handles = [*once.values(), Patch(color=SURFACE, alpha=0.8, label=surface)]
        columns = min(len(handles), view.columns)
        figure.legend(handles=handles, loc="lower center", ncols=columns, frameon=False, handlelength=2.6)
    return figure


def _draw(stages: Sequence[Stage], poses: Sequence[Pose], titles: Sequence[str], head: str = "") -> Figure:
    words, radius = "radiation pattern, near side cut away", stages[0].view.pattern
    return draw_stages(stages, poses, titles, head, vehicle=_draw_vehicle, radius=radius, surface=words)


def _draw_vehicle(axes: Any, stage: Stage, pose: Pose) -> None:
    view, extent_m, position = stage.view, stage.extent_m, pose.position_m
    reach = view.axis * extent_m * pose.antenna_axis
    label = "antenna axis (null)"
    draw_line(axes, position - reach, position + reach, color=DRONE, linewidth=1.8, zorder=6.5, label=label)
    draw_pattern(axes, pose, view.pattern * extent_m, view)
    axes.scatter(*position, color=DRONE, s=26, zorder=7, depthshade=False, label="drone")
