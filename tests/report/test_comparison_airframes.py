"""The answer to the title's question, in words that follow from the numbers."""

import io
import math
from dataclasses import replace
from functools import cache

import pytest
from rich.console import Console

from nullpose import Airframe, ResultTable, compare_airframes, load
from nullpose.report.answer import answer_lines
from nullpose.report.comparison import airframes_view
from nullpose.report.figures.dots import draw_comparison
from nullpose.report.numbers import bound_text
from nullpose.scenario import apply_overrides
from nullpose.study.vehicles import dipoles
from scenes import EXAMPLES


@cache
def compared(name: str, *overrides: str, **options: object) -> ResultTable:
    """Returns an example's vehicles compared."""
    return compare_airframes(apply_overrides(load(EXAMPLES / f"{name}.toml"), list(overrides)), **options)


def text_of(comparison: ResultTable, width: int = 200) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(airframes_view(comparison))
    return console.file.getvalue()


def with_value(comparison: ResultTable, name: str, value: float) -> ResultTable:
    """Returns the comparison with one vehicle's value replaced."""
    rows = tuple(
        replace(row, objective=replace(row.objective, value=value, upper_bound=value))
        if row.name == name
        else row
        for row in comparison.rows
    )
    return replace(comparison, rows=rows)


@pytest.fixture(scope="module")
def plain() -> ResultTable:
    """The paper's scene at a jamming power of 100."""
    return compared("paper", "jammers.M.power_w=100")


@pytest.fixture(scope="module")
def robust() -> ResultTable:
    """The example with errors, with a vehicle of its own."""
    scenario = load(EXAMPLES / "robust.toml")
    own = Airframe(tilt_max_deg=5.0, mount_deg=90.0)
    return compare_airframes(scenario.model_copy(update={"airframe": own}))


def test_no_other_vehicle_suffices(plain: ResultTable) -> None:
    """Were all the others worse, the nearest is named, and only what their bounds prove is said."""
    worse = plain
    for row in dipoles(plain)[:-1]:
        worse = with_value(worse, row.name, 0.5)
    worse = with_value(worse, "tilt-30-horizontal", 0.9 * plain.of("omnidirectional")[0].objective.value)
    _, first, *_ = answer_lines(worse)
    assert first == (
        "No vertical or horizontal dipole compared is enough (proved). The nearest, a 30 degree tilt with a "
        "horizontal dipole, reaches 0.46 dB less than the omnidirectional vehicle."
    )
    rows = tuple(replace(row, objective=replace(row.objective, upper_bound=None)) for row in worse.rows)
    assert "was found enough (not proved of all)" in answer_lines(replace(worse, rows=rows))[1]


def test_nothing_to_give() -> None:
    """Where no vehicle gives anything there is nothing to compare, and it is said."""
    zero = compared("eavesdropper", certify=False)
    for result in zero.rows:
        zero = with_value(zero, result.name, 0.0)
    (line,) = answer_lines(zero)
    assert line == "No vehicle compared with one dipole was found to reach every node."
    assert "nan" not in text_of(zero)
    draw_comparison(zero)


def test_figure_has_a_dot_for_each_vehicle(robust: ResultTable) -> None:
    """A row for each vehicle by its name, the answer below, guarantees in the legend, no overlaps."""
    figure = draw_comparison(robust)
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.get_yticklabels()] == [one.case.label for one in robust.rows]
    assert "0.03 dB less" in figure.get_supxlabel()
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    guaranteed = {"guaranteed, robust pose", "guaranteed, pose shown"}
    assert set(legend) == guaranteed | {
        "value found",
        "upper bound",
        "omnidirectional",
    }
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axes.texts]
    assert not any(box.overlaps(other) for i, box in enumerate(boxes) for other in boxes[i + 1 :])
    assert all(box.x1 <= figure.bbox.x1 for box in boxes)


@pytest.mark.parametrize("apart", [1e3, 1e9, math.inf])
def test_bounds_far_away_hide_no_value(plain: ResultTable, apart: float) -> None:
    """The axis follows the values; a bound far above them is an arrow at the edge, with its number."""
    far = [
        replace(row, objective=replace(row.objective, upper_bound=apart * row.objective.value))
        for row in dipoles(plain)[:-1]
    ]
    names = [row.name for row in far]
    table = replace(plain, rows=(*far, *(row for row in plain.rows if row.name not in names)))
    figure = draw_comparison(table)
    (axes,) = figure.axes
    left, right = axes.get_xlim()
    values_db = [row.objective.value_db for row in table.rows]
    assert left < min(values_db) < max(values_db) < right
    assert max(values_db) - min(values_db) > 0.4 * (right - left)
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "upper bound far above" in legend
    numbers = [text.get_text() for text in axes.texts]
    assert len(numbers) > 3
    assert set(numbers) <= {bound_text(row.objective, 1) for row in far}


def test_close_values_are_told_apart_by_whole_numbers(plain: ResultTable) -> None:
    """Values within a hundredth of a decibel: no number of the axis is written as a difference."""
    rows = tuple(
        replace(row, objective=replace(row.objective, value=28.3 + 5e-4 * place, upper_bound=28.32))
        for place, row in enumerate(plain.rows)
    )
    figure = draw_comparison(replace(plain, rows=rows))
    figure.draw_without_rendering()
    (axes,) = figure.axes
    assert axes.xaxis.get_offset_text().get_text() == ""
    ticks = [float(text.get_text()) for text in axes.get_xticklabels()]
    assert ticks == pytest.approx(list(axes.get_xticks()), abs=1e-9)
