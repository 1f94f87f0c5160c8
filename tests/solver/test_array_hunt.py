"""Independent searches for the best state of an array."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_search import ArrayHunt
from nullpose.solver.array_task import ArrayTask


def _task(scenario: Scenario) -> ArrayTask:
    return ArrayTask.of(scenario, Array(elements=3, layout="linear", spacing_wavelengths=0.5))


def test_harsh_jamming_is_reached_from_calmer(random_scene: Callable) -> None:
    """With jammers 1e7 times as strong as the nodes it is not worse than with less, but for a little."""
    rng = np.random.default_rng(4)
    loud = _task(random_scene(rng, 3, 2, 1e7))
    assert loud.jamming > 1e6
    calm = loud.calmed(1e4)
    assert calm.jamming == pytest.approx(1e4)
    ends = []
    for task in (loud, calm):
        hunt = ArrayHunt(task, 0)
        for _ in range(2):
            hunt.search()
        ends.append(hunt.best)
    assert ends[1] - 0.1 < ends[0] <= ends[1] + 1e-6
