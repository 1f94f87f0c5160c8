"""A sweep written and shown."""

import io
from pathlib import Path

from rich.console import Console

from nullpose import Scenario
from nullpose.report.sweep import sweep_view, write_sweep
from nullpose.study import ResultTable, spaced, sweep


def shown(table: ResultTable) -> str:
    """Returns what a terminal shows of a sweep."""
    console = Console(width=200, file=io.StringIO())
    console.print(sweep_view(table))
    return console.file.getvalue()


def test_what_is_proved_is_shown(paper: Scenario) -> None:
    """One line says that all is certified, or which case is not and why, with its bounds in the table."""
    power, values = "jammers.M.power_w", [0.1, 10.0]
    text = shown(sweep(paper, power, values))
    assert "Each point is certified optimal within 1e-6 (relative)" in text
    assert "upper bound" not in text
    assert "no upper bound" in shown(sweep(paper, power, values, certify=False))
    proved = sweep(paper, power, values, schemes=["vertical"])
    short = sweep(paper, power, values, schemes=["optimum"], node_limit=5)
    text = shown(ResultTable(power, (*proved.rows, *short.rows)))
    assert text.count("upper bound") == 2
    assert "Vertical: each point is certified optimal within 1e-6" in text
    assert "Optimum: all bounds are valid, but the requested gap is not reached at 2 of 2" in text
    assert "Optimum: the node limit of 5" in text
    for row in short.rows:
        bound = [float(words.split()[0]) for words in text.split("upper bound ")[1:]]
        assert any(row.upper_bound_db <= number < row.upper_bound_db + 0.01 for number in bound)


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
