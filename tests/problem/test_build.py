"""From a scenario to its family: the ratios are the SINRs, the domain is the airspace."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import dense_ratios

from nullpose.physics import sinr
from nullpose.problem.build import build_family

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, nodes=st.integers(1, 8), jammers=st.integers(0, 4))
def test_ratios_are_the_sinrs(seed: int, nodes: int, jammers: int, random_problem: Callable) -> None:
    """Recomputed from the arrays with dense matrices, the ratios are the SINRs of the physics (eq. 2.1)."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, nodes, jammers)
    position = rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0])
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    np.testing.assert_allclose(
        dense_ratios(build_family(scene), position, axis), sinr(scene, position, axis), rtol=1e-9, atol=1e-13
    )


FENCE = [(-10.0, 0.0), (70.0, -20.0), (90.0, 50.0), (0.0, 80.0)]


@pytest.mark.parametrize(
    ("airspace", "low_m", "high_m"),
    [
        ({}, [-np.inf, -np.inf], [np.inf, np.inf]),
        ({"x_m": (-5.0, 60.0), "y_m": (0.0, 0.0)}, [-5.0, 0.0], [60.0, 0.0]),
        ({"geofence_m": FENCE}, [-10.0, -20.0], [90.0, 80.0]),
        ({"geofence_m": FENCE, "x_m": (5.0, 200.0)}, [5.0, -20.0], [90.0, 80.0]),
    ],
)
def test_the_box_is_the_airspaces_and_its_fences(
    airspace: dict, low_m: list[float], high_m: list[float], random_problem: Callable
) -> None:
    """Bounds left out are infinite, those given are kept, a fence bounds what is unbounded or wider."""
    family = build_family(random_problem(np.random.default_rng(1), 2, 1, keep_out_m=2.5, **airspace))
    np.testing.assert_array_equal(family.domain.low_m, [*low_m, 10.0])
    np.testing.assert_array_equal(family.domain.high_m, [*high_m, 40.0])
    assert family.domain.keep_out_m == 2.5


def test_a_touching_keep_out_ball_is_left_out(scene: Callable) -> None:
    """One that reaches in, by however little, is kept."""
    for keep_out_m, kept in ((8.0, []), (8.1, [0])):
        family = build_family(scene([(30.0, 0.0, 0.0)], keep_out_m=keep_out_m))
        np.testing.assert_array_equal(family.domain.keep_out_points_m, family.ratios.points_m[kept])


@given(seed=SEEDS, keep_out_m=st.floats(0.5, 45.0))
def test_no_ball_that_matters_is_left_out(seed: int, keep_out_m: float, random_problem: Callable) -> None:
    """No position lies inside the ball of a point that was left out, and every ball kept reaches in."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, 3, 2, x_m=(20.0, 45.0), keep_out_m=keep_out_m)
    family = build_family(scene)
    kept = {tuple(point) for point in family.domain.keep_out_points_m}
    left_out = np.array([point for point in family.ratios.points_m if tuple(point) not in kept]).reshape(
        -1, 3
    )
    inside = rng.uniform([20.0, -60.0, 10.0], [45.0, 160.0, 40.0], (500, 3))
    inside[::2, 2] = 10.0
    distances = np.linalg.norm(inside[:, None] - left_out, axis=-1)
    assert np.all(distances >= keep_out_m)
    nearest = np.clip(family.domain.keep_out_points_m, family.domain.low_m, family.domain.high_m)
    assert np.all(np.linalg.norm(family.domain.keep_out_points_m - nearest, axis=1) < keep_out_m)
