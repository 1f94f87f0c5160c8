"""The figure of a comparison of airframes: a bar for each vehicle, with its bound."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Any

from nullpose.objectives import Quantity
from nullpose.report.airframes import answer_lines
from nullpose.report.figures.style import GREY, INK, VEHICLES, house_style
from nullpose.report.numbers import share_text
from nullpose.study import AirframeComparison, AirframeResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_airframes"]

_ROW_INCH = 0.3
_GAP = 0.6  # between dipoles and arrays, in rows
_DEEPEST_DB = 25.0  # bars that end farther below the omnidirectional one are cut off
_CAPTION_LETTERS = 125


def draw_airframes(comparison: AirframeComparison) -> Figure:
    """Return the figure: a bar for each vehicle, a line from it up to its bound, and what it guarantees.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    from matplotlib.figure import Figure

    scenario = comparison.scenario
    quantity = Quantity.of(scenario)
    rows = list(comparison.results)
    lines = [words for line in answer_lines(comparison) for words in textwrap.wrap(line, _CAPTION_LETTERS)]
    with house_style():
        height = 1.6 + _ROW_INCH * len(rows) + 0.17 * len(lines)
        figure = Figure(figsize=(7.0, height), layout="constrained")
        axes = figure.add_subplot()
        low, high = _range(comparison, quantity)
        places = [index + (_GAP if index >= len(comparison.dipoles) else 0.0) for index in range(len(rows))]
        for place, result in zip(places, rows, strict=True):
            _draw_row(axes, comparison, quantity, place, result, low)
        whole = quantity.in_unit(comparison.omnidirectional.value)
        axes.axvline(whole, color=VEHICLES["omnidirectional"].colour, linewidth=0.9, zorder=2.5)
        axes.set_xlim(low, high + 0.2 * (high - low))
        axes.set_yticks(places, [result.case.label for result in rows])
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(places[-1] + 0.6, -0.6)
        axes.grid(visible=False, axis="y")
        axes.set_title(
            scenario.name.replace("$", r"\$"), loc="left", fontsize=9.0, fontweight="bold", color=INK
        )
        axes.set_xlabel(f"{quantity.smallest} over the nodes  ({quantity.unit})")
        figure.legend(
            handles=_legend(comparison), loc="outside upper center", ncols=3, frameon=False, handlelength=1.6
        )
        figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=7.5, color=GREY, linespacing=1.35)
    return figure


def _numbers(result: AirframeResult, quantity: Quantity) -> list[float]:
    """Return value, bound and what is guaranteed, in the quantity's unit, as far as they are there."""
    objective, guaranteed = result.objective, result.guaranteed
    values = [] if objective is None else [objective.value, objective.upper_bound]
    values += [] if guaranteed is None else [guaranteed.nominal_pose, guaranteed.robust_pose]
    return [quantity.in_unit(value) for value in values if value is not None]


def _range(comparison: AirframeComparison, quantity: Quantity) -> tuple[float, float]:
    """Return the ends of the value axis: from nothing for a rate, in dB from below the smallest."""
    numbers = [number for result in comparison.results for number in _numbers(result, quantity)]
    numbers = [number for number in numbers if math.isfinite(number)]
    high = max(numbers)
    if quantity.is_rate:
        return 0.0, max(high, 1e-3)
    floor = quantity.in_unit(comparison.omnidirectional.value) - _DEEPEST_DB
    lowest = max(min(numbers), floor)
    return lowest - 0.08 * max(high - lowest, 1.0) - 0.5, high


def _draw_row(
    axes: Axes,
    comparison: AirframeComparison,
    quantity: Quantity,
    place: float,
    result: AirframeResult,
    low: float,
) -> None:
    objective, guaranteed = result.objective, result.guaranteed
    if objective is None:
        axes.text(low, place, " no pose reaches every node", va="center", fontsize=8, color=GREY)
        return
    value = quantity.in_unit(objective.value)
    colour, hatch = _look(result)
    axes.barh(
        place,
        max(value, low) - low,
        left=low,
        height=0.62,
        color=colour,
        hatch=hatch,
        edgecolor="white",
        linewidth=0.0,
        zorder=2.0,
    )
    end = max(value, low)
    if value < low:
        axes.plot([low], [place], color=colour, marker="<", markersize=6.0, clip_on=False, zorder=3.0)
    if objective.upper_bound is not None:
        bound = quantity.in_unit(objective.upper_bound)
        axes.plot([end, bound], [place, place], color=INK, linewidth=1.0, zorder=3.0)
        axes.plot([bound], [place], color=INK, marker="|", markersize=7.0, linestyle="", zorder=3.0)
        end = max(end, bound)
    if guaranteed is not None:
        _draw_guaranteed(axes, quantity, place, low, guaranteed.nominal_pose, guaranteed.robust_pose)
    share = comparison.share(result)
    shown = f"{value:.3g}" if quantity.is_rate else f"{value:.2f}"
    words = "" if share is None or result is comparison.omnidirectional else f"  ({share_text(share)})"
    axes.annotate(
        f"{shown}{words}".replace("-", "\N{MINUS SIGN}"),
        (end, place),
        xytext=(5, 0),
        textcoords="offset points",
        va="center",
        fontsize=8,
        zorder=4.0,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
    )


def _draw_guaranteed(
    axes: Axes, quantity: Quantity, place: float, low: float, nominal: float, robust: float | None
) -> None:
    """Draw a thin bar up to what the robust pose guarantees, and a mark at what the nominal one does."""
    if robust is not None:
        end = max(quantity.in_unit(robust), low)
        axes.barh(place, end - low, left=low, height=0.22, color=INK, zorder=2.2)
    at = quantity.in_unit(nominal)
    if at >= low:
        axes.plot(
            [at],
            [place],
            marker="d",
            color="white",
            markeredgecolor=INK,
            markersize=5.0,
            linestyle="",
            zorder=2.4,
        )


def _look(result: AirframeResult) -> tuple[str, str | None]:
    if result.case.array is not None:
        return VEHICLES["array"].colour, "////" if result.case.combining == "analogue" else None
    return VEHICLES[result.case.name].colour, None


def _legend(comparison: AirframeComparison) -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Any] = [
        Line2D([], [], color=INK, linewidth=1.0, marker="|", markersize=7.0, label="no pose is above this"),
    ]
    if comparison.arrays:
        colour = VEHICLES["array"].colour
        handles.append(Patch(facecolor=colour, edgecolor="white", hatch="////", label="analogue array"))
    if comparison.stated is not None:
        handles.append(Patch(color=VEHICLES["stated"].colour, label="the file's vehicle"))
    if comparison.scenario.is_uncertain:
        handles.append(Patch(color=INK, label="guaranteed, robust pose"))
        handles.append(
            Line2D(
                [],
                [],
                marker="d",
                color="white",
                markeredgecolor=INK,
                linestyle="",
                label="guaranteed, pose shown",
            )
        )
    return handles
