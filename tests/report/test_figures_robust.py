"""The figure of a robust solution: two poses in one space, with the sets that jammers may be in."""

from pathlib import Path

import numpy as np
import pytest

from nullpose import load
from nullpose.report.figures.poses import draw_result
from nullpose.solver import Result, solve

EXAMPLE = Path(__file__).parents[2] / "examples" / "robust.toml"


@pytest.fixture(scope="module")
def solution() -> Result:
    """The example, searched alone."""
    return solve(load(EXAMPLE), robust=True, certify=False)


def test_both_poses_with_what_they_guarantee(solution: Result) -> None:
    """A plan for each, with its values in dB; the errors above them."""
    figure = draw_result(solution)
    for axes, one, name in zip(
        figure.axes,
        (solution.details.robust, solution.details.nominal),
        ("robust pose", "best pose without errors"),
        strict=True,
    ):
        title = axes.get_title().replace("\N{MINUS SIGN}", "-")
        assert title.startswith(name)
        assert f"{10 * np.log10(one.guaranteed):.2f} dB guaranteed" in title
        assert f"{10 * np.log10(one.nominal):.2f} dB without errors" in title
        drones = [line.get_xydata() for line in axes.lines if line.get_label() == "antenna axis (null)"]
        assert np.mean(drones[0], axis=0) == pytest.approx(one.pose.position_m[:2])
    assert "smallest SINR; errors: axis 2 deg, position 0.5 m, M up to 3 m" in figure.get_suptitle()


def test_both_plans_show_the_same_space(solution: Result) -> None:
    """Places can be compared: limits are the same, and both drones are inside."""
    first, second = draw_result(solution).axes
    assert first.get_xlim() == second.get_xlim()
    low, high = first.get_ylim()
    assert (low, high) == second.get_ylim()
    for one in (solution.details.robust, solution.details.nominal):
        assert low < one.pose.position_m[1] < high


def test_the_set_is_drawn_around_its_jammer(solution: Result) -> None:
    """In each plan a circle as wide as the jammer may be off, in its colour, and in the legend once."""
    figure = draw_result(solution)
    for axes in figure.axes:
        (outline,) = [line for line in axes.lines if line.get_label() == "where the jammer may be"]
        assert np.linalg.norm(outline.get_xydata() - [17.0, 15.0], axis=1) == pytest.approx(3.0)
        assert outline.get_color() == "#d55e00"
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts.count("where the jammer may be") == 1
