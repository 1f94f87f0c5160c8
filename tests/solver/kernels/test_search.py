"""The multistart's parts: the box of better poses, the way out of the balls, and the search itself."""

from collections.abc import Callable

import numpy as np
from hypothesis import given, strategies as st
from sizes import few_examples

from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.linear_algebra.axis import best_axis
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.kernels.search.domain import push_out
from nullpose.solver.kernels.search.search import cut_box

SEEDS = st.integers(0, 2**32 - 1)


def box_of(family: Family, level: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns the box outside which no pose reaches a log ratio."""
    low, high = np.empty(3), np.empty(3)
    cut_box(family.ratios, family.domain.low_m, family.domain.high_m, level, low, high)
    return low, high


@few_examples(20)
@given(seed=SEEDS, nodes=st.integers(1, 6), jammers=st.integers(0, 2))
def test_no_better_pose_lies_outside_the_box(
    seed: int, nodes: int, jammers: int, random_scene: Callable
) -> None:
    """Of many positions with their best axes, each that reaches the level lies in the box cut with it."""
    rng = np.random.default_rng(seed)
    family = build_family(random_scene(rng, nodes, jammers, 10.0 ** rng.uniform(-2.0, 3.0)))
    positions = rng.uniform([-100.0, -100.0, 8.0], [200.0, 200.0, 30.0], (60, 3))
    axis = np.empty(3)
    values = np.array([best_axis(family.ratios, p, axis) for p in positions])
    for level in np.quantile(values, [0.0, 0.3, 0.7, 1.0]):
        low, high = box_of(family, level - 1e-12)
        better = positions[values >= level]
        assert np.all((better >= low) & (better <= high))


@given(seed=SEEDS)
def test_no_better_pose_lies_outside_the_box_of_a_secrecy_family(seed: int, random_family: Callable) -> None:
    """The same with isotropic parts, where a low level cuts nothing off, for any axis at all."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, 3, 2)
    positions = rng.uniform([-200.0, -200.0, 8.0], [300.0, 300.0, 30.0], (200, 3))
    logs, out = np.empty(2), np.empty(3)
    values = np.array(
        [
            log_objective(family.ratios, p, u, logs, out)
            for p, u in zip(positions, rng.normal(size=(200, 3)), strict=True)
        ]
    )
    for level in np.quantile(values, [0.0, 0.5, 1.0]):
        low, high = box_of(family, level - 1e-12)
        better = positions[values >= level]
        assert np.all((better >= low) & (better <= high))


def domain(low: np.ndarray, high: np.ndarray, centres: np.ndarray, radius: float) -> tuple[object, ...]:
    """Returns a box without balls as the kernels take it, with keep-out balls of its own."""
    family = Family(
        points_m=np.zeros((1, 3)),
        numerator_isotropic=np.zeros(1),
        numerator_weight=np.ones(1),
        numerator_point=np.zeros(1, dtype=np.int64),
        denominator_of=np.zeros(1, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.zeros(2, dtype=np.int64),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
        low_m=low,
        high_m=high,
        keep_out_points_m=centres,
        keep_out_m=radius,
    )
    return family.domain


@given(seed=SEEDS, balls=st.integers(0, 4), radius=st.floats(0.5, 8.0))
def test_a_push_ends_outside_the_balls(seed: int, balls: int, radius: float) -> None:
    """A position that could be pushed out lies in the box and outside every ball; a clear one stays put."""
    rng = np.random.default_rng(seed)
    low, high = np.array([-30.0, -30.0, 2.0]), np.array([30.0, 30.0, 20.0])
    centres = rng.uniform([-30.0, -30.0, 0.0], [30.0, 30.0, 10.0], (balls, 3))
    for p in rng.uniform([-40.0, -40.0, 0.0], [40.0, 40.0, 25.0], (20, 3)):
        before = np.clip(p, low, high)
        clear = np.all(np.linalg.norm(centres - before, axis=1) >= 1.01 * radius)
        pushed = push_out(p, domain(low, high, centres, radius))
        assert np.all((p >= low) & (p <= high))
        if pushed:
            assert np.all(np.linalg.norm(centres - p, axis=1) >= radius)
        if clear:
            assert pushed
            np.testing.assert_array_equal(p, before)


def test_a_box_inside_a_ball_has_no_way_out() -> None:
    """Where a ball holds the whole box, the push says that it failed."""
    p = np.array([0.5, 0.5, 1.0])
    assert not push_out(p, domain(np.zeros(3), np.ones(3), np.array([[0.5, 0.5, 0.5]]), 5.0))
