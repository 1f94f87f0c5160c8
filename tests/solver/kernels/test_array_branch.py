"""Branch and bound over an array's positions and yaws."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.physics.array import digital_sinr, element_positions
from nullpose.scenario import Array, Scenario
from nullpose.solver.array_search import ArraySearch
from nullpose.solver.kernels.bounds.array_branch import branch_array
from nullpose.solver.kernels.search.array_response import respond

LOW, HIGH = np.array([0.0, 0.0, 8.0, -math.pi / 2]), np.array([60.0, 60.0, 12.0, math.pi / 2])


def _branch(task: ArraySearch, target: float, most: int = 200_000) -> tuple[float, int, np.ndarray]:
    state = np.full(4, math.nan)
    root = np.array([0.5 * (LOW + HIGH), 0.5 * (HIGH - LOW)])
    bound, boxes = branch_array(task.problem, task.family.domain, root, target, most, state)
    return bound, boxes, state


def _task(scenario: Scenario) -> ArraySearch:
    return ArraySearch(scenario, Array(elements=3, layout="linear", spacing_wavelengths=0.5), 0)


def _sampled(task: ArraySearch, rng: np.random.Generator) -> float:
    states = rng.uniform(LOW, HIGH, (20_000, 4))
    states[::2, 2] = LOW[2]
    return float(np.max(task.judge(states)))


def test_the_bound_is_that_of_the_box(scene: Callable) -> None:
    """No sample exceeds it, it comes close to the best sample, and so does the best centre on the way."""
    rng = np.random.default_rng(1)
    for _ in range(3):
        nodes, jammers = (rng.uniform([5.0, 5.0, 0.0], [55.0, 55.0, 4.0], (2, 3)) for _ in range(2))
        task = _task(scene(nodes, jammers, jammer_powers_w=5.0))
        best = math.exp(_sampled(task, rng))
        bound, boxes, state = _branch(task, 1.4 * best)
        assert best <= bound == 1.4 * best
        assert boxes < 200_000
        assert math.exp(task.judge(state[None])[0]) > 0.5 * best


def test_a_limit_leaves_a_bound(random_scene: Callable) -> None:
    """Stopped early it returns a bound that holds, and more boxes never make it worse."""
    rng = np.random.default_rng(2)
    task = _task(random_scene(rng, 3, 2, 10.0))
    best = math.exp(_sampled(task, rng))
    bounds = [_branch(task, 0.0, most)[:2] for most in (10, 100, 1000, 10_000)]
    assert all(boxes <= most for (_, boxes), most in zip(bounds, (10, 100, 1000, 10_000), strict=True))
    assert np.all(np.diff([bound for bound, _ in bounds]) <= 0.0)
    assert bounds[-1][0] >= best


@pytest.mark.parametrize(
    "shut",
    [
        {"no_fly": ({"x_m": (10.0, 50.0), "y_m": (-5.0, 65.0)},)},
        {"no_fly": ({"centre_m": (30.0, 30.0), "radius_m": 25.0},)},
        {"geofence_m": [(0.0, 0.0), (60.0, 0.0), (0.0, 20.0)]},
        {"keep_out_m": 18.0},
    ],
)
def test_what_is_forbidden_does_not_count(shut: dict, scene: Callable) -> None:
    """With the best places forbidden the bound comes down to what is left."""
    nodes, jammers = [(22, 30, 0), (38, 30, 0)], [(30, 12, 0)]
    rng = np.random.default_rng(3)
    open_task, shut_task = _task(scene(nodes, jammers)), _task(scene(nodes, jammers, **shut))
    best, left = math.exp(_sampled(open_task, rng)), math.exp(_sampled(shut_task, rng))
    assert left < 0.9 * best
    target = 0.5 * (left + best)
    bound, boxes, _ = _branch(shut_task, target)
    assert left <= bound == target
    assert boxes < 200_000
    assert _branch(open_task, target, 20_000)[0] >= best


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
