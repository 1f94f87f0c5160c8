"""The verb ``check``."""

from __future__ import annotations

import typer

from nullpose.cli.options import AllowOutside, JsonOutput, Overrides, ScenarioFile, read_scenario
from nullpose.cli.output import tell

__all__ = ["check"]


def check(
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    json_output: JsonOutput = False,
) -> None:
    """Check a scenario file and show what it amounts to, unsolved."""
    from nullpose.report.scenario_tables import scenario_view
    from nullpose.report.summary import summarise

    tell(summarise(read_scenario(file, overrides, allow_outside)), scenario_view, json_output)
    if not json_output:
        typer.echo(f"{file}: no faults")
