"""The grid of a study: every case at every point, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

__all__ = ["solved_grid"]

Point = TypeVar("Point")
Case = TypeVar("Case")
Row = TypeVar("Row")


def solved_grid(
    points: Sequence[Point],
    cases: Sequence[Case],
    solved: Callable[[Point, Case], Row],
    on_progress: Callable[[int, int], None] | None = None,
) -> Iterator[Row]:
    """Yield a row for each case at each point, the cases varying fastest.

    Args:
        points: scenes, or values of a setting.
        cases: schemes, or vehicles.
        solved: makes a row of a point and a case.
        on_progress: called after each row with how many are done and how many there are.
    """
    total = len(points) * len(cases)
    for number, point in enumerate(points):
        for place, case in enumerate(cases, start=1):
            yield solved(point, case)
            if on_progress is not None:
                on_progress(number * len(cases) + place, total)
