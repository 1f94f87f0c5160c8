"""The verb `solve`: one JSON object in the issue's form, tables in words, and a quick start."""

import json
import os
import signal
import subprocess
import sys

import pytest

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.progress import GapBar
from scenes import Run

_LEEWAY = 2.0  # other tests run beside this one; `make bench` measures in earnest


def _solve_json(run: Run, *arguments: object) -> dict[str, object]:
    result = run("solve", *arguments, "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    return json.loads(result.stdout)


def test_json_has_the_documented_keys(run: Run, paper: str) -> None:
    """The object's keys are the contract's, in its order; no number is a NaN or an infinity."""

    def refuse(name: str) -> float:
        raise AssertionError(name)

    result = run("solve", paper, "--json", "--scheme", "vertical")
    answer = json.loads(result.stdout, parse_constant=refuse)
    keys = "scenario scheme status reason rigour objective pose links binding_node stats provenance note"
    assert list(answer) == [*keys.split(), "sensitivity"]
    assert list(answer["objective"]) == ["name", "value", "value_db", "upper_bound", "relative_gap"]
    angles = ["roll_rad", "pitch_rad", "yaw_rad", "tilt_rad", "mount_rad"]
    keys = ["position_m", *angles, "antenna_axis", "frames"]
    assert list(answer["pose"]) == keys
    assert [link["node"] for link in answer["links"]] == ["S1", "S2"]
    assert set(answer["stats"]) == {"wall_s", "starts", "evaluations", "boxes"}


def test_overrides_are_solved_and_recorded(run: Run, paper: str) -> None:
    """The scenario in the answer is the one that was solved, overrides applied."""
    answer = _solve_json(run, paper, "--set", "jammers.M.power_w=10", "--set", "airspace.altitude_m=[8, 20]")
    assert answer["scenario"]["jammers"][0]["power_w"] == 10.0
    assert answer["scenario"]["airspace"]["altitude_m"] == [8.0, 20.0]
    assert answer["objective"]["value_db"] == pytest.approx(0.8333942, abs=1e-6)


def test_fast_proves_nothing(run: Run, paper: str) -> None:
    """--fast searches from more starts and has no bound."""
    answer, fast = _solve_json(run, paper), _solve_json(run, paper, "--fast")
    assert (answer["status"], fast["status"]) == ("certified", "best-found")
    assert (fast["objective"]["upper_bound"], fast["objective"]["relative_gap"]) == (None, None)
    assert fast["stats"]["starts"] > answer["stats"]["starts"]
    assert fast["stats"]["boxes"] == 0 < answer["stats"]["boxes"]


def test_the_gap_can_be_asked_for(run: Run, paper: str) -> None:
    """A wider gap is met with fewer boxes, and recorded."""
    close, wide = (_solve_json(run, paper, "--gap", gap) for gap in ("1e-8", "0.1"))
    assert close["objective"]["relative_gap"] <= 1e-8
    assert 1e-8 < wide["objective"]["relative_gap"] <= 0.1
    assert wide["stats"]["boxes"] < close["stats"]["boxes"]
    assert (close["provenance"]["gap"], wide["provenance"]["gap"]) == (1e-8, 0.1)


@pytest.mark.parametrize(
    ("limit", "reason"),
    [
        (("--node-limit", "50"), "the node limit of 50"),
        (("--time-limit", "1e-6"), "the time limit of 1e-06 s"),
    ],
)
def test_a_limit_is_no_failure(run: Run, paper: str, limit: tuple[str, str], reason: str) -> None:
    """A proof that ends early exits 0 with a bound that holds, and says what ended it."""
    field = paper.replace("paper.toml", "field.toml")
    answer = _solve_json(run, field, *limit)
    assert (answer["status"], answer["reason"]) == ("gap-not-reached", reason)
    best = _solve_json(run, field, "--fast")["objective"]["value"]
    assert answer["objective"]["upper_bound"] >= best
    shown = run("solve", field, *limit).stdout
    assert f"the requested gap was not reached: {reason}" in shown
    assert "\nupper bound " in shown


def test_an_interrupted_proof_prints_its_result(
    run: Run, paper: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C during a proof ends with the result so far on standard output and code 130."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(GapBar, "__call__", interrupt)
    result = run("solve", paper.replace("paper.toml", "field.toml"))
    assert result.exit_code == INTERRUPTED
    assert "the requested gap was not reached: an interrupt" in result.stdout
    assert "\nupper bound " in result.stdout
    result = run("solve", paper.replace("paper.toml", "field.toml"), "--json")
    assert result.exit_code == INTERRUPTED
    answer = json.loads(result.stdout)
    assert (answer["status"], answer["reason"]) == ("gap-not-reached", "an interrupt")


TOLD_AT_ONCE = """
import sys
import nullpose.cli.progress as progress
from nullpose.cli.app import main

progress._QUIET_S = progress._LOG_EVERY_S = 0.0
sys.argv[0] = "nullpose"
main()
"""


def test_an_interrupt_of_the_real_program_keeps_the_result(paper: str) -> None:
    """A signal that arrives once the proof has begun ends it, and the tables are printed all the same."""
    arguments = ["solve", paper.replace("paper.toml", "field.toml"), "--gap", "1e-8", "--time-limit", "300"]
    program = subprocess.Popen(
        [sys.executable, "-c", TOLD_AT_ONCE, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"COLUMNS": "200"},
    )
    assert program.stderr is not None
    while "proving:" not in (line := program.stderr.readline()):
        assert line or program.poll() is None
    program.send_signal(signal.SIGINT)
    stdout, stderr = program.communicate(timeout=600)
    assert program.returncode == INTERRUPTED
    assert "smallest SINR 1.58" in stdout
    assert "not reached: an interrupt" in stdout
    assert "Traceback" not in stderr


def test_a_requirement_that_no_pose_meets_is_bad_input(run: Run, paper: str) -> None:
    """It is said by its path with the best that can be met, and the exit code is 2."""
    sets = [
        f"--set={change}" for change in ("objective=sum-rate", *(f"nodes.S{i}.min_sinr_db=5" for i in (1, 2)))
    ]
    result = run("solve", paper, *sets)
    assert result.exit_code == 2
    assert "error: nodes.min_sinr_db: no pose was found" in result.stderr
    assert "proved: every pose misses one by 4.01" in result.stderr
