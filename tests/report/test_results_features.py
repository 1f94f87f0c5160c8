"""Tables of margins, rates and airframes: right words, right units, nothing that is no number."""

import io
from pathlib import Path

import pytest
from rich.console import Console, RenderableType

from nullpose import Scenario, load, solve
from nullpose.report.comparison import comparison_view
from nullpose.report.links import binding_nodes
from nullpose.report.results import result_view
from nullpose.report.scenario import scenario_view, summarise
from nullpose.report.sweep import sweep_view
from nullpose.scenario import apply_overrides
from nullpose.study import compare_schemes, sweep

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name: str) -> Scenario:
    """Returns one of the examples."""
    return load(EXAMPLES / f"{name}.toml")


def text_of(view: RenderableType, width: int = 120) -> str:
    """Returns what a terminal without colours shows."""
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view)
    return console.file.getvalue()


@pytest.mark.parametrize("name", ["airframe", "eavesdropper", "requirements", "no-fly", "robust"])
def test_nothing_is_not_a_number(name: str) -> None:
    """No table of any feature's example prints a NaN or an infinity, and all keep to a terminal's width."""
    scenario = example(name)
    views = (
        scenario_view(scenario),
        result_view(solve(scenario)),
        comparison_view(compare_schemes(scenario)),
    )
    for view in views:
        text = text_of(view)
        assert "nan" not in text.lower().split()
        assert "inf" not in text
        assert max(map(len, text.splitlines())) <= 120


def test_a_rate_has_no_decibels() -> None:
    """The rate is in bits/s/Hz, per node and in all; SNR is what is in dB, at the eavesdropper too."""
    solution = solve(example("eavesdropper"))
    text = text_of(result_view(solution))
    assert "smallest secrecy rate 1.160284 bits/s/Hz" in text
    assert "secrecy rate (bits/s/Hz)" in text
    assert "SINR" not in text
    assert "Eavesdroppers" in text
    assert binding_nodes(solution) == {"S1", "S2"}
    text = text_of(comparison_view(compare_schemes(solution.scenario)))
    assert "Smallest secrecy rate over the nodes (bits/s/Hz)" in text
    assert "axis to E (deg)" in text
    assert "worst node: the smallest secrecy rate" in text
    assert "zero-interference; maximum-gain: left out: " in text


def test_a_margin_is_called_so() -> None:
    """Margins decide which node binds, and stand beside SINR and requirement."""
    solution = solve(example("requirements"))
    text = text_of(result_view(solution))
    assert "smallest margin 3.964289 dB" in text
    assert "smallest SINR" not in text
    assert "required SINR (dB)" in text
    assert binding_nodes(solution) == {"camera", "thermometer"}
    text = text_of(comparison_view(compare_schemes(solution.scenario)))
    assert "margin thermometer (dB)" in text
    assert "SINR thermometer (dB)" in text
    assert "Vertical: missed: node " in text
    assert "node camera: 0.87 dB below" in text


def test_a_downlink_is_summarised_as_one() -> None:
    """What the drone sends arrives at nodes and eavesdroppers, each with a noise of its own."""
    scenario = apply_overrides(example("eavesdropper"), ["eavesdroppers.E.noise_dbm=-10"])
    summary = summarise(scenario)
    node, eavesdropper = summary["nodes"][0], summary["eavesdroppers"][0]
    assert node["best_power_to_noise_db"] == pytest.approx(10.0 * 1.193820026, abs=1e-6)
    assert eavesdropper["noise_dbm"] == pytest.approx(-10.0)
    assert eavesdropper["best_power_to_noise_db"] == pytest.approx(27.95880017, abs=1e-6)
    assert node["power_w"] is None
    text = text_of(scenario_view(scenario))
    assert "transmits" in text
    assert "power (dBm)" not in text


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
