"""What no combining of an array exceeds."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Array, Scenario
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
