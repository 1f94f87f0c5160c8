"""Boxes of floating-point numbers contain the exact dyadic ones, and their parts cover them."""

from fractions import Fraction

import numpy as np
from hypothesis import given, strategies as st
from tests.certificate.plain import boxes_at, make_leaves, seeds

from nullpose.certificate.boxes import Boxes, boxes_of, parts, uncovered
from nullpose.certificate.pose_value import exact
from nullpose.certificate.weighted_sum import mix_slots

ends = st.one_of(
    st.floats(-1e3, 1e3),
    st.floats(-1e9, 1e9),
    st.sampled_from([0.0, 8.0, 30.0, -1e-300, 1e-300, 5e-324, 0.1, -0.1]),
)
sides = st.tuples(ends, ends).map(sorted)
places = st.integers(0, 50).flatmap(lambda d: st.tuples(st.just(d), st.integers(0, (1 << d) - 1)))


def span(boxes: Boxes, b: int, i: int) -> tuple[Fraction, Fraction]:
    """Return the exact ends of a box along one axis."""
    centre, half = Fraction(float(boxes.centre[b, i])), Fraction(float(boxes.half[b, i]))
    return centre - half, centre + half


@given(root=st.tuples(sides, sides, sides), place=st.tuples(places, places, places))
def test_boxes_contain_the_exact_ones(root: tuple, place: tuple) -> None:
    """Centre and half side, and the hull, enclose the dyadic part of the root, and hardly more."""
    leaves = make_leaves(1, box=[x for pair in place for x in pair])
    boxes = boxes_of(np.array(root).T, leaves)
    hull = boxes.hull
    for i, ((low, high), (depth, index)) in enumerate(zip(root, place, strict=True)):
        side = Fraction(high) - Fraction(low)
        first = Fraction(low) + side * Fraction(index, 1 << depth)
        last = Fraction(low) + side * Fraction(index + 1, 1 << depth)
        below, above = span(boxes, 0, i)
        assert below <= first <= last <= above
        assert float(hull.low[i, 0]) <= below <= above <= float(hull.high[i, 0])
        slack = Fraction(1, 10**14) * (abs(Fraction(low)) + abs(Fraction(high))) + Fraction(1, 10**300)
        assert above - below <= last - first + slack


@given(root=st.tuples(sides, sides, sides), place=st.tuples(places, places, places))
def test_parts_cover_their_parent(root: tuple, place: tuple) -> None:
    """The eight parts meet in the middle and reach the ends, along every axis, and keep the leaf."""
    leaves = make_leaves(1, box=[x for pair in place for x in pair])
    boxes = boxes_of(np.array(root).T, leaves)
    eight = parts(boxes)
    assert eight.leaf.tolist() == [0] * 8
    for i in range(3):
        low, high = span(boxes, 0, i)
        firsts = [span(eight, c, i) for c in range(8) if not c >> i & 1]
        seconds = [span(eight, c, i) for c in range(8) if c >> i & 1]
        assert max(a for a, _ in firsts) <= low
        assert min(b for _, b in firsts) >= max(a for a, _ in seconds)
        assert min(b for _, b in seconds) >= high


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1e-6, 1.0, 1e6]))
def test_distances_are_bounds(seed: int, scale: float) -> None:
    """No exact position of a box is nearer or farther than the bounds, and the bounds are met."""
    rng = np.random.default_rng(seed)
    boxes = boxes_at(
        scale * rng.normal(size=(1, 3)), scale * rng.uniform(0.0, 1.0, (1, 3)) * rng.integers(0, 2, (1, 3))
    )
    point = scale * rng.normal(size=3)
    low, high = np.array([span(boxes, 0, i) for i in range(3)]).T
    q = exact(point)
    near2 = sum(max(a - x, x - b, Fraction(0)) ** 2 for a, b, x in zip(low, high, q, strict=True))
    far2 = sum(max(abs(a - x), abs(b - x)) ** 2 for a, b, x in zip(low, high, q, strict=True))
    half2 = sum(((b - a) / 2) ** 2 for a, b in zip(low, high, strict=True))
    distance2 = boxes.distance2(point[None])
    assert float(distance2.low[0]) <= near2
    assert float(distance2.high[0]) >= far2
    assert float(boxes.half2.low[0]) <= half2 <= float(boxes.half2.high[0])
    assert float(distance2.high[0]) <= float(far2) * (1.0 + 1e-13)
    assert float(distance2.low[0]) >= float(near2) - 1e-13 * float(far2)


def test_mixes_fill_slots() -> None:
    """Each box gets its leaf's mix; unused slots, and leaves without a mix, weigh nothing."""
    leaves = make_leaves(3, mix=[1, -1, 0], mixes=({2: 0.25, 0: 0.75}, {1: 1.0}))
    ratio, weight = mix_slots(leaves.chosen(np.array([2, 0, 1])))
    assert ratio[:, 0].tolist() == [2, 0]
    assert weight.tolist() == [[0.25, 1.0, 0.0], [0.75, 0.0, 0.0]]
    none = make_leaves(1, mix=-1, mixes=())
    assert mix_slots(none)[1].tolist() == [[0.0]]


Row = tuple[int, ...]  # depth and index along x, y, z; face; depth and index along two sides

ROOT: Row = (0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0)
DEEPEST = 3  # of the small trees that are judged by counting cells
COUNTED = 1 << DEEPEST


def halves(row: Row, column: int) -> list[Row]:
    """Return the two parts of a row, cut across the direction whose depth is in a column."""
    depth, index = row[column], row[column + 1]
    return [(*row[:column], depth + 1, 2 * index + half, *row[column + 2 :]) for half in range(2)]


def random_tree(rng: np.random.Generator, splits: int, deepest: int = 50) -> list[Row]:
    """Return the leaves of a tree made by random splits of positions and of axes."""
    rows = [ROOT]
    for _ in range(splits):
        row = rows.pop(rng.integers(len(rows)))
        columns = [c for c in (0, 2, 4, *((7, 9) if row[6] >= 0 else ())) if row[c] < deepest]
        if row[6] < 0:
            columns.append(6)
        if not columns:
            rows.append(row)
            continue
        column = columns[rng.integers(len(columns))]
        rows += [(*row[:6], f, 0, 0, 0, 0) for f in range(3)] if column == 6 else halves(row, column)
    return rows


def gaps(rows: list[Row]) -> str:
    """Return what the checker says of rows."""
    table = np.array(rows, dtype=np.int64).reshape(-1, 11)
    words = uncovered(make_leaves(len(table), box=table[:, :6], cell=table[:, 6:]))
    return words.removeprefix("the leaves do not cover the root: ")


def counted(rows: list[Row]) -> bool:
    """Return whether rows cover everything, by counting the cells of the finest grid."""
    grid = np.zeros((3,) + (COUNTED,) * 5, dtype=bool)
    for row in rows:
        places = [
            slice(row[c + 1] << DEEPEST - row[c], row[c + 1] + 1 << DEEPEST - row[c]) for c in (0, 2, 4, 7, 9)
        ]
        if row[6] < 0:
            grid[:, places[0], places[1], places[2]] = True
        else:
            grid[(row[6], *places)] = True
    return bool(grid.all())


@given(seed=seeds, splits=st.integers(0, 25))
def test_any_missing_leaf_is_missed(seed: int, splits: int) -> None:
    """In any order the leaves cover; each in turn, left out, leaves a hole; given twice, it does no harm."""
    rng = np.random.default_rng(seed)
    rows = random_tree(rng, splits)
    assert gaps([rows[i] for i in rng.permutation(len(rows))]) == ""
    for i in range(len(rows)):
        assert gaps(rows[:i] + rows[i + 1 :])
        assert gaps([*rows, rows[i]]) == ""


@given(seed=seeds, splits=st.integers(1, 30))
def test_a_moved_leaf_is_found(seed: int, splits: int) -> None:
    """A leaf put elsewhere, made smaller or given to another face leaves a hole that is found."""
    rng = np.random.default_rng(seed)
    rows = random_tree(rng, splits)
    i = int(rng.integers(len(rows)))
    row = rows[i]
    columns = (0, 2, 4, 7, 9) if row[6] >= 0 else (0, 2, 4)
    moved = [halves(row, c)[rng.integers(2)] for c in columns]  # half of it is left
    for c in columns:
        if row[c]:
            other = int(rng.integers((1 << row[c]) - 1))
            moved.append((*row[: c + 1], other + (other >= row[c + 1]), *row[c + 2 :]))
    moved.append((*row[:6], (row[6] + 1) % 3, *row[7:]))
    if row[6] >= 0:
        moved.append((*row[:6], (row[6] + 2) % 3, *row[7:]))
    for one in moved:
        assert gaps([*rows[:i], one, *rows[i + 1 :]])


@given(seed=seeds, splits=st.integers(0, 20), changes=st.integers(1, 3))
def test_what_is_called_covered_is(seed: int, splits: int, changes: int) -> None:
    """After any changes of rows, leaves that pass do cover every cell of the finest grid."""
    rng = np.random.default_rng(seed)
    rows = random_tree(rng, splits, deepest=DEEPEST)
    for _ in range(changes):
        i = int(rng.integers(len(rows)))
        row = list(rows[i])
        column = int(rng.choice([0, 2, 4, 6, 7, 9]))
        if column == 6:
            row[6] = int(rng.integers(-1, 3))
        else:
            row[column] = int(rng.integers(DEEPEST + 1))
            row[column + 1] = int(rng.integers(1 << row[column]))
        rows[i] = tuple(row)
    if gaps(rows) == "":
        assert counted(rows)


def test_the_deepest_tree_is_checked() -> None:
    """A comb of fifty cuts in each direction covers, and its last tooth is missed."""
    rows, last = [], ROOT
    for column in (0, 2, 4):
        for _ in range(50):
            one, last = halves(last, column)
            rows.append(one)
    assert gaps([*rows, last]) == ""
    assert gaps(rows)
