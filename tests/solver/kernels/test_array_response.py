"""An array's ratios in a state and their slopes, against the plain equations and finite differences."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.physics.array import digital_sinr, element_positions
from nullpose.scenario import Array
from nullpose.solver.array_search import ArraySearch
from nullpose.solver.kernels.search.array_response import respond

CASES = [(1, "linear"), (2, "linear"), (5, "circular"), (8, "linear")]


def _response(task: ArraySearch, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    logs, slopes = np.empty(task.problem.nodes), np.empty((task.problem.nodes, 4))
    worst = respond(task.problem, state, logs, slopes)
    assert worst == np.min(logs) == task.judge(state[None])[0]
    return logs, slopes


@pytest.mark.parametrize(("elements", "layout"), CASES)
@pytest.mark.parametrize("jamming_w", [1.0, 1e7])
def test_values_are_those_of_the_physics(
    elements: int, layout: str, jamming_w: float, random_scene: Callable
) -> None:
    """The logarithms are those of the plain equations, also under jamming 1e7 times the nodes' power."""
    rng = np.random.default_rng(elements)
    for jammers in range(4):
        scene = random_scene(rng, 3, jammers, jamming_w)
        task = ArraySearch(scene, Array(elements=elements, layout=layout, spacing_wavelengths=0.6), 0)
        state = rng.uniform([0.0, 0.0, 9.0, 0.0], [99.0, 99.0, 29.0, 6.0])
        places = element_positions(elements, layout, 0.6, state[3])
        expected = digital_sinr(scene, state[:3], places)
        np.testing.assert_allclose(np.exp(_response(task, state)[0]), expected, rtol=1e-9)


@pytest.mark.parametrize(("elements", "layout"), CASES)
def test_slopes_are_those_of_differences(elements: int, layout: str, random_scene: Callable) -> None:
    """Every slope, in position and yaw, is what central differences give."""
    rng = np.random.default_rng(10 + elements)
    array = Array(elements=elements, layout=layout, spacing_wavelengths=0.6)
    for jammers in range(4):
        task = ArraySearch(random_scene(rng, 3, jammers, 10.0), array, 0)
        state = rng.uniform([0.0, 0.0, 9.0, 0.0], [99.0, 99.0, 29.0, 6.0])
        slopes = _response(task, state)[1]
        steps = 1e-5 * np.eye(4)
        differences = [
            (_response(task, state + step)[0] - _response(task, state - step)[0]) / 2e-5 for step in steps
        ]
        np.testing.assert_allclose(slopes, np.transpose(differences), rtol=1e-5, atol=1e-5)


def test_straight_above(scene: Callable) -> None:
    """Straight above a jammer it is not heard, and slopes are finite; above a node, that one is not heard."""
    field = scene([(0, 0, 0), (30, 0, 0)], [(10, 10, 0)], jammer_powers_w=1e6)
    task = ArraySearch(field, Array(elements=3, layout="linear", spacing_wavelengths=0.5), 0)
    above_jammer, above_node = np.array([10.0, 10.0, 9.0, 0.3]), np.array([0.0, 0.0, 9.0, 0.3])
    logs, slopes = _response(task, above_jammer)
    assert np.all(np.isfinite(logs))
    assert np.all(np.isfinite(slopes))
    logs, slopes = _response(task, above_node)
    assert logs[0] == -np.inf
    assert np.isfinite(logs[1])
    assert np.all(np.isfinite(slopes))
