"""The verb `reproduce`, on fewer jamming levels than it takes in earnest."""

import json
from functools import partial
from pathlib import Path

import pytest

import nullpose.paper
from scenes import Run

FILES = [
    "figure2-printed.csv",
    "figure2-printed.png",
    "figure2-printed.svg",
    "figure2.csv",
    "figure2.png",
    "figure2.svg",
    "poses.png",
    "poses.svg",
]


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes the verb take one level in three decades."""
    levels = [10.0**exponent for exponent in range(-3, 7, 3)]
    fewer = partial(nullpose.paper.reproduce, levels=levels, printed_levels=levels[::3])
    monkeypatch.setattr(nullpose.paper, "reproduce", fewer)


@pytest.mark.usefixtures("coarse")
def test_reproduce(run: Run, tmp_path: Path) -> None:
    """All files are written, and the object on standard output names them and says what is proved."""
    result = run("reproduce", "--out", tmp_path / "out", "--json")
    assert result.exit_code == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == FILES
    printed = json.loads(result.stdout)
    assert sorted(Path(path).name for path in printed["files"]) == FILES
    assert printed["figure2"]["optimum"]["certified"] == 4
    assert printed["figure2"]["optimum"]["largest_relative_gap"] <= 1e-6
