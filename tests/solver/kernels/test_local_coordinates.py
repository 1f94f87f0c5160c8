"""The search variables of a pose: where a step leads, and what it keeps."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.local_coordinates import (
    domain_slacks,
    local_coordinates,
    move,
    nearest_node,
    reduce_hessian,
    rotation_rates,
    slack_count,
)

SEEDS = st.integers(0, 2**32 - 1)


def stepped(
    family: Family, field: AxisField, p: np.ndarray, u: np.ndarray, step: np.ndarray, free: tuple[bool, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the pose that a step leads to, and the change of the pose by each variable, (6, n)."""
    directions, pose, moved = np.empty((5, 6)), np.concatenate([p, u]), np.empty(6)
    n = local_coordinates(family.arrays, field.arrays, pose, np.array(free), directions)
    move(field.arrays, pose, directions, n, step, 1.0, moved)
    return moved[:3], moved[3:], directions[:n].T


@given(seed=SEEDS, is_free=st.booleans())
def test_the_jacobian_is_that_of_the_move(seed: int, is_free: bool, paper: Callable) -> None:
    """Small moves follow the Jacobian; what is left of them is along the axis, where the ratios are flat."""
    rng = np.random.default_rng(seed)
    field = AxisField.free() if is_free else AxisField.affine(rng.normal(size=3), rng.normal(size=(3, 3)))
    p, u = rng.uniform(5.0, 30.0, 3), rng.normal(size=3)
    u = u / np.linalg.norm(u) if is_free else field.offset + field.matrix @ p
    step = 1e-5 * rng.normal(size=5)
    ends = [
        stepped(build_family(paper(1.0)), field, p, u, sign * step, (True, True, True))
        for sign in (1.0, -1.0)
    ]
    jacobian = ends[0][2]
    assert jacobian.shape == (6, 5 if is_free else 3)
    expected = jacobian @ step[: jacobian.shape[1]]
    np.testing.assert_allclose((ends[0][0] - ends[1][0]) / 2.0, expected[:3], atol=1e-13)
    moved = (ends[0][1] - ends[1][1]) / 2.0 - expected[3:]
    np.testing.assert_allclose(moved - (moved @ u) * u / (u @ u), 0.0, atol=1e-12)


@pytest.mark.parametrize("held", range(3))
def test_a_held_coordinate_does_not_move(held: int, paper: Callable) -> None:
    """A coordinate that is not free has no variable, and no step moves it."""
    free = tuple(i != held for i in range(3))
    p, u = np.array([1.0, 2.0, 3.0]), np.array([0.6, 0.0, 0.8])
    new_p, new_u, jacobian = stepped(build_family(paper(1.0)), AxisField.free(), p, u, np.full(5, 0.1), free)
    assert jacobian.shape == (6, 4)
    assert new_p[held] == p[held]
    assert all(new_p[i] != p[i] for i in range(3) if i != held)
    assert np.linalg.norm(new_u) == pytest.approx(1.0, abs=1e-15)


@given(seed=SEEDS, sign=st.sampled_from([-1.0, 1.0]))
def test_a_rotating_step_keeps_the_null_on_the_jammer(seed: int, sign: float, paper: Callable) -> None:
    """At the rate of rotation a straight step of any size keeps the null on the strongest jammer exactly."""
    rng = np.random.default_rng(seed)
    family: Family = build_family(paper(100.0))
    p = rng.uniform([-20.0, 0.0, 8.0], [20.0, 50.0, 30.0])
    u = sign * (family.points_m[2] - p)
    u /= np.linalg.norm(u)
    step = np.array([*rng.uniform(-0.1, 0.1, 3), 0.0, 0.0])  # of the distance to the nearest node
    rates = np.empty((3, 3))
    rotation_rates(family.arrays, p, u, rates)
    rate = -sign / np.linalg.norm(family.points_m[2] - p)
    np.testing.assert_allclose(rates, rate * np.eye(3), rtol=1e-14)
    new_p, new_u, _ = stepped(family, AxisField.free(), p, u, step, (True, True, True))
    np.testing.assert_allclose(np.cross(new_u, family.points_m[2] - new_p), 0.0, atol=1e-13)


def test_without_jammers_nothing_rotates(scene: Callable) -> None:
    """Without an interferer the axis does not rotate with the position."""
    family = build_family(scene([(0, 0, 0)]))
    rates = np.empty((3, 3))
    rotation_rates(family.arrays, np.array([3.0, 4.0, 12.0]), np.array([0.0, 0.0, 1.0]), rates)
    assert not np.any(rates)


def test_slacks_are_distances_to_the_constraints(paper: Callable) -> None:
    """Faces by their distance, infinite if unbounded; balls and a band's ends by differences of squares."""
    family = build_family(paper(1.0, keep_out_m=9.0))
    slacks = np.empty(slack_count(family.domain))
    p, u = np.array([3.0, 4.0, 12.0]), np.array([0.6, 0.0, 0.8])
    band = AxisField.within(0.25, 0.75)
    domain_slacks(p, u, family.domain, band.arrays, np.empty(0, dtype=np.int64), slacks)
    balls = np.sum((family.keep_out_points_m - p) ** 2, axis=1) - 81.0
    np.testing.assert_allclose(slacks, [np.inf, np.inf, 4.0, np.inf, np.inf, 18.0, *balls, 0.39, 0.11])
    assert len(balls) == 3
    assert nearest_node(family.arrays, p) == pytest.approx(13.0, abs=1e-15)


@given(seed=SEEDS, n=st.integers(1, 5))
def test_reduced_hessian(seed: int, n: int) -> None:
    """The Hessian in the search variables is the congruence by the directions."""
    rng = np.random.default_rng(seed)
    hess, directions, out = rng.normal(size=(6, 6)), rng.normal(size=(5, 6)), np.zeros((5, 5))
    hess += hess.T
    reduce_hessian(hess, directions, n, out)
    np.testing.assert_allclose(out[:n, :n], directions[:n] @ hess @ directions[:n].T, atol=1e-12)
