"""Results in words and columns."""

import io

import pytest
from rich.console import Console, RenderableType

from nullpose import Scenario, Solution, solve
from nullpose.report.comparison import compare_all
from nullpose.report.tables import binding_nodes, comparison_view, solution_view, status_words


def text_of(view: RenderableType, width: int = 200) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view)
    return console.file.getvalue()


@pytest.fixture(scope="module")
def optimum(paper: Scenario) -> Solution:
    """The optimum of the paper's scenario."""
    return solve(paper)


def test_numbers_of_a_solution(optimum: Solution) -> None:
    """The value is told in dB and as a ratio, the pose in metres and degrees, the axis by two angles."""
    text = text_of(solution_view(optimum))
    for words in ("0.9836997 dB (1.254209)", "x -2.2423 m", "roll -17.180 deg", "79.565 deg from vertical"):
        assert words in text
    assert "azimuth 162.52 deg" in text


def test_both_nodes_bind_on_the_kink(optimum: Solution) -> None:
    """At the optimum both nodes have the smallest SINR, and both are marked."""
    assert binding_nodes(optimum) == {"S1", "S2"}
    assert text_of(solution_view(optimum)).count("binding") == 2


def test_one_node_binds_above_the_jammer(paper: Scenario) -> None:
    """The vertical antenna next to the jammer is nearer to one node, and the other binds."""
    assert binding_nodes(solve(paper, "vertical")) == {"S2"}


def test_status_is_told_in_words(optimum: Solution) -> None:
    """The status says what is not proved, and how many searches there were."""
    words = status_words(optimum)
    assert "not proved" in words
    assert f"{optimum.stats.starts} starts" in words


def test_a_null_on_the_jammer_is_called_so(paper: Scenario) -> None:
    """An interference of rounding noise is not told in decibels."""
    assert "nulled" in text_of(solution_view(solve(paper, "zero-interference")))


def test_comparison_fits_a_terminal(paper: Scenario) -> None:
    """In eighty columns the four cases keep their numbers whole."""
    text = text_of(comparison_view(compare_all(paper)), width=80)
    for words in ("0.9836997", "0.8123549", "-0.6998473", "-2.1602611"):
        assert words in text
    assert max(map(len, text.splitlines())) <= 80


def test_names_that_look_like_markup(field: Scenario) -> None:
    """A node's name is printed as it is."""
    data = field.to_dict()
    data["nodes"][0]["name"] = "[red]gate"
    data["name"] = "field [1]"
    scenario = Scenario.from_dict(data)
    assert "[red]gate" in text_of(solution_view(solve(scenario)))
    text = text_of(comparison_view(compare_all(scenario)))
    assert "[red]gate" in text
    assert "field [1]" in text
