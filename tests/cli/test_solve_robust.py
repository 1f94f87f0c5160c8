"""`solve --robust`: the guarantee and its bound in tables and JSON, and what it refuses."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from nullpose import load, solve

Run = Callable[..., Result]

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
