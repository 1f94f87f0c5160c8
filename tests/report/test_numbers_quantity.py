"""Numbers of every objective in the right words and units."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from nullpose import Link
from nullpose.objectives import Quantity
from nullpose.report.numbers import bound_text, bound_words, value_words
from nullpose.solver import Objective

EXAMPLES = Path(__file__).parents[2] / "examples"

MARGIN = Objective(name="min_margin", value=2.0, value_db=10.0 * math.log10(2.0), upper_bound=2.0001)
RATE = Objective(
    name="min_secrecy_rate", value=1.25, value_db=math.nan, upper_bound=1.2500011, relative_gap=1e-6
)


def test_only_ratios_are_told_in_decibels() -> None:
    """A rate is told as it is, a ratio in dB and as it is."""
    assert value_words(RATE) == "1.25 bits/s/Hz"
    assert value_words(MARGIN) == "3.0103 dB (2)"
    assert Quantity.named("min_secrecy_rate").in_unit(1.25) == 1.25
    assert Quantity.named("min_margin").in_unit(100.0) == pytest.approx(20.0)


@pytest.mark.parametrize("objective", [MARGIN, RATE])
@pytest.mark.parametrize("digits", [0, 2, 5])
def test_a_bound_is_never_rounded_down(objective: Objective, digits: int) -> None:
    """The text of a bound is not below the bound, and by less than one unit of its last digit above it."""
    bound = Quantity.named(objective.name).in_unit(objective.upper_bound)
    text = bound_text(objective, digits)
    assert bound <= float(text) + 1e-12
    assert float(text) < bound + 1.1 * 10.0 ** -len(text.split(".")[1])


def test_a_bound_has_its_unit_and_its_gap() -> None:
    """The words of a bound; none where nothing is proved."""
    assert bound_words(RATE).endswith("bits/s/Hz (relative gap 1.0e-06)")
    assert bound_words(replace(RATE, upper_bound=None, relative_gap=None)) == ""


def test_each_node_has_its_number() -> None:
    """A link gives the rate, the margin or the SINR, whichever is asked for."""
    link = Link("S", {"sinr": 4.0, "sinr_db": 6.0, "margin": 2.0, "secrecy_rate_bps_hz": 0.5})
    assert Quantity.named("min_secrecy_rate").at(link) == 0.5
    assert Quantity.named("min_margin").at(link) == 2.0
    assert Quantity.named("min_sinr").at(link) == 4.0
