"""The SINR of each link: eq. 2.1, and what must leave it unchanged."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import (
    ErrorCase,
    Reception,
    digital_sinr,
    eavesdropper_snr,
    evaluate,
    node_snr,
    received_power_w,
    secrecy_rate,
    sinr,
)
from nullpose.physics.pose import Pose
from nullpose.scenario import Jammer, Receiver, Scenario, apply_overrides
from scenes import small

SEEDS = st.integers(0, 2**32 - 1)
NODES = st.integers(1, 6)
JAMMERS = st.integers(0, 3)


@given(seed=SEEDS, nodes=NODES, jammers=JAMMERS)
def test_sinr_is_equation_2_1(
    seed: int, nodes: int, jammers: int, random_scene: Callable, random_poses: Callable
) -> None:
    """The SINR is eq. 2.1 with the gains of eq. 1.4 as printed, written out in plain Python."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, nodes, jammers)
    position, axis = random_poses(rng)

    def received(point_m: tuple[float, float, float], power_w: float) -> float:
        distance = math.dist(point_m, position)
        cosine = sum((q - p) / distance * a for q, p, a in zip(point_m, position, axis, strict=True))
        return (1.0 - cosine**2) * power_w / distance**2

    interference_w = sum(received(j.position_m, j.transmit_power_w) for j in scene.jammers)
    expected = [
        received(node.position_m, node.transmit_power_w) / (interference_w + scene.receiver.noise_power_w)
        for node in scene.nodes
    ]
    np.testing.assert_allclose(sinr(scene, position, axis), expected, rtol=1e-12, atol=1e-14)


@given(seed=SEEDS)
def test_moving_the_whole_scene_changes_nothing(
    seed: int, random_scene: Callable, random_poses: Callable
) -> None:
    """Rotating and shifting nodes, jammers, position and axis together leaves every SINR unchanged."""
    rng = np.random.default_rng(seed)
    before, (position, axis) = random_scene(rng, 4, 2), random_poses(rng)
    rotation, shift_m = Rotation.from_quat(rng.normal(size=4)).as_matrix(), rng.uniform(-100.0, 100.0, 3)
    moved_m = before.source_positions_m @ rotation.T + shift_m
    after = sinr(before, rotation @ position + shift_m, rotation @ axis, moved_m)
    np.testing.assert_allclose(after, sinr(before, position, axis), rtol=1e-9)


@given(seed=SEEDS, nodes=NODES, jammers=JAMMERS)
def test_one_more_jammer_never_helps(
    seed: int, nodes: int, jammers: int, random_scene: Callable, random_poses: Callable
) -> None:
    """Adding a jammer raises no node's SINR, at any pose."""
    rng = np.random.default_rng(seed)
    more = random_scene(rng, nodes, jammers + 1)
    fewer = more.model_copy(update={"jammers": more.jammers[:-1]})
    positions, axes = random_poses(rng, 50)
    assert np.all(sinr(more, positions, axes) <= sinr(fewer, positions, axes))


@given(seed=SEEDS, gain_db=st.floats(-120.0, 20.0))
def test_path_gain_weighs_against_the_noise_only(
    seed: int, gain_db: float, random_scene: Callable, random_poses: Callable
) -> None:
    """A path gain at 1 m is the same as that much less noise."""
    rng = np.random.default_rng(seed)
    plain, pose = random_scene(rng, 3, 2), random_poses(rng)
    noise_w = plain.receiver.noise_power_w
    gained = Receiver(noise_w=noise_w, reference_gain_db=gain_db)
    quieter = Receiver(noise_w=noise_w / 10.0 ** (gain_db / 10.0), reference_gain_db=0.0)
    ratios = [sinr(plain.model_copy(update={"receiver": each}), *pose) for each in (gained, quieter)]
    np.testing.assert_allclose(*ratios, rtol=1e-12)


def test_shapes_follow_the_poses(random_scene: Callable, random_poses: Callable) -> None:
    """Leading shapes of positions and axes broadcast, nodes come last, and each entry is the scalar call."""
    rng = np.random.default_rng(12)
    scene = random_scene(rng, 3, 2)
    positions, _ = random_poses(rng, 4, 1)
    _, axes = random_poses(rng, 5)
    ratios = sinr(scene, positions, axes)
    assert ratios.shape == (4, 5, 3)
    for i, j in np.ndindex(4, 5):
        np.testing.assert_allclose(ratios[i, j], sinr(scene, positions[i, 0], axes[j]), rtol=1e-14)


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
