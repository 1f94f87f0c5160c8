"""The verb `map`: a table and a figure of what each place gives."""

import csv
import json
from pathlib import Path

import pytest

from scenes import Run


def test_files_of_a_map(run: Run, paper: str, tmp_path: Path) -> None:
    """CSV, PNG and PDF; the best of the table is the value that is certified, and so said."""
    result = run("map", paper, "--out", tmp_path / "new", "--cells", 31)
    assert (result.exit_code, result.stderr) == (0, "")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["map.csv", "map.pdf", "map.png"]
    with (tmp_path / "new" / "map.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert max(float(row["min_sinr_db"]) for row in rows) == pytest.approx(0.9836997, abs=1e-3)
    assert "best 0.98369" in result.stdout
    assert result.stdout.count("Wrote ") == 3


def test_json_of_a_map(run: Run, paper: str, tmp_path: Path) -> None:
    """That of a solve, with the plane, its best place and the files."""
    found = json.loads(run("map", paper, "--fast", "--cells", 5, "--out", tmp_path, "--json").stdout)
    assert found["status"] == "best-found"
    best = found["map"]["best"]
    assert (found["map"]["name"], found["map"]["unit"], len(found["files"])) == ("min_sinr_db", "dB", 3)
    assert best["value"] == pytest.approx(found["objective"]["value_db"], abs=1e-9)
    assert best["position_m"] == pytest.approx(found["pose"]["position_m"])
