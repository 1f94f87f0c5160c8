"""The lines that tell a pose on the Earth, in NED and as quaternions."""

import math
from dataclasses import replace

import pytest

from nullpose import Pose, Result, solve
from nullpose.report.results import frame_rows
from nullpose.scenario import Origin, Scenario


@pytest.fixture(scope="module")
def solution(paper: Scenario) -> Result:
    """A pose whose numbers are round, on the Earth."""
    scenario = paper.model_copy(update={"origin": Origin(lat_deg=0.0, lon_deg=0.0, alt_m=0.0)})
    found = solve(paper, certify=False)
    return replace(found, scenario=scenario, pose=Pose((0.0, 0.0, 20.0), 0.0, math.pi / 2.0))


def test_the_lines_of_a_round_pose(solution: Result) -> None:
    """Straight above the origin, pitched by a quarter turn: every number can be told by heart."""
    assert frame_rows(solution.scenario, solution.pose) == [
        ("on the Earth", "lat 0.00000000 deg, lon 0.00000000 deg, alt 20.000 m over the WGS-84 ellipsoid"),
        ("NED, body FRD", "north 0.0000 m, east 0.0000 m, down -20.0000 m"),
        ("", "roll 0.000 deg, pitch -90.000 deg, yaw 90.000 deg"),
        ("quaternion wxyz", "(0.707107, 0.000000, 0.707107, 0.000000) in ENU, body FLU"),
        ("", "(0.500000, 0.500000, -0.500000, 0.500000) in NED, body FRD"),
    ]


def test_nothing_without_an_origin(solution: Result, paper: Scenario) -> None:
    """A scenario that lies nowhere on the Earth has no such lines."""
    assert frame_rows(paper, solution.pose) == []
