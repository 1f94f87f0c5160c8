"""The verb `antenna compare`."""

import json
from collections.abc import Callable

from typer.testing import Result

Run = Callable[..., Result]


def test_table_and_answer(run: Run, paper: str) -> None:
    """What is promised, received and possible, and the answer in a sentence at the end."""
    result = run("antenna", "compare", paper.replace("paper", "whips"))
    assert result.exit_code == 0
    for words in (
        "best pose for the paper's antennas",
        "pose 1 with the stated antennas",
        "best pose for the stated antennas",
    ):
        assert words in result.stdout
    assert "24.11 dB less" in result.stdout


def test_json(run: Run, paper: str) -> None:
    """One object with the values, both solutions and the answer."""
    result = run("antenna", "compare", paper.replace("paper", "whips"), "--fast", "--json")
    assert result.exit_code == 0
    data = json.loads(result.stdout)
    values = {row["case"]: row["min_sinr"] for row in data["rows"]}
    assert {"scenario", "rows", "provenance", "answer"} <= set(data)
    assert values["received"] < values["possible"]
