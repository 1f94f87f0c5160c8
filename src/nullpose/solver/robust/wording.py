"""An error case in words."""

from __future__ import annotations

import math

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.physics.error_case import ErrorCase
from nullpose.scenario import Scenario

_LEAST_RAD = 1e-9
_LEAST_M = 1e-6


def in_words(scenario: Scenario, axis: FloatArray, case: ErrorCase) -> str:
    """Return an error case as a phrase: what is off by how much, and in which direction.

    Args:
        scenario: has the names of jammers and eavesdroppers.
        axis: (3,) the commanded unit antenna axis; the phrase speaks of its end that points up.
        case: the error case.
    """
    up = axis if axis[2] >= 0.0 else -axis
    parts = []
    if case.rotation_rad > _LEAST_RAD:
        lean = case.rotation_world @ up - up
        parts.append(f"axis {math.degrees(case.rotation_rad):.3g} deg off, {_direction(lean)}")
    moved = [("drone", case.position_offset_m)]
    moved += zip(scenario.jammer_names, case.jammer_offsets_m, strict=True)
    moved += zip(scenario.eavesdropper_names, case.eavesdropper_offsets_m, strict=True)
    for name, offset_m in moved:
        distance_m = float(np.linalg.norm(offset_m))
        if distance_m > _LEAST_M:
            parts.append(f"{name} {distance_m:.3g} m off, {_direction(offset_m)}")
    return "; ".join(parts) if parts else "everything as stated"


def _direction(vector: FloatArray) -> str:
    """Return a direction by its azimuth, from east towards north, and its elevation."""
    east, north, up = vector
    azimuth_deg = math.degrees(math.atan2(north, east)) % 360.0
    elevation_deg = math.degrees(math.atan2(up, math.hypot(east, north)))
    return f"towards azimuth {round(azimuth_deg) % 360:d} deg, elevation {round(elevation_deg):d} deg"
