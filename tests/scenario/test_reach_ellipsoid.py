"""Distances from ellipsoids."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from nullpose.scenario.reach import distance_m


@pytest.mark.parametrize("flat", range(4))
@pytest.mark.parametrize("seed", range(3))
def test_against_a_general_minimiser(seed: int, flat: int) -> None:
    """A constrained minimiser comes to the same distance from ellipsoids, discs, stretches and points."""
    rng = np.random.default_rng(seed)
    semi_axes_m = 10.0 ** rng.uniform(-1.0, 1.0, 3) * (np.arange(3) >= flat)
    matrix = Rotation.random(random_state=rng).as_matrix() @ np.diag(semi_axes_m)
    centre, point = rng.normal(size=3), rng.normal(0.0, 20.0, 3)
    found = minimize(
        lambda x: np.sum((centre + matrix @ x - point) ** 2),
        np.zeros(3),
        method="SLSQP",
        constraints={"type": "ineq", "fun": lambda x: 1.0 - x @ x},
        options={"ftol": 1e-14, "maxiter": 500},
    )
    inside = centre + matrix @ np.array([0.3, -0.5, 0.7])
    outer_m, inner_m = distance_m(np.array([point, inside]), centre, matrix)
    assert outer_m == pytest.approx(np.sqrt(found.fun), rel=1e-5)
    assert inner_m == pytest.approx(0.0, abs=1e-9)
