"""The verb `solve`: one JSON object in the issue's form, tables in words, and a quick start."""

import json
import math
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from nullpose.cli.options import SchemeName

Run = Callable[..., Result]
Process = Callable[..., subprocess.CompletedProcess[str]]

_LEEWAY = 2.0  # other tests run beside this one; `make bench` measures in earnest


def _solve_json(run: Run, *arguments: object) -> dict[str, object]:
    result = run("solve", *arguments, "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    return json.loads(result.stdout)


def test_json_has_the_documented_keys(run: Run, paper: str) -> None:
    """The object's keys are the contract's, in its order."""
    answer = _solve_json(run, paper)
    assert list(answer) == [
        "scenario",
        "scheme",
        "status",
        "objective",
        "pose",
        "links",
        "stats",
        "provenance",
        "note",
    ]
    assert list(answer["objective"]) == ["name", "value", "value_db", "upper_bound", "relative_gap"]
    assert list(answer["pose"]) == ["position_m", "roll_rad", "pitch_rad", "yaw_rad", "antenna_axis"]
    assert [link["node"] for link in answer["links"]] == ["S1", "S2"]
    assert set(answer["stats"]) == {"wall_s", "starts", "evaluations"}


def test_json_of_a_real_process_is_one_object(process: Process, paper: str) -> None:
    """Standard output holds one JSON object and nothing else."""
    done = process("solve", paper, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["objective"]["value_db"] == pytest.approx(0.9836997, abs=1e-6)


def test_overrides_are_solved_and_recorded(run: Run, paper: str) -> None:
    """The scenario in the answer is the one that was solved, overrides applied."""
    answer = _solve_json(run, paper, "--set", "jammers.M.power_w=10", "--set", "airspace.altitude_m=[8, 20]")
    assert answer["scenario"]["jammers"][0]["power_w"] == 10.0
    assert answer["scenario"]["airspace"]["altitude_m"] == [8.0, 20.0]
    assert answer["objective"]["value_db"] == pytest.approx(0.8333942, abs=1e-6)


def test_the_same_seed_gives_the_same_answer(run: Run, paper: str) -> None:
    """Two runs with one seed agree to the last digit."""
    first, second = (_solve_json(run, paper, "--seed", 7) for _ in range(2))
    assert first["pose"] == second["pose"]
    assert first["provenance"]["seed"] == 7


@pytest.mark.parametrize("scheme", list(SchemeName))
def test_every_scheme_prints_tables(run: Run, paper: str, scheme: SchemeName) -> None:
    """Each scheme's tables name the value, the pose, the links and the jammer."""
    result = run("solve", paper, "--scheme", scheme.value)
    assert result.exit_code == 0
    for words in ("smallest SINR", "position", "roll", "deg from vertical", "Links", "Jammers", "not proved"):
        assert words in result.stdout


def test_null_jammer(run: Run, paper: str) -> None:
    """The null can be pointed at a jammer by name, which the note tells."""
    arguments = ("--scheme", "zero-interference", "--null-jammer", "M")
    assert "null on jammer M" in _solve_json(run, paper, *arguments)["note"]
    assert "nulled" in run("solve", paper, *arguments).stdout


def test_a_scenario_without_jammers(run: Run, tmp_path: Path, paper: str) -> None:
    """Nothing to null is no fault, and no table of jammers is printed."""
    text = Path(paper).read_text(encoding="utf-8")
    calm = tmp_path / "calm.toml"
    calm.write_text(text[: text.index("[[jammers]]")], encoding="utf-8")
    result = run("solve", calm)
    assert result.exit_code == 0
    assert "Jammers" not in result.stdout


def test_numbers_that_json_lacks_are_null(run: Run, paper: str) -> None:
    """No NaN and no infinity is ever printed."""

    def refuse(name: str) -> float:
        raise AssertionError(name)

    result = run("solve", paper, "--json", "--scheme", "vertical")
    json.loads(result.stdout, parse_constant=refuse)


def test_known_statistics_are_plausible(run: Run, paper: str) -> None:
    """Several searches were run, and each link's decibels are those of its ratio."""
    answer = _solve_json(run, paper)
    assert answer["stats"]["starts"] > 1
    for link in answer["links"]:
        assert link["sinr_db"] == pytest.approx(10.0 * math.log10(link["sinr"]))
    assert answer["objective"]["value"] == min(link["sinr"] for link in answer["links"])
    assert math.hypot(*answer["pose"]["antenna_axis"]) == pytest.approx(1.0)
