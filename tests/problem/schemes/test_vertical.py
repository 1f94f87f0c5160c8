"""The vertical case, against a search of positions by the physics alone."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.physics import sinr
from nullpose.solver import Scheme, solve

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
