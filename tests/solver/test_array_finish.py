"""The last digits of an array's state."""

from collections.abc import Callable

import numpy as np

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_finish import finished
from nullpose.solver.array_task import ArrayTask


def _task(scenario: Scenario) -> ArrayTask:
    return ArrayTask.of(scenario, Array(elements=4, layout="circular", spacing_wavelengths=0.5))


def _start(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform([0.0, 0.0, 9.0, 0.0], [99.0, 99.0, 29.0, 6.0])


def test_no_small_step_is_better(random_scene: Callable) -> None:
    """Around what is finished no state of the domain is better, and the value is that of the state."""
    rng = np.random.default_rng(1)
    for _ in range(5):
        task = _task(random_scene(rng, 3, 1))
        start = _start(rng)
        value, state = finished(task, start)
        assert value == task.value(state)
        assert value >= task.value(start)
        for _ in range(300):
            near = state + 10.0 ** rng.uniform(-6.0, -3.0) * rng.normal(size=4)
            near[:3] = np.clip(near[:3], task.family.low_m, task.family.high_m)
            if np.all(task.walls(near[:3])[0] >= 0.0):
                assert task.value(near) <= value + 1e-7


def test_it_ends_inside(random_scene: Callable) -> None:
    """Among zones, balls and tight bounds it ends where the airspace allows, outside every ball."""
    rng = np.random.default_rng(2)
    zone = {"polygon_m": [(30.0, 30.0), (70.0, 30.0), (50.0, 70.0)]}
    drum = {"centre_m": (20.0, 60.0), "radius_m": 12.0, "altitude_m": (0.0, 20.0)}
    for _ in range(6):
        scene = random_scene(rng, 2, 1, 10.0, x_m=(5.0, 80.0), no_fly=(zone, drum), keep_out_m=12.0)
        task = _task(scene)
        start = _start(rng)
        start[:3] = [50.0, 45.0, 9.0]  # inside the polygon
        value, state = finished(task, start)
        assert np.isfinite(value)
        assert scene.airspace.allows(state[:3])
        points_m = np.vstack([scene.node_positions_m, scene.jammer_positions_m])
        assert np.min(np.linalg.norm(points_m - state[:3], axis=1)) >= 12.0


def test_a_fixed_position_stays(paper: Callable) -> None:
    """Where the airspace is one point only the yaw moves."""
    task = _task(paper(1.0, x_m=(3.0, 3.0), y_m=(20.0, 20.0), altitude_m=(9.0, 9.0)))
    start = _start(np.random.default_rng(3))
    start[:3] = [3.0, 20.0, 9.0]
    value, state = finished(task, start)
    np.testing.assert_array_equal(state[:3], [3.0, 20.0, 9.0])
    assert value > task.value(start)
