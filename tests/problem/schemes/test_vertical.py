"""The vertical case, against a search of positions by the physics alone."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from nullpose.physics import sinr
from nullpose.solver import Scheme, solve

UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("ratio", "low", "high"),
    [
        (0.1, (-30.0, 10.0), (30.0, 40.0)),
        # from about P_M/P = 1 on the optimum is a needle, millimetres wide, beside the jammer's vertical
        (1.0, (16.95, 14.95), (17.05, 15.05)),
        (10.0, (16.99, 14.99), (17.01, 15.01)),
    ],
)
def test_the_paper_by_differential_evolution(ratio: float, low: tuple, high: tuple, paper: Callable) -> None:
    """Differential evolution on eq. 2.1, in the room where the optimum lies, comes to the same value."""
    one = paper(ratio)

    searched = differential_evolution(
        lambda positions: -np.log(np.min(sinr(one, positions.T, UP), axis=-1)),
        [*zip(low, high, strict=True), (8.0, 9.0)],
        seed=3,
        vectorized=True,
        updating="deferred",
        popsize=40,
        maxiter=400,
        tol=1e-12,
        polish=False,
    )
    assert solve(one, Scheme.VERTICAL).objective.value == pytest.approx(
        float(np.exp(-searched.fun)), rel=1e-9
    )


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
