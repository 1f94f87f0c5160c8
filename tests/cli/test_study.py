"""The verb `study`: run, status and show."""

import json
import shutil
from pathlib import Path

import pytest

from nullpose import load
from nullpose.study.monte_carlo import draw_scene, read_study, scene_at
from scenes import Run

SPEC = """
name = "Two vehicles"
scenes = 4
gap = 1e-2
[scene]
file = "paper.toml"
[jammers]
name = "M"
layout = "disc"
count = 1
centre_m = [0.0, 25.0]
radius_m = 60.0
power_w = 1.0
[[cases]]
name = "free"
[[cases]]
name = "tilt"
airframe = "tilt-10-horizontal"
[sweep]
jammers.M.power_w = [1.0, 10.0]
"""


@pytest.fixture
def spec(tmp_path: Path, paper: str) -> Path:
    """A small study."""
    path = tmp_path / "spec.toml"
    path.write_text(SPEC, encoding="utf-8")
    shutil.copy(paper, tmp_path)
    return path


@pytest.fixture
def done(run: Run, spec: Path, tmp_path: Path) -> Path:
    """The folder of the small study, solved."""
    result = run("study", "run", spec, "--out", tmp_path / "out", "--workers", 0, "--chunk", 3)
    assert result.exit_code == 0, result.output
    return tmp_path / "out"


def test_run_says_how_far_it_is(run: Run, spec: Path, tmp_path: Path) -> None:
    """At its end the folder is told, in words or as JSON; again, nothing is to do."""
    arguments = ("study", "run", spec, "--out", tmp_path / "out", "--workers", 0, "--chunk", 3)
    result = run(*arguments)
    assert "Two vehicles\n" in result.stdout
    assert "scenes     4 of 4 (100 %), complete\n" in result.stdout
    assert "rows       16, 0 of them failures\n" in result.stdout
    again = json.loads(run(*arguments, "--json").stdout)
    assert (again["done"], again["parts"], again["chunk"], again["complete"]) == (4, 2, 3, True)


def test_status_reads_what_is_there(run: Run, done: Path) -> None:
    """Also while not all of it is: the next step is named."""
    (done / "parts" / "part-000000003-000000003.parquet").unlink()
    result = run("study", "status", done)
    assert "scenes     3 of 4 (75 %), not running\n" in result.stdout
    assert "nullpose study run with the same spec and folder goes on from there" in result.stdout
    assert json.loads(run("study", "status", done, "--json").stdout)["rows"] == 12


def test_show_prints_a_scenario_file(run: Run, done: Path, tmp_path: Path) -> None:
    """What it prints loads as the scene, before the sweep or at a point of it, with a case's vehicle."""
    spec = read_study(done).spec
    path = tmp_path / "scene.toml"
    path.write_text(run("study", "show", done, "--scene", 2).stdout, encoding="utf-8")
    assert load(path) == draw_scene(spec, 2)
    arguments = ("--scene", 2, "--point", 1, "--case", "tilt")
    path.write_text(run("study", "show", done, *arguments).stdout, encoding="utf-8")
    assert load(path) == spec.cases[1].on(scene_at(spec, 2, 1))
    assert load(path).airframe is not None
    assert json.loads(run("study", "show", done, "--scene", 0, "--json").stdout)["name"] == "scene 0"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--scene", 4), "scene: given 4; allowed: 0 to 3"),
        (("--scene", 0, "--point", 2), "point: given 2; allowed: 0 to 1"),
        (("--scene", 0, "--case", "level"), "case: given 'level'; allowed: free, tilt"),
    ],
)
def test_show_refuses_what_is_not_there(
    run: Run, done: Path, arguments: tuple[object, ...], message: str
) -> None:
    """With what there is."""
    result = run("study", "show", done, *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr


def test_a_faulty_spec_is_told_whole(run: Run, spec: Path, tmp_path: Path) -> None:
    """All faults at once by path, and nothing is begun."""
    text = spec.read_text(encoding="utf-8").replace("scenes = 4", "scenes = 0").replace('"disc"', '"disk"')
    spec.write_text(text, encoding="utf-8")
    result = run("study", "run", spec, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert f"error: {spec}: 2 faults" in result.stderr
    assert "  scenes: got 0" in result.stderr
    assert "  jammers.layout: got" in result.stderr
    assert not (tmp_path / "out").exists()
