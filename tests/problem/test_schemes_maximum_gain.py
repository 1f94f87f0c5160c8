"""Maximum gain: eq. 3.4 for two nodes, the best smallest node power for another number."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from paper_schemes import zero_interference_axis

from nullpose.errors import UsageError
from nullpose.physics import antenna_gain, sinr
from nullpose.problem.build import build_family
from nullpose.problem.schemes import ZERO_INTERFERENCE
from nullpose.scenario import Scenario
from nullpose.solver import Scheme, Status, solve
from nullpose.solver.by_scheme import solve_scheme
from nullpose.solver.kernels.search.maximum_gain import maximum_gain_value
from nullpose.solver.options import SolveOptions


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


@pytest.fixture(scope="module")
def three_jammers(scene: Callable) -> Scenario:
    """Returns a scene of two nodes and three jammers of unlike powers."""
    return scene(
        [(0, 0, 0), (0, 50, 0)], [(17, 15, 4), (-25, 40, 1), (30, 30, 0)], jammer_powers_w=[0.3, 5.0, 1.0]
    )


def test_each_jammer_is_tried(three_jammers: Scenario) -> None:
    """A jammer named has the null on it; without a name the best of all is kept, and the note says which."""
    named = {}
    for index, name in enumerate(three_jammers.jammer_names):
        named[name] = solve(three_jammers, Scheme.ZERO_INTERFERENCE, null_jammer=name)
        pose = named[name].pose
        gains = antenna_gain(pose.position_m, pose.antenna_axis, three_jammers.jammer_positions_m)
        assert gains[index] < 1e-30
        assert np.all(np.delete(gains, index) > 1e-6)
        assert named[name].note == f"null on jammer {name}"
    best = solve(three_jammers, Scheme.ZERO_INTERFERENCE)
    winner = max(named, key=lambda name: named[name].objective.value)
    assert best.objective == named[winner].objective
    assert best.pose == named[winner].pose
    assert best.note == f"null on jammer {winner}, the best of 3"
    assert best.stats.starts == sum(solution.stats.starts for solution in named.values())
    assert best.stats.evaluations == sum(solution.stats.evaluations for solution in named.values())
    assert len({solution.objective.value for solution in named.values()}) == 3


def test_an_unknown_jammer_is_refused(three_jammers: Scenario) -> None:
    """Another name is refused, with those there are."""
    with pytest.raises(UsageError, match="given 'X'; the scenario's jammers are M1, M2, M3"):
        solve_scheme(three_jammers, ZERO_INTERFERENCE, SolveOptions(certify=False), "X")


@pytest.mark.parametrize("seed", range(3))
def test_an_end_on_a_ball_and_the_floor_is_exact(seed: int, scene: Callable) -> None:
    """Where the keep-out ball and the floor both hold the position, the value is the best of their circle."""
    one = scene(
        [(0, 0, 0)],
        [(20, 10, 0), (0, -20, 4)],
        jammer_powers_w=0.09331957,
        altitude_m=(0.0, 20.0),
        keep_out_m=0.5,
    )
    turn = np.linspace(0.0, 2.0 * np.pi, 200_001)
    circle = 0.5 * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(turn.size)])
    along = np.min(sinr(one, circle, zero_interference_axis(circle, one.jammer_positions_m[1])), axis=1)
    solution = solve(one, Scheme.ZERO_INTERFERENCE, seed=seed, null_jammer="M2")
    assert solution.objective.value == pytest.approx(along.max(), rel=1e-9)


UP = np.array([0.0, 0.0, 1.0])


def test_the_needle_beside_the_vertical(paper: Callable) -> None:
    """At P_M/P = 1 the best position is 6 mm beside the jammer's vertical: better than straight above."""
    one = paper(1.0)
    solution = solve(one, Scheme.VERTICAL)
    np.testing.assert_allclose(solution.pose.position_m, [16.9974, 15.0054, 8.0], atol=1e-4)
    above = np.min(sinr(one, np.array([17.0, 15.0, 8.0]), UP))
    assert 10.0 * np.log10(above) == pytest.approx(-2.1609, abs=1e-4)
    assert solution.objective.value_db == pytest.approx(-2.1603, abs=5e-5)


@pytest.mark.parametrize("ratio", [1e3, 1e6])
def test_strong_jamming_ends_straight_above(ratio: float, paper: Callable) -> None:
    """Under strong jamming the level vehicle hovers straight above the jammer."""
    position = solve(paper(ratio), Scheme.VERTICAL).pose.position_m
    np.testing.assert_allclose(position, [17.0, 15.0, 8.0], atol=1e-5)
