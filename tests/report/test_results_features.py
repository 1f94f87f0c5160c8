"""Tables of margins, rates and airframes: right words, right units, nothing that is no number."""

import io
from pathlib import Path

import pytest
from rich.console import Console, RenderableType

from nullpose import Scenario, load
from nullpose.report.sweep import sweep_view
from nullpose.study import sweep
from scenes import EXAMPLES


def example(name: str) -> Scenario:
    """Returns one of the examples."""
    return load(EXAMPLES / f"{name}.toml")


def text_of(view: RenderableType, width: int = 120) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view)
    return console.file.getvalue()


def test_a_sweep_of_rates_is_one_of_rates(tmp_path: Path) -> None:
    """Title, cells and file are in bits/s/Hz."""
    table = sweep(example("eavesdropper"), "eavesdroppers.E.position_m[0]", [17.0, 60.0])
    text = text_of(sweep_view(table))
    assert "Smallest secrecy rate over the nodes (bits/s/Hz)" in text
    assert "1.1603" in text
    head = table.write_csv(tmp_path / "t.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "min_secrecy_rate_bps_hz,upper_bound_bps_hz" in head
    row = table.to_dict()["rows"][0]
    assert row["min_secrecy_rate"] == table.rows[0].objective.value
    assert (row["objective"], row["upper_bound_db"]) == ("min_secrecy_rate", None)
    assert row["min_sinr"] == min(link["sinr"] for link in row["links"])


def test_a_sweep_of_margins_keeps_sinr_and_margin_apart(tmp_path: Path) -> None:
    """The smallest SINR and the smallest margin are two columns."""
    table = sweep(
        example("requirements"), "nodes.camera.min_sinr_db", [3.0], schemes=["optimum"], certify=False
    )
    assert "Smallest margin over the nodes (dB)" in text_of(sweep_view(table))
    (row,) = table.rows
    assert row.min_sinr_db == pytest.approx(-2.0357, abs=1e-3)
    assert row.objective.value_db == pytest.approx(3.9643, abs=1e-3)
    head = table.write_csv(tmp_path / "t.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "min_margin_db" in head
