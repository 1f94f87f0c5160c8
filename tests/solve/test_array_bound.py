"""What no combining of an array exceeds."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Array, Scenario
from nullpose.solve import solve
from nullpose.solve.array_bound import array_bound
from nullpose.solve.array_task import ArrayTask


def _task(scenario: Scenario, elements: int, shared: bool = False) -> ArrayTask:
    array = Array(elements=elements, layout="circular", spacing_wavelengths=0.7)
    return ArrayTask.of(scenario, array, shared=shared)


@pytest.mark.parametrize("shared", [False, True])
def test_no_state_exceeds_it(shared: bool, random_scene: Callable) -> None:
    """Of many random states, in weak and in strong jamming, none is above the bound."""
    rng = np.random.default_rng(1)
    for jamming_w in (0.01, 10.0, 1e5):
        task = _task(random_scene(rng, 2, 2, jamming_w), 3, shared)
        bound = array_bound(task, seed=0, time_limit_s=10.0)
        states = rng.uniform(-3.0, 3.0, (3000, task.size))
        states[:, :3] = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 12.0], (3000, 3))
        assert max(map(task.value, states)) <= math.log(bound.value)


def test_it_is_k_times_the_silent_vertical_case(random_scene: Callable) -> None:
    """K times what the vertical case is certified to reach with the jammers taken away."""
    scenario = random_scene(np.random.default_rng(2), 3, 1, 10.0)
    silent = solve(scenario.model_copy(update={"jammers": ()}), "vertical")
    for elements in (2, 5):
        bound = array_bound(_task(scenario, elements), seed=0, time_limit_s=10.0)
        assert bound.value == pytest.approx(elements * silent.objective.value, rel=1e-4)
        assert bound.nodes > 0


def test_one_element_has_the_bound_of_the_vertical_case(paper: Callable) -> None:
    """For one element the jammers count, and the bound is the vertical case's own."""
    vertical = solve(paper(1.0), "vertical")
    bound = array_bound(_task(paper(1.0), 1), seed=0, time_limit_s=10.0)
    assert bound.value == pytest.approx(vertical.objective.upper_bound, rel=2e-6)
