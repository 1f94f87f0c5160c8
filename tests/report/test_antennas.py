"""The comparison of antennas in words."""

import io
from pathlib import Path

from rich.console import Console

from nullpose import load
from nullpose.report.comparison import antennas_answer as answer, antennas_view
from nullpose.study import compare_antennas

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_every_number_is_there() -> None:
    """Promised, received, the same by cause, possible with its bound; the answer has the same numbers."""
    found = compare_antennas(load(EXAMPLES / "whips.toml"))
    file = io.StringIO()
    Console(width=100, file=file).print(antennas_view(found))
    for number in ("0.9837", "-23.1287", "0.9749", "-24.5472", "-1.9496"):
        assert number in file.getvalue()
    assert "24.11 dB less" in answer(found)
    assert "21.18 dB more than that" in answer(found)
