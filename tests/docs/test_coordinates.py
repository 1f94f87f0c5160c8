"""The page on coordinates: its numbers are those of the program, and its examples load and run."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import nullpose
from nullpose.errors import ScenarioError
from nullpose.physics import pose_frames

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "coordinates.md").read_text(encoding="utf-8")


def _rows(heading: str) -> list[list[str]]:
    """Returns the cells of the table whose header begins so."""
    lines = PAGE.split(f"\n| {heading}", maxsplit=1)[1].split("\n\n", maxsplit=1)[0].splitlines()[2:]
    return [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in lines]


def _blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)


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
