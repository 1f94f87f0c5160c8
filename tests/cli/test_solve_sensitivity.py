"""The table If things are off, its sizes, and the errors that --robust takes where none are stated."""

import json

import pytest


def _sensitivity(run, *arguments):
    return json.loads(run(*arguments, "--json").stdout)["sensitivity"]


@pytest.mark.parametrize("verb", [["solve"], ["evaluate", "--pose", "0,25,8"]])
def test_a_pose_is_told_with_what_errors_cost(run, paper, verb):
    """Solve and evaluate print the table, and the sizes of --off change its values."""
    verb, *pose = verb
    assert "If things are off" in run(verb, paper, *pose).stdout
    usual = _sensitivity(run, verb, paper, *pose)
    assert usual["attitude"]["deg"] == 1.0
    assert usual["jammers"]["m"] == 10.0
    assert usual["all"]["value"] <= min(usual[kind]["value"] for kind in ("attitude", "position", "jammers"))
    larger = _sensitivity(run, verb, paper, *pose, "--off", "position_m=3,jammers_m=200")
    assert larger["attitude"] == pytest.approx(usual["attitude"], rel=1e-9)
    assert larger["position"]["m"] == 3.0
    assert larger["jammers"]["value_db"] < usual["jammers"]["value_db"] - 2.0


def test_a_pose_on_a_null_is_called_one(run, paper):
    """Where all errors together cost more than 3 dB a line names the null and the way out."""
    said = " ".join(run("solve", paper, "--set", "jammers.M.power_w=100").stdout.split())
    assert "stands on a null (towards M)" in said
    assert "--robust finds the best pose for such errors" in said
    still = run("solve", paper, "--off", "attitude_deg=0,position_m=0,jammers_m=0").stdout
    assert "stands on a null" not in still


def test_no_way_out_is_named_that_is_refused(run):
    """Among buildings --robust is refused, so that nothing advises it."""
    said = run("solve", "examples/town.toml", "--gap", "0.1").stdout
    assert "stands on a null (towards M)" in said
    assert "--robust" not in said


@pytest.mark.parametrize("text", ["", "attitude=1", "position_m=far", "jammers_m=-1", "jammers_m"])
def test_sizes_that_are_none_are_refused_by_name(run, paper, text):
    """A size that cannot be read ends with exit code 2 and says what is allowed."""
    found = run("solve", paper, "--off", text)
    assert found.exit_code == 2
    assert "allowed" in found.stderr


def test_robust_takes_these_errors_where_none_are_stated(run, paper):
    """--robust solves for the errors of --off, and says so."""
    found = json.loads(
        run("solve", paper, "--robust", "--fast", "--off", "position_m=2,jammers_m=1.5", "--json").stdout
    )
    assert found["scenario"]["receiver"]["position_error_m"] == 2.0
    assert found["scenario"]["jammers"][0]["uncertainty_m"] == 1.5
    assert "file states no errors" in found["note"]
    assert "axis 1 deg, position 2 m, M up to 1.5 m" in found["note"]
    assert found["robust"]["guaranteed"] <= found["sensitivity"]["all"]["value"]


def test_assumed_balls_stay_out_of_the_airspace(run, paper):
    """The jammer is 4 m below the floor: its ball has less than 3 m, as the note says."""
    found = json.loads(run("solve", paper, "--robust", "--fast", "--json").stdout)
    radius_m = found["scenario"]["jammers"][0]["uncertainty_m"]
    assert 2.0 < radius_m < 3.0
    assert f"M up to {radius_m:g} m" in found["note"]
