"""The verb `verify`: what was proved, or why not, and the exit code that goes with it."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from scenes import Run

Process = Callable[..., subprocess.CompletedProcess[str]]

CHECKED = ("proved", "message", "leaves")
CLAIM = ("scheme", "null_jammer", "value", "upper_bound", "instants")
SUBJECT = ("name", "scenario_sha256", *CLAIM, "antenna", "scenario")


@pytest.fixture
def proof(run: Run, paper: str, tmp_path: Path) -> Path:
    """Returns a certificate of the paper's optimum."""
    path = tmp_path / "proof.json"
    assert run("solve", paper, "--gap", "1e-3", "--certificate", path).exit_code == 0
    return path


def spoil(path: Path, change: Callable[[dict[str, Any]], object]) -> None:
    """Change a certificate's data."""
    data = json.loads(path.read_text(encoding="utf-8"))
    change(data)
    path.write_text(json.dumps(data), encoding="utf-8")


def test_a_proof_is_shown(run: Run, proof: Path) -> None:
    """What is proved goes to standard output, with exit code 0, as one object if that is asked for."""
    result = run("verify", proof)
    answer = json.loads(run("verify", proof, "--json").stdout)
    assert (result.exit_code, result.stderr) == (0, "")
    assert (list(answer), answer["proved"]) == ([*CHECKED, *SUBJECT], True)
    assert answer["leaves"] == len(json.loads(proof.read_text())["trees"][0]["leaves"]["test"])


def test_whether_it_is_about_a_scenario(run: Run, proof: Path, tmp_path: Path) -> None:
    """The same problem in other units and names is the same; a jammer elsewhere is told, and fails."""
    stated = Path("examples/paper.toml").read_text(encoding="utf-8")
    mine = tmp_path / "mine.toml"
    mine.write_text(
        stated.replace('"S1"', '"gate"').replace("noise_w = 1e-3", "noise_dbm = 0.0"), encoding="utf-8"
    )
    same = run("verify", proof, "--scenario", mine)
    assert (same.exit_code, same.stdout.splitlines()[-1]) == (0, f"about {mine}: nothing differs")
    text = mine.read_text().replace("[17.0, 15.0, 4.0]", "[17.0, 15.0, 3.0]")
    mine.write_text(text, encoding="utf-8")
    other = run("verify", proof, "--scenario", mine)
    assert other.exit_code == 1
    assert "jammers[0].position_m: the certificate has [17.0, 15.0, 4.0]" in other.stderr
    answer = json.loads(run("verify", proof, "--scenario", mine, "--json").stdout)
    assert answer["proved"] is True
    assert answer["about_scenario"] is False
    assert any(line.startswith("jammers[0].position_m") for line in answer["differences"])


def test_a_rejected_certificate_names_the_leaf(run: Run, proof: Path) -> None:
    """A level lowered too far is found, and told on standard error with exit code 1."""

    def lower(data: dict[str, Any]) -> None:
        data["trees"][0]["leaves"]["level"][7] *= 1e-6

    spoil(proof, lower)
    result = run("verify", proof)
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith("rejected: tree 'free': leaf 7 (x, y, z: ")
    answer = run("verify", proof, "--json")
    assert answer.exit_code == 1
    assert json.loads(answer.stdout)["proved"] is False
    assert "leaf 7" in json.loads(answer.stdout)["message"]


def test_malformed_parts_are_named(run: Run, proof: Path) -> None:
    """A missing key, a changed scenario and a missing file are told by name, with exit code 2."""
    spoil(proof, lambda data: data["pose"].pop("roll_rad"))
    result = run("verify", proof)
    assert (result.exit_code, result.stderr) == (
        2,
        f"error: {proof}: pose.roll_rad: is missing; must be a finite number\n",
    )
    spoil(proof, lambda data: data["scenario"]["nodes"][0].update(power_w=2.0))
    result = run("verify", proof)
    assert result.exit_code == 2
    assert "scenario_sha256" in result.stderr
    result = run("verify", proof.with_name("none.json"))
    assert result.exit_code == 2
    assert "cannot be read" in result.stderr
