"""Where the camera stands, and how far it sees."""

from types import SimpleNamespace

import numpy as np
import pytest

from nullpose.scenario import Scenario
from nullpose.studio.camera import aim
from nullpose.studio.scene import scene_size_m


@pytest.mark.parametrize("scale", [0.1, 1.0, 20.0, 400.0])
def test_nothing_of_a_scene_is_cut_away(paper: Scenario, scale: float) -> None:
    """From ten metres to tens of kilometres the whole scene lies between the near and the far plane."""
    nodes = tuple(
        one.model_copy(update={"position_m": tuple(scale * np.array(one.position_m))}) for one in paper.nodes
    )
    scenario = paper.model_copy(update={"nodes": nodes})
    camera = SimpleNamespace()
    aim(camera, scenario)
    reach_m = scene_size_m(scenario)
    forward = (camera.look_at - camera.position) / np.linalg.norm(camera.look_at - camera.position)
    for offset in np.ndindex(2, 2, 2):
        corner = camera.look_at + reach_m * (np.array(offset) - 0.5)
        assert camera.near < (corner - camera.position) @ forward < camera.far
    assert np.linalg.norm(camera.position - camera.look_at) < 0.1 * camera.far
