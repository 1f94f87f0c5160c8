"""Results in words and columns."""

import io
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console, RenderableType

from nullpose import Pose, Result, Scenario, apply_overrides, load, solve
from nullpose.report.comparison import comparison_view
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import bound_words
from nullpose.report.results import frame_rows, result_view
from nullpose.report.words import error_words
from nullpose.scenario import Origin
from nullpose.study import compare_schemes

EXAMPLES = Path(__file__).parents[2] / "examples"


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
    for words in ("0.9836997 dB (1.254209)", "x -2.24", "roll -17.18", "79.56"):
        assert words in text
    assert "azimuth 162.52" in text


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
        return [line.split()[place] for line in text.splitlines()[5:9]], text

    values, text = shown(paper, -3)
    assert values == ["0.9838", "0.8124", "-0.6998", "-2.1602"]
    assert "certified: optimal within the requested gap" in text
    statuses, text = shown(field, -1)
    assert statuses == ["certified", "certified", "bounded", "certified"]
    assert "bounded: the upper bound is valid, but the requested gap was not reached" in text
    assert "the bound is that of the optimum" in text
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


@pytest.fixture(scope="module")
def on_earth(paper: Scenario) -> Result:
    """A pose whose numbers are round, on the Earth."""
    scenario = paper.model_copy(update={"origin": Origin(lat_deg=0.0, lon_deg=0.0, alt_m=0.0)})
    found = solve(paper, certify=False)
    return replace(found, scenario=scenario, pose=Pose((0.0, 0.0, 20.0), 0.0, math.pi / 2.0))


def test_the_lines_of_a_round_pose(on_earth: Result, paper: Scenario) -> None:
    """Straight above the origin, pitched by a quarter turn: all is known; nothing without an origin."""
    place = "lat 0.0000000000 deg, lon 0.0000000000 deg, alt 20.00000 m over the WGS-84 ellipsoid"
    assert frame_rows(on_earth.scenario, on_earth.pose, 0) == [
        ("on the Earth", place),
        ("NED, body FRD", "north 0.0000 m, east 0.0000 m, down -20.0000 m"),
        ("", "roll 0.000 deg, pitch -90.000 deg, yaw 90.000 deg"),
        ("quaternion wxyz", "(0.707107, 0.000000, 0.707107, 0.000000) in ENU, body FLU"),
        ("", "(0.500000, 0.500000, -0.500000, 0.500000) in NED, body FRD"),
    ]
    assert frame_rows(paper, on_earth.pose, 0) == []


def robust_text(scenario: Scenario) -> str:
    """Returns what is printed of a robust solution that nothing is proved of."""
    return text_of(result_view(solve(scenario, robust=True, certify=False)))


def test_errors_are_listed() -> None:
    """Each error that is stated is named once, with its unit."""
    assert error_words(load(EXAMPLES / "robust.toml")) == "axis 2 deg, position 0.5 m, M up to 3 m"
    assert error_words(load(EXAMPLES / "paper.toml")) == ""


def test_without_a_proof_no_bound_is_claimed() -> None:
    """The table says that other poses are not bounded."""
    scenario = apply_overrides(load(EXAMPLES / "robust.toml"), ["receiver.position_error_m=0"])
    text = robust_text(scenario)
    assert "no upper bound on the guaranteed value" in text
    assert "relative gap" not in text


def test_rates_keep_their_unit() -> None:
    """A secrecy rate is never told in dB."""
    scenario = apply_overrides(load(EXAMPLES / "eavesdropper.toml"), ["receiver.attitude_error_deg=1"])
    text = robust_text(scenario)
    assert "guaranteed: smallest secrecy rate" in text
    assert "bits/s/Hz" in text
    assert " dB" not in text


@pytest.mark.parametrize(
    ("power_dbm", "words"),
    [
        (-40.0, "the hop that binds: from the drone to command post"),
        (20.0, "both hops bind: from spring to the drone, and from the drone to command post"),
        (40.0, "the hop that binds: from ford, mill, spring to the drone"),
    ],
)
def test_a_relay_says_which_hop_binds(power_dbm: float, words: str) -> None:
    """A weak drone is the bottleneck itself, a strong one its nodes; between, the pose makes both equal."""
    relay = apply_overrides(load(EXAMPLES / "relay.toml"), [f"transmitter.power_dbm={power_dbm}"])
    text = text_of(result_view(solve(relay)))
    assert words in text
    assert "It is part of the destination's noise." in text
    assert len(re.findall(r"^command post ", text, flags=re.MULTILINE)) == 1
