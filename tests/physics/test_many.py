"""Many scenes at once: the same numbers as one at a time."""

import numpy as np
from hypothesis import given, strategies as st

from nullpose.physics import margin, margins_of_many
from nullpose.scenario import Scenario


def random_scene(rng: np.random.Generator, nodes: int, jammers: int) -> Scenario:
    """Returns a scene with as many points as asked for, some of its nodes with a weight."""
    ground = [0.0, 0.0, 0.0], [60.0, 60.0, 4.0]
    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": rng.uniform(1e-4, 1e-2), "reference_gain_db": rng.uniform(-50.0, 10.0)},
            "nodes": [
                {"position_m": rng.uniform(*ground).tolist(), "power_w": rng.uniform(0.1, 3.0)}
                | ({"weight": rng.uniform(0.2, 5.0)} if rng.uniform() < 0.3 else {})
                for _ in range(nodes)
            ],
            "jammers": [
                {"position_m": rng.uniform(*ground).tolist(), "power_w": 10.0 ** rng.uniform(-2.0, 3.0)}
                for _ in range(jammers)
            ],
        }
    )


@given(seed=st.integers(0, 2**32 - 1), nodes=st.integers(1, 12), jammers=st.integers(0, 4))
def test_each_scene_has_its_own_margins(seed: int, nodes: int, jammers: int) -> None:
    """To the last digit those of one scene alone."""
    rng = np.random.default_rng(seed)
    scenes = [random_scene(rng, nodes, jammers) for _ in range(5)]
    places = rng.uniform([-20.0, -20.0, 8.0], [80.0, 80.0, 30.0], (5, 3))
    axes = rng.normal(size=(5, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    together = margins_of_many(scenes, places, axes)
    assert together.shape == (5, nodes)
    for scene, place, axis, margins in zip(scenes, places, axes, together, strict=True):
        np.testing.assert_array_equal(margins, margin(scene, place, axis))
