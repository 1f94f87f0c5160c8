"""The barrier problem behind the polish."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import minimize_scalar

from nullpose.solver.kernels.barrier import barrier_value, best_level, newton_step, residual

SEEDS = st.integers(0, 2**32 - 1)


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
        return -barrier_value(f - t, t, mu)

    searched = minimize_scalar(
        cost, bounds=(-0.2 - 4.0 * mu, -0.2), method="bounded", options={"xatol": 1e-10}
    )
    assert best_level(f, mu) == pytest.approx(searched.x, abs=1e-6 * mu**0.5)


def test_the_barrier_is_minus_infinity_outside() -> None:
    """Where any gap is not positive the barrier is minus infinity."""
    assert barrier_value(np.array([-0.5, 0.5, 0.5]), 1.5, 0.1) == -math.inf
    assert barrier_value(np.array([0.5, 1.5, 0.0]), 0.5, 0.1) == -math.inf
    expected = 0.5 + 0.1 * (math.log(0.5) + math.log(1.5) + math.log(0.5))
    assert barrier_value(np.array([0.5, 1.5, 0.5]), 0.5, 0.1) == pytest.approx(expected, abs=1e-15)


@given(seed=SEEDS, n=st.integers(1, 5), ratios=st.integers(1, 4))
def test_a_newton_step_climbs_and_solves_its_system(seed: int, n: int, ratios: int) -> None:
    """With a concave Hessian the step is dense Newton's, and the barrier's slope along it is positive."""
    rng = np.random.default_rng(seed)
    count, mu = ratios + 3, 0.05
    gaps = rng.uniform(0.1, 1.0, count)
    duals = mu / gaps
    rates = rng.normal(size=(count, 6))
    rates[:, n] = np.where(np.arange(count) < ratios, -1.0, 0.0)  # ratios k have gaps f_k - t
    root = rng.normal(size=(5, 5))
    h = -root @ root.T
    factor, step = np.empty((6, 6)), np.empty(6)
    slope = newton_step(gaps, duals, rates, h, n, mu, factor, step)
    in_use = rates[:, : n + 1]
    gradient = mu * (1.0 / gaps) @ in_use
    gradient[n] += 1.0
    curvature = in_use.T @ np.diag(duals / gaps) @ in_use
    curvature[:n, :n] -= h[:n, :n]
    np.testing.assert_allclose(step[: n + 1], np.linalg.solve(curvature, gradient), rtol=1e-6, atol=1e-9)
    assert gradient @ step[: n + 1] > 0.0
    assert math.isfinite(slope)


def test_no_residual_at_a_solution() -> None:
    """Two ratios that pull apart, held by equal multipliers, leave no residual; other multipliers do."""
    mu = 0.1
    gaps, rates = np.full(2, 2.0 * mu), np.array([[1.0, -1.0], [-1.0, -1.0]])
    assert residual(gaps, np.array([0.5, 0.5]), rates, 1, mu) == pytest.approx(0.0, abs=1e-15)
    assert residual(gaps, np.array([0.6, 0.4]), rates, 1, mu) == pytest.approx(0.2, abs=1e-15)
