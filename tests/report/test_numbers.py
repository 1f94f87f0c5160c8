"""Numbers, shares and names as a report writes them."""

import math

from nullpose.objectives import Quantity
from nullpose.report.numbers import count_of, escaped, listed, number, percent, with_interval

RATE = Quantity.named("min_secrecy_rate")
MINUS = "\N{MINUS SIGN}"


def test_numbers() -> None:
    """Two decimals of decibels, three digits of rates; no minus before nothing; a dash for no number."""
    assert [number(value) for value in (4.104, -0.001, -2.5)] == ["4.10", "0.00", f"{MINUS}2.50"]
    assert number(0.12345, RATE) == "0.123"
    assert (number(math.nan), number(-math.inf)) == ("\N{EN DASH}", f"{MINUS}\N{INFINITY}")


def test_intervals() -> None:
    """Both ends, or a dash where one is not known; none if neither is."""
    assert with_interval(1.0, 0.5, 2.0) == "1.00 (0.50 to 2.00)"
    assert with_interval(1.0, math.nan, 2.0) == "1.00 (\N{EN DASH} to 2.00)"
    assert with_interval(1.0, math.nan, math.nan) == "1.00"


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


def test_words() -> None:
    """Plurals, lists, and signs that Markdown would take for its own."""
    assert (count_of(1, "scene"), count_of(2000, "scene")) == ("1 scene", "2,000 scenes")
    assert (listed(["a"]), listed(["a", "b", "c"])) == ("a", "a, b and c")
    assert escaped("a|b <c>\n*d*") == r"a\|b \<c\> \*d\*"
