"""Maximum gain as printed, for comparison with the paper only."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from nullpose.physics import evaluate, maximum_gain_sinr_as_printed, to_db
from nullpose.solve import Scheme, Status, solve


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_the_paper_by_differential_evolution(ratio: float, paper: Callable) -> None:
    """Differential evolution on eq. 3.5 to the letter comes to the same value."""
    one = paper(ratio)
    searched = differential_evolution(
        lambda positions: -np.log(np.min(maximum_gain_sinr_as_printed(one, positions.T), axis=-1)),
        [(-40.0, 40.0), (0.0, 50.0), (8.0, 30.0)],
        seed=1,
        vectorized=True,
        updating="deferred",
        popsize=30,
        maxiter=600,
        tol=1e-12,
    )
    value = solve(one, Scheme.MAXIMUM_GAIN_PRINTED).objective.value
    assert value == pytest.approx(math.exp(-searched.fun), rel=1e-7)


def test_the_links_are_those_of_the_printed_form(paper: Callable) -> None:
    """Links and value are eq. 3.5's, below what the antenna at that pose receives, and the note says so."""
    one = paper(3.0)
    solution = solve(one, Scheme.MAXIMUM_GAIN_PRINTED)
    printed = maximum_gain_sinr_as_printed(one, solution.pose.position_m)
    assert [link.sinr for link in solution.links] == list(printed)
    assert [link.sinr_db for link in solution.links] == list(to_db(printed))
    received = min(link.sinr for link in evaluate(one, solution.pose))
    assert solution.objective.value < received
    assert "no antenna receives it" in solution.note


def test_it_stays_equidistant_and_does_not_saturate(paper: Callable) -> None:
    """As printed the optimum stays as far from both nodes and keeps falling with the jamming power."""
    solutions = [solve(paper(ratio), Scheme.MAXIMUM_GAIN_PRINTED) for ratio in (1.0, 100.0, 1e4)]
    for solution in solutions:
        assert solution.pose.position_m[1] == pytest.approx(25.0, abs=1e-3)
    drops = np.diff([solution.objective.value_db for solution in solutions])
    assert np.all(drops < -5.0)


def test_nothing_is_proved_of_it(paper: Callable) -> None:
    """Asked for a proof or not, the printed form has none, and says why."""
    solution = solve(paper(1.0), Scheme.MAXIMUM_GAIN_PRINTED)
    assert solution.status is Status.BEST_FOUND
    assert solution.objective.upper_bound is None
    assert "nothing is proved of it" in solution.reason
