"""The verb `vehicle`: both sides for each mount, as tables, JSON and figure; bad input in words."""

import json
from pathlib import Path

import pytest
from matplotlib.image import imread

from nullpose.cli.options import REACH
from nullpose.study.case import SHARE
from scenes import Run


def test_json_is_a_contract(run: Run, paper: str) -> None:
    """The keys are those that the page states; a level vehicle that suffices has no side that fails."""
    result = run("vehicle", paper, "--mount", "0,90", "--loss-db", "0.5", "--json")
    answer = json.loads(result.stdout)
    assert list(answer) == ["target", "mounts", "best", "rigour", "seconds"]
    assert list(answer["target"]) == ["share", "value", "omnidirectional_value"]
    keys = ["mount_deg", "suffices_deg", "value", "fails_deg", "upper_bound", "reason"]
    assert all(list(side) == keys for side in (*answer["mounts"], answer["best"]))
    upright, flat = answer["mounts"]
    assert upright["fails_deg"] == pytest.approx(upright["suffices_deg"] - 0.1)
    assert upright["upper_bound"] < answer["target"]["value"] <= upright["value"]
    assert (flat["suffices_deg"], flat["fails_deg"], flat["upper_bound"]) == (0.0, None, None)
    assert (upright["reason"], flat["reason"]) == ("", "")


def test_what_a_limit_left_open_is_said(run: Run, paper: str) -> None:
    """The two sides are then further apart than a step, or one is missing, and the limit is named."""
    options = ("vehicle", paper, "--mount", "45", "--gap", "1e-2", "--node-limit", 1)
    (side,) = json.loads(run(*options, "--json").stdout)["mounts"]
    assert side["reason"] == "the node limit of 1"
    assert (
        None in (side["suffices_deg"], side["fails_deg"]) or side["suffices_deg"] - side["fails_deg"] > 0.15
    )
    words = " ".join(run(*options).stdout.split())
    assert "The rest is open: the node limit of 1." in words


@pytest.mark.parametrize("width", [(), ("--width", "column")])
def test_a_figure_is_drawn(run: Run, paper: str, tmp_path: Path, width: tuple[str, ...]) -> None:
    """For screens and for a column."""
    file = tmp_path / "tilt.png"
    result = run("vehicle", paper, "--mount", "best", "--figure", str(file), *width)
    assert result.exit_code == 0
    assert imread(file).std() > 0.05


def test_the_usual_reach_is_the_library_s() -> None:
    """Help is shown without loading the library, so its default is written there too."""
    assert REACH == SHARE
