"""Channels: what the solver certifies with them is accepted, and proves nothing with another channel."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sizes import chosen, diagonal
from tests.certificate.plain import accepted, certified, put_together, rejected

from nullpose.certificate import Certificate, certificate_text, differences, parse_certificate
from nullpose.scenario import Scenario, load
from scenes import EXAMPLES

SCHEMES = ["optimum", "zero-interference", "maximum-gain", "vertical"]


def city(environment: str, average: str) -> dict[str, Any]:
    """Return the table of a channel by elevation."""
    return {"model": "elevation", "environment": environment, "average": average}


CHANNELS: dict[str, dict[str, Any]] = {
    "power law 1.6": {"model": "power-law", "exponent": 1.6},
    "power law 3": {"model": "power-law", "exponent": 3.0},
    "power law 6": {"model": "power-law", "exponent": 6.0},
    "suburban": city("suburban", "power"),
    "urban in dB": city("urban", "db"),
    "urban of exponent 2.6": city("urban", "power") | {"exponent": 2.6},
    "suburban of exponent 1.7 in dB": city("suburban", "db") | {"exponent": 1.7},
}


def in_channel(scenario: Scenario, channel: dict[str, Any], **parts: Any) -> Scenario:
    """Return a scenario with a channel, its noise such that a link of 25 m has the SNR of free space."""
    data = scenario.to_dict()
    quieter = 25.0 ** (2.0 - channel.get("exponent", 2.0))
    for receiver in (data["receiver"], *data.get("eavesdroppers", [])):
        if "noise_w" in receiver:
            receiver["noise_w"] *= quieter
    return Scenario.from_dict(data | {"channel": channel} | parts)


@pytest.mark.parametrize(("name", "scheme", "power_w"), diagonal([*CHANNELS], SCHEMES, [0.1, 10.0]))
def test_channels_are_proved(name: str, scheme: str, power_w: float, paper: Callable) -> None:
    """Every case of the paper with every kind of channel, jammed weakly and strongly."""
    certificate = certified(in_channel(paper(power_w), CHANNELS[name]), scheme)
    assert certificate.upper_bound <= certificate.value * 1.0011
    accepted(certificate)
    again = parse_certificate(certificate_text(certificate))
    assert not differences(again, certificate.scenario)


FEATURES: dict[str, dict[str, Any]] = {
    "leak": {"antenna": {"null_depth_db": 25.0}},
    "belt": {"airframe": {"tilt_max_deg": 20.0, "mount_deg": 45.0}},
    "level": {"airframe": {"preset": "level", "mount_deg": 90.0}},
    "upright": {"airframe": {"preset": "level"}},
    "zone": {
        "airspace": {
            "altitude_m": [8.0, 30.0],
            "no_fly": [{"centre_m": [-2.2, 23.8], "radius_m": 6.0}, {"x_m": [5.0, 9.0], "y_m": [0.0, 60.0]}],
        }
    },
    "fence": {
        "airspace": {
            "altitude_m": [8.0, 30.0],
            "geofence_m": [[0.0, 0.0], [40.0, 0.0], [40.0, 60.0], [20.0, 30.0], [5.0, 60.0]],
        }
    },
}


@pytest.mark.parametrize(
    ("feature", "name"), diagonal([*FEATURES], ["power law 3", "suburban", "urban of exponent 2.6"])
)
def test_channels_go_with_other_features(feature: str, name: str, paper: Callable) -> None:
    """Leaky antennas, bands of axes, zones and a fence."""
    certificate = put_together(in_channel(paper(), CHANNELS[name], **FEATURES[feature]))
    assert certificate.upper_bound <= certificate.value * 1.0011
    accepted(certificate)


@pytest.mark.parametrize("name", chosen(CHANNELS, [0, 3, 6]))
def test_channels_of_secrecy_rates_are_proved(name: str) -> None:
    """The eavesdroppers' channels are in the denominators."""
    accepted(certified(in_channel(load(EXAMPLES / "eavesdropper.toml"), CHANNELS[name])))


def test_whips_in_a_city_are_proved(paper: Callable) -> None:
    """Dipoles on the ground, whose channels count with the ends of their range; one of another kind."""
    data = in_channel(paper(), CHANNELS["suburban"]).to_dict()
    for point in data["nodes"]:
        point["antenna"] = "dipole"
    data["jammers"][0]["channel"] = {"model": "power-law", "exponent": 2.2}
    accepted(certified(Scenario.from_dict(data), gap=0.05))


def test_a_city_of_500_m_is_proved() -> None:
    """The optimum is at an altitude between the lowest and the highest."""
    certificate = certified(load(EXAMPLES / "urban.toml"))
    assert 140.0 < certificate.position_m[2] < 180.0
    accepted(certificate)


@pytest.fixture(scope="module")
def sound(paper: Callable) -> dict[str, Certificate]:
    """Returns a certificate of each kind of channel."""
    return {name: certified(in_channel(paper(), table)) for name, table in CHANNELS.items()}


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        ("power law 3", "exponent", 2.99),
        ("power law 3", "reference_distance_m", 0.9),
        ("power law 6", "exponent", 5.9),
        ("suburban", "environment", "urban"),
        ("suburban", "average", "db"),
        ("suburban", "average", "guaranteed"),
        ("urban in dB", "average", "power"),
        ("urban in dB", "environment", "dense-urban"),
        ("urban of exponent 2.6", "exponent", 2.59),
        ("suburban of exponent 1.7 in dB", "exponent", 1.6),
    ],
)
def test_a_certificate_is_of_its_own_channel(
    name: str, key: str, value: object, sound: dict[str, Certificate]
) -> None:
    """With another exponent, environment or average it is rejected, and the difference is named."""
    certificate = sound[name]
    data = certificate.scenario.to_dict()
    data["channel"][key] = value
    other = Scenario.from_dict(data)
    assert "smallest SINR" in rejected(replace(certificate, scenario=other))
    named = differences(certificate, other)
    assert any(words.startswith(f"channel.{key}: the certificate has") for words in named)


def test_the_leaves_of_one_channel_prove_no_other(sound: dict[str, Certificate], paper: Callable) -> None:
    """Even with a pose and a value of the other: its nodes have more there than the bound allows."""
    weak = certified(in_channel(paper(), city("urban", "power")))
    assert weak.value < sound["suburban"].value
    claimed = replace(weak, scenario=sound["suburban"].scenario)
    value = sound["suburban"].value
    assert "smallest SINR is" in rejected(replace(claimed, value=value, upper_bound=value))
    forged = replace(sound["suburban"], trees=weak.trees, upper_bound=sound["suburban"].value * 1.001)
    assert "is not excluded" in rejected(forged) or "root" in rejected(forged)
    stronger = replace(sound["urban in dB"], trees=sound["suburban"].trees)
    levels = [leaf for tree in stronger.trees for leaf in tree.leaves.level]
    assert np.max(levels) > stronger.upper_bound
    assert "its level is above the bound" in rejected(stronger)
