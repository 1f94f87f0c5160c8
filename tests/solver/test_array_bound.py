"""What no combining of an array exceeds."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Array, Scenario
from nullpose.solver import solve
from nullpose.solver.array_bound import array_bound
from nullpose.solver.array_task import ArrayTask


def _task(scenario: Scenario, elements: int, *, layout: str = "circular") -> ArrayTask:
    array = Array(elements=elements, layout=layout, spacing_wavelengths=0.7)
    return ArrayTask.of(scenario, array)


def _sampled(task: ArrayTask, rng: np.random.Generator) -> float:
    states = rng.uniform(-math.pi, math.pi, (3000, 4))
    states[:, :3] = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 12.0], (3000, 3))
    return max(map(task.value, states))


@pytest.mark.parametrize("layout", ["linear", "circular"])
@pytest.mark.parametrize("jamming_w", [0.01, 10.0, 1e5])
def test_no_state_exceeds_it(
    layout: str, jamming_w: float, random_scene: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of many random states of all yaws none is above the bound, wherever the boxes run out."""
    monkeypatch.setitem(array_bound.__globals__, "_MOST_BOXES", 20_000)
    rng = np.random.default_rng(1)
    task = _task(random_scene(rng, 2, 2, jamming_w), 3, layout=layout)
    known = _sampled(task, rng)
    bound = array_bound(task, known, gap=1e-2)
    assert known <= math.log(bound.value)


def test_it_reaches_the_gap(random_scene: Callable) -> None:
    """Asked about the level that it found itself, it stops at the gap; about a lower one, it says more."""
    task = _task(random_scene(np.random.default_rng(2), 2, 1, 10.0), 3)
    first = array_bound(task, math.log(1e-3), gap=1e-2)
    assert first.state is not None
    level = task.value(first.state)
    assert level > math.log(1e-3)
    again = array_bound(task, math.log(first.value), gap=1e-2)
    assert math.log(first.value) <= math.log(again.value) <= math.log(first.value) + 1e-2


def test_without_jammers_it_is_k_times_the_vertical_case(random_scene: Callable) -> None:
    """K times what the vertical case is certified to reach."""
    scenario = random_scene(np.random.default_rng(3), 3, 0)
    vertical = solve(scenario, "vertical")
    for elements in (2, 5):
        level = math.log(elements * vertical.objective.value)
        bound = array_bound(_task(scenario, elements), level, gap=1e-5)
        assert bound.value == pytest.approx(elements * vertical.objective.value, rel=2e-5)
        assert bound.boxes > 0


def test_one_element_has_the_bound_of_the_vertical_case(paper: Callable) -> None:
    """For one element the bound is the certified vertical case's own."""
    vertical = solve(paper(1.0), "vertical")
    bound = array_bound(_task(paper(1.0), 1), math.log(vertical.objective.value), gap=1e-6)
    assert bound.value == pytest.approx(vertical.objective.upper_bound, rel=2e-6)
