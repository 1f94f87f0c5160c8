"""The verb `schema`: the JSON Schema of scenario files."""

import json
from collections.abc import Callable

from typer.testing import Result

from nullpose import json_schema

Run = Callable[..., Result]


def test_schema_is_printed_whole(run: Run) -> None:
    """Standard output is the schema and nothing else."""
    result = run("schema")
    assert (result.exit_code, result.stderr) == (0, "")
    assert json.loads(result.stdout) == json_schema()
