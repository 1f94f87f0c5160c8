"""The figure of an array: its plan and its heading."""

from pathlib import Path

import numpy as np
import pytest

from nullpose import load
from nullpose.report.figures.poses import draw_result
from nullpose.solver import solve

EXAMPLE = Path(__file__).parents[2] / "examples" / "array.toml"


def test_the_heading_is_the_yaw() -> None:
    """From the drone a line runs ahead; there is no axis with a null, since each node has its own beam."""
    solution = solve(load(EXAMPLE), certify=False)
    (plan,) = draw_result(solution).axes
    (heading,) = [line for line in plan.lines if line.get_label() == "heading (yaw)"]
    start, end = heading.get_xydata()
    assert start == pytest.approx(solution.pose.position_m[:2])
    ahead = end - start
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(solution.pose.yaw_rad)
    assert not [line for line in plan.lines if "axis" in line.get_label()]
