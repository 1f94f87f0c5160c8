"""Zero interference: eqs. 3.1 and 3.2."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import antenna_gain, sinr, zero_interference_axis, zero_interference_sinr

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
    louder = scene(
        one.node_positions_m, one.node_powers_w, one.jammer_positions_m, factor * one.jammer_powers_w
    )
    position, _ = random_poses(rng)
    quiet = zero_interference_sinr(one, position)
    np.testing.assert_array_equal(zero_interference_sinr(louder, position), quiet)
    axis = zero_interference_axis(position, louder.jammer_positions_m[0])
    np.testing.assert_allclose(sinr(louder, position, axis), quiet, rtol=1e-12)


@given(seed=SEEDS)
def test_the_null_is_on_the_jammer(seed: int, random_poses: Callable) -> None:
    """The gain towards the jammer is zero to the rounding of two directions, squared."""
    rng = np.random.default_rng(seed)
    position, _ = random_poses(rng)
    jammer = rng.uniform(0.0, 100.0, 3) * [1.0, 1.0, 0.05]
    assert antenna_gain(position, zero_interference_axis(position, jammer), jammer[None])[0] < 1e-31


@pytest.mark.parametrize("jammers", [0, 2])
def test_equation_3_2_is_for_one_jammer(jammers: int, random_scene: Callable) -> None:
    """Without a jammer, or with two, eq. 3.2 is refused, and the message says how many there are."""
    scene = random_scene(np.random.default_rng(1), 2, jammers)
    with pytest.raises(ValueError, match=f"one jammer; this scenario has {jammers}"):
        zero_interference_sinr(scene, np.array([0.0, 0.0, 10.0]))
