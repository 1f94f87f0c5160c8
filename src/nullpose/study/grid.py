"""The grid of a study: every case at every point, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any, TypeVar, Unpack

from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver import Result, SolveKeywords, solve, solve_array
from nullpose.solver.robust import solve_robust

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


def solved_case(
    scenario: Scenario,
    scheme: Scheme = Scheme.OPTIMUM,
    *,
    robust: bool = False,
    **options: Unpack[SolveKeywords],
) -> Result:
    """Return the best pose of a case: of a vehicle with one dipole, with an array, or under errors.

    Args:
        scenario: with the case's vehicle.
        scheme: how the pose of one dipole is chosen.
        robust: whether the pose is asked for that guarantees most under the scenario's errors.
        options: as for :func:`nullpose.solve`.
    """
    if robust:
        return solve_robust(scenario, **options)
    if scenario.array is not None:
        return solve_array(scenario, **options)
    return solve(scenario, scheme, **options)
