"""The verb `evaluate`: a pose of one's own, held against the proved bound."""

import json
from pathlib import Path

import pytest

from nullpose import load
from scenes import EXAMPLES, Run

BEST = ("--pose", "-2.2423,23.8182,8", "--attitude", "-17.180,-79.071,0")


def test_json_has_the_shape_of_solve(run: Run, paper: str) -> None:
    """All keys of `solve --json` are there, and what the distance and the best pose are."""
    given = json.loads(run("evaluate", paper, *BEST, "--json").stdout)
    solved = json.loads(run("solve", paper, "--json").stdout)
    assert set(solved) <= set(given)
    assert given["status"] == "given"
    assert given["objective"]["upper_bound"] == pytest.approx(solved["objective"]["upper_bound"], rel=1e-6)
    assert 0.0 <= given["below_bound"] < 1e-3
    assert given["best"]["objective"]["value"] == solved["objective"]["value"]


def test_a_file_of_poses(run: Run, paper: str, tmp_path: Path) -> None:
    """A row for each, as a table and as JSON with the scenario once."""
    file = tmp_path / "poses.csv"
    file.write_text("x_m,y_m,z_m,roll_deg,pitch_deg\n0,25,9,0,80\n0,25,4,0,80\n", encoding="utf-8")
    shown = run("evaluate", paper, "--poses", file)
    assert (shown.exit_code, shown.stderr) == (0, "")
    assert "2 poses given" in shown.stdout
    assert "not allowed" in shown.stdout
    told = json.loads(run("evaluate", paper, "--poses", file, "--json").stdout)
    assert [case["status"] for case in told["cases"]] == ["given", "given"]
    assert told["cases"][0]["below_bound"] > 0.0
    assert told["cases"][1]["not_allowed"] == ["the position is 4 m outside altitude_m"]
    assert all("scenario" not in case for case in told["cases"])


def test_a_pose_by_latitude_and_longitude(run: Run) -> None:
    """The pose of a place on the Earth is that of its metres; degrees in place of metres earn a warning."""
    geodetic = str(EXAMPLES / "geodetic.toml")
    scenario = load(geodetic)
    position_m = scenario.origin.position_m({"lat_deg": 50.0006, "lon_deg": 14.5012, "alt_m": 280.0})
    common = ("--attitude", "0,80,0", "--gap", "1", "--json")
    placed = run("evaluate", geodetic, "--pose-lat-lon", "50.0006,14.5012,280", *common)
    metric = run("evaluate", geodetic, "--pose", ",".join(map(repr, position_m.tolist())), *common)
    assert placed.exit_code == metric.exit_code == 0
    assert (placed.stderr, metric.stderr) == ("", "")
    value, same = (json.loads(result.stdout)["objective"]["value"] for result in (placed, metric))
    assert value == pytest.approx(same, rel=1e-12)
    mistaken = run("evaluate", geodetic, "--pose", "50.0006,14.5012,60", *common)
    assert "warning: --pose: 50.0006 m east and 14.5012 m north are close to the origin's" in mistaken.stderr
    assert "--pose-lat-lon" in mistaken.stderr
