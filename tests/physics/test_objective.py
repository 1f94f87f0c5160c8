"""Margins, and the value that a scenario asks for."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import margin, objective_value, secrecy_rate, sinr
from nullpose.scenario import Scenario, apply_overrides

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS)
def test_margin_is_the_sinr_over_what_is_required(
    seed: int, random_scene: Callable, random_poses: Callable
) -> None:
    """In decibels a requirement is taken off, by a weight the SINR is divided, and else it is left."""
    rng = np.random.default_rng(seed)
    scene, (position, axis) = random_scene(rng, 3, 2), random_poses(rng, 4)
    stated = apply_overrides(scene, ["nodes.S1.min_sinr_db=-4", "nodes.S3.weight=2.5"])
    ratios_db = 10.0 * np.log10(sinr(scene, position, axis))
    margins_db = 10.0 * np.log10(margin(stated, position, axis))
    taken_off_db = [-4.0, 0.0, 10.0 * np.log10(2.5)]
    np.testing.assert_allclose(margins_db, ratios_db - taken_off_db, atol=1e-9)


@given(seed=SEEDS)
def test_without_weights_it_is_the_smallest_sinr(
    seed: int, random_scene: Callable, random_poses: Callable
) -> None:
    """The value of a plain scenario is the paper's, to the last bit."""
    rng = np.random.default_rng(seed)
    scene, (position, axis) = random_scene(rng, 4, 1), random_poses(rng, 3, 2)
    value = objective_value(scene, position, axis)
    assert value.shape == (3, 2)
    np.testing.assert_array_equal(value, sinr(scene, position, axis).min(axis=-1))
    np.testing.assert_array_equal(margin(scene, position, axis), sinr(scene, position, axis))


@given(seed=SEEDS, factor=st.floats(0.01, 100.0))
def test_weights_scale_the_value_and_not_the_choice(
    seed: int, factor: float, random_scene: Callable, random_poses: Callable
) -> None:
    """The same weight on every node divides every value by it."""
    rng = np.random.default_rng(seed)
    scene, (position, axis) = random_scene(rng, 3, 1), random_poses(rng, 6)
    weighted = apply_overrides(scene, [f"nodes.S{i}.weight={factor!r}" for i in (1, 2, 3)])
    np.testing.assert_allclose(
        objective_value(weighted, position, axis) * factor, objective_value(scene, position, axis), rtol=1e-13
    )


def test_with_the_secrecy_rate(paper: Scenario, random_poses: Callable) -> None:
    """With that objective the value is the smallest secrecy rate over the nodes."""
    secret = apply_overrides(
        paper,
        [
            "objective=secrecy-rate",
            "transmitter.power_w=1",
            "jammers=[]",
            "eavesdroppers=[{position_m = [17, 15, 4]}]",
        ],
    )
    position, axis = random_poses(np.random.default_rng(1), 20)
    rates = secrecy_rate(secret, position, axis)
    value = objective_value(secret, position, axis)
    np.testing.assert_array_equal(value, rates.min(axis=-1))
    assert value.shape == (20,)


def test_one_pose_gives_a_number(paper: Scenario) -> None:
    """A single pose gives an array without dimensions, which is as good as a number."""
    value = objective_value(paper, [-2.24, 23.82, 8.0], [0.0, 0.0, 1.0])
    assert value.shape == ()
    assert float(value) == pytest.approx(float(sinr(paper, [-2.24, 23.82, 8.0], [0.0, 0.0, 1.0]).min()))
