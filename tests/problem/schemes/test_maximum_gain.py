"""Maximum gain: eq. 3.4 for two nodes, the best smallest node power for another number."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.problem.build import build_family
from nullpose.solver import Scheme, Status, solve
from nullpose.solver.kernels.search.maximum_gain import maximum_gain_value


def test_the_optimum_leaves_the_equidistant_plane(paper: Callable) -> None:
    """At P_M/P = 1 the best position is as far from both nodes; at 3 it is not, against the paper's claim."""
    near = solve(paper(1.0), Scheme.MAXIMUM_GAIN).pose.position_m
    far = solve(paper(3.0), Scheme.MAXIMUM_GAIN)
    assert near[1] == pytest.approx(25.0, abs=1e-6)
    np.testing.assert_allclose(far.pose.position_m, [2.1, 15.5, 8.0], atol=0.06)
    assert far.objective.value_db == pytest.approx(-1.057, abs=5e-4)


@pytest.mark.parametrize(("nodes", "jammers"), [(1, 1), (3, 1), (4, 2)])
def test_no_position_is_far_better(nodes: int, jammers: int, random_scene: Callable) -> None:
    """Of many positions with their maximum-gain axes none is better than the one found."""
    rng = np.random.default_rng(10 * nodes + jammers)
    one = random_scene(rng, nodes, jammers, 1.0)
    family = build_family(one)
    best = math.log(solve(one, Scheme.MAXIMUM_GAIN).objective.value)
    axis = np.empty(3)
    for position in rng.uniform([-20.0, -20.0, 8.0], [120.0, 120.0, 12.0], (4000, 3)):
        assert maximum_gain_value(family.ratios, position, axis) <= best + 1e-9


def test_equal_distances_keep_the_value(scene: Callable) -> None:
    """Where several axes serve the nodes alike to rounding, the value reported is still the pose's best."""
    square = scene([(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0)], [(40, 10, 1)], jammer_powers_w=0.1)
    solution = solve(square, Scheme.MAXIMUM_GAIN)
    assert solution.objective.value <= solve(square).objective.value * (1.0 + 1e-9)
    assert solution.objective.value > 0.5 * solve(square).objective.value


@pytest.mark.parametrize("nodes", [1, 3])
def test_another_number_has_the_optimum_s_bound(nodes: int, random_scene: Callable) -> None:
    """For another number the bound is that of the free axis, seldom tight, and the reason says so."""
    one = random_scene(np.random.default_rng(nodes), nodes, 1)
    solution, optimum = solve(one, Scheme.MAXIMUM_GAIN), solve(one)
    assert solution.status is Status.GAP_NOT_REACHED
    assert "the bound is that of the optimum" in solution.reason
    assert solution.objective.upper_bound == optimum.objective.upper_bound
    assert solution.objective.value <= optimum.objective.value * (1.0 + 1e-9)
    fast = solve(one, Scheme.MAXIMUM_GAIN, certify=False)
    assert (fast.status, fast.reason) == (Status.BEST_FOUND, "")
