"""The quick climb on an array's smallest ratio."""

from collections.abc import Callable

import numpy as np

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_task import ArrayTask
from nullpose.solver.kernels.array_climb import climb

BETAS = np.array([4.0, 16.0, 64.0])


def _task(scenario: Scenario) -> ArrayTask:
    return ArrayTask.of(scenario, Array(elements=4, layout="linear", spacing_wavelengths=0.5))


def _climb(task: ArrayTask, state: np.ndarray, steps: int = 60) -> tuple[float, int]:
    """Climbs from a state, which is overwritten."""
    state[:], value, evaluations = climb(task.problem, task.family.domain, state[None], BETAS, steps)
    return value, evaluations


def test_a_climb_ends_higher(random_scene: Callable) -> None:
    """From inside the domain it never ends much lower than it began, and mostly far higher."""
    rng = np.random.default_rng(3)
    gains = []
    for _ in range(20):
        task = _task(random_scene(rng, 3, 1, 1.0))
        state = rng.uniform([0.0, 0.0, 9.0, 0.0], [99.0, 99.0, 29.0, 6.0])
        before = task.value(state)
        value, evaluations = _climb(task, state)
        assert evaluations > 3
        assert value <= task.value(state)  # the penalty is taken off
        gains.append(value - before)
    assert min(gains) > -np.log(3) / BETAS[0]
    assert np.median(gains) > 0.5


def test_walls_hold(random_scene: Callable) -> None:
    """A climb ends in the box and outside balls and zones, but for some centimetres."""
    rng = np.random.default_rng(4)
    zone = {"x_m": (40.0, 60.0), "y_m": (-10.0, 120.0), "altitude_m": (0.0, 20.0)}
    drum = {"centre_m": (20.0, 50.0), "radius_m": 9.0}
    for _ in range(10):
        scene = random_scene(rng, 3, 1, x_m=(10.0, 70.0), no_fly=(zone, drum), keep_out_m=6.0)
        task = _task(scene)
        state = np.array([35.0, 50.0, 12.0, rng.uniform(0, 6)])
        _climb(task, state)
        outside = np.maximum(task.family.low_m - state[:3], state[:3] - task.family.high_m)
        assert np.max(outside) < 0.05
        assert np.min(task.walls(state[:3])[0]) > -0.05
        assert np.min(scene.airspace.clearance_m(state[:3])) > -0.05


def test_nowhere_to_go(scene: Callable) -> None:
    """Where a node is not heard there is no slope to climb, and the value says so."""
    task = _task(scene([(0, 0, 0)]))
    state = np.array([0.0, 0.0, 10.0, 0.0])
    assert _climb(task, state)[0] == -np.inf


def test_the_best_of_many_states_is_climbed_from(random_scene: Callable) -> None:
    """Without a step it is the state with the highest smallest log ratio; with steps it ends elsewhere."""
    rng = np.random.default_rng(5)
    task = _task(random_scene(rng, 3, 2))
    states = rng.uniform(9.0, 20.0, (7, 4))
    best = max(states, key=task.value)
    stayed, moved = (climb(task.problem, task.family.domain, states, BETAS, most)[0] for most in (0, 60))
    np.testing.assert_array_equal(stayed, best)
    assert task.value(moved) > task.value(best)
