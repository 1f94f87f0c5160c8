"""`solve` and `check` of a scenario on the Earth, and the file that `--geojson` writes."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Run = Callable[..., Result]


@pytest.fixture
def geodetic(paper: str) -> str:
    """The example by latitude and longitude, with its nodes in a file of their own."""
    return paper.replace("paper.toml", "geodetic.toml")


def test_the_example_is_solved_and_put_on_the_map(run: Run, geodetic: str, tmp_path: Path) -> None:
    """The pose is told on the Earth, in NED and as quaternions, and the file holds the same place."""
    out = tmp_path / "new" / "pose.geojson"
    result = run("solve", geodetic, "--fast", "--geojson", out)
    assert (result.exit_code, result.stderr) == (0, "")
    for words in ("on the Earth", "NED, body FRD", "quaternion wxyz", "over the WGS-84 ellipsoid"):
        assert words in result.stdout
    pose, *others = json.loads(out.read_text(encoding="utf-8"))["features"]
    told = re.search(r"lat ([\d.]+) deg, lon ([\d.]+) deg, alt ([\d.]+) m", result.stdout)
    assert told is not None
    lat_deg, lon_deg, alt_m = map(float, told.groups())
    assert pose["geometry"]["coordinates"][:2] == pytest.approx([lon_deg, lat_deg], abs=1e-8)
    assert pose["geometry"]["coordinates"][2] == pytest.approx(alt_m, abs=1e-3)
    assert [each["properties"]["name"] for each in others[:5]] == ["weir", "gauge", "lock", "mill", "meadow"]


def test_json_has_the_frames(run: Run, geodetic: str) -> None:
    """With an origin the JSON object has the geodetic place; the scenario in it keeps what was stated."""
    answer = json.loads(run("solve", geodetic, "--fast", "--json").stdout)
    frames = answer["pose"]["frames"]
    assert frames["enu"]["position_m"] == answer["pose"]["position_m"]
    assert frames["geodetic"]["lat_deg"] == pytest.approx(50.0, abs=0.01)
    assert answer["scenario"]["nodes"][1]["lat_deg"] == 50.0006
    assert len(answer["scenario"]["nodes"][1]["position_m"]) == 3


def test_without_an_origin_nothing_is_solved(run: Run, paper: str, tmp_path: Path) -> None:
    """A scenario without an origin is refused at once, with exit code 2 and what to add."""
    out = tmp_path / "pose.geojson"
    result = run("solve", paper, "--geojson", out)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "error: GeoJSON: the scenario has no origin" in result.stderr
    assert "[origin]" in result.stderr
    assert not out.exists()


def test_a_file_that_cannot_be_written_is_told_before_the_solve(
    run: Run, geodetic: str, tmp_path: Path
) -> None:
    """A folder that a file stands in the way of ends the command with its name."""
    (tmp_path / "file").touch()
    result = run("solve", geodetic, "--geojson", tmp_path / "file" / "pose.geojson")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "cannot write to the folder" in result.stderr


def test_check_shows_the_origin(run: Run, geodetic: str) -> None:
    """The tables of a scenario on the Earth say where it is, and the points in metres."""
    result = run("check", geodetic)
    assert result.exit_code == 0
    assert "lat 50.00000000 deg, lon 14.50000000 deg, alt 230.000 m" in result.stdout
    assert "86.0369" in result.stdout


def test_faults_of_the_nodes_file_are_told_with_their_place(run: Run, geodetic: str, tmp_path: Path) -> None:
    """A fault in the file of nodes is reported under the scenario's name, at its own place."""
    example = Path(geodetic)
    nodes = example.with_name("nodes.geojson").read_text(encoding="utf-8")
    (tmp_path / "nodes.geojson").write_text(nodes.replace("50.0006,", "500.006,"), encoding="utf-8")
    scene = tmp_path / "scene.toml"
    scene.write_text(example.read_text(encoding="utf-8"), encoding="utf-8")
    result = run("check", scene)
    assert result.exit_code == 2
    assert (
        "  nodes.geojson: features[1].geometry: got longitude 14.5012 and latitude 500.006, must be"
        in result.stderr
    )
