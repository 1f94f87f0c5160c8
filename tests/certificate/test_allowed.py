"""Zones and balls with multipliers: they help, and what they help to exclude is excluded."""

from dataclasses import replace

import numpy as np
import pytest
from tests.certificate.plain import boxes_at, dense_forms, dense_ratios, make_leaves, random_family

from nullpose.certificate.affine_test import affine_holds
from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import AFFINE, TOWARDS, WORLD, Leaves
from nullpose.certificate.free_test import free_holds
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family

# a notched block with a floor and a ceiling, a cylinder, and a fence with a corner that points inwards
BLOCK = np.array([[10.0, 10.0], [40.0, 10.0], [40.0, 40.0], [25.0, 20.0], [10.0, 40.0]])
FENCE = np.array([[-20.0, -20.0], [80.0, -20.0], [80.0, 80.0], [30.0, 60.0], [-20.0, 80.0]])
CIRCLE = np.array([[55.0, 15.0, 12.0, 0.0]])


def zoned(family: Family) -> Family:
    """Return a family with a zone of each kind and no ball."""
    block, fence = (np.hstack([each, np.roll(each, -1, axis=0)]) for each in (BLOCK, FENCE))
    return family.changed(
        keep_out_points_m=np.zeros((0, 3)),
        zone_kind=np.array([0, 1, 2]),
        zone_start=np.array([0, 5, 6, 11]),
        zone_edges=np.vstack([block, CIRCLE, fence]),
        zone_range_m=np.array([[9.0, 20.0], [-np.inf, np.inf], [-np.inf, np.inf]]),
    )


def inside(outline: np.ndarray, p: np.ndarray) -> bool:
    """Return whether a point is inside a polygon, by the angle that it turns through as seen from there."""
    first, last = outline - p[:2], np.roll(outline, -1, axis=0) - p[:2]
    across = first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0]
    return bool(abs(np.sum(np.arctan2(across, np.sum(first * last, axis=1)))) > np.pi)


def allows(zone: int, p: np.ndarray) -> bool:
    """Return whether a zone allows a position."""
    if zone == 0:
        return not (9.0 < p[2] < 20.0 and inside(BLOCK, p))
    if zone == 1:
        return bool(np.hypot(*(p[:2] - CIRCLE[0, :2])) >= CIRCLE[0, 2])
    return inside(FENCE, p)


def boxes_at_borders(rng: np.random.Generator, count: int) -> tuple[Boxes, np.ndarray]:
    """Return boxes across the borders of zones, on walls, corners and ceilings, and their zones."""
    zone = rng.integers(3, size=count)
    centre = np.empty((count, 3))
    half = 10.0 ** rng.uniform(-3.0, -0.5, (count, 3))
    for b in range(count):
        outline = BLOCK if zone[b] == 0 else FENCE
        e = int(rng.integers(5))
        share = float(rng.choice([0.0, rng.uniform(0.1, 0.9)]))
        centre[b, :2] = outline[e] + share * (outline[(e + 1) % 5] - outline[e])
        centre[b, 2] = rng.choice([9.0, 14.0, 20.0]) if zone[b] == 0 else rng.uniform(9.0, 29.0)
        if zone[b] == 1:
            turn = rng.uniform(0.0, 2.0 * np.pi)
            centre[b, :2] = CIRCLE[0, :2] + CIRCLE[0, 2] * np.array([np.cos(turn), np.sin(turn)])
    centre += rng.uniform(-0.9, 0.9, (count, 3)) * half
    return boxes_at(centre, half), zone


def greatest(field: AxisField, forms: tuple[np.ndarray, np.ndarray]) -> float:
    """Return the greatest ratio of two forms over the axes of a field."""
    above, below = forms
    if not field.is_free:
        return float(above[2, 2] / below[2, 2])
    some = slice(2 if field.band[1] == 0.0 else 3)
    return float(np.linalg.eigvals(np.linalg.solve(below[some, some], above[some, some])).real.max())


def excluded(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes are excluded by the test that goes with a field."""
    with np.errstate(all="ignore"):
        return (free_holds if field.is_free else affine_holds)(family, field, leaves, boxes)


@pytest.mark.parametrize("field", [AxisField.free(), AxisField.within(0.0, 0.0), AxisField.vertical()])
def test_no_allowed_pose_of_an_excluded_box_reaches_the_level(field: AxisField) -> None:
    """At levels that forbidden positions of a box may reach, and allowed ones may or may not."""
    helped, count = 0, 60
    for seed in range(3):
        rng = np.random.default_rng(seed)
        family = zoned(random_family(rng, 1, 2))
        boxes, zone = boxes_at_borders(rng, count)
        tops = np.empty((count, 2))
        for b in range(count):
            places = boxes.centre[b] + np.sign(rng.normal(size=(12, 3))) * boxes.half[b]
            values = np.array([greatest(field, dense_forms(family, p)) for p in places])
            fine = np.array([allows(int(zone[b]), p) for p in places])
            tops[b] = values[fine].max(initial=values.min()), values.max()
        level = tops[:, 0] + rng.uniform(-0.1, 1.1, count) * (tops[:, 1] - tops[:, 0])
        kind = np.full(count, AFFINE) if not field.is_free else rng.choice([WORLD, WORLD, TOWARDS], count)
        point = rng.integers(len(family.ratios.points_m), size=count)
        leaves = make_leaves(count, test=kind, level=level, ball=zone, point=point)
        holds = excluded(family, field, leaves, boxes)
        without = excluded(family, field, replace(leaves, ball=np.full(count, -1)), boxes)
        assert np.all(holds[without])
        helped += np.count_nonzero(holds & ~without)
        for b in np.flatnonzero(holds):
            shifts = rng.uniform(-1.0, 1.0, (30, 3))
            shifts[:15] = np.sign(shifts[:15])
            for p in boxes.centre[b] + shifts * boxes.half[b]:
                if allows(int(zone[b]), p):
                    assert greatest(field, dense_forms(family, p)) < level[b]
    assert helped > 7


@pytest.mark.parametrize("field", [AxisField.free(), AxisField.vertical()])
@pytest.mark.parametrize("zone", [0, 1, 2])
def test_zones_help(zone: int, field: AxisField) -> None:
    """Small boxes across a wall are excluded at levels that their forbidden part alone reaches."""
    rng = np.random.default_rng(7)
    family = zoned(random_family(rng, 1, 0))
    out = {0: [25.0, 10.0, 14.0], 1: [43.0, 15.0, 14.0], 2: [-20.0, 10.0, 14.0]}[zone]
    way = {0: [0.0, 1.0, 0.0], 1: [1.0, 0.0, 0.0], 2: [-1.0, 0.0, 0.0]}[zone]
    # a node behind the wall is nearer to positions that are forbidden
    points = np.array([np.array(out) + 20.0 * np.array(way)])
    family = family.changed(points_m=points, numerator_isotropic=np.zeros(1))
    boxes = boxes_at(np.array([out]), 0.01)
    upright = np.array([0.0, 0.0, 1.0])
    level = float(dense_ratios(family, np.array(out), upright).min()) * (1.0 + 1e-5)
    leaves = make_leaves(1, test=WORLD if field.is_free else AFFINE, level=level, ball=zone)
    assert excluded(family, field, leaves, boxes)[0]
    assert not excluded(family, field, replace(leaves, level=leaves.level * (1.0 - 2e-5)), boxes)[0]
    for other in {-1, 0, 1, 2} - {zone}:
        assert not excluded(family, field, replace(leaves, ball=np.array([other])), boxes)[0]


def test_corners_help() -> None:
    """In a notch both walls count at once; round a corner each of them must do."""
    rng = np.random.default_rng(8)
    family = zoned(random_family(rng, 1, 0))
    upright = np.array([0.0, 0.0, 1.0])
    cases = [
        (0, [25.0, 20.0, 14.0], [0.0, -1.0, 0.0], True),  # the notch, the node behind it
        (0, [25.0, 20.0, 14.0], [0.0, 1.0, 0.0], False),  # the node in front of it
        (2, [80.0, -20.0, 14.0], [1.0, -1.0, 0.0], True),  # a corner of the fence
        (2, [30.0, 60.0, 14.0], [0.0, 1.0, 0.0], True),  # pointing inwards: round it on either side
    ]
    for zone, at, way, expected in cases:
        here = family.changed(
            points_m=np.array([at]) + 15.0 * np.array([way]), numerator_isotropic=np.zeros(1)
        )
        boxes = boxes_at(np.array([at]), 1e-3)
        steepness = 1e-4 if expected else 1e-6
        level = float(dense_ratios(here, np.array(at), upright).min()) * (1.0 + steepness)
        leaves = make_leaves(1, level=level, ball=zone)
        held = free_holds(here, AxisField.free(), leaves, boxes)[0]
        plain = free_holds(here, AxisField.free(), replace(leaves, ball=np.array([-1])), boxes)[0]
        assert (held, plain) == (expected, False), (zone, at)


@pytest.mark.parametrize("field", [AxisField.free(), AxisField.within(0.0, 0.0), AxisField.vertical()])
def test_balls_curve(field: AxisField) -> None:
    """A ball in the middle of a box excludes none of what is around it, whatever its multiplier."""
    family = random_family(np.random.default_rng(9), 1, 1)
    family = family.changed(keep_out_points_m=np.array([[20.0, 20.0, 60.0]]), keep_out_m=1.0)
    test = WORLD if field.is_free else AFFINE
    for half, expected in ((0.5, True), (0.6, False), (2.0, False)):
        boxes = boxes_at(family.domain.keep_out_points_m.copy(), half)
        for multiplier in (1.0, 1e3, 1e6):
            leaves = make_leaves(1, test=test, level=1e-6, ball=0, ball_multiplier=multiplier)
            assert excluded(family, field, leaves, boxes)[0] == (expected and multiplier > 1.0)
