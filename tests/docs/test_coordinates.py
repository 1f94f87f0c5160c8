"""The page on coordinates: its numbers are those of the program, and its examples load and run."""

import json
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import nullpose
from nullpose.errors import ScenarioError
from nullpose.physics import FramePose, pose_frames
from nullpose.scenario.geodesy import geodetic_from_enu, ned_from_enu

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "coordinates.md").read_text(encoding="utf-8")


def _rows(heading: str) -> list[list[str]]:
    """Returns the cells of the table whose header begins so."""
    lines = PAGE.split(f"\n| {heading}", maxsplit=1)[1].split("\n\n", maxsplit=1)[0].splitlines()[2:]
    return [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in lines]


def _numbers(text: str) -> list[float]:
    return [float(number) for number in text.split(",")]


def _blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)


@pytest.mark.parametrize("row", _rows("east, north, up (m)"), ids=lambda row: row[0])
def test_places_worked_out_by_hand(row: list[str]) -> None:
    """Each place of the worked example is the program's, to the last digit that is printed."""
    lat_deg, lon_deg, alt_m = geodetic_from_enu(_numbers(row[0]), [0.0, 0.0, 0.0])
    assert lat_deg == pytest.approx(float(row[1]), abs=5e-9)
    assert lon_deg == pytest.approx(float(row[2]), abs=5e-9)
    assert alt_m == pytest.approx(float(row[3]), abs=5e-5)


def test_the_same_places_in_ned() -> None:
    """The sentence that has the three places in NED has them in the order of the table."""
    sentence = PAGE.split("In north, east, down the three points are ")[1].split(".\n")[0]
    told = [_numbers(numbers) for numbers in re.findall(r"\(([^)]*)\)", sentence)]
    assert told == [ned_from_enu(_numbers(row[0])).tolist() for row in _rows("east, north, up (m)")]


@pytest.mark.parametrize("row", _rows("frame | roll, pitch, yaw (deg)"), ids=lambda row: row[0])
def test_the_attitude_worked_out_by_hand(row: list[str]) -> None:
    """Angles and quaternion of the worked attitude are the program's in both frames."""
    scenario = nullpose.load(ROOT / "examples" / "paper.toml")
    frames = pose_frames(scenario, nullpose.Pose([0.0, 0.0, 0.0], 0.0, math.pi / 2.0))
    frame: FramePose = getattr(frames, row[0][:3].lower())
    angles = np.degrees([frame.roll_rad, frame.pitch_rad, frame.yaw_rad])
    np.testing.assert_allclose(angles, _numbers(row[1]), atol=1e-12)
    np.testing.assert_allclose(frame.quaternion_wxyz, _numbers(row[2]), atol=5e-5)


def test_the_python_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """The page's program runs from the repository and prints the page's numbers."""
    monkeypatch.chdir(ROOT)
    (code,) = _blocks("python")
    exec(compile(code, "coordinates.md", "exec"), {})
    printed = capsys.readouterr().out
    assert "0.00904369" in printed
    assert "alt_m=1000.0" in printed
    assert [round(abs(float(number)), 4) for number in re.findall(r"-?0\.[45]\d*", printed)[-4:]] == [0.5] * 4


def test_the_toml_loads() -> None:
    """The origin and the node of the page make a scenario when the rest is added."""
    text = _blocks("toml")[0]
    rest = "[airspace]\naltitude_m = [8, 30]\n[receiver]\nnoise_w = 1e-3\nfrequency_hz = 1e9\n"
    scenario = nullpose.Scenario.from_dict(tomllib.loads(text + rest))
    assert scenario.node_positions_m[0] == pytest.approx([86.037, 66.741, 0.499], abs=1e-3)


def test_the_fence_and_the_zones_load(tmp_path: Path) -> None:
    """The page's areas in degrees, and its files of areas, make a scenario with its origin and node."""
    scene, inline, files = _blocks("toml")
    receiver = "[receiver]\nnoise_w = 1e-3\nfrequency_hz = 1e9\n"
    scenario = nullpose.Scenario.from_dict(tomllib.loads(scene + inline + receiver))
    assert [zone.shape for zone in scenario.airspace.no_fly] == ["polygon", "cylinder"]
    assert scenario.airspace.geofence_m is not None
    ring = [[14.4989, 49.9993], [14.5053, 49.9993], [14.5053, 50.0025], [14.4989, 49.9993]]
    place = " ".join(f"{lon},{lat}" for lon, lat in ring)
    shape = f"<outerBoundaryIs><LinearRing><coordinates>{place}</coordinates></LinearRing></outerBoundaryIs>"
    geometry = {"type": "Polygon", "coordinates": [ring]}
    feature = {"type": "Feature", "properties": {}, "geometry": geometry}
    text = json.dumps({"type": "FeatureCollection", "features": [feature]})
    (tmp_path / "fence.geojson").write_text(text, encoding="utf-8")
    (tmp_path / "zones.kml").write_text(
        f"<kml><Placemark><Polygon>{shape}</Polygon></Placemark></kml>", encoding="utf-8"
    )
    (tmp_path / "scene.toml").write_text(scene + files + receiver, encoding="utf-8")
    airspace = nullpose.load(tmp_path / "scene.toml").airspace
    assert airspace.geofence_m == airspace.no_fly[0].polygon_m


def test_the_files_of_nodes_load(tmp_path: Path) -> None:
    """The page's GeoJSON and CSV hold the node that its TOML holds."""
    (geojson,) = _blocks("json")
    csv = next(block for block in _blocks("text") if block.startswith("name,"))
    toml = _blocks("toml")[0]
    rest = toml.split("[[nodes]]")[0] + "[airspace]\naltitude_m = [8, 30]\n[receiver]\nnoise_w = 1e-3\n"
    scenarios = []
    for file, text in (("nodes.geojson", geojson), ("nodes.csv", csv)):
        (tmp_path / file).write_text(text, encoding="utf-8")
        scene = tmp_path / "scene.toml"
        scene.write_text(f'nodes_from = "{file}"\n{rest}frequency_hz = 1e9\n', encoding="utf-8")
        scenarios.append(nullpose.load(scene))
    assert json.loads(geojson)["features"][0]["properties"]["name"] == "gauge"
    assert scenarios[0] == scenarios[1]
    assert scenarios[0].node_names == ("gauge",)


def test_the_faults_are_told_like_that(tmp_path: Path) -> None:
    """The page's example of faults is what a file with those faults is told."""
    rows = [f"n{line},50.{line:04},14.5,230,20" for line in range(2, 10)]
    rows[5] = rows[5][:-2] + "2O"
    rows[7] = rows[7][:-2]
    text = "\n".join(["name,lat_deg,lon_deg,alt_m,power_dbm", *rows])
    (tmp_path / "nodes.csv").write_text(text, encoding="utf-8")
    toml = _blocks("toml")[0]
    rest = toml.split("[[nodes]]")[0] + "[airspace]\naltitude_m = [8, 30]\n[receiver]\nnoise_w = 1e-3\n"
    scene = tmp_path / "mine.toml"
    scene.write_text(f'nodes_from = "nodes.csv"\n{rest}frequency_hz = 1e9\n', encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        nullpose.load(scene)
    told = next(block for block in _blocks("text") if block.startswith("error"))
    assert str(caught.value).splitlines()[1:] == told.splitlines()[1:]


def test_the_keys_are_those_of_the_program() -> None:
    """The table of frames has the keys of the JSON object."""
    scenario = nullpose.load(ROOT / "examples" / "geodetic.toml")
    frames = pose_frames(scenario, nullpose.Pose([0.0, 0.0, 40.0], 0.0, 0.0)).to_dict()
    assert [row[0] for row in _rows("key | world")] == list(frames)
    assert {row[0] for row in _rows("name | order")} <= frames["enu"].keys()
