"""Free axes: what is excluded is excluded, with cells, bands, balls and several denominators."""

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from sizes import few_examples
from tests.certificate.plain import (
    boxes_at,
    carried,
    dense_ratios,
    excess_over,
    full,
    link_matrix,
    make_leaves,
    one_box,
    random_family,
    seeds,
)

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, WORLD
from nullpose.certificate.forms import COLUMN, ROW, negative_definite
from nullpose.certificate.frames import expansion, frames_of
from nullpose.certificate.free_test import free_holds, sharper, with_constants
from nullpose.certificate.interval import Interval
from nullpose.channel import LinkChannel
from nullpose.problem.axis_field import AxisField

BANDS = [(0.0, 0.0), (0.0, 0.1), (0.3, 0.3), (0.2, 0.9), (0.75, 1.0), (0.0, 1.0)]


def six_of(matrix: np.ndarray, slack: float = 0.0) -> Interval:
    """Return a symmetric matrix as the form of one box."""
    six = matrix[ROW, COLUMN][:, None]
    return Interval(six - slack, six + slack)


@given(seed=seeds)
def test_definiteness_is_that_of_the_eigenvalues(seed: int) -> None:
    """Clearly negative forms pass, others never; a wide interval passes only if all its members would."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(3, 3))
    matrix = matrix + matrix.T
    matrix *= 10.0 ** rng.uniform(-8, 8)
    size = np.abs(matrix).max()
    matrix -= np.eye(3) * (
        np.linalg.eigvalsh(matrix)[-1] + size * 10.0 ** rng.uniform(-6, 1) * rng.choice([-1, 1])
    )
    top = np.linalg.eigvalsh(matrix)[-1]
    assert negative_definite(six_of(matrix))[0] == (top < 0.0)
    slack = float(size * 10.0 ** rng.uniform(-8, 0))
    if negative_definite(six_of(matrix, slack))[0]:
        noise = slack * rng.choice([-1.0, 1.0], (20, 3, 3))
        noise = np.triu(noise) + np.swapaxes(np.triu(noise, 1), 1, 2)
        assert np.linalg.eigvalsh(matrix + noise).max() < 0.0


def test_undefined_forms_are_not_definite() -> None:
    """Neither zero nor infinity nor not-a-number passes."""
    for bad in (0.0, np.inf, -np.inf, np.nan):
        with np.errstate(all="ignore"):
            for diagonal in ([bad] * 3, [-1.0, -1.0, bad]):
                form = Interval(np.array([*diagonal, 0.0, 0.0, 0.0])[:, None])
                assert not negative_definite(form)[0] or bad == -np.inf
            assert not negative_definite(Interval(np.repeat([[-1.0], [np.nan]], 3, axis=0)))[0]


def dense_side(cell: np.ndarray, side: int) -> np.ndarray:
    """Return the form ``(v - low a)(high a - v)`` of a cell's side."""
    a, v = int(cell[0]), int(cell[0] + 1 + side) % 3
    width = 2.0 * 2.0 ** -float(cell[1 + 2 * side])
    low = -1.0 + width * cell[2 + 2 * side]
    first, second = np.zeros(3), np.zeros(3)
    first[v], first[a] = 1.0, -low
    second[v], second[a] = -1.0, low + width
    return 0.5 * (np.outer(first, second) + np.outer(second, first))


def dense_band(band: tuple[float, float], multiplier: float) -> np.ndarray:
    """Return the form of a band's end, times the multiplier: not negative for axes within the band."""
    upright = np.diag([0.0, 0.0, 1.0])
    if multiplier > 0.0:
        return multiplier * (band[1] * np.eye(3) - upright)
    return -multiplier * (upright - band[0] * np.eye(3))


def random_cell(rng: np.random.Generator) -> np.ndarray:
    """Return a cell of axes."""
    depth = rng.integers(0, 6, 2)
    index = [int(rng.integers(1 << d)) for d in depth]
    return np.array([int(rng.integers(3)), depth[0], index[0], depth[1], index[1]])


def axis_of(rng: np.random.Generator, cell: np.ndarray) -> np.ndarray:
    """Return an axis inside a cell, of any length and sign."""
    u = np.ones(3)
    for side in range(2):
        width = 2.0 * 2.0 ** -float(cell[1 + 2 * side])
        u[(cell[0] + 1 + side) % 3] = -1.0 + width * (cell[2 + 2 * side] + rng.uniform())
    return u * rng.normal()


def axes_within(rng: np.random.Generator, band: tuple[float, float], count: int) -> np.ndarray:
    """Return axes of a band, (count, 3), of any length and sign."""
    upright = np.sqrt(rng.uniform(*band, count))
    turn = rng.uniform(0.0, 2.0 * np.pi, count)
    across = np.sqrt(1.0 - upright**2)
    axes = np.column_stack([across * np.cos(turn), across * np.sin(turn), upright])
    return axes * rng.normal(size=(count, 1))


@pytest.mark.parametrize("turning", [False, True])
@given(seed=seeds)
def test_constant_forms_are_enclosed(turning: bool, seed: int) -> None:
    """Sides of cells and ends of bands are not negative inside, and turned they keep to the expansion."""
    rng = np.random.default_rng(seed)
    family, boxes, cell = random_family(rng, 2, 2), one_box(rng), random_cell(rng)
    band = BANDS[int(rng.integers(len(BANDS)))]
    sides = rng.uniform(0.0, 2.0, (1, 2)) * rng.integers(0, 2, (1, 2))
    ends = rng.uniform(-2.0, 2.0, 1) * rng.integers(0, 2, 1)
    point, test = int(rng.integers(4)), TOWARDS if turning else WORLD
    leaves = make_leaves(1, test=test, point=point, cell=cell, sides=sides, band=ends)
    frames = frames_of(family.ratios, leaves, boxes)
    nothing = Interval(np.zeros((6, 4, 1)))
    total = with_constants(nothing, AxisField.within(*band), leaves, boxes, frames)
    spreads = [sides[0, i] * np.sqrt(2.0) * np.linalg.norm(dense_side(cell, i)) for i in range(2)]
    bend = (1.0 + np.sqrt(2.0)) * (sum(spreads) + abs(ends[0])) / frames.rho_least.low[0] ** 2
    rest = 0.5 * bend * float(boxes.half2.high[0]) * turning
    constant = sum(sides[0, i] * dense_side(cell, i) for i in range(2)) + dense_band(band, ends[0])
    for _ in range(4):
        u = axis_of(rng, cell)
        for side in range(2):
            assert u @ dense_side(cell, side) @ u >= -1e-12 * (u @ u)
        (u,) = axes_within(rng, band, 1)
        assert u @ dense_band(band, ends[0]) @ u >= -1e-12 * (u @ u)
        x = rng.uniform(-1.0, 1.0, 3) * boxes.half[0]
        centre = boxes.centre[0]
        turn = carried(frames.turning[0], family.ratios.points_m[point], centre, centre + x)
        turn = turn @ frames.basis.middle()[:, :, 0]
        bound = full(total[:, 0]) + sum(h * full(total[:, 1 + i]) for i, h in enumerate(x))
        error = turn.T @ constant @ turn - bound
        slack = 1e-11 * (1.0 + np.abs(bound).max())
        assert np.linalg.eigvalsh(error).max() <= slack
        assert np.linalg.eigvalsh(error).min() >= -2.0 * rest - slack


@pytest.mark.parametrize("turning", [False, True])
def test_the_remainder_near_a_null_is_a_bound(turning: bool, channel: LinkChannel | None) -> None:
    """Along any axis a link is at least what the smaller remainder leaves of its expansion."""
    rng = np.random.default_rng(7)
    used, cases = 0, 20
    for _ in range(cases):
        family, boxes = random_family(rng, 2, 2, channel=channel), one_box(rng)
        centre, half = boxes.centre[0], boxes.half[0]
        point, anchor = rng.permutation(len(family.ratios.points_m))[:2]
        point_m, anchor_m = family.ratios.points_m[point], family.ratios.points_m[anchor]
        leaves = make_leaves(1, test=TOWARDS if turning else WORLD, point=anchor)
        frames = frames_of(family.ratios, leaves, boxes)
        near_null = (point_m - centre) / np.linalg.norm(point_m - centre)
        near_null = near_null + rng.normal(size=3) * 10.0 ** rng.uniform(-4.0, 0.0)
        vector = np.linalg.solve(frames.basis.middle()[:, :, 0], near_null / np.linalg.norm(near_null))
        form, down, bend = expansion(family.ratios, frames, boxes, np.array([point]), False)
        plain = down * boxes.half2 * 0.5
        share, rest = sharper(form[:, 0], vector[:, None], boxes, frames, np.array([point]), bend, plain)
        used += share[0] > 0.0
        assert 0.0 <= share[0] < 1.0
        here = vector @ full(form[:, 0]) @ vector
        assert share[0] * here + rest.high[0] <= plain.high[0] * (1.0 + 1e-12)
        corners = rng.choice([-1.0, 1.0], (20, 3)) * rng.choice([1.0, rng.uniform()], (20, 1))
        for x in corners * half:
            turn = carried(frames.turning[0], anchor_m, centre, centre + x) @ frames.basis.middle()[:, :, 0]
            bound = full(form[:, 0]) + sum(h * full(form[:, 1 + i]) for i, h in enumerate(x))
            exact = turn.T @ link_matrix(point_m - centre - x, family.ratios.leak) @ turn
            exact = exact * excess_over(family, centre + x)[point]
            excess = np.linalg.eigvalsh(exact - (1.0 - share[0]) * bound)[0] + rest.high[0]
            assert excess >= -1e-12 * np.trace(exact)
    assert 0.1 * cases < used < cases


def mixes_of(rng: np.random.Generator, ratios: int, count: int) -> tuple[dict[int, float], ...]:
    """Return some mixes of ratios, some with one ratio only."""
    drawn = rng.dirichlet(np.ones(ratios), count) ** rng.choice([1.0, 3.0], (count, 1))
    return tuple({int(k): float(w) for k, w in enumerate(row) if w > 1e-3} for row in drawn)


@few_examples(2)
@given(groups=st.sampled_from([1, 3]), keep_out_m=st.sampled_from([1.0, 20.0]), seed=seeds)
def test_no_pose_of_an_excluded_box_reaches_the_level(
    groups: int, keep_out_m: float, channel: LinkChannel | None, seed: int
) -> None:
    """Whatever frame, mix, cell, band or ball: allowed poses of excluded boxes stay below the level."""
    rng = np.random.default_rng(seed)
    count, ratios = 60, int(rng.integers(1, 5))
    family = random_family(rng, ratios, 2, keep_out_m=keep_out_m, groups=groups, channel=channel)
    boxes = boxes_at(
        rng.uniform([-20.0, -20.0, 10.0], [80.0, 80.0, 30.0], (count, 3)),
        10.0 ** rng.uniform(-2.0, 0.5, (count, 3)),
    )
    band = BANDS[int(rng.integers(len(BANDS)))]
    best = [dense_ratios(family, p, axes_within(rng, band, 200)).min(axis=1).max() for p in boxes.centre]
    cell = np.array([random_cell(rng) for _ in range(count)])
    cell[::2] = [-1, 0, 0, 0, 0]
    level = np.array(best) * 10.0 ** rng.uniform(-0.3, 0.8, count)
    leaves = make_leaves(
        count,
        test=rng.choice([WORLD, TOWARDS], count),
        point=rng.integers(len(family.ratios.points_m), size=count),
        level=level,
        mix=np.arange(count),
        mixes=mixes_of(rng, ratios, count),
        cell=cell,
        sides=rng.uniform(0.0, 3.0, (count, 2)) * rng.integers(0, 2, (count, 2)),
        band=level * rng.uniform(-1.0, 1.0, count) * rng.integers(0, 2, count),
        ball=rng.integers(-1, len(family.ratios.points_m), count),
        ball_multiplier=10.0 ** rng.uniform(-4.0, 0.0, count) * rng.integers(0, 2, count),
    )
    with np.errstate(all="ignore"):
        holds = free_holds(family, AxisField.within(*band), leaves, boxes)
    assume(np.any(holds))
    assert not np.all(holds)
    tried = 0
    for b in np.flatnonzero(holds):
        p = boxes.centre[b] + rng.uniform(-1.0, 1.0, (20, 3)) * boxes.half[b]
        u = axes_within(rng, band, 20)
        fine = np.linalg.norm(family.ratios.points_m - p[:, None], axis=2).min(axis=1) >= keep_out_m
        if cell[b, 0] >= 0:
            u = np.array([axis_of(rng, cell[b]) for _ in p])
            upright2 = u[:, 2] ** 2 / np.sum(u * u, axis=1)
            fine &= (band[0] <= upright2) & (upright2 <= band[1])
        tried += np.count_nonzero(fine)
        assert np.all(dense_ratios(family, p, u).min(axis=1)[fine] < leaves.level[b])
    assume(tried)


def test_multipliers_of_a_band_count() -> None:
    """At a level that some axis reaches and none of the band does, a multiplier of the band excludes."""
    rng = np.random.default_rng(11)
    hits = 0
    for _ in range(20):
        family = random_family(rng, 1, 2)
        boxes = one_box(rng)
        boxes = Boxes(leaf=boxes.leaf, centre=boxes.centre, half=boxes.half * 1e-3)
        centre = boxes.centre[0]
        steep, any_axis = (
            dense_ratios(family, centre, axes_within(rng, band, 2000)).min(axis=1).max()
            for band in ((0.75, 1.0), (0.0, 1.0))
        )
        if any_axis < 1.2 * steep:
            continue
        hits += 1
        level = np.array([1.1 * steep])
        sizes = level[0] * np.concatenate([[0.0], -(10.0 ** np.linspace(-3, 2, 60))])
        leaves = make_leaves(len(sizes), level=level, band=sizes)
        alike = boxes.chosen(np.zeros(len(sizes), dtype=np.int64))
        held = free_holds(family, AxisField.within(0.75, 1.0), leaves, alike)
        assert not held[0]
        assert np.any(held)
        assert not np.any(free_holds(family, AxisField.within(0.0, 1.0), leaves, alike))
    assert hits > 3
