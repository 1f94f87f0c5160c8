"""What is received through channels other than free space."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import ErrorCase, Reception, digital_sinr, evaluate, sinr
from nullpose.physics.pose import Pose
from nullpose.scenario import Scenario, apply_overrides

SEEDS = st.integers(0, 2**32 - 1)
URBAN = 'channel={model="elevation", environment="urban", average="%s"}'
CHANNELS = ['channel={model="power-law", exponent=2.7}', URBAN % "power", URBAN % "db", URBAN % "guaranteed"]
CHANNELS.append('channel={model="elevation", environment="urban", average="power", exponent=2.7}')


def test_free_space_by_another_name(random_scene: Callable, random_poses: Callable) -> None:
    """A power law of exponent 2 from 1 m is free space, to the last bit."""
    rng = np.random.default_rng(11)
    scene, (position_m, axis) = random_scene(rng, 3, 2), random_poses(rng)
    for channel in ({"model": "free-space"}, {"model": "power-law", "exponent": 2.0}):
        same = Scenario.from_dict(scene.to_dict() | {"channel": channel})
        assert same.source_channels is None
        pose = Pose.from_axis(position_m, axis)
        assert evaluate(same, pose) == evaluate(scene, pose)


def test_reference_gain_holds_at_the_reference_distance(paper: Scenario) -> None:
    """At 5 m the law from 5 m has the reference gain, and at 50 m a thousandth of it for an exponent of 3."""
    channel = "channel={model='power-law', exponent=3, reference_distance_m=5.0}"
    scene = apply_overrides(paper, ["airspace.keep_out_m=5", channel, "receiver.reference_gain_db=-10"])
    for distance_m, gain in ((5.0, 0.1), (50.0, 1e-4)):
        received_w = Reception(scene, [distance_m, 0.0, 0.0], [0.0, 0.0, 1.0]).received_w
        assert received_w[0] == pytest.approx(gain, rel=1e-12)


@given(seed=SEEDS)
def test_guaranteed_is_below_the_mean(seed: int, random_scene: Callable, random_poses: Callable) -> None:
    """Nodes out of sight and jammers in sight: no mean is worse at any pose."""
    rng = np.random.default_rng(seed)
    scene, pose = random_scene(rng, 3, 2), random_poses(rng, 5)
    worst, *means = (sinr(apply_overrides(scene, [URBAN % each]), *pose) for each in ("guaranteed", "power"))
    assert np.all(worst <= means[0])


@pytest.mark.parametrize("channel", CHANNELS)
def test_a_point_has_its_own_channel(channel: str, paper: Scenario) -> None:
    """A jammer that states free space is received as in free space; nodes follow the scenario."""
    pose = ([-2.0, 24.0, 40.0], [0.6, 0.0, 0.8])
    free = Reception(paper, *pose).received_w
    scene = apply_overrides(paper, [channel, "jammers.M1.channel=free-space"])
    received_w = Reception(scene, *pose).received_w
    assert received_w[2] == free[2]
    assert np.all(received_w[:2] < free[:2])
    assert scene.jammer_channels is None
    assert scene.node_channels is not None


@pytest.mark.parametrize("channel", CHANNELS)
def test_an_error_moves_the_channel_along(channel: str, paper: Scenario) -> None:
    """A jammer that is elsewhere is seen from there: the same as a scenario that states it there."""
    scene, moved_m = apply_overrides(paper, [channel]), np.array([30.0, -40.0, 2.0])
    there = (np.array(scene.jammers[0].position_m) + moved_m).tolist()
    stated = apply_overrides(scene, [f"jammers.M1.position_m={there}"])
    case = ErrorCase(
        position_offset_m=np.zeros(3),
        rotation_world=np.eye(3),
        jammer_offsets_m=moved_m[None],
        eavesdropper_offsets_m=np.zeros((0, 3)),
    )
    pose = ([-2.0, 24.0, 40.0], [0.6, 0.0, 0.8])
    np.testing.assert_allclose(Reception(scene, *pose, case).sinr, Reception(stated, *pose).sinr, rtol=1e-12)


@pytest.mark.parametrize("channel", CHANNELS)
def test_one_element_is_the_upright_dipole(channel: str, paper: Scenario) -> None:
    """An array of one element receives through the channel what one upright dipole does."""
    scene, position_m = apply_overrides(paper, [channel]), [-2.0, 24.0, 40.0]
    np.testing.assert_allclose(
        digital_sinr(scene, position_m, np.zeros((1, 3))),
        sinr(scene, position_m, [0.0, 0.0, 1.0]),
        rtol=1e-12,
    )


def test_eavesdroppers_are_interferers(paper: Scenario) -> None:
    """With guaranteed averages those who listen are in sight, and a jammer that disturbs a node as well."""
    data = paper.to_dict() | {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}}
    data["eavesdroppers"] = [{"position_m": [30.0, 5.0, 4.0]}]
    free = Scenario.from_dict(data)
    scene = apply_overrides(free, [URBAN % "guaranteed"])
    assert scene.eavesdropper_channels.strengths == pytest.approx([10.0**-0.1])
    assert scene.node_channels.strengths == pytest.approx([0.01, 0.01])
    noise_w = scene.receiver.noise_power_w
    np.testing.assert_allclose(
        scene.node_noise_w - noise_w, 10.0**-0.1 * (free.node_noise_w - noise_w), rtol=1e-12
    )
