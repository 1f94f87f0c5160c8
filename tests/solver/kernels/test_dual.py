import math

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.certificate.forms import matrices
from nullpose.solver.kernels.linear_algebra import axis, dual

best_axis_of_forms, dual_multipliers = plain(axis.best_axis_of_forms), plain(dual.dual_multipliers)
SMALLEST = (np.empty(0), 0.0)  # shares and offset of no mean
ISOTROPIC = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / 3.0


def random_forms(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return link forms of random directions and strengths, (count, 6)."""
    away = rng.normal(size=(count, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    forms = np.eye(3) - away[:, :, None] * away[:, None, :]
    forms *= rng.uniform(0.2, 5.0, size=count)[:, None, None]
    return np.stack([forms[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))], axis=1)


def dual_value(forms: np.ndarray, multipliers: np.ndarray) -> float:
    """Return the largest eigenvalue of the weighted sum of forms."""
    return float(np.linalg.eigvalsh(matrices((multipliers @ forms)[:, None])[0])[-1])


@pytest.mark.parametrize("count", [1, 2, 3, 7, 40])
def test_multipliers_bound_the_best_axis(count: int) -> None:
    """The multipliers lie in the simplex, and their bound is never below what the best axis reaches."""
    rng = np.random.default_rng(count)
    for _ in range(50 if count < 10 else 10):
        forms = random_forms(rng, count)
        best = best_axis_of_forms(forms, np.empty(3))
        multipliers, matrix = np.empty(count), np.empty(6)
        primal = dual_multipliers(
            forms, 0, count, best, math.inf, 1e-7, ISOTROPIC, multipliers, matrix, *SMALLEST
        )
        assert np.all(multipliers >= 0.0)
        assert np.sum(multipliers) == pytest.approx(1.0, abs=1e-12)
        bound = dual_value(forms, multipliers)
        assert bound >= best * (1.0 - 1e-12)
        assert primal == pytest.approx(bound, rel=1e-5)
        assert np.all(np.linalg.eigvalsh(matrices(matrix[:, None])[0]) > 0.0)
        assert np.sum(matrix[:3]) == pytest.approx(1.0, abs=1e-12)


def test_a_side_only_lowers_the_bound() -> None:
    """A constraint on the axis, with its multiplier, never raises the bound."""
    rng = np.random.default_rng(6)
    for _ in range(50):
        forms = random_forms(rng, 4)
        side = np.array([-1.0, -1.0, 1.0, 0.0, 0.0, 0.0])  # within 45 degrees of the vertical
        start = np.array([0.2, 0.2, 0.6, 0.0, 0.0, 0.0])
        free, confined = np.empty(4), np.empty(5)
        level = best_axis_of_forms(forms, np.empty(3))
        arguments = (level, math.inf, 1e-7)
        unbound = dual_multipliers(forms, 0, 4, *arguments, ISOTROPIC, free, np.empty(6), *SMALLEST)
        both = np.vstack([side, forms])
        bound = dual_multipliers(both, 1, 5, *arguments, start, confined, np.empty(6), *SMALLEST)
        assert bound <= unbound * (1.0 + 1e-5)
        assert dual_value(both, confined) == pytest.approx(bound, rel=1e-5)
