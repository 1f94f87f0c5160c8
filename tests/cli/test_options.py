"""Every command answers for one instant of a scene in motion, and says for which."""

import json
from pathlib import Path
from typing import Any

import pytest
from sizes import chosen

from nullpose import load
from nullpose.scenario import Scenario
from scenes import Run

ROOT = Path(__file__).parents[2]
MOVING = str(ROOT / "examples" / "moving_jammer.toml")
SWEPT = ("--set", "jammers.M.power_w", "--from", 1, "--to", 2, "--points", 2, "--fast")
COMMANDS = {
    "solve": ("solve", MOVING, "--fast"),
    "compare": ("compare", MOVING, "--fast"),
    "airframes": ("compare", MOVING, "--airframes", "--fast"),
    "vehicle": ("vehicle", MOVING, "--mount", "0"),
    "evaluate": ("evaluate", MOVING, "--pose", "0,20,10"),
    "antenna": ("antenna", "compare", MOVING, "--fast", "--set", "antenna.null_depth_db=20"),
    "check": ("check", MOVING),
    "map": ("map", MOVING, "--cells", 11, "--fast", "--out", "map"),
    "sweep": ("sweep", MOVING, *SWEPT, "--out", "sweep"),
}


@pytest.fixture
def outputs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let files be written to a folder of the test's."""
    monkeypatch.chdir(tmp_path)


def _found(value: object, key: str) -> list[Any]:
    inner = list(value.values()) if isinstance(value, dict) else value if isinstance(value, list) else []
    own = [value[key]] if isinstance(value, dict) and key in value else []
    return own + [found for each in inner for found in _found(each, key)]


@pytest.mark.usefixtures("outputs")
@pytest.mark.parametrize("name", chosen(COMMANDS, [0, 4, 6]))
def test_the_instant_is_told(run: Run, name: str) -> None:
    """In the text and in JSON; without the option it is the first."""
    first = run(*COMMANDS[name])
    assert first.exit_code == 0
    assert "at 0 s" in first.stdout
    later = run(*COMMANDS[name], "--at", 12.5, "--json")
    assert _found(json.loads(later.stdout), "at_s") == [12.5]


def test_the_answer_is_that_of_the_still_scene(run: Run, tmp_path: Path) -> None:
    """A file with the still scene of the instant gives the same value and bound."""
    still = tmp_path / "still.toml"
    still.write_text(load(MOVING).at(10.0).to_toml())
    answers = [
        json.loads(run("solve", *words, "--json").stdout) for words in ((MOVING, "--at", 10), (still,))
    ]
    assert answers[0]["objective"] == answers[1]["objective"]
    assert answers[0]["scenario"] == answers[1]["scenario"]


def test_a_certificate_holds_the_still_scene(run: Run, tmp_path: Path) -> None:
    """It is verified, and is about the scene in motion at its own instant."""
    certificate = tmp_path / "cert.json"
    assert run("solve", MOVING, "--at", 10, "--certificate", certificate).exit_code == 0
    assert Scenario.from_dict(json.loads(certificate.read_text())["scenario"]) == load(MOVING).at(10.0)
    checked = run("verify", certificate, "--scenario", MOVING)
    assert checked.exit_code == 0
    assert "at 10 s" in checked.stdout
    assert "nothing differs" in checked.stdout
    other = tmp_path / "other.toml"
    other.write_text((ROOT / "examples" / "moving_jammer.toml").read_text().replace("[4.0,", "[5.0,"))
    checked = run("verify", certificate, "--scenario", other)
    assert checked.exit_code == 1
    assert "jammers[0].position_m" in checked.stderr


def test_one_pose_is_held_for_all_instants(run: Run) -> None:
    """The value is the smallest of every instant."""
    level = ("--set", "airframe.tilt_max_deg=0", "--set", "time.step_s=10")
    found = json.loads(run("solve", MOVING, "--hover", *level, "--json").stdout)
    assert found["hover"]["time_s"] == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    assert found["objective"]["value"] == min(found["hover"]["value"])
    assert found["scenario"]["at_s"] == found["hover"]["worst_s"]
    assert found["status"] == "certified"


def test_a_held_pose_has_a_certificate(run: Run, tmp_path: Path) -> None:
    """It is about the scene in motion, and not about one of its instants."""
    scene, proof = tmp_path / "scene.toml", tmp_path / "proof.json.gz"
    text = Path(MOVING).read_text(encoding="utf-8").replace("step_s = 1.0", "step_s = 10.0")
    scene.write_text(text.replace("omnidirectional", "level"), encoding="utf-8")
    found = json.loads(run("solve", scene, "--hover", "--gap", 0.05, "--certificate", proof, "--json").stdout)
    assert found["rigour"] == "verified"
    done = run("verify", proof, "--scenario", scene)
    assert done.exit_code == 0
    assert "at all 7 instants" in " ".join(done.stdout.split())
    assert "nothing differs" in done.stdout
    assert run("verify", proof, "--scenario", MOVING).exit_code == 1
