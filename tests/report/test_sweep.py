"""A sweep written and shown."""

import io
from pathlib import Path

from rich.console import Console

from nullpose import Scenario
from nullpose.report.sweep import sweep_view, write_sweep
from nullpose.study import spaced, sweep


def test_long_sweeps_are_thinned_out_on_the_screen_only(paper: Scenario, tmp_path: Path) -> None:
    """A hundred values make a hundred rows in the file, and at most forty on the screen."""
    table = sweep(paper, "jammers.M.power_w", spaced(0.1, 10.0, 100, log=True), schemes=["vertical"])
    write_sweep(table, tmp_path, log=True)
    console = Console(width=200, file=io.StringIO())
    console.print(sweep_view(table))
    lines = console.file.getvalue().splitlines()
    assert "One row in 3 is shown." in " ".join(lines)
    assert len(lines) < 50
    assert len((tmp_path / "sweep.csv").read_text(encoding="utf-8").splitlines()) == 101
