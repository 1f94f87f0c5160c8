"""The grid of a study: every case at every point, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any, TypeVar

Row = TypeVar("Row")


def solved_grid(
    points: Sequence[Any],
    cases: Sequence[Any],
    solved: Callable[[Any, Any], Row],
    on_progress: Callable[[int, int], None] | None = None,
) -> Iterator[Row]:
    """Yield a row for each case at each point, the cases varying fastest.

    Args:
        points: scenes, or values of a setting.
        cases: schemes, or vehicles.
        solved: makes a row of a point and a case.
        on_progress: called after each row with how many are done and how many there are.
    """
    for done, (point, case) in enumerate(product(points, cases), start=1):
        yield solved(point, case)
        if on_progress is not None:
            on_progress(done, len(points) * len(cases))
