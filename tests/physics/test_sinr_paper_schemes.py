"""The paper's closed forms: eqs. 3.1 and 3.2, and eqs. 3.4 and 3.5 normalised."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from paper_schemes import maximum_gain_axis, maximum_gain_sinr, zero_interference_axis, zero_interference_sinr

from nullpose.physics import antenna_gain, sinr

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, nodes=st.integers(1, 5))
def test_equation_3_2_is_2_1_with_the_axis_of_3_1(
    seed: int, nodes: int, random_scene: Callable, random_poses: Callable
) -> None:
    """Eq. 3.2 and eq. 2.1 at the axis of eq. 3.1 are the same number."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, nodes, 1)
    positions, _ = random_poses(rng, 7)
    axes = zero_interference_axis(positions, scene.jammer_positions_m[0])
    np.testing.assert_allclose(np.linalg.norm(axes, axis=-1), 1.0, rtol=1e-15)
    np.testing.assert_allclose(
        zero_interference_sinr(scene, positions), sinr(scene, positions, axes), rtol=1e-13
    )


@given(seed=SEEDS, factor=st.floats(1e-6, 1e12))
def test_the_jamming_power_is_gone(
    seed: int, factor: float, scene: Callable, random_scene: Callable, random_poses: Callable
) -> None:
    """Neither eq. 3.2 nor eq. 2.1 at its axis feels the jammer's power, up to 120 dB more of it."""
    rng = np.random.default_rng(seed)
    one = random_scene(rng, 3, 1)
    one = scene(one.node_positions_m, one.jammer_positions_m, jammer_powers_w=one.jammer_powers_w)
    louder = scene(one.node_positions_m, one.jammer_positions_m, jammer_powers_w=factor * one.jammer_powers_w)
    position, _ = random_poses(rng)
    quiet = zero_interference_sinr(one, position)
    np.testing.assert_array_equal(zero_interference_sinr(louder, position), quiet)
    axis = zero_interference_axis(position, louder.jammer_positions_m[0])
    np.testing.assert_allclose(sinr(louder, position, axis), quiet, rtol=1e-12)


@pytest.mark.parametrize(
    ("form", "nodes", "jammers", "words"),
    [
        (zero_interference_sinr, 2, 0, "one jammer; this scenario has 0"),
        (zero_interference_sinr, 2, 2, "one jammer; this scenario has 2"),
        (maximum_gain_axis, 1, 1, "two nodes; this scenario has 1"),
        (maximum_gain_sinr, 3, 1, "two nodes; this scenario has 3"),
    ],
)
def test_other_numbers_are_refused(
    form: Callable, nodes: int, jammers: int, words: str, random_scene: Callable
) -> None:
    """Eq. 3.2 is for one jammer and eq. 3.4 for two nodes; the message says how many there are."""
    with pytest.raises(ValueError, match=words):
        form(random_scene(np.random.default_rng(1), nodes, jammers), np.array([0.0, 0.0, 10.0]))


@given(seed=SEEDS, jammers=st.integers(0, 3))
def test_equation_3_5_is_2_1_with_the_normalised_axis(
    seed: int, jammers: int, random_scene: Callable, random_poses: Callable
) -> None:
    """Eq. 3.5 is eq. 2.1 at the normalised axis of eq. 3.4, which is broadside to both nodes."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 2, jammers)
    position, _ = random_poses(rng)
    first, second = (np.array(node.position_m) - position for node in scene.nodes)
    axis = np.cross(first, second)
    axis /= np.linalg.norm(axis)
    found = maximum_gain_axis(scene, position)
    assert abs(found @ axis) == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(antenna_gain(position, found, scene.node_positions_m), 1.0, rtol=1e-11)
    jamming_w = 0.0
    for jammer in scene.jammers:
        away = np.array(jammer.position_m) - position
        cosine = float(away @ axis) / math.hypot(*away)
        jamming_w += (1.0 - cosine**2) * jammer.transmit_power_w / float(away @ away)
    expected = [
        node.transmit_power_w / float(away @ away) / (jamming_w + scene.receiver.noise_power_w)
        for node, away in zip(scene.nodes, (first, second), strict=True)
    ]
    np.testing.assert_allclose(maximum_gain_sinr(scene, position), expected, rtol=1e-10)
    np.testing.assert_allclose(sinr(scene, position, found), expected, rtol=1e-10)
