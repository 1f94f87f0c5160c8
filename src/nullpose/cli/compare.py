"""The verb ``compare``."""

from __future__ import annotations

from nullpose.cli.options import JsonOutput, Overrides, ScenarioFile, Seed
from nullpose.cli.output import Ticker, compiling_announced, show, show_json

__all__ = ["compare"]


def compare(
    file: ScenarioFile,
    overrides: Overrides = None,
    seed: Seed = 0,
    json_output: JsonOutput = False,
) -> None:
    """Solve a scenario under all four schemes, side by side."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file), overrides or [])
    from nullpose.report.comparison import compare_all

    with compiling_announced(), Ticker("solving") as ticker:
        comparison = compare_all(scenario, seed=seed, on_progress=ticker)
    if json_output:
        show_json(comparison.to_dict())
        return
    from nullpose.report.tables import comparison_view

    show(comparison_view(comparison))
