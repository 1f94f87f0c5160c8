"""The verb `compare`: the four cases agree with the known answers, and one that does not apply says why."""

import csv
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Run = Callable[..., Result]

KNOWN = Path(__file__).parents[1] / "reference" / "paper_scenario" / "known_answers.csv"
LEVELS = ("0.001", "0.1", "1", "10", "1000")
SCHEMES = ["optimum", "zero-interference", "maximum-gain", "vertical"]


def _known(level: str) -> dict[str, str]:
    """The given digits of each scheme's value at a level, corrected where the reference says so."""
    with KNOWN.open(encoding="utf-8", newline="") as file:
        _, *known = csv.DictReader(file)  # below the names stand the units
    rows = [row for row in known if row["jamming_ratio"] in (level, "")]
    return {row["scheme"]: row["corrected_db"] or row["min_sinr_db"] for row in rows}


@pytest.mark.parametrize("level", LEVELS)
def test_known_answers(run: Run, paper: str, level: str) -> None:
    """Seven digits agree to 1e-6 relative of the ratio; fewer agree to all the digits given."""
    result = run("compare", paper, "--set", f"jammers.M.power_w={level}", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    answer = json.loads(result.stdout)
    assert [case["scheme"] for case in answer["cases"]] == SCHEMES
    known = _known(level)
    assert set(known) == set(SCHEMES)
    for case in answer["cases"]:
        digits = known[case["scheme"]]
        decimals = len(digits.split(".")[1])
        if decimals == 7:
            ratio = 10.0 ** (float(digits) / 10.0)
            assert case["objective"]["value"] == pytest.approx(ratio, rel=1e-6)
        else:
            assert case["objective"]["value_db"] == pytest.approx(float(digits), abs=0.5001 * 10.0**-decimals)


def test_json_states_the_scenario_once(run: Run, paper: str) -> None:
    """The cases are solve objects without the scenario, which stands beside them."""
    answer = json.loads(run("compare", paper, "--json").stdout)
    assert list(answer) == ["scenario", "cases", "provenance"]
    assert all("scenario" not in case and "pose" in case for case in answer["cases"])


def test_a_case_that_does_not_apply_says_why(run: Run, tmp_path: Path, paper: str) -> None:
    """Without a jammer there is nothing to null; table and JSON say so."""
    text = Path(paper).read_text(encoding="utf-8")
    calm = tmp_path / "calm.toml"
    calm.write_text(text[: text.index("[[jammers]]")], encoding="utf-8")
    result = run("compare", calm, "--json")
    absent = [case for case in json.loads(result.stdout)["cases"] if case["status"] == "not-applicable"]
    assert [(case["scheme"], sorted(case)) for case in absent] == [
        ("zero-interference", ["reason", "scheme", "status"])
    ]
    assert "jammer" in absent[0]["reason"]
    assert "Zero interference: not applicable" in run("compare", calm).stdout
