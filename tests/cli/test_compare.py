"""The verb `compare`: the four cases agree with the known answers, and one that does not apply says why."""

import json
from pathlib import Path
from typing import Any

import pytest
from matplotlib.image import imread
from sizes import chosen

from scenes import Run


def test_a_case_that_does_not_apply_says_why(run: Run, tmp_path: Path, paper: str) -> None:
    """Without a jammer there is nothing to null; table and JSON say so, the scenario standing there once."""
    text = Path(paper).read_text(encoding="utf-8")
    calm = tmp_path / "calm.toml"
    calm.write_text(text[: text.index("[[jammers]]")], encoding="utf-8")
    answer = json.loads(run("compare", calm, "--json").stdout)
    assert list(answer) == ["scenario", "rows", "left_out", "provenance"]
    assert all("scenario" not in row and "pose" in row for row in answer["rows"])
    ((case, reason),) = (absent.values() for absent in answer["left_out"])
    assert case == "zero-interference"
    assert "jammer" in reason
    assert "zero-interference: left out: " in run("compare", calm).stdout


def test_vehicles_as_one_object(run: Run, paper: str) -> None:
    """Every vehicle has a row in JSON too, and the answer says which suffices."""
    data = json.loads(run("compare", paper, "--airframes", "--fast", "--json").stdout)
    assert {"scenario", "rows", "left_out", "tolerance", "suffices", "least_sufficient", "answer"} <= set(
        data
    )
    assert (len(data["rows"]), data["least_sufficient"]) == (16, None)  # nothing is proved
    assert "level vehicle with the dipole mounted at 80 degrees" in data["answer"][0]
    assert "10 degree tilt" in data["answer"][1]


@pytest.mark.parametrize("vehicles", chosen([((),), (("--airframes",),)], [0]))
def test_limits_reach_each_case(run: Run, paper: str, vehicles: tuple[str, ...]) -> None:
    """The gap, the number of boxes and a search alone hold for every row."""

    def rows(*options: str) -> list[dict[str, Any]]:
        found = json.loads(run("compare", paper, *vehicles, *options, "--json").stdout)["rows"]
        return [row for row in found if "array" not in row]

    wide = rows("--gap", "0.5")
    assert {row["status"] for row in wide} == {"certified"}
    assert max(row["relative_gap"] for row in wide) > 1e-3
    assert max(row["stats"]["boxes"] for row in rows("--node-limit", "1")) <= 64
    assert {(row["status"], row["upper_bound"]) for row in rows("--fast")} == {("best-found", None)}


def test_figure_of_vehicles(run: Run, paper: str, tmp_path: Path) -> None:
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


def test_figures_of_cases(run: Run, paper: str, tmp_path: Path) -> None:
    """Without --airframes the cases are drawn, in each format that is named."""
    result = run("compare", paper, "--fast", "--figure", tmp_path / "a.png", "--figure", tmp_path / "a.pdf")
    assert result.exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {"a.png", "a.pdf"}
