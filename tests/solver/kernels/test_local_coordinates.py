"""The search variables of a pose: where a step leads, and what it keeps."""

from collections.abc import Callable

import numpy as np
from hypothesis import given, strategies as st

from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.local_coordinates import (
    local_coordinates,
    move,
    rotation_rates,
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
