"""What a trajectory gives between its instants: samples, of which nothing is proved."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from nullpose.errors import ScenarioError
from nullpose.objectives import FloatArray
from nullpose.physics import Pose, evaluate, objective_of_links, rotation_world_from_body
from nullpose.physics.rotation import attitude_of
from nullpose.solver.trajectory import Trajectory

PARTS = 10
"""Samples from an instant to the next."""


def sample_between(flight: Trajectory, parts: int = PARTS) -> FloatArray:
    """Evaluate a flight at and between its instants: on straight lines, the attitude turning evenly.

    Times at which the scene is none, such as with two points at one place, are left out.

    Args:
        flight: the trajectory.
        parts: samples from an instant to the next.

    Returns:
        Times in s and values, power ratios or bits/s/Hz, (2, n).
    """
    poses, instants_s, samples = flight.poses, flight.times_s, []
    turns = [rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad) for pose in poses]
    times_s = np.interp(np.arange(parts * (len(poses) - 1) + 1) / parts, np.arange(len(poses)), instants_s)
    places_m = np.stack([np.interp(times_s, instants_s, axis) for axis in flight.positions_m.T], axis=1)
    attitudes = Slerp(instants_s, Rotation.from_matrix(turns))(times_s).as_matrix()
    for time_s, place_m, attitude in zip(times_s.tolist(), places_m, attitudes, strict=True):
        with suppress(ScenarioError):
            scene = flight.scenario.at(time_s)
            pose = Pose(place_m, *attitude_of(attitude), poses[0].mount_rad)
            samples.append((time_s, objective_of_links(scene, evaluate(scene, pose))))
    return np.array(samples).T
