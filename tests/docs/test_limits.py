"""The numbers on the limits page are what the program finds."""

from pathlib import Path

import numpy as np
import pytest

import nullpose

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "limits.md").read_text(encoding="utf-8")
TURNS_RAD = np.linspace(0.0, 2.0 * np.pi, 721)


@pytest.fixture(scope="module")
def solution() -> nullpose.Result:
    """The optimum of the paper's scenario under strong jamming."""
    scenario = nullpose.load(ROOT / "examples" / "paper.toml")
    return nullpose.solve(nullpose.apply_overrides(scenario, ["jammers.M.power_w=100"]))


def test_value_without_error(solution: nullpose.Result) -> None:
    """The value that the page starts from is the optimum."""
    assert f"reaches a smallest SINR of {solution.objective.value:.3f}" in PAGE


def test_jammer_one_metre_off(solution: nullpose.Result) -> None:
    """The value left with the jammer 1 m aside is the worst over all horizontal directions."""
    x, y, z = solution.scenario.jammers[0].position_m
    moved = ([x + float(np.cos(turn)), y + float(np.sin(turn)), z] for turn in TURNS_RAD[::2])
    worst = min(
        nullpose.min_sinr(
            nullpose.apply_overrides(solution.scenario, [f"jammers.M.position_m={place}"]), solution.pose
        )
        for place in moved
    )
    assert f"leaves {worst:.3f}" in PAGE
