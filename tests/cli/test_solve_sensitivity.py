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
