"""Outputs of `solve` and its kin: tried before the solve, never in the place of another file."""

import json
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from nullpose import load
from scenes import Run

LIMITED = """
import json, resource, signal, sys
from typer.testing import CliRunner
from nullpose.cli.app import app
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
for words in json.loads(sys.argv[1]):
    done = CliRunner().invoke(app, words)
    print(done.exit_code, done.stderr, end="")
"""


@pytest.fixture
def scene(paper: str, tmp_path: Path) -> Path:
    """A scenario on the Earth that names its nodes, in a folder of its own."""
    for name in ("geodetic.toml", "nodes.geojson"):
        shutil.copy(Path(paper).with_name(name), tmp_path)
    return tmp_path / "geodetic.toml"


@pytest.fixture
def unsolvable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes any solve an error, so that only what comes before it can pass."""

    def fail(*_: object, **__: object) -> None:
        raise AssertionError("solved before the outputs were looked at")

    study = import_module("nullpose.study")  # first: it keeps the solver that it finds
    monkeypatch.setattr(study, "compare_airframes", fail)
    monkeypatch.setattr(study, "sweep", fail)
    monkeypatch.setattr(import_module("nullpose.solver"), "solve", fail)


@pytest.mark.usefixtures("unsolvable")
@pytest.mark.parametrize("option", ["--certificate", "--export", "--figure"])
def test_inputs_are_not_overwritten(option: str, run: Run, scene: Path) -> None:
    """The scenario and the file of its nodes, themselves or through a link, are no outputs."""
    link = scene.with_name("link.kml" if option == "--export" else "link.svg")
    link.symlink_to(scene)
    before = {path: path.read_bytes() for path in scene.parent.iterdir()}
    for output, what in ((link, "the scenario"), (scene, "the scenario"), ("nodes.geojson", "nodes_from")):
        if (option, output) in {("--figure", "nodes.geojson"), ("--figure", scene), ("--export", scene)}:
            continue  # refused by its name before that
        result = run("solve", scene, option, scene.parent / output)
        assert (result.exit_code, result.stdout) == (2, "")
        assert f"error: {option}: {scene.parent / output} is the file of {what} too" in result.stderr
    assert {path: path.read_bytes() for path in scene.parent.iterdir()} == before


@pytest.mark.usefixtures("unsolvable")
def test_two_outputs_are_two_files(run: Run, scene: Path) -> None:
    """Two options that name one file are refused, and both are named."""
    result = run("solve", scene, "--certificate", scene.parent / "x.svg", "--figure", scene.parent / "x.svg")
    assert result.exit_code == 2
    assert "--figure: " in result.stderr
    assert " is the file of --certificate too" in result.stderr
    (scene.parent / "link.tum").symlink_to("pose.kml")
    exports = (word for name in ("pose.kml", "link.tum") for word in ("--export", scene.parent / name))
    assert (
        f"--export: {scene.parent / 'link.tum'} is the file of --export too"
        in run("solve", scene, *exports).stderr
    )


@pytest.mark.usefixtures("unsolvable")
@pytest.mark.parametrize("option", ["--certificate", "--export", "--figure"])
def test_outputs_are_tried_before_the_solve(option: str, run: Run, scene: Path) -> None:
    """A folder of that name, a device, or a file where the folder would be is told at once."""
    ending = ".kml" if option == "--export" else ".svg"
    (scene.parent / f"folder{ending}").mkdir()
    (scene.parent / f"device{ending}").symlink_to("/dev/null")
    for name in (f"folder{ending}", f"device{ending}", f"nodes.geojson/x{ending}"):
        result = run("solve", scene, option, scene.parent / name)
        assert result.exit_code == 2
        assert "cannot write" in result.stderr
        assert "in the way" in result.stderr


@pytest.mark.usefixtures("unsolvable")
def test_other_verbs_try_theirs_too(run: Run, scene: Path) -> None:
    """A comparison's figure, and each file of a sweep."""
    (scene.parent / "x.svg").symlink_to(scene)
    result = run("compare", scene, "--airframes", "--figure", scene.parent / "x.svg")
    assert result.exit_code == 2
    assert "is the file of the scenario too" in result.stderr
    (scene.parent / "sweep.csv").symlink_to("nodes.geojson")
    sweep = ("sweep", scene, "--set", "receiver.noise_dbm", "--from", -100, "--to", -90, "--points", 2)
    result = run(*sweep, "--out", scene.parent)
    assert result.exit_code == 2
    assert "--out (sweep.csv): " in result.stderr
    assert "is the file of nodes_from too" in result.stderr


def test_a_full_disk_leaves_what_was_there(scene: Path, tmp_path: Path) -> None:
    """Each output that does not fit is a message and exit code 2; the older file stays, and no other."""
    outputs = {"--certificate": "p.json", "--export": "p.geojson", "--figure": "p.png"}
    paths = {option: tmp_path / name for option, name in outputs.items()}
    for path in paths.values():
        path.write_text("old", encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    runs = [["solve", str(scene), "--gap", "0.1", option, str(path)] for option, path in paths.items()]
    command = [sys.executable, "-c", LIMITED, json.dumps(runs)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    told = [f"2 error: cannot write {path}: File too large" for path in paths.values()]
    assert done.stdout.splitlines() == told
    assert {path.read_text(encoding="utf-8") for path in paths.values()} == {"old"}
    assert sorted(tmp_path.iterdir()) == before


def test_nodes_from_elsewhere_need_an_option(run: Run, scene: Path) -> None:
    """Every verb that reads a scenario refuses them, and takes them with --allow-outside."""
    (scene.parent / "below").mkdir()
    inner = scene.parent / "below" / "scene.toml"
    inner.write_text(scene.read_text(encoding="utf-8").replace('"nodes.geojson"', '"../nodes.geojson"'))
    sweep = ("--set", "receiver.noise_dbm", "--from", -100, "--to", -90, "--points", 2)
    for verb, *options in (
        ("check",),
        ("solve", "--fast"),
        ("compare", "--fast"),
        ("sweep", *sweep, "--fast", "--scheme", "vertical", "--out", scene.parent / "out"),
    ):
        result = run(verb, inner, *options)
        assert result.exit_code == 2
        assert "nodes_from: got the text" in result.stderr
        assert "--allow-outside" in result.stderr
        assert run(verb, inner, *options, "--allow-outside").exit_code == 0
    assert load(inner, allow_outside=True) == load(scene)


def test_every_file_is_told(run: Run, scene: Path, tmp_path: Path) -> None:
    """What was written is named, each file once."""
    written = [tmp_path / name for name in ("pose.pdf", "pose.svg", "pose.cert.json")]
    figures = ("--figure", written[0], "--figure", written[1], "--width", "column")
    result = run("solve", scene, *figures, "--certificate", written[2])
    assert result.exit_code == 0
    assert all(result.stdout.count(f"Wrote {path}\n") == 1 for path in written)
    assert all(path.stat().st_size > 0 for path in written)
