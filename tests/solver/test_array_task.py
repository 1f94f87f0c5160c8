"""An array's problem as numbers."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_allclose

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_task import ArrayTask


def _task(scenario: Scenario) -> ArrayTask:
    return ArrayTask.of(scenario, Array(elements=4, layout="linear", spacing_wavelengths=0.5))


def test_turning_by_the_symmetry_changes_nothing(random_scene: Callable) -> None:
    """A row turned by half a turn, a circle by one of its elements: the ratios are the same."""
    rng = np.random.default_rng(9)
    for layout, elements in (("linear", 4), ("circular", 5), ("circular", 2), ("circular", 1)):
        array = Array(elements=elements, layout=layout, spacing_wavelengths=0.5)
        task = ArrayTask.of(random_scene(rng, 3, 2, 10.0), array)
        state = np.append(rng.uniform([0, 0, 9], [99, 99, 29]), rng.uniform(-3.0, 3.0))
        turned = state + np.array([0.0, 0.0, 0.0, 2.0 * math.pi / task.symmetry])
        assert task.value(turned) == pytest.approx(task.value(state), abs=1e-9)


def test_nothing_out_of_reach_is_as_good(random_scene: Callable) -> None:
    """Every state with a value has its position in the box that is said to hold all such positions."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        task = _task(random_scene(rng, 3, 1, jamming_w=1e-3))
        for _ in range(30):
            state = rng.uniform([-200, -200, 8, 0], [300, 300, 30, 6])
            low_m, high_m = task.reach(task.value(state))
            assert np.all((low_m <= state[:3]) & (state[:3] <= high_m))


def test_walls_are_distances(paper: Callable) -> None:
    """Balls, planes and cylinders: the distances to them, and the ways out as unit vectors."""
    drum = {"centre_m": (0.0, 30.0), "radius_m": 5.0}
    box = {"x_m": (20.0, 40.0), "y_m": (20.0, 40.0), "altitude_m": (0.0, 15.0)}
    task = _task(paper(1.0, altitude_m=(0.0, 30.0), keep_out_m=3.0, no_fly=(drum, box)))
    position_m = np.array([8.0, 30.0, 12.0])
    distance_m, ways = task.walls(position_m)
    balls = np.linalg.norm(position_m - task.family.keep_out_points_m, axis=1) - 3.0
    assert_allclose(distance_m, [*balls, 3.0, 12.0], atol=1e-12)
    assert_allclose(np.linalg.norm(ways, axis=1), 1.0, rtol=1e-12)
    step = 1e-6
    for i in range(3):
        further = task.walls(position_m + step * np.eye(3)[i])[0]
        assert_allclose((further - distance_m) / step, ways[:, i], atol=1e-5)


def test_a_position_a_little_outside_is_put_right(paper: Callable) -> None:
    """It ends in the domain, next to where it was, whatever it was outside of."""
    drum = {"centre_m": (0.0, 30.0), "radius_m": 5.0}
    scene = paper(1.0, altitude_m=(4.0, 30.0), x_m=(-4.0, 50.0), keep_out_m=3.0, no_fly=(drum,))
    task = _task(scene)
    points_m = np.vstack([scene.node_positions_m, scene.jammer_positions_m])
    for wrong in ([17.0, 15.0, 6.99], [-4.01, 40.0, 9.0], [0.0, 35.0 - 1e-7, 9.0], [17.0, 15.0, 30.01]):
        right = task.repaired(np.array(wrong))
        assert right is not None
        assert scene.airspace.allows(right)
        assert np.min(np.linalg.norm(points_m - right, axis=1)) >= 3.0
        assert np.linalg.norm(right - wrong) < 1.0
    untouched = np.array([3.0, 3.0, 9.0])
    np.testing.assert_array_equal(task.repaired(untouched), untouched)
