"""Free axes: the expansions enclose the forms they stand for, and what they exclude is excluded."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, WORLD
from nullpose.certificate.free_test import (
    Frames,
    add_sides,
    expansion,
    frames_of,
    free_holds,
    negative_definite,
    projector,
    turning_rate,
)
from nullpose.certificate.interval import Interval
from nullpose.family import Family

seeds = st.integers(0, 2**32 - 1)

SIX = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def full(six: list[Interval], b: int = 0) -> np.ndarray:
    """Return the middle of a form of six intervals as a matrix."""
    matrix = np.empty((3, 3))
    for x, (i, j) in zip(six, SIX, strict=True):
        matrix[i, j] = matrix[j, i] = x.middle()[b]
    return matrix


def six_of(matrix: np.ndarray, slack: float = 0.0) -> list[Interval]:
    """Return a symmetric matrix as six intervals for one box."""
    return [Interval([matrix[i, j] - slack], [matrix[i, j] + slack]) for i, j in SIX]


def one_box(rng: np.random.Generator) -> Boxes:
    """Return a box above the field."""
    return Boxes(
        leaf=np.zeros(1, dtype=np.int64),
        centre=rng.uniform([-30.0, -30.0, 9.0], [80.0, 80.0, 30.0], (1, 3)),
        half=rng.uniform(0.05, 1.5, (1, 3)),
    )


def carried(family: Family, frames: Frames, centre: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return the rotation that carries the world frame at the centre along a straight line to p.

    The direction to a point turns in one plane along the line: the least rotation between its ends is it.
    """
    if not frames.turning[0]:
        return np.eye(3)
    anchor = family.points_m[frames.anchor[0]]
    d, e = anchor - centre, anchor - p
    d, e = d / np.linalg.norm(d), e / np.linalg.norm(e)
    axis = np.cross(d, e)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + d @ e)


def framed(family: Family, boxes: Boxes, turning: bool, rng: np.random.Generator, make: Callable) -> Frames:
    """Return the frames of one box, standing still or turning towards some point."""
    point = np.array([int(rng.integers(len(family.points_m)))])
    leaves = make(
        1, test=np.array([TOWARDS if turning else WORLD]), point=point if turning else point * 0 - 1
    )
    return frames_of(family, leaves, boxes)


@pytest.mark.parametrize("turning", [False, True])
@settings(max_examples=50)
@given(seed=seeds)
def test_expansions_enclose_the_forms(
    turning: bool, seed: int, random_family: Callable, make_leaves: Callable, link_matrix: Callable
) -> None:
    """Value, slopes and remainder enclose the turned form of every point all over the box."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 3, 2), one_box(rng)
    frames = framed(family, boxes, turning, rng, make_leaves)
    basis, gram = frames.basis[0], full(frames.gram)
    for x in rng.uniform(-1.0, 1.0, (3, 3)) * boxes.half[0]:
        p = boxes.centre[0] + x
        rotation = carried(family, frames, boxes.centre[0], p)
        for j in range(len(family.points_m)):
            form, slopes, up, down = expansion(family, frames, boxes, np.array([j]))
            turned = basis.T @ rotation.T @ link_matrix(family.points_m[j] - p) @ rotation @ basis
            error = turned - full(form) - sum(h * full(s) for h, s in zip(x, slopes, strict=True))
            around = full(projector(frames)) if turning and j == frames.anchor[0] else gram
            reach = 0.5 * float(x @ x)
            slack = 1e-12 * np.abs(turned).max()
            assert np.linalg.eigvalsh(error - up.high[0] * reach * around)[-1] <= slack
            assert np.linalg.eigvalsh(error + down.high[0] * reach * around)[0] >= -slack


@given(seed=seeds)
def test_the_form_at_the_centre_is_exact(
    seed: int, random_family: Callable, make_leaves: Callable, link_matrix: Callable
) -> None:
    """Intervals of the value are narrow and hold the form in the basis; an anchor has its null there."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 2, 2), one_box(rng)
    frames = framed(family, boxes, True, rng, make_leaves)
    basis = frames.basis[0]
    assert basis.T @ basis == pytest.approx(np.eye(3), abs=1e-14)
    for j in range(4):
        form, _, _, _ = expansion(family, frames, boxes, np.array([j]))
        exact = basis.T @ link_matrix(family.points_m[j] - boxes.centre[0]) @ basis
        for x, (i, k) in zip(form, SIX, strict=True):
            slack = 1e-14 * np.abs(exact).max()
            assert x.low[0] - slack <= exact[i, k] <= x.high[0] + slack
            assert x.high[0] - x.low[0] <= 1e-12 * np.abs(exact).max()


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
            assert not negative_definite([Interval([bad])] * 3 + [Interval([0.0])] * 3)[0] or bad == -np.inf
            assert not negative_definite([Interval([-1.0])] * 2 + [Interval([bad])] + [Interval([0.0])] * 3)[
                0
            ] or (bad == -np.inf)
            assert not negative_definite([Interval([-1.0])] * 3 + [Interval([np.nan])] * 3)[0]


def dense_side(cell: np.ndarray, side: int) -> np.ndarray:
    """Return the form ``(v - low a)(high a - v)`` of a cell's side."""
    a, v = int(cell[0]), int(cell[0] + 1 + side) % 3
    width = 2.0 * 2.0 ** -float(cell[1 + 2 * side])
    low = -1.0 + width * cell[2 + 2 * side]
    first, second = np.zeros(3), np.zeros(3)
    first[v], first[a] = 1.0, -low
    second[v], second[a] = -1.0, low + width
    return 0.5 * (np.outer(first, second) + np.outer(second, first))


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


@given(seed=seeds)
def test_turning_rates_are_derivatives(seed: int, random_family: Callable, make_leaves: Callable) -> None:
    """The rate of a turned constant form agrees with differences of the frame that is carried along."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 2, 2), one_box(rng)
    frames = framed(family, boxes, True, rng, make_leaves)
    q = rng.normal(size=(3, 3))
    q = q + q.T
    centre, step = boxes.centre[0], 1e-4
    for e in range(3):
        ends = [carried(family, frames, centre, centre + s * step * np.eye(3)[e]) for s in (-1.0, 1.0)]
        change = (ends[1].T @ q @ ends[1] - ends[0].T @ q @ ends[0]) / (2.0 * step)
        assert turning_rate(frames, Interval(q[None]), e).middle()[0] == pytest.approx(change, abs=1e-7)


@pytest.mark.parametrize("turning", [False, True])
@given(seed=seeds)
def test_sides_of_cells_are_enclosed(
    turning: bool, seed: int, random_family: Callable, make_leaves: Callable
) -> None:
    """An axis in a cell makes its sides not negative; over the box the turned sides keep to the expansion."""
    rng = np.random.default_rng(seed)
    family, boxes, cell = random_family(rng, 2, 2), one_box(rng), random_cell(rng)
    sides = rng.uniform(0.0, 2.0, (1, 2)) * rng.integers(0, 2, (1, 2))
    point = np.array([int(rng.integers(4))])
    test = np.array([TOWARDS if turning else WORLD])
    leaves = make_leaves(1, test=test, point=point, cell=cell[None], sides=sides)
    frames = frames_of(family, leaves, boxes)
    zero = Interval(np.zeros(1))
    matrix, slopes = [zero] * 6, [[zero] * 6 for _ in range(3)]
    rest = add_sides(leaves, boxes, frames, boxes.half2 * 0.5, matrix, slopes, zero)
    constant = sides[0, 0] * dense_side(cell, 0) + sides[0, 1] * dense_side(cell, 1)
    for _ in range(4):
        u = axis_of(rng, cell)
        for side in range(2):
            assert u @ dense_side(cell, side) @ u >= -1e-12 * (u @ u)
        x = rng.uniform(-1.0, 1.0, 3) * boxes.half[0]
        turn = carried(family, frames, boxes.centre[0], boxes.centre[0] + x) @ frames.basis[0]
        bound = full(matrix) + sum(h * full(s) for h, s in zip(x, slopes, strict=True))
        error = turn.T @ constant @ turn - bound
        assert np.abs(np.linalg.eigvalsh(error)).max() <= float(rest.high[0]) + 1e-11
        if not turning:
            assert float(rest.high[0]) <= 1e-300


def mixes_of(rng: np.random.Generator, ratios: int, count: int) -> tuple[dict[int, float], ...]:
    """Return some mixes of ratios, some with one ratio only."""
    drawn = rng.dirichlet(np.ones(ratios), count) ** rng.choice([1.0, 3.0], (count, 1))
    return tuple({int(k): float(w) for k, w in enumerate(row) if w > 1e-3} for row in drawn)


@pytest.mark.parametrize("keep_out_m", [1.0, 20.0])
@settings(max_examples=5)
@given(seed=seeds)
def test_no_pose_of_an_excluded_box_reaches_the_level(
    keep_out_m: float, seed: int, random_family: Callable, make_leaves: Callable, dense_ratios: Callable
) -> None:
    """Whatever frame, mix, cell or ball: allowed poses of excluded boxes stay below the level."""
    rng = np.random.default_rng(seed)
    count, ratios = 60, int(rng.integers(1, 5))
    family = random_family(rng, ratios, 2, keep_out_m=keep_out_m)
    boxes = Boxes(
        leaf=np.arange(count),
        centre=rng.uniform([-20.0, -20.0, 10.0], [80.0, 80.0, 30.0], (count, 3)),
        half=10.0 ** rng.uniform(-2.0, 0.5, (count, 3)),
    )
    best = [max(dense_ratios(family, p, u).min() for u in rng.normal(size=(200, 3))) for p in boxes.centre]
    cell = np.array([random_cell(rng) for _ in range(count)])
    cell[::2] = [-1, 0, 0, 0, 0]
    leaves = make_leaves(
        count,
        test=rng.choice([WORLD, TOWARDS], count),
        point=rng.integers(len(family.points_m), size=count),
        level=np.array(best) * 10.0 ** rng.uniform(-0.3, 0.8, count),
        mix=np.arange(count),
        mixes=mixes_of(rng, ratios, count),
        cell=cell,
        sides=rng.uniform(0.0, 3.0, (count, 2)) * rng.integers(0, 2, (count, 2)),
        ball=rng.integers(-1, len(family.points_m), count),
        ball_multiplier=10.0 ** rng.uniform(-4.0, 0.0, count) * rng.integers(0, 2, count),
    )
    with np.errstate(all="ignore"):
        holds = free_holds(family, leaves, boxes)
    assert np.any(holds)
    assert not np.all(holds)
    for b in np.flatnonzero(holds):
        for _ in range(20):
            p = boxes.centre[b] + rng.uniform(-1.0, 1.0, 3) * boxes.half[b]
            if np.min(np.linalg.norm(family.points_m - p, axis=1)) < keep_out_m:
                continue
            u = axis_of(rng, cell[b]) if cell[b, 0] >= 0 else rng.normal(size=3)
            assert dense_ratios(family, p, u).min() < leaves.level[b]
