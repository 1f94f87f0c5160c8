"""Independent searches for the best state of an array."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.errors import SolveError
from nullpose.scenario import Array, Scenario
from nullpose.solver.array_search import ArrayHunt
from nullpose.solver.array_task import ArrayTask


def _task(scenario: Scenario) -> ArrayTask:
    return ArrayTask.of(scenario, Array(elements=3, layout="linear", spacing_wavelengths=0.5))


def test_searches_that_agree_close_it(paper: Callable) -> None:
    """After three searches with the same end no other is needed; the best state has the best value."""
    task = _task(paper(1.0))
    hunt = ArrayHunt(task, 0)
    hunt.search_on()
    assert (len(hunt.ends), hunt.agreeing) == (3, 3)
    assert hunt.best == max(hunt.ends) == task.value(hunt.state)
    assert hunt.reaches(math.exp(hunt.best) * 1.01, 0.011)
    assert not hunt.reaches(math.exp(hunt.best) * 1.01, 0.009)
    assert hunt.starts > 0
    assert hunt.evaluations > hunt.starts


def test_what_turns_up_elsewhere_is_taken(paper: Callable) -> None:
    """A state from elsewhere is finished, and kept if it is better than all before."""
    task = _task(paper(1.0))
    hunt = ArrayHunt(task, 0)
    start = np.array([2.0, 25.0, 9.0, 0.1])
    assert hunt.look(start) == hunt.best > task.value(start)
    before = hunt.best
    assert hunt.look(np.array([9.0, 1.0, 29.0, 0.1])) <= hunt.best
    assert hunt.best >= before


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


def test_nothing_to_find_is_said(scene: Callable) -> None:
    """Where no state has a value, the search says so."""
    below = scene([(0, 0, 0)], x_m=(-1.0, 1.0), y_m=(-1.0, 1.0), altitude_m=(8.0, 8.0))
    task = _task(below)
    hunt = ArrayHunt(task, 0)
    hunt.task = _task(scene([(0, 0, 0)], x_m=(0.0, 0.0), y_m=(0.0, 0.0), altitude_m=(8.0, 8.0)))
    hunt.places_m = np.zeros((0, 3))
    with pytest.raises(SolveError, match="widen the airspace"):
        hunt.search()
