"""The verb `solve` with an array: it is solved, not passed over."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Run = Callable[..., Result]


@pytest.fixture
def array(paper: str) -> str:
    """The example with an array of four."""
    return paper.replace("paper.toml", "array.toml")


def test_the_array_is_what_is_solved(run: Run, array: str) -> None:
    """Value, proof, pose and array are shown."""
    result = run("solve", array)
    assert result.exit_code == 0
    for words in (
        "Array of 4, digital: smallest SINR 7.21",
        "optimal within the requested gap",
        "roll 0.000 deg, pitch 0.000 deg, yaw ",
        "4 upright dipoles, linear",
    ):
        assert words in result.stdout
    assert "antenna axis" not in result.stdout
    answer = json.loads(run("solve", array, "--json").stdout)
    assert answer["scenario"]["array"]["elements"] == 4
    assert answer["objective"]["value"] <= answer["objective"]["upper_bound"]


def test_other_verbs_say_that_they_leave_it_out(run: Run, array: str, tmp_path: Path) -> None:
    """Cases of one dipole are solved without the array, and it is said."""
    assert "All cases use one antenna" in run("compare", array, "--fast").stdout
    settings = ("--set", "jammers.M.power_w", "--from", 1, "--to", 2, "--points", 2, "--scheme", "vertical")
    result = run("sweep", array, *settings, "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert "the file's array is left out" in result.stderr
