"""The figure of an array: its elements, its heading, and a beam that looks where it should."""

from pathlib import Path

import numpy as np
import pytest

from nullpose import load
from nullpose.physics.array import placed_elements
from nullpose.report.figures.pattern import beam_surface
from nullpose.report.figures.poses import draw_result
from nullpose.solver import Result, solve

EXAMPLE = Path(__file__).parents[2] / "examples" / "array.toml"


@pytest.fixture(scope="module")
def solution() -> Result:
    """The example."""
    return solve(load(EXAMPLE), certify=False)


def _elements(solution: Result) -> np.ndarray:
    return placed_elements(solution.scenario, solution.pose)


def _drawn_elements(solution: Result) -> np.ndarray:
    axes = draw_result(solution).axes[1]
    (dots,) = [
        each for each in axes.collections if str(each.get_label()).startswith("elements, not to scale")
    ]
    return np.transpose(dots._offsets3d)


def test_elements_stand_as_they_are_laid_out(solution: Result) -> None:
    """The dots are the elements, turned by the yaw, all enlarged by one factor."""
    drawn, real = _drawn_elements(solution), _elements(solution)
    factor = np.linalg.norm(drawn) / np.linalg.norm(real)
    assert drawn == pytest.approx(factor * real, abs=1e-9)
    assert len(drawn) == 4


def test_the_beam_has_its_null_on_the_jammer(solution: Result) -> None:
    """Towards the jammer the surface drawn comes close to the vehicle, towards the node it does not."""
    scenario, position = solution.scenario, solution.pose.position_m
    node = [link.node for link in solution.links].index(solution.binding_node)
    weights = solution.details.weights[node]
    surface = beam_surface(_elements(solution), weights).reshape(3, -1).T
    reach = np.linalg.norm(surface, axis=1)
    assert reach.max() == pytest.approx(1.0)

    def towards(point_m: np.ndarray) -> float:
        ahead = (point_m - position) / np.linalg.norm(point_m - position)
        directions = surface / np.maximum(reach, 1e-12)[:, None]
        return float(reach[np.argmax(np.where(reach > 1e-9, directions @ ahead, -1.0))])

    assert towards(scenario.jammer_positions_m[0]) < 0.02
    assert towards(scenario.node_positions_m[node]) > 0.5
