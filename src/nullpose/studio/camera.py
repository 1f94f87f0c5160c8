"""Where the camera stands at first, and how far it sees."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullpose.scenario import Scenario
from nullpose.studio.scene import scene_size_m

_FAR = 100.0  # sizes of the scene that the camera sees, which leaves room to move away from it


def aim(camera: Any, scenario: Scenario) -> None:
    """Let a camera look at the whole of a scene.

    Args:
        camera: of a page, or the one that pages begin with.
        scenario: the scene.
    """
    size_m = scene_size_m(scenario)
    points = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    middle[2] = max(0.08 * size_m, 0.5 * float(scenario.airspace.lower_m[2]))
    camera.position, camera.look_at = middle + size_m * np.array([0.82, -0.52, 0.56]), middle
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    camera.near = 0.02 * size_m
    camera.far = _FAR * size_m
