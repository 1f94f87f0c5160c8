"""What is received at poses, and the objective that a scenario makes of it."""

from collections.abc import Callable

import numpy as np
from hypothesis import given, strategies as st

from nullpose.physics import Reception, objective_value, received_power_w, sinr
from nullpose.physics.reception import node_values
from nullpose.scenario import Scenario, apply_overrides

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS)
def test_margin_is_the_sinr_over_what_is_required(
    seed: int, random_scene: Callable, random_poses: Callable
) -> None:
    """In decibels a requirement is taken off, by a weight the SINR is divided, and else it is left."""
    rng = np.random.default_rng(seed)
    scene, pose = random_scene(rng, 3, 2), random_poses(rng, 4, 2)
    demanding = apply_overrides(scene, ["nodes.S1.min_sinr_db=-4", "nodes.S3.weight=2.5"])
    ratios_db = 10.0 * np.log10(sinr(scene, *pose))
    margins_db = 10.0 * np.log10(node_values(Reception(demanding, *pose)))
    np.testing.assert_allclose(margins_db, ratios_db - [-4.0, 0.0, 10.0 * np.log10(2.5)], atol=1e-9)
    np.testing.assert_array_equal(objective_value(scene, *pose), sinr(scene, *pose).min(axis=-1))
    assert objective_value(demanding, *pose).shape == (4, 2)


def test_received_power(paper: Scenario) -> None:
    """Broadside at 10 m, 2 W arrive as the path gain times 2 W over 100 square metres, nodes first."""
    upright = ([0.0, 0.0, 1.0],)
    assert received_power_w(np.zeros(3), *upright, [[10.0, 0.0, 0.0]], [2.0], 1e-4) == 1e-4 * 2.0 / 100.0
    received_w = Reception(paper, [10.0, 0.0, 0.0], *upright).received_w
    assert (received_w.shape, received_w[0]) == ((3,), 0.01)
