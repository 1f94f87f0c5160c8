"""The verb ``schema``."""

from __future__ import annotations

from nullpose.cli.output import show_json


def schema() -> None:
    """Print the JSON Schema of scenario files.

    Text editors use it to complete and check scenario files.
    """
    from nullpose.scenario import json_schema

    show_json(json_schema())
