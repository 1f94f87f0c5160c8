"""Coverage: a split tree's leaves cover it, and a hole is found wherever it is."""

import numpy as np
from hypothesis import given, strategies as st
from tests.certificate.plain import make_leaves, seeds

from nullpose.certificate.boxes import uncovered

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
