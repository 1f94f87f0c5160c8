"""The verb ``solve``."""

from __future__ import annotations

from typing import Annotated

import typer

from nullpose.cli.options import JsonOutput, Overrides, ScenarioFile, SchemeName, Seed
from nullpose.cli.output import compiling_announced, show, show_json

__all__ = ["solve"]


def solve(
    file: ScenarioFile,
    scheme: Annotated[
        SchemeName, typer.Option("--scheme", help="How the pose is chosen.")
    ] = SchemeName.OPTIMUM,
    overrides: Overrides = None,
    seed: Seed = 0,
    null_jammer: Annotated[
        str | None,
        typer.Option(
            "--null-jammer",
            metavar="NAME",
            help="Zero interference: the jammer to point the null at. Without it each is tried.",
            show_default=False,
        ),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Find the best pose for a scenario."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file), overrides or [])
    from nullpose.solve import solve as solve_scenario

    with compiling_announced():
        solution = solve_scenario(scenario, scheme.value, seed=seed, null_jammer=null_jammer)
    if json_output:
        show_json(solution.to_dict())
        return
    from nullpose.report.tables import solution_view

    show(solution_view(solution))
