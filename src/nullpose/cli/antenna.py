"""The verbs ``antenna ...``: what antennas do to a pose."""

from __future__ import annotations

import typer

from nullpose.cli.options import (
    AllowOutside,
    Fast,
    Gap,
    JsonOutput,
    NodeLimit,
    Overrides,
    ScenarioFile,
    Seed,
    TimeLimit,
    read_scenario,
    solve_options,
)
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.progress import Ticker

antenna = typer.Typer(name="antenna", help="What the antennas change.", no_args_is_help=True)


@antenna.command()
def compare(
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    json_output: JsonOutput = False,
) -> None:
    """Compare the paper's antennas with the file's.

    The best pose for the paper's antennas flown with those that the file states, and the best pose for these.
    """
    scenario = read_scenario(file, overrides, allow_outside)
    options = solve_options(gap, time_limit, node_limit, fast, seed)
    from nullpose.report.antennas import answer, antennas_view
    from nullpose.study import compare_antennas

    with compiling_announced(), Ticker("comparing antennas") as ticker:
        found = compare_antennas(scenario, on_progress=ticker, **options)
    tell(found, antennas_view, json_output, answer=answer(found))
