"""The search over positions alone, on objectives whose answer is known another way."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from paper_schemes import maximum_gain_sinr

from nullpose.errors import SolveError
from nullpose.physics import sinr, to_db
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.multistart import multistart
from nullpose.solver.position_search import PositionSearch


def found(objective: Callable[[np.ndarray], float], family: Family, seed: int = 0) -> PositionSearch:
    """Returns a search that has ended."""
    search = PositionSearch(objective, family, seed)
    search.search()
    return search


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 0.3])
def test_the_vertical_case_two_ways(ratio: float, paper: Callable) -> None:
    """On the vertical objective it comes to what the polished multistart finds with derivatives."""
    scene = paper(ratio)
    family = build_family(scene)
    up = np.array([0.0, 0.0, 1.0])

    def objective(p: np.ndarray) -> float:
        return float(to_db(np.min(sinr(scene, p, up)))) * math.log(10.0) / 10.0

    search = found(objective, family)
    other = multistart(family, AxisField.affine(up, np.zeros((3, 3))), seed=0)
    assert search.best == pytest.approx(other.log_value, abs=1e-8)
    assert search.best == objective(search.state)
    np.testing.assert_allclose(search.state, other.position_m, atol=1e-3)
    assert 1 <= search.starts < search.evaluations


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_maximum_gain_two_ways(ratio: float, paper: Callable) -> None:
    """On the maximum-gain objective for two nodes it comes to what the polished multistart finds."""
    scene = paper(ratio)
    family = build_family(scene)

    def objective(p: np.ndarray) -> float:
        return float(np.log(np.min(maximum_gain_sinr(scene, p))))

    other = multistart(family, AxisField.broadside(*scene.node_positions_m), seed=0)
    assert found(objective, family).best == pytest.approx(other.log_value, abs=1e-7)


def test_the_position_is_in_the_domain(paper: Callable) -> None:
    """Bounds and keep-out balls hold at the position found, where they bind too."""
    scene = paper(0.1, x_m=(3.0, 20.0), keep_out_m=25.6)
    family = build_family(scene)

    def objective(p: np.ndarray) -> float:
        return float(np.log(np.min(sinr(scene, p, np.array([0.0, 0.0, 1.0])))))

    position = found(objective, family).state
    low, high, centres = family.domain.low_m, family.domain.high_m, family.domain.keep_out_points_m
    radius = family.domain.keep_out_m
    assert np.all((position >= low) & (position <= high))
    assert np.all(np.linalg.norm(centres - position, axis=1) >= radius)


def test_a_seed_repeats(paper: Callable) -> None:
    """The same seed gives the same position to the last bit."""
    scene = paper(1.0)

    def objective(p: np.ndarray) -> float:
        return float(np.log(np.min(sinr(scene, p, np.array([0.6, 0.0, 0.8])))))

    first, second = (found(objective, build_family(scene), 4) for _ in range(2))
    np.testing.assert_array_equal(first.state, second.state)
    assert first.evaluations == second.evaluations


def test_an_objective_without_a_value_is_said(paper: Callable) -> None:
    """An objective that is minus infinity everywhere has no best position, and that is said."""
    with pytest.raises(SolveError, match="widen the airspace"):
        found(lambda p: -math.inf, build_family(paper(1.0)))


def test_a_wall_between_zones_is_searched(scene: Callable) -> None:
    """Where the airspace leaves a wall of no width, a position on it is found."""
    zones = [
        {"polygon_m": [(west, -5), (east, -5), (east, 45), (west, 45)]} for west, east in ((-5, 5), (5, 15))
    ]
    walled = scene([(0, 0, 0), (10, 40, 1)], x_m=(0.0, 10.0), y_m=(0.0, 40.0), no_fly=zones)
    search = found(lambda p: -float(p[2]), build_family(walled))
    assert walled.airspace.allows(search.state)
    assert search.best == -8.0
