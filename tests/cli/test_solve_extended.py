"""An objective and a scheme that nullpose does not have, each one file and one line, work in every verb."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from toy_objective import CAUTIOUS_SINR
from toy_scheme import NORTHWARD

from nullpose import evaluate, load, min_sinr, solve
from nullpose.objectives import RECORDS as OBJECTIVES
from nullpose.physics import Pose
from nullpose.problem.schemes import RECORDS as SCHEMES, Scheme

SCENE = """
objective = "cautious-sinr"
nodes = [{ name = "S1", position_m = [0.0, 0.0, 0.0], power_w = 1.0 },
         { name = "S2", position_m = [0.0, 50.0, 0.0], power_w = 1.0 }]
jammers = [{ name = "M", position_m = [17.0, 15.0, 4.0], power_w = 0.5 }]

[airspace]
altitude_m = [8.0, 30.0]

[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
"""


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Registers both records: the objective's line, and the scheme's with its member."""
    monkeypatch.setitem(OBJECTIVES, CAUTIOUS_SINR.name, CAUTIOUS_SINR)
    monkeypatch.setitem(SCHEMES, NORTHWARD.name, NORTHWARD)
    member = str.__new__(Scheme, NORTHWARD.name)
    member._name_, member._value_ = "NORTHWARD", NORTHWARD.name
    monkeypatch.setitem(Scheme._value2member_map_, NORTHWARD.name, member)
    monkeypatch.setitem(Scheme._member_map_, "NORTHWARD", member)
    monkeypatch.setattr(Scheme, "_member_names_", [*Scheme._member_names_, "NORTHWARD"])


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """The paper's scene with half the jamming, under the toy objective."""
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def test_the_objective_is_solved_certified_and_evaluated(scene: Path, paper: str) -> None:
    """Half the jamming counted twice: value and pose are the paper's, under another name."""
    result, known = solve(load(scene)), solve(load(Path(paper)))
    assert result.objective.name == "min_cautious_sinr"
    assert result.status == known.status
    assert result.objective.value == pytest.approx(known.objective.value, rel=1e-9)
    assert result.objective.value <= result.objective.upper_bound <= result.objective.value * (1.0 + 1e-4)
    links = evaluate(load(scene), result.pose)
    assert min(link.values["cautious_sinr"] for link in links) == result.objective.value
    assert min(link.sinr for link in links) == min_sinr(load(scene), result.pose) > result.objective.value


def test_the_scheme_is_solved_and_certified(paper: str) -> None:
    """Its pose has the stated axis, is certified, and is no better than the optimum."""
    result = solve(load(Path(paper)), "northward")
    assert abs(result.pose.antenna_axis[1]) == pytest.approx(1.0, abs=1e-12)
    assert result.objective.upper_bound <= result.objective.value * (1.0 + 1e-4)
    assert result.objective.value < solve(load(Path(paper))).objective.value
    assert evaluate(load(Path(paper)), Pose([3.0, 20.0, 9.0], 1.5, 0.0))


def test_every_verb_prints_the_objective(scene: Path, tmp_path: Path, run: Callable) -> None:
    """Solved, evaluated, compared, swept, mapped: each verb ends well and names the quantity."""
    verbs = {
        "solve": (scene, "--certificate", tmp_path / "proof.npz", "--off", "attitude_deg=1"),
        "evaluate": (scene, "--pose", "0,25,8", "--attitude", "0,-30,0", "--time-limit", 5),
        "compare": (scene, "--fast"),
        "sweep": (scene, "--set", "jammers.M.power_w", "--from", 1, "--to", 10, "--points", 2, "--fast",
                  "--out", tmp_path / "out"),
        "map": (scene, "--fast", "--out", tmp_path / "map", "--cells", 8),
        "check": (scene,),
    }  # fmt: skip
    for verb, arguments in verbs.items():
        done = run(verb, *arguments)
        assert done.exit_code == 0, (verb, done.output)
        assert "cautious SINR" in done.output, (verb, done.output)
    checked = run("verify", tmp_path / "proof.npz")
    assert checked.exit_code == 0, checked.output
    assert "cautious SINR" in checked.output
    found = json.loads(run("solve", scene, "--fast", "--json").output)
    assert found["objective"]["name"] == "min_cautious_sinr"
    assert set(found["links"][0]) == {"node", "sinr", "sinr_db", "cautious_sinr", "cautious_sinr_db"}


def test_every_verb_knows_the_scheme(paper: str, tmp_path: Path, run: Callable) -> None:
    """Solved with a certificate that is verified, compared and swept beside the others."""
    solved = run("solve", paper, "--scheme", "northward", "--certificate", tmp_path / "proof.npz")
    assert solved.exit_code == 0, solved.output
    checked = run("verify", tmp_path / "proof.npz")
    assert checked.exit_code == 0, checked.output
    assert "along the north" in checked.output
    compared = run("compare", paper, "--fast")
    assert "Northward" in compared.output, compared.output
    swept = run("sweep", paper, "--set", "jammers.M.power_w", "--from", 1, "--to", 10, "--points", 2,
                "--scheme", "northward", "--fast", "--out", tmp_path)  # fmt: skip
    assert swept.exit_code == 0, swept.output
    assert "northward" in swept.output
