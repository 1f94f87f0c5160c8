"""`solve --robust`: the guarantee and its bound in tables and JSON, and what it refuses."""

import json
from pathlib import Path

import pytest

from nullpose import load, solve
from scenes import Run

ROBUST = str(Path(__file__).parents[2] / "examples" / "robust.toml")


@pytest.fixture(scope="module", autouse=True)
def _kernels() -> None:
    """Compiles the kernels of robust solves, so that no test meets the notice by chance."""
    solve(load(ROBUST), robust=True, gap=0.5)


QUICK = ("--set", "receiver.position_error_m=0", "--gap", "0.05")


def test_json_holds_guarantee_and_bound(run: Run) -> None:
    """The robust pose guarantees more than the nominal one, and no more than the bound."""
    result = run("solve", ROBUST, "--robust", "--json", *QUICK)
    assert (result.exit_code, result.stderr) == (0, "")
    answer = json.loads(result.stdout)
    assert answer["status"] == "certified"
    assert answer["robust"]["guaranteed"] >= 1.75 * answer["nominal"]["guaranteed"]
    assert answer["robust"]["guaranteed"] <= answer["robust"]["worst_found"] <= answer["robust"]["nominal"]
    assert answer["robust"]["guaranteed"] <= answer["upper_bound"]
    assert answer["relative_gap"] <= 0.05


def test_the_robust_pose_comes_in_every_frame(run: Run, tmp_path: Path) -> None:
    """With an origin both poses are told on the Earth and in NED, in tables, in JSON and as GeoJSON."""
    earthly = tmp_path / "scene.toml"
    origin = "\n[origin]\nlat_deg = 50.0\nlon_deg = 14.5\nalt_m = 230.0\nalt_msl_m = 185.0\n"
    earthly.write_text(Path(ROBUST).read_text(encoding="utf-8") + origin, encoding="utf-8")
    path = tmp_path / "poses.geojson"
    result = run("solve", earthly, "--robust", "--fast", "--export", path)
    assert (result.exit_code, result.stderr, result.stdout.count("on the Earth")) == (0, "", 2)
    robust, nominal, *_ = json.loads(path.read_text(encoding="utf-8"))["features"]
    assert [robust["properties"]["kind"], nominal["properties"]["kind"]] == ["pose", "pose-as-stated"]
    answer = json.loads(run("solve", earthly, "--robust", "--fast", "--json").stdout)
    for one, feature in ((answer["robust"], robust), (answer["nominal"], nominal)):
        place = one["frames"]["geodetic"]
        assert feature["geometry"]["coordinates"][:2] == pytest.approx([place["lon_deg"], place["lat_deg"]])
        north_m, east_m, _ = one["frames"]["ned"]["position_m"]
        assert [east_m, north_m] == one["position_m"][:2]


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
