"""Schemes and antennas of one scenario compared."""

import io
from pathlib import Path

from rich.console import Console

from nullpose import Scenario, load
from nullpose.report.answer import antennas_answer as answer
from nullpose.report.comparison import antennas_view, comparison_view
from nullpose.study import compare_antennas, compare_schemes

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_optimum_is_the_best(field: Scenario) -> None:
    """No case beats the optimum."""
    optimum, *others = compare_schemes(field).rows
    assert all(other.objective.value <= optimum.objective.value for other in others)


def test_what_does_not_apply_has_its_reason(paper: Scenario) -> None:
    """Without a jammer zero interference is reported, not dropped."""
    comparison = compare_schemes(Scenario.from_dict({**paper.to_dict(), "jammers": []}))
    ((scheme, reason),) = comparison.left_out.items()
    assert scheme == "zero-interference"
    assert "jammer" in reason
    assert len(comparison.to_dict()["rows"]) == 3


def test_rates_have_a_column_in_mbit(paper: Scenario) -> None:
    """If a bandwidth is stated; ratios have none."""
    receiver = {"bandwidth_hz": 20e6, "noise_figure_db": 6.0, "reference_gain_db": -80.0}
    for objective, count in (("sum-rate", 1), ("min-sinr", 0)):
        table = paper.to_dict() | {"objective": objective, "receiver": receiver}
        found = compare_schemes(Scenario.from_dict(table), certify=False)
        file = io.StringIO()
        Console(width=100, file=file).print(comparison_view(found))
        assert file.getvalue().count("Mbit/s") == count
        rows = found.to_dict()["rows"]
        assert all(
            ("value_mbps" in row, "upper_bound_mbps" in row) == (count == 1, count == 1) for row in rows
        )
        if count:
            assert f"{20.0 * found.rows[0].objective.value:.4f}" in file.getvalue()


def test_every_number_is_there() -> None:
    """Promised, received, the same by cause, possible with its bound; the answer has the same numbers."""
    found = compare_antennas(load(EXAMPLES / "whips.toml"), certify=False)
    file = io.StringIO()
    Console(width=100, file=file).print(antennas_view(found))
    for number in ("0.9837", "-23.1287", "0.9749", "-24.5472", "-1.9496"):
        assert number in file.getvalue()
    assert "24.11 dB less" in answer(found)
    assert "21.18 dB more than that" in answer(found)
