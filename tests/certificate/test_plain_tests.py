"""Distances alone: what is called out of reach is, and so is what a root box leaves out."""

import numpy as np
from hypothesis import given
from tests.certificate.plain import boxes_at, dense_ratios, make_leaves, random_family, seeds

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.plain_tests import far_holds, kept_out, root_holds
from nullpose.problem.axis_field import AxisField


def some_boxes(rng: np.random.Generator, count: int) -> Boxes:
    """Return boxes above the field, one for each leaf."""
    return boxes_at(
        rng.uniform([-40.0, -40.0, 5.0], [100.0, 100.0, 30.0], (count, 3)),
        10.0 ** rng.uniform(-2.0, 1.0, (count, 3)),
    )


def inside(rng: np.random.Generator, boxes: Boxes, b: int, count: int) -> np.ndarray:
    """Return positions of a box, corners among them."""
    shifts = rng.uniform(-1.0, 1.0, (count, 3))
    shifts[: count // 2] = np.sign(shifts[: count // 2])
    return boxes.centre[b] + shifts * boxes.half[b]


def nearest_m(boxes: Boxes, b: int, point: np.ndarray) -> float:
    """Return the distance from a point to a box."""
    return float(np.linalg.norm(np.maximum(np.abs(point - boxes.centre[b]) - boxes.half[b], 0.0)))


@given(seed=seeds)
def test_far_is_far(seed: int) -> None:
    """No allowed pose of a box that is out of reach gives all nodes the level; just out of reach is told."""
    rng = np.random.default_rng(seed)
    groups = int(rng.integers(1, 4))
    family = random_family(rng, 3, 1, keep_out_m=float(rng.choice([1.0, 12.0])), groups=groups)
    boxes = some_boxes(rng, 30)
    level = 10.0 ** rng.uniform(-1.0, 2.0, 30)
    distances = [[nearest_m(boxes, b, at) for at in family.ratios.points_m[:3]] for b in range(30)]
    reach = np.maximum(distances, family.domain.keep_out_m)
    top = family.ratios.numerator_isotropic + family.ratios.numerator_weight / reach**2
    exact = np.min(top / family.ratios.denominator_isotropic[family.ratios.denominator_of], axis=1)
    level[::2] = exact[::2] * (1.0 + 1e-9 * np.sign(rng.normal(size=15)))
    holds = far_holds(
        family, AxisField.free(), make_leaves(30, point=np.zeros(30, dtype=int), level=level), boxes
    )
    assert np.array_equal(holds, exact < level)
    for b in np.flatnonzero(holds):
        p = inside(rng, boxes, b, 6)
        allowed = (
            np.linalg.norm(family.ratios.points_m - p[:, None], axis=2).min(axis=1)
            >= family.domain.keep_out_m
        )
        ratios = dense_ratios(family, p, rng.normal(size=(6, 3))).min(axis=1)
        assert np.all(ratios[allowed] <= level[b])


@given(seed=seeds)
def test_kept_out_is_inside_the_ball(seed: int) -> None:
    """A box is kept out if its farthest corner is in the ball, to rounding."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, 3, 1, keep_out_m=25.0)
    boxes = some_boxes(rng, 40)
    ball = rng.integers(4, size=40)
    away = np.abs(family.domain.keep_out_points_m[ball] - boxes.centre) + boxes.half
    farthest = np.linalg.norm(away, axis=1)
    holds = kept_out(family, ball, boxes)
    assert np.array_equal(holds, farthest < 25.0)
    larger = family.changed(keep_out_m=float(farthest[0]) * (1.0 + 1e-12))
    smaller = family.changed(keep_out_m=float(farthest[0]) * (1.0 - 1e-12))
    assert kept_out(larger, ball, boxes)[0]
    assert not kept_out(smaller, ball, boxes)[0]
    none = family.changed(keep_out_points_m=np.zeros((0, 3)))
    assert not np.any(kept_out(none, ball, boxes))


@given(seed=seeds)
def test_nothing_beyond_the_root_beats_the_bound(seed: int) -> None:
    """A root passes exactly if beyond each face one node, at its best, stays within the bound."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, 3, 1, groups=int(rng.integers(1, 4)))
    bound = float(10.0 ** rng.uniform(0.0, 1.5))
    lack = (
        bound * family.ratios.denominator_isotropic[family.ratios.denominator_of]
        - family.ratios.numerator_isotropic
    )
    radius = np.sqrt(family.ratios.numerator_weight / np.maximum(lack, 1e-300))
    points = family.ratios.points_m[:3]
    gaps = np.maximum(0.0, np.maximum(family.domain.low_m - points, points - family.domain.high_m)) ** 2
    others = np.sum(gaps, axis=1, keepdims=True) - gaps  # from all of the airspace along the other axes
    left = np.sqrt(np.maximum(0.0, radius[:, None] ** 2 - others))
    low, high = np.max(points - left, axis=0), np.min(points + left, axis=0)
    wide = np.array([low - 1e-6 * radius.max(), high + 1e-6 * radius.max()])
    assert np.all(lack > 0.0)
    assert root_holds(family, wide, bound) == ""
    for side, i in ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2)):
        narrow = wide.copy()
        narrow[side, i] += 2e-6 * radius.max() * (1.0 if side == 0 else -1.0)
        fault = root_holds(family, narrow, bound)
        end = (family.domain.low_m if side == 0 else family.domain.high_m)[i]
        enough = narrow[side, i] <= end if side == 0 else narrow[side, i] >= end
        enough |= bool(np.any(radius**2 < others[:, i]))  # of some node everything is out of reach
        assert (fault == "") == bool(enough)
        assert enough or f"ends at {'xyz'[i]} = " in fault
