"""The polish, a climb without a search: where it ends, a Karush-Kuhn-Tucker point holds, by other means."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import nnls

from nullpose.physics import sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.linear_algebra.axis import best_axis
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.multistart import climb

SEEDS = st.integers(0, 2**32 - 1)
VERTICAL = AxisField.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))


def polished(
    family: Family, field: AxisField, p: np.ndarray, u: np.ndarray
) -> tuple[float, np.ndarray, np.ndarray]:
    """Returns the value, position and axis at which the polish ends; the starting pose is left alone."""
    p, u = p.copy(), u.copy()
    value, _ = run(family, field, p, u)
    return value, p, u


def run(family: Family, field: AxisField, p: np.ndarray, u: np.ndarray) -> tuple[float, np.ndarray]:
    """Polishes a pose in place; returns its value and the multipliers, which must be a convex mixture."""
    found = climb(family, field, p, u, mu=0.1, steps=200)
    p[:], u[:] = found.position_m, found.axis
    assert 0 <= found.evaluations <= 200
    assert np.all(found.multipliers >= 0.0)
    assert np.sum(found.multipliers) == pytest.approx(1.0, abs=1e-6)
    return found.log_value, found.multipliers


def value_at(family: Family, p: np.ndarray, u: np.ndarray) -> float:
    """Returns the smallest log ratio at a pose."""
    logs, out = (
        np.empty(len(family.ratios.denominator_isotropic)),
        np.empty(len(family.ratios.numerator_point)),
    )
    return log_objective(family.ratios, p, u, logs, out)


def log_ratio_slopes(family: Family, p: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the log ratios (R,) and their gradients (R, 6) by the complex step, exact to rounding.

    A step of 1e-30 along the imaginary axis needs no subtraction, so nothing is lost to its smallness.
    """
    ratios = family.ratios
    poses = np.tile(np.concatenate([p, u]).astype(complex), (6, 1)) + 1e-30j * np.eye(6)
    r = ratios.points_m - poses[:, None, :3]
    u_c = poses[:, None, 3:]
    cross = np.stack(
        [
            u_c[..., (i + 1) % 3] * r[..., (i + 2) % 3] - u_c[..., (i + 2) % 3] * r[..., (i + 1) % 3]
            for i in range(3)
        ],
        axis=-1,
    )
    links = np.sum(cross**2, axis=-1) / np.sum(r**2, axis=-1) ** 2  # (6, points)
    size = np.sum(poses[:, 3:] ** 2, axis=-1)[:, None]
    tops = ratios.numerator_isotropic * size + ratios.numerator_weight * links[:, ratios.numerator_point]
    jamming = np.sum(ratios.denominator_weight * links[:, ratios.denominator_point], axis=-1, keepdims=True)
    logs = np.log(tops) - np.log(ratios.denominator_isotropic * size + jamming)
    return logs[0].real, logs.imag.T / 1e-30


def stationarity(family: Family, field: AxisField, p: np.ndarray, u: np.ndarray) -> float:
    """Returns how far a pose is from a Karush-Kuhn-Tucker point, per length to the nearest point.

    The multipliers are found afresh, by non-negative least squares: a convex mixture of the gradients of the
    ratios that are smallest, plus outward pushes of the faces and balls that are met, is to be zero.
    """
    logs, slopes = log_ratio_slopes(family, p, u)
    length = float(
        np.min(np.linalg.norm(family.ratios.points_m - p, axis=1))
    )  # gives both halves the same units
    if field.is_free:
        frame = np.linalg.svd(u[None])[2][1:]
        gradients = np.hstack([length * slopes[:, :3], slopes[:, 3:] @ frame.T])
    else:
        gradients = length * (slopes[:, :3] + slopes[:, 3:] @ field.matrix)
    active = gradients[logs - logs.min() < 1e-8]
    low, high, centres = family.domain.low_m, family.domain.high_m, family.domain.keep_out_points_m
    radius = family.domain.keep_out_m
    pushes = [
        sign * np.eye(3)[i]
        for sign, gap in ((1.0, p - low), (-1.0, high - p))
        for i in range(3)
        if gap[i] < 1e-7 * length
    ]
    outwards = p - centres
    pushes += [out for out in outwards if np.linalg.norm(out) < radius * (1.0 + 1e-7)]
    # one large weight makes the mixture convex, steep pushes make their size irrelevant
    steep = 1.0 + float(np.abs(active).max())
    mixture = np.zeros((gradients.shape[1] + 1, len(active) + len(pushes)))
    mixture[:-1, : len(active)] = active.T
    mixture[-1, : len(active)] = steep
    for column, push in enumerate(pushes, start=len(active)):
        mixture[:3, column] = steep * push / np.linalg.norm(push)
    target = np.zeros(len(mixture))
    target[-1] = steep
    return float(nnls(mixture, target)[1])


def inside(family: Family, p: np.ndarray) -> bool:
    """Returns whether a position lies in the domain, to the last digit."""
    low, high, centres = family.domain.low_m, family.domain.high_m, family.domain.keep_out_points_m
    radius = family.domain.keep_out_m
    clear = np.all(np.sum((centres - p) ** 2, axis=1) >= radius**2)
    return bool(np.all(p >= low) and np.all(p <= high) and clear)


@pytest.mark.parametrize("field", [AxisField.free(), VERTICAL], ids=["free", "vertical"])
@pytest.mark.parametrize("nodes", range(1, 7))
def test_ends_are_stationary(nodes: int, field: AxisField, random_scene: Callable) -> None:
    """From anywhere, the axis free or vertical, the polish ends no lower, in the domain, at a KKT point."""
    rng = np.random.default_rng(nodes)
    for start in range(60):
        family = build_family(random_scene(rng, nodes, start % 4, 10.0 ** rng.uniform(-1.0, 4.0)))
        p = rng.uniform([-20.0, -20.0, 8.1], [120.0, 120.0, 29.9])
        u = rng.normal(size=3)
        u /= np.linalg.norm(u)
        before = value_at(family, p, u if field.is_free else field.offset)
        value, p, u = polished(family, field, p, u)
        assert value >= before
        assert value == value_at(family, p, u)
        assert inside(family, p)
        assert np.linalg.norm(u) == pytest.approx(1.0, abs=1e-14)
        assert stationarity(family, field, p, u) < 1e-6


def test_the_paper_under_a_million_times_the_power(paper: Callable) -> None:
    """With a jammer of 60 dB more the null is a needle; every start still ends in it, to 1e-9."""
    ends = hundred_ends(build_family(paper(1e6)))
    assert np.ptp(ends) < 1e-9
    # the optimum of zero interference is reached, and left by less than its reciprocal share
    assert 10.0 * np.log10(math.exp(ends.max())) == pytest.approx(0.8123549, abs=1e-6)


def hundred_ends(family: Family) -> np.ndarray:
    """Returns the values that a hundred starts within 29 m of both nodes end at, half with a random axis."""
    rng = np.random.default_rng(17)
    nodes = family.ratios.points_m[:2]
    ends = []
    while len(ends) < 100:
        p = rng.uniform([-30.0, 20.0, 8.0], [30.0, 30.0, 16.0])
        if np.any(
            np.linalg.norm(nodes - p, axis=1) > 29.0
        ):  # 29^2 = P / (sigma^2 1.19): beyond, no pose is as good
            continue
        u = rng.normal(size=3)
        u /= np.linalg.norm(u)
        if len(ends) % 2:
            best_axis(family.ratios, p, u)
        ends.append(polished(family, AxisField.free(), p, u)[0])
    return np.array(ends)


def test_a_fixed_position_leaves_the_axis(paper: Callable) -> None:
    """Where nothing but the axis is free, the polish finds the best axis of that position."""
    family = build_family(paper(10.0, altitude_m=(9.0, 9.0), x_m=(1.0, 1.0), y_m=(21.0, 21.0)))
    axis = np.empty(3)
    best = best_axis(family.ratios, np.array([1.0, 21.0, 9.0]), axis)
    ends = []
    rng = np.random.default_rng(4)
    for _ in range(20):
        u = rng.normal(size=3)
        value, p, u = polished(family, AxisField.free(), np.zeros(3), u / np.linalg.norm(u))
        np.testing.assert_array_equal(p, [1.0, 21.0, 9.0])
        ends.append(value)
        assert value <= best + 1e-12
    assert max(ends) == pytest.approx(best, abs=1e-10)


def test_a_keep_out_ball_that_binds(paper: Callable) -> None:
    """Where the keep-out balls cover the optimum, the polish ends on a ball and no neighbour is better."""
    scene = paper(1.0, keep_out_m=26.5)
    family = build_family(scene)
    value, p, u = polished(family, AxisField.free(), np.array([-15.0, 20.0, 12.0]), np.array([1.0, 0.0, 0.2]))
    assert inside(family, p)
    distances = np.linalg.norm(family.ratios.points_m - p, axis=1)
    assert distances.min() == pytest.approx(26.5, abs=1e-8)
    assert stationarity(family, AxisField.free(), p, u) < 1e-4
    rng = np.random.default_rng(6)
    for size in (1.0, 1e-2, 1e-4):
        around = p + size * rng.normal(size=(20_000, 3))
        around[:, 2] = np.clip(around[:, 2], 8.0, 30.0)
        turned = u + size / 30.0 * rng.normal(size=(20_000, 3))
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        allowed = np.all(np.linalg.norm(around[:, None] - family.ratios.points_m, axis=-1) >= 26.5, axis=1)
        nearby = np.min(sinr(scene, around[allowed], turned[allowed]), axis=1)
        assert nearby.max() <= math.exp(value) * (1.0 + 1e-9)


def test_a_start_in_a_ball_is_refused(paper: Callable) -> None:
    """A start inside a keep-out ball has no value: minus infinity."""
    family = build_family(paper(1.0, keep_out_m=12.0))
    value, *_ = polished(family, AxisField.free(), np.array([0.0, 0.0, 9.0]), np.array([1.0, 0.0, 0.0]))
    assert value == -math.inf


@given(seed=SEEDS)
def test_several_denominators_too(seed: int, random_family: Callable) -> None:
    """With several denominators and isotropic parts the polish ends no lower, and in the domain."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, 4, 2)
    p = rng.uniform([0.0, 0.0, 8.1], [100.0, 100.0, 29.9])
    u = rng.normal(size=3)
    u /= np.linalg.norm(u)
    start = value_at(family, p, u)
    assert climb(family, AxisField.free(), p, u, steps=0).log_value == pytest.approx(start, rel=1e-12)
    value, p, u = polished(family, AxisField.free(), p, u)
    assert value >= start
    assert value == value_at(family, p, u)
    assert inside(family, p)
