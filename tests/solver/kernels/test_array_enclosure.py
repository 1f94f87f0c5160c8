"""The bound on an array's smallest ratio over a box."""

import math
from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.scenario import Array, Scenario
from nullpose.solver.array_search import ArraySearch
from nullpose.solver.kernels.bounds import array_enclosure
from nullpose.solver.kernels.search.array_response import respond

box_bound = plain(array_enclosure.box_bound)
CORNERS = np.array(list(product((-1.0, 1.0), repeat=4)))


def _task(scenario: Scenario, elements: int, layout: str = "linear") -> ArraySearch:
    array = Array(elements=elements, layout=layout, spacing_wavelengths=0.6)
    return ArraySearch(scenario, array, 0)


def _largest(task: ArraySearch, centre: np.ndarray, half: np.ndarray, rng: np.random.Generator) -> float:
    inside = np.vstack([CORNERS, rng.uniform(-1.0, 1.0, (40, 4))])
    return math.exp(np.max(task.judge(centre + half * inside)))


@pytest.mark.parametrize("layout", ["linear", "circular"])
@pytest.mark.parametrize("jamming_w", [0.1, 10.0, 1e4, 1e7])
def test_nothing_in_a_box_exceeds_it(layout: str, jamming_w: float, random_scene: Callable) -> None:
    """In boxes of all sizes and shapes, near and far, no state is above the bound."""
    rng = np.random.default_rng(int(jamming_w * 10))
    for _ in range(50):
        scene = random_scene(rng, int(rng.integers(1, 5)), int(rng.integers(0, 4)), jamming_w)
        task = _task(scene, int(rng.integers(1, 9)), layout)
        centre = np.append(rng.uniform([0.0, 0.0, 6.0], [99.0, 99.0, 30.0]), rng.uniform(-3.0, 3.0))
        half = 10.0 ** rng.uniform(-4.0, 0.5) * rng.uniform([0, 0, 0, 0], [2.0, 2.0, 2.0, 0.3])
        bound = box_bound(task.problem, centre, half)
        assert _largest(task, centre, half, rng) <= bound * (1.0 + 1e-9)


@pytest.mark.parametrize("where", ["jammer", "node"])
@pytest.mark.parametrize("reach_m", [1e-3, 0.1, 3.0])
def test_boxes_over_a_point(where: str, reach_m: float, random_scene: Callable) -> None:
    """A box that reaches over a jammer or a node has a bound too, and nothing in it exceeds that."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        scene = random_scene(rng, 2, 2, 1e3)
        task = _task(scene, 3)
        below = scene.jammer_positions_m[0] if where == "jammer" else scene.node_positions_m[0]
        half = np.append(reach_m * rng.uniform(0.1, 1.0, 3), 0.1)
        centre = np.append(below + np.array([0.0, 0.0, 9.0]), 0.3) + half * rng.uniform(-0.9, 0.9, 4)
        bound = box_bound(task.problem, centre, half)
        assert np.isfinite(bound)
        assert _largest(task, centre, half, rng) <= bound * (1.0 + 1e-9)


def _excess(task: ArraySearch, centre: np.ndarray, half: np.ndarray) -> float:
    """How far the bound of a one-node scene is above the value and the slope at the centre."""
    logs, slopes = np.empty(1), np.empty((1, 4))
    value = math.exp(respond(task.problem, centre, logs, slopes))
    return box_bound(task.problem, centre, half) - value * (1.0 + np.abs(slopes[0]) @ half)


def test_it_is_exact_to_the_first_order(random_scene: Callable) -> None:
    """For one node, what it is above value and slope falls with the square of the box's size."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        task = _task(random_scene(rng, 1, 2, 10.0), 4)
        centre = np.append(rng.uniform([0.0, 0.0, 9.0], [99.0, 99.0, 29.0]), rng.uniform(-3.0, 3.0))
        shape = rng.uniform(0.5, 1.0, 4) * [1.0, 1.0, 1.0, 0.05]
        large, small, smaller = (_excess(task, centre, size * shape) for size in (1e-2, 5e-3, 5e-4))
        assert large == pytest.approx(4.0 * small, rel=0.05)
        assert small == pytest.approx(100.0 * smaller, rel=0.05)


def test_slopes_of_several_nodes_cancel(scene: Callable) -> None:
    """Half way between two nodes, where what one loses the other gains, the bound is of second order."""
    task = _task(scene([(0, 0, 0), (40, 0, 0)]), 1)
    centre = np.array([20.0, 0.0, 20.0, 0.0])
    value = math.exp(task.judge(centre[None])[0])
    excess = [
        box_bound(task.problem, centre, np.array([size, 0.0, 0.0, 0.0])) / value - 1.0 for size in (0.2, 0.1)
    ]
    assert excess[0] == pytest.approx(4.0 * excess[1], rel=0.1)
    assert excess[0] < 1e-3
