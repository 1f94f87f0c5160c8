"""Zero interference: the null on a jammer, and which one."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.errors import UsageError
from nullpose.physics import antenna_gain, sinr, zero_interference_axis
from nullpose.problem.schemes.zero_interference import ZERO_INTERFERENCE
from nullpose.scenario import Scenario
from nullpose.solver import Scheme, solve
from nullpose.solver.by_scheme import solve_scheme
from nullpose.solver.options import SolveOptions


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
