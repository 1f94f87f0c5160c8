"""Results in words and columns."""

import io
import math
import re

import pytest
from rich.console import Console, RenderableType

from nullpose import Result, Scenario, solve
from nullpose.report.comparison import comparison_view
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import bound_words
from nullpose.report.results import result_view
from nullpose.study import compare_schemes


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
    """Bounds are rounded up; each case has its status, and each status is explained."""

    def shown(scenario: Scenario, place: int, **options: object) -> tuple[list[str], str]:
        text = text_of(comparison_view(compare_schemes(scenario, **options)))
        return [line.split()[place] for line in text.splitlines()[4:8]], text

    values, text = shown(paper, -3)
    assert values == ["0.9838", "0.8124", "-0.6998", "-2.1602"]
    assert "certified: optimal within the requested gap" in text
    statuses, text = shown(field, -1)
    assert statuses == ["certified", "certified", "bounded", "certified"]
    assert "bounded: the upper bound is valid, but the requested gap was not reached" in text
    assert "Maximum gain: the bound is that of the optimum" in text
    bounds, text = shown(paper, -3, certify=False)
    assert bounds == ["-"] * 4
    assert "not proved" in text


def test_comparison_fits_a_terminal(paper: Scenario) -> None:
    """In eighty columns the four cases keep their numbers whole."""
    text = text_of(comparison_view(compare_schemes(paper)), width=80)
    for words in ("0.9837", "0.8124", "-0.6998", "-2.1603", "162.52"):
        assert words in text
    assert max(map(len, text.splitlines())) <= 80


def test_names_that_look_like_markup(field: Scenario) -> None:
    """A node's name is printed as it is."""
    data = field.to_dict()
    data["nodes"][0]["name"] = "[red]gate"
    data["name"] = "field [1]"
    scenario = Scenario.from_dict(data)
    assert "[red]gate" in text_of(result_view(solve(scenario)))
    text = text_of(comparison_view(compare_schemes(scenario)))
    assert "[red]gate" in text
    assert "field [1]" in text
