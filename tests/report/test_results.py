"""Results in words and columns."""

import io
import math
from dataclasses import replace

import pytest
from rich.console import Console, RenderableType

from nullpose import Pose, Result, Scenario, solve
from nullpose.report.comparison import comparison_view
from nullpose.report.results import frame_rows, result_view
from nullpose.scenario import Origin
from nullpose.study import compare_schemes


def text_of(view: RenderableType, width: int = 200) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view)
    return console.file.getvalue()


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
