"""The barrier problem behind the polish."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from nullpose.solve.kernels.barrier import barrier_value, best_level, newton_step, residual

SEEDS = st.integers(0, 2**32 - 1)
NO_SLACKS, NO_USE = np.empty(0), np.empty(0, dtype=np.bool_)


@given(seed=SEEDS, ratios=st.integers(1, 100), exponent=st.floats(-10.0, 0.0), spread=st.floats(0.0, 20.0))
def test_the_best_level_is_where_the_weights_sum_to_one(
    seed: int, ratios: int, exponent: float, spread: float
) -> None:
    """At the level that maximises the barrier the multipliers mu / (f - t) sum to one, below every ratio."""
    f = spread * np.random.default_rng(seed).normal(size=ratios)
    mu = 10.0**exponent
    t = best_level(f, mu)
    assert t < f.min()
    assert np.sum(mu / (f - t)) == pytest.approx(1.0, abs=1e-9 + 1e-14 * (1.0 + abs(t)) / mu)


@pytest.mark.parametrize("mu", [1.0, 0.1, 1e-3])
def test_the_best_level_maximises_the_barrier(mu: float) -> None:
    """SciPy's scalar search of the barrier's value comes to the same level."""
    f = np.array([0.3, 0.5, -0.2, 1.4])

    def cost(t: float) -> float:
        return -barrier_value(f, t, NO_SLACKS, NO_USE, mu)

    searched = minimize_scalar(
        cost, bounds=(-0.2 - 4.0 * mu, -0.2), method="bounded", options={"xatol": 1e-10}
    )
    assert best_level(f, mu) == pytest.approx(searched.x, abs=1e-6 * mu**0.5)


def test_the_barrier_is_minus_infinity_outside() -> None:
    """Outside any constraint in use the barrier is minus infinity; constraints not in use do not count."""
    f, slacks = np.array([1.0, 2.0]), np.array([0.5, -1.0])
    used, spared = np.array([True, True]), np.array([True, False])
    assert barrier_value(f, 1.5, slacks, spared, 0.1) == -math.inf
    assert barrier_value(f, 0.5, slacks, used, 0.1) == -math.inf
    expected = 0.5 + 0.1 * (math.log(0.5) + math.log(1.5) + math.log(0.5))
    assert barrier_value(f, 0.5, slacks, spared, 0.1) == pytest.approx(expected, abs=1e-15)


@given(seed=SEEDS, n=st.integers(1, 5), ratios=st.integers(1, 4))
def test_a_newton_step_climbs_and_solves_its_system(seed: int, n: int, ratios: int) -> None:
    """With a concave Hessian the step is dense Newton's, and the barrier's slope along it is positive."""
    rng = np.random.default_rng(seed)
    sides, mu, t = 3, 0.05, 0.2
    f, slacks = t + rng.uniform(0.1, 1.0, ratios), rng.uniform(0.1, 1.0, sides)
    used = np.array([True, False, True])
    z, zs = mu / (f - t), mu / slacks
    slopes, rows = rng.normal(size=(ratios, 6)), rng.normal(size=(sides, 6))
    root = rng.normal(size=(5, 5))
    h = -root @ root.T
    system, factor, step = np.empty((6, 6)), np.empty((6, 6)), np.empty(6)
    slope = newton_step(f, t, slacks, used, z, zs, slopes, rows, h, n, mu, system, factor, step)
    # the same by dense algebra: variables x and t, ratios f_k + a_k x - t, slacks s_c + b_c x
    rates = np.hstack([slopes[:, :n], -np.ones((ratios, 1))])
    faces = np.hstack([rows[used, :n], np.zeros((2, 1))])
    gradient = mu * (1.0 / (f - t)) @ rates + mu * (1.0 / slacks[used]) @ faces
    gradient[n] += 1.0
    curvature = rates.T @ np.diag(z / (f - t)) @ rates + faces.T @ np.diag(zs[used] / slacks[used]) @ faces
    curvature[:n, :n] -= h[:n, :n]
    np.testing.assert_allclose(step[: n + 1], np.linalg.solve(curvature, gradient), rtol=1e-6, atol=1e-9)
    assert gradient @ step[: n + 1] > 0.0
    assert math.isfinite(slope)


def test_no_residual_at_a_solution() -> None:
    """Two ratios that pull apart, held by equal multipliers, leave no residual; other multipliers do."""
    f, mu = np.array([1.0, 1.0]), 0.1
    t = 1.0 - 2.0 * mu
    slopes, rows = np.array([[1.0], [-1.0]]), np.zeros((0, 1))
    none = np.zeros(0)
    balanced = residual(f, t, none, NO_USE, np.array([0.5, 0.5]), none, slopes, rows, 1, mu)
    assert balanced == pytest.approx(0.0, abs=1e-15)
    tilted = residual(f, t, none, NO_USE, np.array([0.6, 0.4]), none, slopes, rows, 1, mu)
    assert tilted == pytest.approx(0.2, abs=1e-15)
