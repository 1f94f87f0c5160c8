"""The sentence that states what was proved: its numbers claim no more than what was."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.certificate import Certificate
from nullpose.certificate.sentence import sentence
from nullpose.scenario import Airframe, Airspace, Array, Eavesdropper, Scenario, Transmitter

numbers = st.floats(-6.0, 6.0).map(lambda x: 10.0**x)


@pytest.fixture(scope="module")
def claim(paper: Callable) -> Certificate:
    """Returns a claim without a proof."""
    return Certificate(
        scenario=paper(),
        scheme="optimum",
        null_jammer=None,
        value=1.25,
        upper_bound=1.26,
        position_m=np.array([0.0, 25.0, 8.0]),
        roll_rad=0.0,
        pitch_rad=0.0,
        yaw_rad=0.0,
        trees=(),
    )


def changed(scenario: Scenario, **parts: object) -> Scenario:
    """Return a scenario with other parts."""
    return scenario.model_copy(update=parts)


def overheard(scenario: Scenario) -> Scenario:
    """Return a scenario in which the drone transmits and somebody listens in."""
    return changed(
        scenario,
        objective="secrecy-rate",
        transmitter=Transmitter(power_w=1.0),
        nodes=tuple(node.model_copy(update={"power_w": None}) for node in scenario.nodes),
        eavesdroppers=(Eavesdropper(position_m=(1.0, 2.0, 3.0)),),
    )


@given(value=numbers, gap=st.floats(0.0, 1.0))
def test_ratios_are_rounded_outwards(value: float, gap: float, claim: Certificate) -> None:
    """What is said of the bound is at least it, and of the value at most it, in decibels too."""
    bound = value * (1.0 + gap)
    words = sentence(replace(claim, value=value, upper_bound=bound), 7)
    most, most_db = (float(x) for x in re.findall(r"above (\S+) \((\S+) dB\)", words)[0])
    least, least_db = (float(x) for x in re.findall(r"every node (\S+) \((\S+) dB\) or more", words)[0])
    assert least <= value <= bound <= most
    assert most <= bound * (1.0 + 1e-6) + 1e-9
    assert least >= value * (1.0 - 1e-6) - 1e-9
    assert least_db <= 10.0 * math.log10(value)
    assert most_db >= 10.0 * math.log10(bound)
    near = float(re.findall(r"within a relative (\S+) of it", words)[0])
    assert bound <= value * (1.0 + near) * (1.0 + 1e-12)
    assert words.endswith("; 7 final boxes checked")


@given(rate=st.floats(-3.0, 20.0), gap=st.floats(0.0, 1.0))
def test_rates_are_rounded_outwards(rate: float, gap: float, claim: Certificate) -> None:
    """Rates too, and they are never below zero."""
    scenario = overheard(claim.scenario)
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
    assert "above 1.5e-07 (" in words
    assert "within a relative 5.01e-01 of it" in words


def test_places_are_named(claim: Certificate) -> None:
    """Zones and fence, one or several."""
    zone = {"x_m": (50.0, 60.0), "y_m": (0.0, 9.0)}
    fence = [(-90.0, -90.0), (90.0, -90.0), (0.0, 90.0)]
    cases = [
        ({}, "no position and no antenna axis gives"),
        ({"no_fly": [zone]}, "no position outside the no-fly zone and no antenna axis gives"),
        ({"geofence_m": fence}, "no position inside the geofence and no antenna axis gives"),
        (
            {"geofence_m": fence, "no_fly": [zone, {"centre_m": (40.0, 0.0), "radius_m": 1.0}]},
            "no position inside the geofence and outside the 2 no-fly zones and no antenna axis gives",
        ),
    ]
    for parts, expected in cases:
        scenario = changed(claim.scenario, airspace=Airspace(altitude_m=(8.0, 30.0), **parts))
        assert expected in sentence(replace(claim, scenario=scenario), 1)


def test_axes_are_named(claim: Certificate) -> None:
    """The scheme's axes, or the airframe's reach where it is limited."""
    for scheme, expected in (
        ("vertical", "with a vertical antenna"),
        ("zero-interference", "with an antenna whose null is on a jammer"),
        ("maximum-gain", "with an antenna broadside to both nodes"),
    ):
        assert f"no position {expected} gives" in sentence(replace(claim, scheme=scheme), 1)
    named = replace(claim, scheme="zero-interference", null_jammer="M1")
    assert "whose null is on jammer M1 gives" in sentence(named, 1)
    limited = changed(claim.scenario, airframe=Airframe(tilt_max_deg=12.5, mount_deg=90.0))
    words = "within the airframe's reach (tilt at most 12.5 degrees, dipole mounted at 90 degrees) gives"
    assert words in sentence(replace(claim, scenario=limited), 1)
    free = changed(claim.scenario, airframe=Airframe(preset="omnidirectional"))
    assert "airframe" not in sentence(replace(claim, scenario=free), 1)


def test_what_is_left_out_is_named(claim: Certificate) -> None:
    """Errors and arrays are no part of the claim."""
    sure, jammers = claim.scenario, claim.scenario.jammers
    unsure = changed(sure, jammers=(jammers[0].model_copy(update={"uncertainty_m": 1.0}),))
    array = Array(elements=4, layout="linear", spacing_wavelengths=0.5)
    for scenario, expected in (
        (sure, "in this scenario no position"),
        (unsure, "in this scenario, its errors left out, no position"),
        (changed(sure, array=array), "in this scenario, its array left out, no position"),
        (changed(unsure, array=array), "in this scenario, its errors and array left out, no position"),
    ):
        assert expected in sentence(replace(claim, scenario=scenario), 1)


def test_margins_are_called_so(claim: Certificate) -> None:
    """With a weight or a requirement it is a margin that is stated."""
    nodes = (claim.scenario.nodes[0].model_copy(update={"min_sinr_db": 3.0}), claim.scenario.nodes[1])
    words = sentence(replace(claim, scenario=changed(claim.scenario, nodes=nodes)), 1)
    assert "gives every node a margin above 1.26" in words
    assert "a secrecy rate above" in sentence(replace(claim, scenario=overheard(claim.scenario)), 1)
