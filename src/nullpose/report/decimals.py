"""How many decimals a printed pose has, so that whoever types it again has the printed value."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.scenario import Scenario
from nullpose.study.evaluation import pose_faults

METRES, DEGREES, COMPONENTS = 4, 3, 6
"""The fewest decimals of a position in metres, of angles in degrees, and of components of unit length."""
_MOST = 10


def more_decimals(scenario: Scenario, pose: Pose) -> int:
    """Count the decimals beyond the fewest with which a printed pose is worth the printed value.

    Near a deep null or on a border they are more than elsewhere. Typed are the position with the attitude,
    which must be allowed if the pose is, and with the axis as angles or as a vector.

    Args:
        scenario: what the pose is evaluated in; with an array none are counted.
        pose: as reported.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> more_decimals(scenario, nullpose.Pose([0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=-0.5))
        2
    """
    if scenario.array is not None:
        return 0
    quantity, is_allowed = Quantity.of(scenario), not any(pose_faults(scenario, pose))

    def value(typed: Pose) -> float:
        return quantity.in_unit(objective_of_links(scenario, evaluate(scenario, typed)))

    exact = value(pose)
    last_digit = 10.0 ** (math.floor(math.log10(min(max(abs(exact), 0.1), 1e9))) - 6)  # of seven
    for more in range(_MOST):
        attitude, *axes = _typed(scenario, pose, more)
        is_off = any(abs(value(each) - exact) > 0.5 * last_digit for each in (attitude, *axes))
        if not (is_off or (is_allowed and any(pose_faults(scenario, attitude)))):
            return more
    return _MOST


def _typed(scenario: Scenario, pose: Pose, more: int) -> Iterator[Pose]:
    """Yield a pose with so many more decimals: by its attitude, then by its axis where that is all."""
    position_m, axis = (
        np.round(pose.position_m, METRES + more),
        np.round(pose.antenna_axis, COMPONENTS + more),
    )
    angles = [pose.roll_rad, pose.pitch_rad, pose.yaw_rad, tilt_rad(pose), azimuth_rad(pose)]
    roll, pitch, yaw, tilt, azimuth = np.radians(np.round(np.degrees(angles), DEGREES + more)).tolist()
    yield Pose(position_m, roll, pitch, yaw, pose.mount_rad)
    if scenario.antenna_record.is_quadratic:
        yield Pose.from_axis(position_m, axis)
        level = math.sin(tilt)
        yield Pose.from_axis(
            position_m, (level * math.cos(azimuth), level * math.sin(azimuth), math.cos(tilt))
        )
