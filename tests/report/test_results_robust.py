"""A robust solution in words: rates and ratios in their units, and nothing guaranteed said plainly."""

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from nullpose import Scenario, apply_overrides, load
from nullpose.report.results import result_view
from nullpose.report.words import error_words
from nullpose.solver import solve

EXAMPLES = Path(__file__).parents[2] / "examples"


def text_of(scenario: Scenario) -> str:
    """Returns what is printed of a robust solution that nothing is proved of."""
    console = Console(width=160, file=StringIO())
    console.print(result_view(solve(scenario, robust=True, certify=False)))
    return str(console.file.getvalue())


def test_errors_are_listed() -> None:
    """Each error that is stated is named once, with its unit."""
    assert error_words(load(EXAMPLES / "robust.toml")) == "axis 2 deg, position 0.5 m, M up to 3 m"
    assert error_words(load(EXAMPLES / "paper.toml")) == ""


def test_without_a_proof_no_bound_is_claimed() -> None:
    """The table says that other poses are not bounded."""
    scenario = apply_overrides(load(EXAMPLES / "robust.toml"), ["receiver.position_error_m=0"])
    text = text_of(scenario)
    assert "no upper bound on the guaranteed value" in text
    assert "relative gap" not in text


@pytest.mark.parametrize("words", ["bits/s/Hz", "guaranteed: smallest secrecy rate"])
def test_rates_keep_their_unit(words: str) -> None:
    """A secrecy rate is never told in dB."""
    scenario = apply_overrides(load(EXAMPLES / "eavesdropper.toml"), ["receiver.attitude_error_deg=1"])
    text = text_of(scenario)
    assert words in text
    assert " dB" not in text
