"""The verb `compare` with `--airframes`: one table, one figure, one answer."""

import json
from collections.abc import Callable
from pathlib import Path

from matplotlib.image import imread
from typer.testing import Result

Run = Callable[..., Result]


def test_table_and_answer(run: Run, paper: str) -> None:
    """Every vehicle has a row, and the answer says which suffices."""
    result = run("compare", paper, "--airframes", "--set", "jammers.M.power_w=100")
    assert result.exit_code == 0
    for words in ("level, vertical", "tilt 10, horizontal", "omnidirectional", "array of 8, digital"):
        assert words in result.stdout
    answer = "A 10 degree tilt with a horizontal dipole reaches 0.03 dB less than the omnidirectional"
    assert any(line.startswith(answer) for line in result.stdout.splitlines())


def test_json(run: Run, paper: str) -> None:
    """One object with the vehicles, their shares and the answer."""
    result = run("compare", paper, "--airframes", "--fast", "--json")
    assert result.exit_code == 0
    data = json.loads(result.stdout)
    assert {"scenario", "rows", "left_out", "tolerance", "least_sufficient", "answer"} <= set(data)
    assert len(data["rows"]) == 8
    assert data["least_sufficient"] == "tilt-10"
    assert "10 degree tilt" in data["answer"][0]


def test_figure(run: Run, paper: str, tmp_path: Path) -> None:
    """The figure is written by its suffix, in a folder made for it, and its path is told."""
    file = tmp_path / "new" / "vehicles.png"
    eavesdropper = paper.replace("paper.toml", "eavesdropper.toml")
    result = run("compare", eavesdropper, "--airframes", "--fast", "--figure", file)
    assert result.exit_code == 0
    assert result.stdout.splitlines()[-1] == f"Wrote {file}"
    assert imread(file)[..., :3].std() > 0.05
    data = json.loads(
        run("compare", eavesdropper, "--airframes", "--fast", "--figure", file, "--json").stdout
    )
    assert data["files"] == [str(file)]


def test_a_figure_needs_a_format(run: Run, paper: str, tmp_path: Path) -> None:
    """Without --airframes the cases are drawn; other formats are refused before any work."""
    result = run("compare", paper, "--fast", "--figure", tmp_path / "a.png")
    assert result.exit_code == 0
    assert f"Wrote {tmp_path / 'a.png'}" in result.stdout
    result = run("compare", paper, "--airframes", "--figure", tmp_path / "a.gif")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "allowed: a name that ends in .png, .svg or .pdf" in result.stderr
