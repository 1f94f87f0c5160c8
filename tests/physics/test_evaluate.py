"""What a pose gives each node of a scenario."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import (
    Link,
    Pose,
    antenna_axis,
    evaluate,
    min_margin,
    min_secrecy_rate,
    min_sinr,
    node_snr,
    objective_value,
    secrecy_rate,
    sinr,
)
from nullpose.scenario import Scenario, apply_overrides

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, yaw=st.floats(-math.pi, math.pi))
def test_links_are_the_sinr_of_the_pose(
    seed: int, yaw: float, random_scene: Callable, random_poses: Callable
) -> None:
    """Each node's link, in order, is eq. 2.1 at the pose's axis, whatever the yaw; the least is min_sinr."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 4, 2)
    position, axis = random_poses(rng)
    pose = Pose.from_axis(position, axis, yaw)
    links = evaluate(scene, pose)
    assert [link.node for link in links] == ["S1", "S2", "S3", "S4"]
    np.testing.assert_allclose([link.sinr for link in links], sinr(scene, position, axis), rtol=1e-9)
    np.testing.assert_allclose(
        [link.sinr_db for link in links], 10.0 * np.log10([link.sinr for link in links]), atol=1e-12
    )
    assert min_sinr(scene, pose) == min(link.sinr for link in links)


def test_the_paper_at_its_optimum(paper: Scenario) -> None:
    """At the place known as the paper's optimum for P_M/P = 1 a fine grid of axes comes to 0.9837 dB."""
    position = np.array([-2.24, 23.82, 8.0])
    roll, pitch = np.meshgrid(np.linspace(-0.31, -0.29, 201), np.linspace(-1.39, -1.37, 201))
    ratios = np.min(sinr(paper, position, antenna_axis(roll, pitch)), axis=-1)
    at = np.unravel_index(np.argmax(ratios), ratios.shape)
    best = min_sinr(paper, Pose(position, roll[at], pitch[at]))
    assert best == pytest.approx(ratios[at], rel=1e-13)
    assert 10.0 * math.log10(best) == pytest.approx(0.9837, abs=1e-4)
    below = evaluate(paper, Pose([0.0, 0.0, 10.0], 0.0, 0.0))  # the first node is straight along the dipole
    assert below[0] == Link("S1", {"sinr": 0.0, "sinr_db": -math.inf})
    assert below[1].sinr > 0.0


POSE = Pose([3.0, 24.0, 9.0], 0.2, -1.1)


def test_links_with_margins(paper: Scenario) -> None:
    """If any node states a requirement every link has a margin; the least is what the scenario asks for."""
    for link in evaluate(paper, POSE):
        assert (link.margin, link.margin_db, link.secrecy_rate_bps_hz) == (None, None, None)
    assert min_margin(paper, POSE) == min_sinr(paper, POSE)
    stated = apply_overrides(paper, ["nodes.S2.min_sinr_db=-6"])
    first, second = evaluate(stated, POSE)
    assert first.margin == first.sinr
    assert first.margin_db == first.sinr_db
    assert second.margin_db == pytest.approx(second.sinr_db + 6.0, abs=1e-12)
    assert min_margin(stated, POSE) == min(first.margin, second.margin)
    assert min_margin(stated, POSE) == objective_value(stated, POSE.position_m, POSE.antenna_axis)
    assert min_sinr(stated, POSE) == min_sinr(paper, POSE)
    assert second.secrecy_rate_bps_hz is None


def test_links_of_the_downlink(paper: Scenario) -> None:
    """With the secrecy rate a link is the node's reception of the drone: its SNR and its rate."""
    changes = ["transmitter.power_w=2", "eavesdroppers=[{position_m = [-20, 15, 4]}]"]
    secret = apply_overrides(paper, ["objective=secrecy-rate", *changes])
    links = evaluate(secret, POSE)
    at = (secret, POSE.position_m, POSE.antenna_axis)
    assert [link.sinr for link in links] == list(node_snr(*at))
    assert [link.secrecy_rate_bps_hz for link in links] == list(secrecy_rate(*at))
    assert [link.margin for link in links] == [None, None]
    assert min_secrecy_rate(secret, POSE) == min(link.secrecy_rate_bps_hz for link in links)
    assert min_secrecy_rate(secret, POSE) == objective_value(*at)
    assert type(links[0].secrecy_rate_bps_hz) is float
