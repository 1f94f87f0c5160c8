"""Results in words and columns."""

import io
import math
import re

import pytest
from rich.console import Console, RenderableType

from nullpose import Result, Scenario, solve
from nullpose.report.comparison import compare_all, comparison_view
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import bound_words
from nullpose.report.results import result_view


def text_of(view: RenderableType, width: int = 200) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view)
    return console.file.getvalue()


@pytest.fixture(scope="module")
def optimum(paper: Scenario) -> Result:
    """The optimum of the paper's scenario."""
    return solve(paper)


def test_numbers_of_a_solution(optimum: Result) -> None:
    """The value is told in dB and as a ratio, the pose in metres and degrees, the axis by two angles."""
    text = text_of(result_view(optimum))
    for words in ("0.9836997 dB (1.254209)", "x -2.2423 m", "roll -17.180 deg", "79.565 deg from vertical"):
        assert words in text
    assert "azimuth 162.52 deg" in text


def test_both_nodes_bind_on_the_kink(optimum: Result) -> None:
    """At the optimum both nodes have the smallest SINR, and both are marked."""
    assert binding_nodes(optimum) == {"S1", "S2"}
    assert text_of(result_view(optimum)).count("worst") == 2


def test_the_bound_is_told_with_its_gap(optimum: Result, paper: Scenario) -> None:
    """The bound stands below the value, never rounded below what is proved; without one there is no line."""
    words = bound_words(optimum.objective)
    found = re.fullmatch(r"upper bound (-?\d+\.\d+) dB \(relative gap (.*)\)", words)
    assert found is not None
    bound_db = 10.0 * math.log10(optimum.objective.upper_bound)
    assert bound_db <= float(found[1]) < bound_db + 1e-6
    assert found[2] == "1.0e-06"
    assert words in text_of(result_view(optimum))
    fast = solve(paper, certify=False)
    assert bound_words(fast.objective) == ""
    assert "upper bound" not in text_of(result_view(fast))


def test_a_comparison_shows_bounds_and_who_is_certified(paper: Scenario, field: Scenario) -> None:
    """Bounds have a row of their own; statuses name their cases unless all share one."""
    text = text_of(comparison_view(compare_all(paper)))
    (row,) = [line for line in text.splitlines() if "upper bound (dB)" in line]
    assert row.split()[3:] == ["0.9837041", "0.8123593", "-0.6998429", "-2.1602567"]
    assert text.count("certified optimal") == 1
    text = text_of(comparison_view(compare_all(field)))
    assert "Optimum; Zero interference; Vertical: certified" in text
    assert "Maximum gain: the upper bound is valid, but the requested gap was not reached" in text
    assert "the bound is that of the optimum" in text
    fast = text_of(comparison_view(compare_all(paper, certify=False)))
    (row,) = [line for line in fast.splitlines() if "upper bound (dB)" in line]
    assert row.split()[3:] == ["-"] * 4
    assert "not proved" in fast


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
    assert "[red]gate" in text_of(result_view(solve(scenario)))
    text = text_of(comparison_view(compare_all(scenario)))
    assert "[red]gate" in text
    assert "field [1]" in text
