"""Numbers, shares, bounds and names of settings as every report writes them."""

import math
from dataclasses import replace

import pytest

from nullpose.objectives import RECORDS
from nullpose.report.numbers import axis_label, bound_text, bound_words, number, percent, value_words
from nullpose.solver import Objective

MINUS = "\N{MINUS SIGN}"
_MARGIN, (_RATE,) = RECORDS["min-sinr"].quantities[1], RECORDS["secrecy-rate"].quantities
MARGIN = Objective(quantity=_MARGIN, value=2.0, value_db=10.0 * math.log10(2.0), upper_bound=2.0001)
RATE = Objective(quantity=_RATE, value=1.25, value_db=math.nan, upper_bound=1.2500011, relative_gap=1e-6)


def test_numbers() -> None:
    """Two decimals of decibels, three digits of rates; no minus before nothing; a dash for no number."""
    assert [number(value) for value in (4.104, -0.001, -2.5)] == ["4.10", "0.00", f"{MINUS}2.50"]
    assert number(0.12345, RATE.quantity) == "0.123"
    assert (number(math.nan), number(-math.inf)) == ("\N{EN DASH}", f"{MINUS}\N{INFINITY}")


def test_shares_are_all_or_nothing_only_if_they_are() -> None:
    """Rounding never makes a share whole, nor nothing of it."""
    shares = {
        1.0: "100 %",
        0.999: "99 %",
        0.0: "0 %",
        0.004: "under 1 %",
        0.935: "94 %",
        -0.12: f"{MINUS}12 %",
    }
    assert {share: percent(share) for share in shares} == shares
    assert percent(0.9999, 1) == "99.9 %"


def test_only_ratios_are_told_in_decibels() -> None:
    """A rate is told as it is, a ratio in dB and as it is; a bound has its unit and its gap."""
    assert value_words(RATE) == "1.25 bits/s/Hz"
    assert value_words(MARGIN) == "3.0103 dB (2)"
    assert bound_words(RATE).endswith("bits/s/Hz (relative gap 1.0e-06)")
    assert bound_words(replace(RATE, upper_bound=None, relative_gap=None)) == ""


def test_a_rate_with_a_bandwidth_is_told_in_mbit_too() -> None:
    """Value and bound; the bound is rounded up in this unit as well."""
    wide = replace(RATE, quantity=replace(RATE.quantity, mbps=17.3))
    assert value_words(wide) == "1.25 bits/s/Hz (21.625 Mbit/s)"
    rate, mbit = bound_words(wide).split(" (")
    assert rate == bound_words(RATE).split(" (")[0]
    assert mbit.endswith(" Mbit/s; relative gap 1.0e-06)")
    assert 0.0 <= float(mbit.split()[0]) - 17.3 * 1.2500011 < 1e-5


@pytest.mark.parametrize("objective", [MARGIN, RATE])
@pytest.mark.parametrize("digits", [0, 2, 5])
def test_a_bound_is_never_rounded_down(objective: Objective, digits: int) -> None:
    """The text of a bound is not below the bound, and by less than one unit of its last digit above it."""
    bound = objective.quantity.in_unit(objective.upper_bound)
    text = bound_text(objective, digits)
    assert bound <= float(text) + 1e-12
    assert float(text) < bound + 1.1 * 10.0 ** -len(text.split(".")[1])


@pytest.mark.parametrize(
    ("path", "label"),
    [
        ("jammers.M.power_w", "Power of jammer M (W)"),
        ("nodes.S1.min_sinr_db", "Required SINR of node S1 (dB)"),
        ("receiver.noise_dbm", "Noise power of the receiver (dBm)"),
        ("receiver.attitude_error_deg", "Attitude error of the receiver (degrees)"),
        ("jammers.M.position_m[2]", "Position of jammer M, up (m)"),
        ("airspace.altitude_m[0]", "Altitude of the airspace, lowest (m)"),
        ("array.elements", "Elements of the array"),
        ("airframe.tilt_max_deg", "Largest tilt of the airframe (degrees)"),
    ],
)
def test_a_setting_is_told_in_words(path: str, label: str) -> None:
    """No key of the file is on the axis."""
    assert axis_label(path) == label
