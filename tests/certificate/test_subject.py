"""The sentence that states what was proved: its numbers claim no more than what was."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import overheard

from nullpose.certificate import Certificate
from nullpose.certificate.subject import differences, sentence
from nullpose.scenario import Scenario

numbers = st.floats(-6.0, 6.0).map(lambda x: 10.0**x)


@pytest.fixture(scope="module")
def claim(paper: Callable) -> Certificate:
    """Returns a claim without a proof."""
    numbers = {"value": 1.25, "upper_bound": 1.26, "roll_rad": 0.0, "pitch_rad": 0.0, "yaw_rad": 0.0}
    what = {"scenario": paper(), "scheme": "optimum", "null_jammer": None, "trees": ()}
    return Certificate(position_m=np.array([0.0, 25.0, 8.0]), **what, **numbers)


@given(value=numbers, gap=st.floats(0.0, 1.0))
def test_ratios_are_rounded_outwards(value: float, gap: float, claim: Certificate) -> None:
    """What is said of the bound is at least it, and of the value at most it, in decibels too."""
    bound = value * (1.0 + gap)
    words = sentence(replace(claim, value=value, upper_bound=bound), 7)
    most_db, most = (float(x) for x in re.findall(r"above (\S+) dB \((\S+)\)", words)[0])
    least_db, least = (float(x) for x in re.findall(r"every node (\S+) dB \((\S+)\) or more", words)[0])
    assert least <= value <= bound <= most
    assert most <= bound * (1.0 + 1e-6) + 1e-9
    assert least >= value * (1.0 - 1e-6) - 1e-9
    assert least_db <= 10.0 * math.log10(value)
    assert most_db >= 10.0 * math.log10(bound)
    near = float(re.findall(r"within (\S+) \(relative\) of it", words)[0])
    assert bound <= value * (1.0 + near) * (1.0 + 1e-12)
    assert words.endswith("; 7 final boxes checked")


@given(rate=st.floats(-3.0, 20.0), gap=st.floats(0.0, 1.0))
def test_rates_are_rounded_outwards(rate: float, gap: float, claim: Certificate) -> None:
    """Rates too, and they are never below zero."""
    scenario = overheard(claim.scenario, (1.0, 2.0, 3.0))
    value, bound = 2.0**rate, 2.0 ** (rate + gap)
    words = sentence(replace(claim, scenario=scenario, value=value, upper_bound=bound), 1)
    most, least, near = (float(x) for x in re.findall(r"(\S+) bits/s/Hz", words))
    assert 0.0 <= least <= max(0.0, rate)
    assert max(0.0, rate + gap) <= most <= max(0.0, rate + gap) + 2e-9
    distance = max(0.0, rate + gap) - max(0.0, rate)
    assert distance <= near <= distance * 1.01 + 1e-9
    assert "E" not in words.split("proved")[1].split("secrecy")[1].split("bits")[0]


def test_small_numbers_are_not_lost(claim: Certificate) -> None:
    """A bound of next to nothing is written out."""
    words = sentence(replace(claim, value=1e-7, upper_bound=1.5e-7), 1)
    assert "(1.5e-07), and" in words
    assert "within 5.01e-01 (relative) of it" in words


def test_antennas_with_a_pattern_are_compared(paper: Callable, claim: Certificate) -> None:
    """A certificate of a half-wave dipole is about that, and not about a short one or another pattern."""

    def with_antenna(**antenna: object) -> Scenario:
        return Scenario.from_dict(paper().to_dict() | {"antenna": antenna})

    certificate = replace(claim, scenario=with_antenna(kind="half-wave"))
    assert differences(certificate, with_antenna(kind="half-wave")) == ()
    for other in (paper(), with_antenna(kind="pattern", harmonics=[[1.0], [0.3, 0.0, 0.0]])):
        assert any(words.startswith("antenna") for words in differences(certificate, other))
