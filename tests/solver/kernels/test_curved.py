"""Upper bounds on quadratics over a box, against sampling."""

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.solver.kernels.bounds import curved
from nullpose.solver.kernels.bounds.enclosure import JET

box_maximum = plain(curved.box_maximum)


def quadratic(
    rng: np.random.Generator, curvature: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return a jet, and the quadratic that it stands for: (jet, half sides, gradient, Hessian)."""
    half = 10.0 ** rng.uniform(-1.0, 0.5, size=3)
    gradient = rng.normal(size=3)
    root = rng.normal(size=(3, 3))
    hessian = curvature * root @ root.T + 0.1 * np.diag(rng.normal(size=3))
    jet = np.zeros(JET)
    jet[1:4] = gradient
    jet[4:10] = hessian[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return jet, half, gradient, hessian


@pytest.mark.parametrize("curvature", [-3.0, -0.1, 0.1, 3.0])
def test_the_bound_holds_and_is_near(curvature: float) -> None:
    """Wherever a bound below zero is claimed, no sample is above it; it beats a sum of parts."""
    rng = np.random.default_rng(7)
    ratios = []
    for _ in range(60):
        jet, half, gradient, hessian = quadratic(rng, curvature)
        x = rng.uniform(-1.0, 1.0, size=(4000, 3))
        x[:2000] = np.sign(x[:2000]) * np.where(np.abs(x[:2000]) > 0.3, 1.0, np.abs(x[:2000]))
        d = x * half
        highest = float(np.max(d @ gradient + 0.5 * np.einsum("ni,ij,nj->n", d, hessian, d)))
        reach = float(np.abs(gradient) @ half) + 0.5 * float(half @ np.abs(hessian) @ half)
        jet[0] = -reach - 1e-9
        bound = box_maximum(jet, half) - jet[0]
        assert highest <= bound * (1.0 + 1e-9)
        ratios.append(bound / reach)
    # strong concavity is worth most of what slopes and curvatures add up to
    assert np.median(ratios) < (0.5 if curvature == -3.0 else 1.0)


def test_a_rank_one_valley_is_kept() -> None:
    """A slope against strong curvature across the axes gains almost nothing, and the bound knows it."""
    v = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
    hessian = -1000.0 * np.outer(v, v)
    jet = np.zeros(JET)
    jet[1:4] = v
    jet[4:10] = hessian[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    jet[0] = -0.1
    # the true gain is 1 / (2 * 1000); by the slope alone it would be sqrt(3)
    assert box_maximum(jet, np.ones(3)) < 0.0
