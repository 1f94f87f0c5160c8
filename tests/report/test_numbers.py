"""Numbers, shares and names as a report writes them."""

import math

from nullpose.objectives import Quantity
from nullpose.report.numbers import number, percent

RATE = Quantity.named("min_secrecy_rate")
MINUS = "\N{MINUS SIGN}"


def test_numbers() -> None:
    """Two decimals of decibels, three digits of rates; no minus before nothing; a dash for no number."""
    assert [number(value) for value in (4.104, -0.001, -2.5)] == ["4.10", "0.00", f"{MINUS}2.50"]
    assert number(0.12345, RATE) == "0.123"
    assert (number(math.nan), number(-math.inf)) == ("\N{EN DASH}", f"{MINUS}\N{INFINITY}")


def test_shares_are_all_or_nothing_only_if_they_are() -> None:
    """Rounding never makes a share whole, nor nothing of it."""
    assert [percent(share) for share in (1.0, 0.999, 0.0, 0.004, 0.935)] == [
        "100 %",
        "99 %",
        "0 %",
        "under 1 %",
        "94 %",
    ]
    assert percent(0.9999, 1) == "99.9 %"
    assert percent(-0.12) == f"{MINUS}12 %"
