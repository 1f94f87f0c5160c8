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


def test_without_an_origin_nothing_is_solved(run: Run, paper: str, tmp_path: Path) -> None:
    """A scenario without an origin is refused at once, with exit code 2 and what to add."""
    out = tmp_path / "pose.geojson"
    result = run("solve", paper, "--geojson", out)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "error: GeoJSON: the scenario has no origin" in result.stderr
    assert "[origin]" in result.stderr
    assert not out.exists()
