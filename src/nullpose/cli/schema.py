"""The verb ``schema``."""

from __future__ import annotations

from nullpose.cli.output import show_json

__all__ = ["schema"]


def schema() -> None:
    """Print the JSON Schema of scenario files, for editors that complete and check them."""
    from nullpose.scenario import json_schema

    show_json(json_schema())
