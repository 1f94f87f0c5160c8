"""The verb `study report`: a study's report in one command."""

import json
import sys
from pathlib import Path

import pytest

from nullpose.study.monte_carlo import StudySpec, folder as folder_module, run_study
from scenes import Run

HOVER = {"position_m": [0.0, 25.0, 10.0]}
SPEC = {
    "name": "small",
    "scenes": 4,
    "scene": {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    },
    "nodes": {"layout": "disc", "count": 2, "centre_m": [0.0, 0.0], "radius_m": 50.0, "power_w": 1.0},
    "cases": [{"name": "upright", "pose": HOVER}, {"name": "rolled", "pose": HOVER | {"roll_deg": 90.0}}],
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A study of two poses that are given."""
    run_study(StudySpec.from_dict(SPEC), tmp_path / "study", workers=0, chunk=4)
    return tmp_path / "study"


def test_a_report(run: Run, folder: Path) -> None:
    """The answer is printed, and the files that were written."""
    result = run("study", "report", folder, "--requirement-db", "3")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("Over 4 scenes the given pose ")
    for name in ("report.md", "report.html", "summary.csv", "study.csv"):
        assert str(folder / "report" / name) in result.stdout
        assert (folder / "report" / name).stat().st_size > 0


def test_json_of_a_report(run: Run, folder: Path, tmp_path: Path) -> None:
    """One object with the statistics; the folder and the reference are those given."""
    result = run("study", "report", folder, "--out", tmp_path / "out", "--against", "rolled", "--json")
    data = json.loads(result.stdout)
    assert [row["against"] for row in data["summary"]] == ["rolled", "rolled"]
    assert all(name.startswith(str(tmp_path / "out")) for name in data["files"])
    assert (data["complete"], data["scenes_done"]) == (True, 4)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--against", "level"), "against: given 'level'; allowed: upright, rolled"),
        (("--requirement-bps-hz", "1"), "are in dB; give --requirement-db instead"),
    ],
)
def test_bad_input(run: Run, folder: Path, arguments: tuple[str, ...], message: str) -> None:
    """A message on one line, and 2."""
    result = run("study", "report", folder, *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("verb", ["report", "status", "show --scene 0"])
def test_no_study(run: Run, tmp_path: Path, verb: str) -> None:
    """It is told in a line."""
    result = run("study", *verb.split(), tmp_path)
    assert result.exit_code == 2
    assert "no study is here" in result.stderr


@pytest.mark.parametrize("verb", ["report", "run"])
def test_a_missing_extra(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, verb: str) -> None:
    """The line has the command that installs it for the interpreter that runs."""
    monkeypatch.setattr(folder_module, "find_spec", lambda name: None)
    result = run("study", verb, tmp_path, *(("--out", tmp_path) if verb == "run" else ()))
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert f"{sys.executable} -m pip install -e '.[study]'" in result.stderr
