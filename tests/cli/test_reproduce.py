"""The verb `reproduce`, on fewer jamming levels than it takes in earnest."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from typer.testing import Result

import nullpose.paper.reproduce

Run = Callable[..., Result]

FILES = ["claims.json", "claims.md", "figure2.csv", "figure2.png", "figure2.svg", "poses.png", "poses.svg"]


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes the verb take one level per decade."""
    levels = [10.0**exponent for exponent in range(-3, 7)]
    fewer = partial(nullpose.paper.reproduce.reproduce, levels=levels, printed_levels=levels[::-8][::-1])
    monkeypatch.setattr(nullpose.paper.reproduce, "reproduce", fewer)


@pytest.mark.usefixtures("coarse")
def test_reproduce(run: Run, tmp_path: Path) -> None:
    """All files are written, and the object on standard output holds the same claims as claims.json."""
    result = run("reproduce", "--out", tmp_path / "out", "--json")
    assert result.exit_code == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == FILES
    printed = json.loads(result.stdout)
    written = json.loads((tmp_path / "out" / "claims.json").read_text(encoding="utf-8"))
    assert printed["claims"] == written["claims"]
    assert {claim["verdict"] for claim in printed["claims"]} == {"holds", "fails"}
    assert all(claim["certainty"]["certified"] == claim["certainty"]["values"] for claim in printed["claims"])
    assert printed["figure2"]["optimum"]["certified"] == 10
    assert printed["figure2"]["optimum"]["largest_relative_gap"] <= 1e-6
