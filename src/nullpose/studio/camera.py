"""Where the camera stands at first, and how far it sees."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario import Scenario
from nullpose.studio.scene import scene_size_m

__all__ = ["camera_m", "near_m"]


def camera_m(scenario: Scenario) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where the camera stands at first, and what it looks at, each (3,) in metres.

    Args:
        scenario: the scene.
    """
    size_m = scene_size_m(scenario)
    points = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    middle[2] = max(0.08 * size_m, 0.5 * float(scenario.airspace.lower_m[2]))
    return middle + size_m * np.array([0.82, -0.52, 0.56]), middle


def near_m(scenario: Scenario) -> float:
    """Return from how far off the camera sees anything, metres.

    Args:
        scenario: the scene.
    """
    # in most scenes beyond the one metre at which viser keeps a pane for background images, whose pixels it
    # works out one by one though there is no image: about a sixth of a picture's time without a graphics card
    return 0.02 * scene_size_m(scenario)
