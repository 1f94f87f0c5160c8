"""The verb ``check``."""

from __future__ import annotations

from nullpose.cli.options import AllowOutside, JsonOutput, Overrides, ScenarioFile, read_scenario
from nullpose.cli.output import show, show_json
from nullpose.cli.printing import say


def check(
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    json_output: JsonOutput = False,
) -> None:
    """Check a scenario file and show its values, without solving."""
    from nullpose.report.scenario import scenario_view, summarise

    scenario = read_scenario(file, overrides, allow_outside)
    if json_output:
        show_json(summarise(scenario))
        return
    show(scenario_view(scenario))
    say(f"{file}: no faults")
