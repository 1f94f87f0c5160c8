"""The box that a proof begins with, and the bound that distances alone give."""

from collections.abc import Callable

import numpy as np

from nullpose.physics import sinr
from nullpose.problem.build import build_family
from nullpose.solver.kernels.bounds.node import COLUMNS
from nullpose.solver.kernels.bounds.root import fill_root, reach_by_distance


def test_no_pose_exceeds_what_distances_allow(random_scene: Callable) -> None:
    """The smallest SINR of any pose of the domain is at most the bound, by the physics."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        scene = random_scene(rng, 3, 2, 30.0)
        family = build_family(scene)
        bound, farthest = reach_by_distance(family.ratios, family.domain)
        position_m = rng.uniform(
            [-40.0, -40.0, family.domain.low_m[2]], [40.0, 40.0, family.domain.high_m[2]], (5000, 3)
        )
        axis = rng.normal(size=(5000, 3))
        ratios = sinr(scene, position_m, axis / np.linalg.norm(axis, axis=1, keepdims=True))
        assert np.all(np.min(ratios, axis=1) <= bound)
        assert np.all(ratios[:, farthest] <= bound)


def test_the_box_holds_what_reaches_the_value(random_scene: Callable) -> None:
    """Every position at which some pose reaches the incumbent's value is in the root box."""
    rng = np.random.default_rng(6)
    for _ in range(10):
        scene = random_scene(rng, 3, 1, 30.0)
        family = build_family(scene)
        position_m = rng.uniform(
            [-40.0, -40.0, family.domain.low_m[2]], [40.0, 40.0, family.domain.high_m[2]], (5000, 3)
        )
        axis = rng.normal(size=(5000, 3))
        value = np.min(sinr(scene, position_m, axis / np.linalg.norm(axis, axis=1, keepdims=True)), axis=1)
        level, row = np.quantile(value, 0.9), np.zeros(COLUMNS)
        fill_root(family.ratios, family.domain, np.log(level), 1e-3, 1e9, np.ones(3), np.ones(3), row)
        assert np.all(np.abs(position_m[value >= level] - row[:3]) <= row[3:6])
