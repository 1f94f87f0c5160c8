"""The verbs `check` and `schema`: what a scenario amounts to, without solving it."""

import json
import math
from collections.abc import Callable

import pytest
from typer.testing import Result

from nullpose import json_schema

Run = Callable[..., Result]


def test_best_ratio_is_that_of_the_closest_point(run: Run, paper: str) -> None:
    """Straight above a node at the lowest altitude, broadside: P / (8^2 sigma^2)."""
    answer = json.loads(run("check", paper, "--json").stdout)
    assert answer["nodes"][0]["nearest_m"] == pytest.approx(8.0)
    assert answer["nodes"][0]["best_power_to_noise_db"] == pytest.approx(10.0 * math.log10(1e3 / 64.0))
    assert answer["jammers"][0]["nearest_m"] == pytest.approx(4.0)


def test_schema_is_printed_whole(run: Run) -> None:
    """Standard output is the schema and nothing else."""
    result = run("schema")
    assert (result.exit_code, result.stderr) == (0, "")
    assert json.loads(result.stdout) == json_schema()
