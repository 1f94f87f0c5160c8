"""Noise, gains and powers, however they are stated."""

import math

import pytest
from hypothesis import given, strategies as st

from nullpose.errors import ScenarioError
from nullpose.scenario import Eavesdropper, Jammer, Node, Receiver, Scenario, apply_overrides, doubts
from scenes import require_fault


@given(st.floats(-270.0, 270.0))
def test_either_unit_of_a_power_is_in_watts(dbm: float) -> None:
    """0 dBm is 1 mW, and 10 dB are a factor of ten."""
    stated = [Node(position_m=(0, 0, 0), power_dbm=each).transmit_power_w for each in (0.0, dbm, dbm + 10.0)]
    assert stated[0] == pytest.approx(1e-3, rel=1e-15)
    assert stated[2] / stated[1] == pytest.approx(10.0, rel=1e-12)
    assert Node(position_m=(0, 0, 0), power_w=2).transmit_power_w == 2.0


@given(st.floats(1e3, 1e12))
def test_gain_from_a_frequency_is_friis(frequency_hz: float) -> None:
    """At 2.4 GHz the free-space gain at 1 m is -40.05 dB; ten times the frequency costs 20 dB."""
    gains = [Receiver(noise_w=1.0, frequency_hz=hz).reference_gain for hz in (2.4e9, frequency_hz)]
    assert 10.0 * math.log10(gains[0]) == pytest.approx(-40.0520, abs=5e-5)
    assert gains[0] / gains[1] == pytest.approx((frequency_hz / 2.4e9) ** 2, rel=1e-12)


@given(st.floats(1.0, 1e10), st.floats(0.0, 30.0))
def test_noise_of_a_bandwidth_is_thermal_noise_and_the_noise_figure(hz: float, figure_db: float) -> None:
    """It is -173.975 dBm/Hz at 290 K, ten times the bandwidth and 10 dB of noise figure are 10 dB each."""
    stated = {"bandwidth_hz": hz, "noise_figure_db": figure_db}
    place = {"position_m": (0, 0, 0)}
    powers_w = [
        Receiver(frequency_hz=1e9, **stated).noise_power_w,
        Node(**place, **stated).noise_power_w,
        Eavesdropper(**place, **stated).noise_power_w,
    ]
    assert len(set(powers_w)) == 1
    noise_dbm = 10.0 * math.log10(powers_w[0]) + 30.0
    assert noise_dbm == pytest.approx(-173.9752 + 10.0 * math.log10(hz) + figure_db, abs=1e-4)


def scene(**receiver: float) -> Scenario:
    """Returns a drone that two nodes listen to, one by its own receiver."""
    places = [[0, 0, 0], [100, 0, 0]]
    return Scenario.from_dict(
        {
            "objective": "secrecy-rate",
            "airspace": {"altitude_m": [20, 50]},
            "receiver": {"frequency_hz": 2.4e9} | receiver,
            "transmitter": {"power_dbm": 20},
            "nodes": [{"position_m": place} for place in places],
            "eavesdroppers": [{"position_m": [50, 50, 0]}],
        }
    )


def test_every_receiver_takes_a_bandwidth() -> None:
    """A node's and an eavesdropper's own count in place of that of [receiver]."""
    own = {"bandwidth_hz": 1e6, "noise_figure_db": 5.0}
    data = scene(noise_dbm=-90).to_dict()
    data["nodes"][0] |= own
    data["eavesdroppers"][0] |= own
    mixed = Scenario.from_dict(data)
    expected_w = Receiver(frequency_hz=1e9, **own).noise_power_w
    assert mixed.node_noise_w.tolist() == pytest.approx([expected_w, 1e-12])
    assert mixed.eavesdropper_noise_w.tolist() == pytest.approx([expected_w])


@pytest.mark.parametrize(
    ("receiver", "message"),
    [
        ({"bandwidth_hz": 1e6}, "bandwidth_hz given without noise_figure_db; add it"),
        ({"noise_figure_db": 3.0}, "noise_figure_db given without bandwidth_hz; add it"),
        ({"noise_dbm": -90.0, "bandwidth_hz": 1e6, "noise_figure_db": 3.0}, "exactly one is allowed"),
        ({"bandwidth_hz": 1e6, "noise_figure_db": -3.0}, "it is not negative"),
        ({}, "neither noise_w nor noise_dbm nor bandwidth_hz and noise_figure_db is given"),
    ],
)
def test_noise_is_stated_in_one_way(receiver: dict[str, float], message: str) -> None:
    """A bandwidth goes with a noise figure and with no other noise."""
    with pytest.raises(ScenarioError, match=message):
        scene(**receiver)


def test_one_way_to_state_noise_replaces_another() -> None:
    """An override of one way drops the keys of the others."""
    wide = apply_overrides(scene(noise_dbm=-90), ["receiver.bandwidth_hz=1e6", "receiver.noise_figure_db=4"])
    assert wide.receiver.noise_dbm is None
    assert apply_overrides(wide, ["receiver.noise_dbm=-90"]) == scene(noise_dbm=-90)


@pytest.mark.parametrize("receiver", [{"noise_dbm": -174.0}, {"bandwidth_hz": 20.0, "noise_figure_db": 6.0}])
def test_noise_below_that_of_a_kilohertz_is_doubted(receiver: dict[str, float]) -> None:
    """It is likely a density in dBm/Hz, or a bandwidth in another unit."""
    (doubt,) = doubts(scene(**receiver))
    assert doubt.path == "receiver"
    assert "less than the thermal noise of 1 kHz" in doubt.message
    assert not doubts(scene(noise_dbm=-144.9))


def test_a_carrier_below_a_megahertz_is_doubted() -> None:
    """It is likely in kHz or MHz."""
    low = apply_overrides(scene(noise_dbm=-90), ["receiver.frequency_hz=2400"])
    assert [(each.path, "2400 MHz is written 2.4e+09" in each.message) for each in doubts(low)] == [
        ("receiver.frequency_hz", True)
    ]


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("noise_dbm_hz", "add 10 log10(bandwidth in Hz), or state bandwidth_hz and noise_figure_db"),
        ("noise_dbw", "0 dBW is 30 dBm"),
        ("frequency_mhz", "1 MHz is 1e6 Hz"),
    ],
)
def test_hints_that_cross_units_say_the_conversion(key: str, words: str) -> None:
    """A hint at a key of another unit alone would be off by the factor."""
    with pytest.raises(ScenarioError) as caught:
        scene(**{key: 1.0})
    assert words in str(caught.value)
    assert "did you mean" in str(caught.value)


KINDS = [
    lambda **values: Jammer(name="M", position_m=(1.0, 2.0, 3.0), power_w=1.0, **values),
    lambda **values: Eavesdropper(name="E", position_m=(1.0, 2.0, 3.0), **values),
]


@pytest.mark.parametrize("kind", KINDS)
def test_the_reach_is_the_radius(kind: object) -> None:
    """Left out, or a radius of 0, the set is a point."""
    for radius_m in (None, 0.0, 3.0):
        assert kind(uncertainty_m=radius_m).uncertainty_reach_m == (radius_m or 0.0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("values", "path", "words"),
    [
        ({"uncertainty_m": -1.0}, "uncertainty_m", "got -1.0, must be a radius in m"),
        ({"uncertainty_m": float("nan")}, "uncertainty_m", "got NaN"),
        ({"uncertainty_m": "3"}, "uncertainty_m", "must be a number: a radius in m"),
        ({"uncertainty_m": []}, "uncertainty_m", "got an empty list, must be a number: a radius in m"),
        ({"uncertainty_m": [1.0, 2.0]}, "uncertainty_m", "got a list of 2 values"),
        ({"uncertainty_m": [1.0, -2.0, 3.0]}, "uncertainty_m", "got a list of 3 values"),
        (
            {"uncertainty_m": [1, 2.5, 0.1]},
            "uncertainty_m",
            "write 2.5, the radius of the ball that contains",
        ),
        (
            {"uncertainty_attitude_deg": [0, 0, 9]},
            "uncertainty_attitude_deg",
            "a ball, which has no attitude",
        ),
    ],
)
def test_faults(kind: object, values: dict[str, object], path: str, words: str) -> None:
    """Each fault is reported once, at its place, for jammers and eavesdroppers alike."""
    require_fault(lambda: kind(**values), path, words)
