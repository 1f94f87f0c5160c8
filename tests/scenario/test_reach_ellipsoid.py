"""Distances from ellipsoids."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from nullpose.scenario.reach import distance_m


def random_matrix(rng: np.random.Generator) -> np.ndarray:
    """Returns the matrix of a turned ellipsoid with semi-axes over two decades."""
    return Rotation.random(random_state=rng).as_matrix() @ np.diag(10.0 ** rng.uniform(-1.0, 1.0, 3))


@pytest.mark.parametrize("seed", range(5))
def test_against_a_general_minimiser(seed: int) -> None:
    """A constrained minimiser comes to the same distance; inside it is none."""
    rng = np.random.default_rng(seed)
    matrix, centre, point = random_matrix(rng), rng.normal(size=3), rng.normal(0.0, 20.0, 3)
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


@pytest.mark.parametrize(
    ("semi_axes", "point", "expected"),
    [
        ([0.0, 0.0, 0.0], [3.0, 4.0, 0.0], 5.0),
        ([2.0, 0.0, 0.0], [5.0, 0.0, 4.0], 5.0),
        ([2.0, 0.0, 0.0], [1.0, 0.0, 4.0], 4.0),
        ([2.0, 2.0, 0.0], [5.0, 0.0, 4.0], 5.0),
        ([2.0, 2.0, 0.0], [0.0, 1.0, 0.0], 0.0),
    ],
)
def test_flat_sets(semi_axes: list[float], point: list[float], expected: float) -> None:
    """A point, a stretch and a disc are ellipsoids too."""
    (distance,) = distance_m(np.array([point]), np.zeros(3), np.diag(semi_axes))
    assert distance == pytest.approx(expected, abs=1e-9)
