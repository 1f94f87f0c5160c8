"""The verb ``compare``."""

from __future__ import annotations

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.options import Fast, Gap, JsonOutput, NodeLimit, Overrides, ScenarioFile, Seed, TimeLimit
from nullpose.cli.output import Ticker, compiling_announced, show, show_json

__all__ = ["compare"]


def compare(
    file: ScenarioFile,
    overrides: Overrides = None,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    json_output: JsonOutput = False,
) -> None:
    """Solve a scenario under all four schemes, side by side."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file), overrides or [])
    from nullpose.report.comparison import compare_all

    with compiling_announced(), Ticker("solving") as ticker:
        comparison = compare_all(
            scenario,
            gap=gap,
            time_limit_s=time_limit,
            node_limit=node_limit,
            certify=not fast,
            seed=seed,
            on_progress=ticker,
        )
    if json_output:
        show_json(comparison.to_dict())
    else:
        from nullpose.report.comparison_tables import comparison_view

        show(comparison_view(comparison))
    if any(solution.interrupted for solution in comparison.solutions):
        raise typer.Exit(INTERRUPTED)
