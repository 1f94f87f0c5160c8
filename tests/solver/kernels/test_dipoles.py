"""The sum of a free axis' test where points have dipoles: above the exact one all over a box."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples
from tests.certificate.plain import boxes_at, make_leaves
from tests.reference.plain_kernels import plain

from nullpose.certificate.dipoles import dipole_sum
from nullpose.certificate.forms import matrices
from nullpose.certificate.interval import Interval
from nullpose.certificate.shear import shear_of
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.kernels.bounds import branch, exclusion, expansion
from nullpose.solver.kernels.bounds.node import CENTRE, COLUMNS, COUNT, FACE, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD
from nullpose.solver.kernels.linear_algebra import links

SEEDS, LEAKS = st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.01])


add_dipole_sum, add_form, frame_at, link_form, workspace_of = map(
    plain,
    (exclusion.add_dipole_sum, links.add_form, expansion.frame_at, links.link_form, branch.workspace_of),
)


def family_of(rng: np.random.Generator, leak: float) -> Family:
    """Return two nodes and two interferers, some of them with dipoles."""
    axes = rng.normal(size=(4, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True) * (1.0 + 1e-15)
    axes[rng.random(4) < 0.3] = 0.0
    leaks = np.where(rng.random(4) < 0.5, 10.0 ** rng.uniform(-3.0, -0.1, 4), 0.0)
    return Family(
        points_m=rng.uniform([0.0, 0.0, 0.0], [60.0, 60.0, 4.0], (4, 3)),
        numerator_isotropic=np.array([0.0, rng.choice([0.0, 1.0])]),
        numerator_weight=10.0 ** rng.uniform(2.0, 3.5, 2),
        numerator_point=np.array([0, 1]),
        denominator_of=np.array([0, 0]),
        denominator_isotropic=np.ones(1),
        denominator_start=np.array([0, 2]),
        denominator_point=np.array([2, 3]),
        denominator_weight=10.0 ** rng.uniform(0.0, 6.0, 2),
        low_m=np.array([-np.inf, -np.inf, 8.0]),
        high_m=np.array([np.inf, np.inf, 30.0]),
        keep_out_points_m=np.zeros((0, 3)),
        keep_out_m=1.0,
        leak=leak,
        ground_axes=axes,
        ground_leaks=np.where(np.any(axes, axis=1), leaks, 1.0),
    )


def exact_form(family: Family, weights: np.ndarray, level: float, p: np.ndarray) -> np.ndarray:
    """Return the sum at a position, from the definition of the forms."""
    ratios = family.ratios

    def form(j: int) -> np.ndarray:
        r, v, through = (
            ratios.points_m[j] - p,
            ratios.ground_axes[j],
            ratios.ground_leaks[j],
        )
        square = r @ r
        plain = (square * np.eye(3) - np.outer(r, r)) / square**2
        plain = (1.0 - ratios.leak) * plain + ratios.leak * np.eye(3) / square
        a = (square * v - (v @ r) * r) / square**1.5
        of_dipole = (1.0 - ratios.leak) * np.outer(a, a) + ratios.leak * (a @ a) * np.eye(3)
        return (1.0 - through) * of_dipole + through * plain

    below = np.eye(3) + sum(ratios.denominator_weight[e] * form(2 + e) for e in range(2))
    above = [
        ratios.numerator_isotropic[k] * np.eye(3) + ratios.numerator_weight[k] * form(k) for k in range(2)
    ]
    return sum(w * (n - level * below) for w, n in zip(weights, above, strict=True))


def turned_axes(family: Family, anchor: int, centre: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return ``I + E`` at a position, for coordinates that turn with a point."""

    def seen(place: np.ndarray) -> np.ndarray:
        r, v = family.ratios.points_m[anchor] - place, family.ratios.ground_axes[anchor]
        if not np.any(v):
            return r / np.linalg.norm(r)
        return ((r @ r) * v - (v @ r) * r) / (r @ r) ** 1.5

    before, now = seen(centre), seen(p)
    if np.any(family.ratios.ground_axes[anchor]):
        return np.eye(3) - np.outer(before, (now - before) / (now @ before))
    return np.eye(3) + np.outer(now / (now @ before) - before, before)


def case_of(seed: int, leak: float) -> tuple:
    """Return a family, multipliers, a level, an anchor and a box clear of all points."""
    rng = np.random.default_rng(seed)
    family, share = family_of(rng, leak), rng.random()
    weights, level = np.array([share, 1.0 - share]), float(10.0 ** rng.uniform(-1.0, 0.5))
    centre = rng.uniform([-10.0, -10.0, 10.0], [70.0, 70.0, 28.0])
    half = 10.0 ** rng.uniform(-3.0, 0.2) * rng.uniform(0.3, 1.0, 3)
    return rng, family, weights, level, int(rng.integers(2, 4)), centre, half


def difference(bound: np.ndarray, exact: np.ndarray) -> float:
    """Return by how much a form is not above another, relative to their sizes."""
    return float(-np.linalg.eigvalsh(bound - exact)[0] / (np.abs(exact).max() + np.abs(bound).max()))


@pytest.mark.parametrize("kind", [WORLD, TOWARDS_POINT])
@given(leak=LEAKS, seed=SEEDS)
def test_the_solvers_sum_is_above_the_exact_one(kind: int, leak: float, seed: int) -> None:
    """Anywhere in the box, in the coordinates of the frame, turning or not."""
    rng, family, weights, level, anchor, centre, half = case_of(seed, leak)
    row = np.zeros(COLUMNS)
    row[CENTRE:HALF], row[HALF:LEVEL], row[LEVEL], row[FACE] = centre, half, level, -1.0
    row[COUNT], row[INDEX : INDEX + 2], row[WEIGHT : WEIGHT + 2] = 2.0, [0.0, 1.0], weights
    basis, matrix, space = np.empty((3, 3)), np.empty(6), workspace_of(family.ratios)
    frame = frame_at(family.ratios, kind, anchor, centre, half, basis)
    add_dipole_sum(family.ratios, AxisField.free().arrays, frame, row, space, matrix)
    for _ in range(8):
        x = rng.uniform(-1.0, 1.0, 3) * half
        exact = exact_form(family, weights, level, centre + x)
        bound = matrices((matrix + x @ space.slopes + space.rest)[:, None])[0]
        ways = [np.eye(3)] if kind == WORLD else [np.eye(3), turned_axes(family, anchor, centre, centre + x)]
        # coordinates stand still where a point's direction changes too much: then they are the world's
        excess = [difference(bound, basis.T @ way.T @ exact @ way @ basis) for way in ways]
        assert min(excess) <= 1e-12


@pytest.mark.parametrize("kind", [WORLD, TOWARDS_POINT])
@given(leak=LEAKS, seed=SEEDS)
@few_examples(20)
def test_the_verifiers_sum_is_above_the_exact_one(kind: int, leak: float, seed: int) -> None:
    """Likewise, with the coordinates that it names itself."""
    rng, family, weights, level, anchor, centre, half = case_of(seed, leak)
    mix = {0: weights[0], 1: weights[1]}
    leaves = make_leaves(1, test=kind, point=anchor, level=level, mixes=(mix,))
    boxes = boxes_at(centre[None], half)
    total, shear = dipole_sum(family.ratios, leaves, boxes, Interval(np.zeros((6, 1)), np.zeros((6, 1))))
    assert kind == TOWARDS_POINT or not shear.on[0]
    basis = shear.basis.middle()[:, :, 0]
    for _ in range(8):
        x = rng.uniform(-1.0, 1.0, 3) * half
        exact = exact_form(family, weights, level, centre + x)
        way = turned_axes(family, anchor, centre, centre + x) if shear.on[0] else np.eye(3)
        bound = matrices(total.high[:, 0] + total.middle()[:, 1:, 0] @ x[:, None])[0]
        assert difference(bound, basis.T @ way.T @ exact @ way @ basis) <= 1e-12


@given(leak=LEAKS, seed=SEEDS)
def test_links_have_their_derivatives(leak: float, seed: int) -> None:
    """Gradient and Hessian by position and axis are those of central differences."""
    rng, family, _, _, anchor, p, _ = case_of(seed, leak)
    pose, step = np.concatenate([p, rng.normal(size=3)]), 1e-5
    none = np.zeros(6), np.zeros((6, 6))

    def at(here: np.ndarray) -> tuple[float, np.ndarray]:
        gradient, hessian = np.zeros(6), np.zeros((6, 6))
        link = link_form(family.ratios, anchor, here[:3], here[3:])
        same = add_form(family.ratios, anchor, 1.0, here[:3], here[3:], gradient, hessian, True)
        assert link == pytest.approx(same, rel=1e-9, abs=1e-18)
        return link, gradient

    gradient, hessian = none
    add_form(family.ratios, anchor, 1.0, pose[:3], pose[3:], gradient, hessian, True)
    for i, e in enumerate(step * np.eye(6)):
        (up, more), (down, less) = at(pose + e), at(pose - e)
        assert gradient[i] == pytest.approx((up - down) / (2 * step), rel=1e-4, abs=1e-9)
        np.testing.assert_allclose(hessian[i], (more - less) / (2 * step), rtol=1e-4, atol=1e-9)


@given(seed=SEEDS)
def test_coordinates_turn_in_small_boxes(seed: int) -> None:
    """They follow the anchor there, by no more than their bound: otherwise nothing would be gained."""
    rng, family, _, _, anchor, centre, _ = case_of(seed, 0.0)
    r, v = family.ratios.points_m[anchor] - centre, family.ratios.ground_axes[anchor]
    if np.any(v) and np.linalg.norm(np.cross(r, v)) < 0.1 * np.linalg.norm(r):  # near the dipole's own null
        return
    way = turned_axes(family, anchor, centre, centre + rng.uniform(-0.01, 0.01, 3))
    boxes = boxes_at(centre[None], 0.01)
    shear = shear_of(family.ratios, make_leaves(1, test=TOWARDS_POINT, point=anchor), boxes)
    assert shear.on[0]
    assert np.linalg.norm(way - np.eye(3), 2) <= shear.sizes[0].high[0] * (1.0 + 1e-9)
