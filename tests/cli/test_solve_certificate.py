"""`solve --certificate`: the proof as a file that `verify` accepts."""

import json
from pathlib import Path

import pytest
from sizes import diagonal

from nullpose.certificate import certificate_text, read_certificate, write_certificate
from nullpose.solver import Scheme
from scenes import Run


@pytest.mark.parametrize(("name", "scheme"), diagonal(["proof.json", "proof.json.gz"], [*Scheme]))
def test_round_trips(name: str, scheme: str, run: Run, paper: str, tmp_path: Path) -> None:
    """Every scheme's certificate is written, compressed or not, read back unchanged, and proved."""
    path = tmp_path / name
    arguments = ("--scheme", scheme, "--gap", "1e-3", "--certificate", path)
    assert run("solve", paper, *arguments).exit_code == 0
    assert path.read_bytes().startswith(b"\x1f\x8b") == (path.suffix == ".gz")
    again = tmp_path / f"again-{name}"
    write_certificate(read_certificate(path), again)
    assert again.read_bytes() == path.read_bytes()
    verified = run("verify", path)
    assert verified.exit_code == 0
    assert "\nPROVED\n" in verified.stdout


def test_the_certificate_is_of_the_answer(run: Run, paper: str, tmp_path: Path) -> None:
    """Value, bound, pose, scenario and provenance are those that were printed."""
    path = tmp_path / "proof.json"
    result = run("solve", paper, "--set", "jammers.M.power_w=10", "--certificate", path, "--json")
    answer, certificate = json.loads(result.stdout), json.loads(path.read_text(encoding="utf-8"))
    assert certificate["value"] == answer["objective"]["value"]
    assert certificate["upper_bound"] == answer["objective"]["upper_bound"]
    assert certificate["scenario"] == answer["scenario"]
    assert certificate["provenance"] == answer["provenance"]
    assert {key: answer["pose"][key] for key in certificate["pose"]} == certificate["pose"]
    assert certificate_text(read_certificate(path)) == path.read_text(encoding="utf-8")


def test_a_bound_that_was_not_closed_is_certified_too(run: Run, paper: str, tmp_path: Path) -> None:
    """Stopped by a limit, the bound reached has a certificate all the same."""
    path = tmp_path / "proof.json"
    result = run("solve", paper, "--gap", "1e-6", "--node-limit", 20, "--certificate", path, "--json")
    assert json.loads(result.stdout)["status"] == "gap-not-reached"
    assert run("verify", path).exit_code == 0


def test_a_proof_is_verified_in_one_go(run: Run, paper: str) -> None:
    """With --verify the rigour is verified; without it the answer says that it could be."""
    assert json.loads(run("solve", paper, "--json").stdout)["rigour"] == "verifiable"
    assert json.loads(run("solve", paper, "--verify", "--json").stdout)["rigour"] == "verified"
