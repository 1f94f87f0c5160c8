"""The search over an array's states."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_finish import finished
from nullpose.solver.array_search import ArraySearch, ArraySettings, Pool
from nullpose.solver.array_task import ArrayTask
from nullpose.solver.multistart import landmarks

LIGHT = ArraySettings(first=40, patience=100, most=400)


def _search(scenario: Scenario, seed: int, settings: ArraySettings = LIGHT) -> tuple[ArrayTask, ArraySearch]:
    array = Array(elements=4, layout="linear", spacing_wavelengths=0.5)
    task = ArrayTask.of(scenario, array)
    return task, ArraySearch(task, np.random.default_rng(seed), landmarks(task.family), settings)


def test_a_pool_keeps_the_best_of_each_value() -> None:
    """States of one value count once, the better of them; the worst leaves when there are too many."""
    pool = Pool(2)
    assert pool.best == -np.inf
    for value in (1.0, -np.inf, 1.00005, 3.0, 2.0, 2.00001):
        pool.offer(value, np.array([value]))
    assert [value for value, _ in pool.entries] == [3.0, 2.00001]
    assert [float(state[0]) for _, state in pool.entries] == [3.0, 2.00001]
    assert pool.best == 3.0


def test_a_seed_repeats(random_scene: Callable) -> None:
    """The same seed gives the same states to the last bit, the best first."""
    scenario = random_scene(np.random.default_rng(2), 3, 2, 10.0)
    (task, first), (_, again) = (_search(scenario, 7) for _ in range(2))
    np.testing.assert_array_equal(first.states, again.states)
    assert (first.climbs, first.evaluations) == (again.climbs, again.evaluations)
    values = [finished(task, state)[0] for state in first.states]
    assert max(values) == pytest.approx(values[0], abs=0.05)


def test_settings_bound_the_work(paper: Callable) -> None:
    """Landmarks, fresh starts and hops are all the climbs there are, and elites are as many as asked."""
    settings = ArraySettings(first=10, coarse=2, elites=3, patience=1000, most=20)
    task, found = _search(paper(1.0), 0, settings=settings)
    assert found.climbs <= len(landmarks(task.family)) + 30
    assert len(found.states) <= 3


def test_independent_searches_agree(random_scene: Callable) -> None:
    """Digital combining with a few nodes: searches from different seeds end at the same value."""
    scenario = random_scene(np.random.default_rng(8), 4, 2, 10.0)
    ends = []
    for seed in range(3):
        task, found = _search(scenario, seed)
        ends.append(max(finished(task, state)[0] for state in found.states))
    np.testing.assert_allclose(ends, ends[0], atol=1e-6)


def test_nothing_is_found_where_nothing_is(scene: Callable) -> None:
    """Where the only position has the node in every dipole's null, no state is kept."""
    point = scene([(0, 0, 0)], x_m=(0.0, 0.0), y_m=(0.0, 0.0), altitude_m=(8.0, 8.0))
    assert _search(point, 0)[1].states == []
