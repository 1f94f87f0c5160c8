"""The verbs `antenna FILE` and `antenna compare`."""

import json
import math
from pathlib import Path

import pytest

from scenes import Run

DATA = Path(__file__).parents[1] / "antenna" / "data"
HALF = DATA / "alone_half_5deg.out.gz"


def test_the_figure_and_json(run: Run, tmp_path: Path) -> None:
    """The figure is written where it was asked for, never over the pattern; JSON has every number."""
    figure = tmp_path / "deeper" / "pattern.png"
    result = run("antenna", HALF, "--figure", figure)
    assert result.exit_code == 0
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert result.stdout.endswith(f"Wrote {figure}\n")
    assert "2.14 dBi, at theta 90, phi 0" in result.stdout
    data = json.loads(run("antenna", HALF, "--figure", figure, "--json").stdout)
    assert data["files"] == [str(figure)]
    assert {"source", "quantity", "notes", "peak_rad", "null_rad", "degree", "step_rad"} <= set(data)
    assert data["peak_dbi"] == pytest.approx(2.14, abs=0.005)
    assert data["null_db"] is None  # of an exact null
    assert data["peak_rad"] == pytest.approx([math.pi / 2.0, 0.0])
    pattern = tmp_path / "pattern.svg"
    pattern.write_bytes(HALF.read_bytes())
    refused = run("antenna", pattern, "--figure", pattern)
    assert (refused.exit_code, pattern.read_bytes()) == (2, HALF.read_bytes())
    assert "is the file of the pattern too" in refused.stderr


def test_faults_are_one_message(run: Run, tmp_path: Path) -> None:
    """Bad input exits with 2, nothing on standard output and the place on standard error."""
    file = tmp_path / "pattern.csv"
    file.write_text("theta_deg,phi_deg,gain_dbi\n0,0,0\n0,10,x\n", encoding="utf-8")
    result = run("antenna", file)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(
        f"error: {file}: 1 fault\n  line 3: got '0,10,x', must be 3 finite numbers"
    )
    for words in ((file, "--format", "msi"), (HALF, "--frequency", "1e9"), (tmp_path / "none.csv",)):
        refused = run("antenna", *words)
        assert (refused.exit_code, refused.stdout) == (2, "")
