"""What ``solve --robust`` does."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.figure import write_figure
from nullpose.cli.gap_bar import GapBar
from nullpose.cli.output import compiling_announced, show, show_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from nullpose.scenario import Scenario
    from nullpose.solve.robust import RobustSolution

__all__ = ["refuse_with_robust", "solve_robustly"]


def refuse_with_robust(**given: object) -> None:
    """Raise a UsageError if an option was given that has no meaning with ``--robust``.

    Args:
        given: the options by their names, false or None where not given.

    Raises:
        UsageError: one of them was.
    """
    from nullpose.errors import UsageError

    for name, value in given.items():
        if value:
            option = name.replace("_", "-")
            raise UsageError(f"--{option}: given with --robust, which has none; leave out one of the two")


def solve_robustly(
    scenario: Scenario,
    *,
    gap: float | None,
    time_limit_s: float,
    node_limit: int,
    certify: bool,
    seed: int,
    json_output: bool,
    figure: Path | None,
) -> None:
    """Find and show the pose that guarantees most under the scenario's errors.

    Args:
        scenario: with errors.
        gap: relative gap asked for, or None.
        time_limit_s: of search and proof.
        node_limit: of the proof.
        certify: whether to bound what any pose guarantees.
        seed: of the searches.
        json_output: whether to print JSON.
        figure: where to draw what was found, or None.

    Raises:
        UsageError: the scenario states no errors, or the figure's name has another ending.
    """
    from nullpose.errors import UsageError
    from nullpose.solve.robust import ROBUST_GAP, solve_robust

    if not scenario.is_uncertain:
        raise UsageError(
            "--robust: the scenario states no errors; add some, in the file or by --set: "
            "receiver.attitude_error_deg, receiver.position_error_m, or uncertainty_m of a jammer or "
            "an eavesdropper"
        )
    target = ROBUST_GAP if gap is None else gap
    with compiling_announced(), GapBar(target) as bar:
        solution = solve_robust(
            scenario,
            gap=target,
            time_limit_s=time_limit_s,
            node_limit=node_limit,
            certify=certify,
            seed=seed,
            on_progress=bar,
        )
    write_figure(figure, partial(_drawn, solution))
    if json_output:
        show_json(solution.to_dict())
    else:
        from nullpose.report.results import robust_view

        show(robust_view(solution))
    if solution.interrupted:
        raise typer.Exit(INTERRUPTED)


def _drawn(solution: RobustSolution) -> Figure:
    from nullpose.report.figures import draw_robust

    return draw_robust(solution)
