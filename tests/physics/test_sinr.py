"""The SINR of each link: eq. 2.1, and what must leave it unchanged."""

import math
from collections.abc import Callable

import numpy as np
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import sinr
from nullpose.scenario import Receiver

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
