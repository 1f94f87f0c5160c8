"""The verbs ``check`` and ``schema``, which solve nothing."""

from __future__ import annotations

from nullpose.cli.options import JsonOutput, SceneOptions, expanded
from nullpose.cli.output import show, show_json
from nullpose.cli.printing import say


@expanded
def check(scene: SceneOptions, json_output: JsonOutput = False) -> None:
    """Check a scenario file and show its values, without solving."""
    from nullpose.report.scenario import scenario_view, summarise

    scenario = scene.read()
    if json_output:
        show_json(summarise(scenario))
    else:
        show(scenario_view(scenario))
        say(f"{scene.file}: no faults")


def schema() -> None:
    """Print the JSON Schema of scenario files.

    Text editors use it to complete and check scenario files.
    """
    from nullpose.scenario import json_schema

    show_json(json_schema())
