"""The exact best axis at a position, against grids, local solvers and duality."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.linalg import sqrtm
from scipy.optimize import minimize
from sizes import few_examples

from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.linear_algebra.axis import best_axis

SEEDS = st.integers(0, 2**32 - 1)
ABOVE = np.array([0.0, 0.0, 10.0])


def ratios_at(family: Family, p: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Returns the ratios (..., R) at axes (..., 3), by cross products: dense forms cancel beside a null."""
    ratios = family.ratios
    r = ratios.points_m - p
    square = np.sum(r**2, axis=1)
    links = np.sum(np.cross(axes[..., None, :], r) ** 2, axis=-1) / square**2
    size = np.sum(axes**2, axis=-1)[..., None]
    tops = ratios.numerator_isotropic * size + ratios.numerator_weight * links[..., ratios.numerator_point]
    entries = ratios.denominator_weight * links[..., ratios.denominator_point]
    spans = zip(ratios.denominator_start[:-1], ratios.denominator_start[1:], strict=True)
    jamming = np.stack([np.sum(entries[..., a:b], axis=-1) for a, b in spans], axis=-1)
    return tops / (ratios.denominator_isotropic * size + jamming)[..., ratios.denominator_of]


def found(family: Family, p: np.ndarray) -> tuple[float, np.ndarray]:
    """Returns the kernel's best value, as a ratio, and its axis, at which the ratios must come to that."""
    axis = np.empty(3)
    value = math.exp(best_axis(family.ratios, p, axis))
    assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-15)
    assert np.min(ratios_at(family, p, axis)) == pytest.approx(value, rel=1e-12)
    return value, axis


def whitened(family: Family, p: np.ndarray, dense_forms: Callable) -> np.ndarray:
    """Returns D^(-1/2) N_k D^(-1/2) for a shared denominator, (R, 3, 3), by SciPy's matrix square root."""
    numerators, (denominator,) = dense_forms(family, p)
    root = np.linalg.inv(sqrtm(denominator).real)
    return np.array([root @ numerator @ root for numerator in numerators])


def searched(family: Family, p: np.ndarray, rng: np.random.Generator, refined: int = 6) -> float:
    """Returns the best of 20,000 axes, some of the best of them refined by SLSQP on the epigraph form.

    The refinement sees logarithms, which beside a null vary as little as the directions do.
    """
    axes = rng.normal(size=(20_000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    values = np.log(np.maximum(np.min(ratios_at(family, p, axes), axis=1), 1e-300))
    best = float(values.max())
    steps = 1e-7 * np.vstack([np.eye(3), -np.eye(3)])

    def logs(u: np.ndarray) -> np.ndarray:
        return np.log(np.maximum(ratios_at(family, p, u), 1e-300))

    def slopes(x: np.ndarray) -> np.ndarray:
        ends = logs(x[:3] + steps)
        return np.column_stack([(ends[:3] - ends[3:]).T / 2e-7, -np.ones(ends.shape[1])])

    for start in np.argsort(-values)[:refined]:
        result = minimize(
            lambda x: -x[3],
            [*axes[start], values[start]],
            jac=lambda x: np.array([0.0, 0.0, 0.0, -1.0]),
            method="SLSQP",
            constraints=[
                {"type": "ineq", "fun": lambda x: logs(x[:3]) - x[3], "jac": slopes},
                {
                    "type": "eq",
                    "fun": lambda x: x[:3] @ x[:3] - 1.0,
                    "jac": lambda x: np.array([*(2.0 * x[:3]), 0.0]),
                },
            ],
            options={"ftol": 1e-14, "maxiter": 100},
        )
        best = max(best, float(np.min(logs(result.x[:3]))))
    return math.exp(best)


@few_examples(12)
@given(seed=SEEDS, nodes=st.sampled_from([1, 2, 3, 4, 5, 10, 30]), jammers=st.integers(0, 3))
def test_no_search_finds_a_better_axis(seed: int, nodes: int, jammers: int, random_scene: Callable) -> None:
    """A dense search of the sphere refined by SLSQP comes to the same value and never above it."""
    rng = np.random.default_rng(seed)
    family = build_family(random_scene(rng, nodes, jammers, 10.0 ** rng.uniform(-1.0, 4.0)))
    p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
    value, _ = found(family, p)
    best = searched(family, p, rng)
    assert best <= value * (1.0 + 1e-12)
    assert best >= value * (1.0 - 1e-6)


@given(seed=SEEDS, nodes=st.integers(1, 12), decades=st.floats(0.0, 6.0))
def test_no_multiplier_is_below_the_value(
    seed: int, nodes: int, decades: float, random_scene: Callable, dense_forms: Callable
) -> None:
    """No mixture of the forms has a top eigenvalue below the value: weak duality, for any number."""
    rng = np.random.default_rng(seed)
    family = build_family(random_scene(rng, nodes, 2, 10.0 ** rng.uniform(-1.0, 4.0)))
    powers = 10.0 ** rng.uniform(0.0, decades, nodes)
    family = family.changed(numerator_weight=family.ratios.numerator_weight * powers)
    p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
    value, _ = found(family, p)
    forms = whitened(family, p, dense_forms)
    mixtures = np.vstack([np.eye(nodes), rng.dirichlet(np.full(nodes, 0.5), 200)])
    tops = np.linalg.eigvalsh(np.einsum("mk,kij->mij", mixtures, forms))[:, -1]
    assert np.all(tops >= value * (1.0 - 1e-12))


@pytest.mark.parametrize("nodes", [3, 4, 5])
@pytest.mark.parametrize("tremor_m", [0.0, 1e-9])
def test_unlike_nodes_at_equal_distances(nodes: int, tremor_m: float, scene: Callable) -> None:
    """At equal distances and powers the cones are pairs of planes; on a sphere of any directions too."""
    rng = np.random.default_rng(nodes)
    for jamming_w in (0.0, 0.0, 0.0, 1.0, 10.0, 1e4):
        around = rng.normal(size=(nodes, 3))
        around /= np.linalg.norm(around, axis=1, keepdims=True)
        places = ABOVE + 20.0 * around + tremor_m * rng.normal(size=(nodes, 3))
        jammers = [(3.0, 1.0, -30.0)] if jamming_w else []
        family = build_family(scene(places, jammers, jammer_powers_w=jamming_w or 1.0))
        value, _ = found(family, ABOVE)
        best = searched(family, ABOVE, rng)
        assert best <= value * (1.0 + 1e-10)  # a cone that is flat to 1e-10 is taken for two planes
        assert best >= value * (1.0 - 1e-7)


@given(seed=SEEDS)
def test_an_axis_beside_the_null(seed: int, scene: Callable) -> None:
    """Under extreme jamming the best axis is the null, and the value that of zero interference (eq. 3.2)."""
    rng = np.random.default_rng(seed)
    nodes = rng.uniform([-50.0, -50.0, 0.0], [50.0, 50.0, 2.0], (3, 3))
    family = build_family(scene(nodes, [(20.0, 10.0, 3.0)], jammer_powers_w=1e9))
    value, axis = found(family, ABOVE)
    null = np.array([20.0, 10.0, 3.0]) - ABOVE
    null /= np.linalg.norm(null)
    silent = np.min(ratios_at(family, ABOVE, null))
    assert value >= silent * (1.0 - 1e-9)
    assert value == pytest.approx(silent, rel=1e-3)
    assert np.linalg.norm(np.cross(axis, null)) < 1e-3


def test_denominators_that_are_equal_are_one(random_scene: Callable) -> None:
    """Writing a shared denominator out once per ratio changes the path taken and not the value."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        family = build_family(random_scene(rng, 4, 2, 10.0))
        apart = family.changed(
            denominator_of=np.arange(4),
            denominator_isotropic=np.ones(4),
            denominator_start=2 * np.arange(5),
            denominator_point=np.tile(family.ratios.denominator_point, 4),
            denominator_weight=np.tile(family.ratios.denominator_weight, 4),
        )
        p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
        shared, _ = found(family, p)
        split, _ = found(apart, p)
        assert split == pytest.approx(shared, rel=1e-12)
