"""What ``solve`` does with a scenario that states an array."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.cli.figure import write_figure
from nullpose.cli.output import compiling_announced, show, show_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from nullpose.scenario import Scenario
    from nullpose.solve import ArraySolution

__all__ = ["refuse_with_array", "solve_with_array"]


def refuse_with_array(**given: object) -> None:
    """Raise a UsageError if an option was given that has no meaning for an array.

    Args:
        given: the options by their names, false or None where not given.

    Raises:
        UsageError: one of them was.
    """
    from nullpose.errors import UsageError

    for name, value in given.items():
        if value:
            option = name.replace("_", "-")
            raise UsageError(
                f"--{option}: given for a scenario with an [array], which has none; leave out one of the two"
            )


def solve_with_array(
    scenario: Scenario,
    combining: str,
    *,
    gap: float | None,
    certify: bool,
    seed: int,
    json_output: bool,
    figure: Path | None,
) -> None:
    """Find and show where a scenario's array reaches most.

    Args:
        scenario: with an array.
        combining: ``"digital"`` or ``"analogue"``.
        gap: relative gap asked for, or None.
        certify: whether to prove anything.
        seed: of the searches.
        json_output: whether to print JSON.
        figure: where to draw what was found, or None.
    """
    from nullpose.solve import solve_array

    with compiling_announced():
        solution = solve_array(scenario, combining, gap=gap, certify=certify, seed=seed)
    write_figure(figure, partial(_drawn, solution))
    if json_output:
        show_json(solution.to_dict())
        return
    from nullpose.report.results import array_view

    show(array_view(solution))


def _drawn(solution: ArraySolution) -> Figure:
    from nullpose.report.figures import draw_array

    return draw_array(solution)
