"""The downlink: what nodes and eavesdroppers receive, and the rate that stays secret."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import eavesdropper_snr, node_snr, received_power_w, secrecy_rate
from nullpose.scenario import Jammer, Scenario
from scenes import small

SEEDS = st.integers(0, 2**32 - 1)


def random_secret(rng: np.random.Generator, nodes: int = 3, eavesdroppers: int = 2) -> Scenario:
    """Returns a scene with places on a field of 100 m and noise over two decades."""
    places = rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (nodes + eavesdroppers, 3)).tolist()
    points = [{"position_m": at, "noise_w": 10.0 ** rng.uniform(-5.0, -3.0)} for at in places]
    return Scenario.from_dict(
        {
            "objective": "secrecy-rate",
            "airspace": {"altitude_m": [8.0, 40.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 3.0},
            "transmitter": {"power_w": 10.0 ** rng.uniform(-1.0, 1.0)},
            "nodes": points[:nodes],
            "eavesdroppers": points[nodes:],
        }
    )


@given(seed=SEEDS)
def test_snr_is_the_received_power_over_the_noise(seed: int, random_poses: Callable) -> None:
    """Each point receives from the drone what the drone would receive from it, over the point's own noise."""
    rng = np.random.default_rng(seed)
    scene, (position, axis) = random_secret(rng), random_poses(rng, 5)
    power = scene.transmitter.transmit_power_w
    for snr, points, noise in (
        (node_snr, scene.node_positions_m, scene.node_noise_w),
        (eavesdropper_snr, scene.eavesdropper_positions_m, scene.eavesdropper_noise_w),
    ):
        powers = np.full(len(points), power)
        expected = received_power_w(position, axis, points, powers, scene.receiver.reference_gain) / noise
        np.testing.assert_allclose(snr(scene, position, axis), expected, rtol=1e-13)


@given(seed=SEEDS)
def test_rate_is_the_difference_of_two_capacities(seed: int, random_poses: Callable) -> None:
    """The printed form, log2(1 + SNR) less the largest that is overheard, cut at 0, is the same number."""
    rng = np.random.default_rng(seed)
    scene, (position, axis) = random_secret(rng), random_poses(rng, 20)
    heard = np.log2(1.0 + node_snr(scene, position, axis))
    overheard = np.log2(1.0 + eavesdropper_snr(scene, position, axis)).max(axis=-1)
    expected = np.maximum(0.0, heard - overheard[:, None])
    rate = secrecy_rate(scene, position, axis)
    assert rate.shape == (20, 3)
    assert (rate >= 0.0).all()
    assert (rate[heard < overheard[:, None] - 1e-12] == 0.0).all()
    np.testing.assert_allclose(rate, expected, atol=1e-13)


def test_weak_signals_keep_their_digits() -> None:
    """With SNRs far below the spacing of numbers at 1, the rate is still right to twelve digits."""
    ears = [{"position_m": [-10, 0, 0], "noise_w": 2e-3}]
    ground = {"nodes": [{"position_m": [10, 0, 0]}], "eavesdroppers": ears}
    scene = Scenario(**small(objective="secrecy-rate", transmitter={"power_w": 1e-18}, **ground))
    snr = 1e-15 / 164.0 * (1.0 - 64.0 / 164.0)  # 8 m above, 10 m beside an upright dipole
    rate = secrecy_rate(scene, [0.0, 0.0, 8.0], [0.0, 0.0, 1.0])
    assert rate[0] == pytest.approx((snr - snr / 2.0) / math.log(2.0), rel=1e-12)


def test_a_jammer_lowers_the_rate(random_poses: Callable) -> None:
    """A jammer raises the nodes' noise, and no eavesdropper's."""
    rng = np.random.default_rng(6)
    scene = random_secret(rng)
    jammer = Jammer(position_m=(50.0, 50.0, 3.0), power_w=0.1)
    jammed = scene.model_copy(update={"jammers": [jammer]})
    position, axis = random_poses(rng, 10)
    heard = [eavesdropper_snr(each, position, axis) for each in (scene, jammed)]
    np.testing.assert_array_equal(*heard)
    assert (jammed.node_noise_w > scene.node_noise_w).all()
    assert (secrecy_rate(jammed, position, axis) <= secrecy_rate(scene, position, axis)).all()


def test_without_a_transmitter(paper: Scenario) -> None:
    """A scenario in which the drone only listens has no downlink, and says so."""
    for of_downlink in (node_snr, eavesdropper_snr, secrecy_rate):
        with pytest.raises(ValueError, match=r"add a \[transmitter\]"):
            of_downlink(paper, [0.0, 0.0, 9.0], [0.0, 0.0, 1.0])
