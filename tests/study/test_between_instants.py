"""Samples of a flight between its instants."""

import numpy as np
import pytest
from flown import TIMES_S, flown
from scipy.spatial.transform import Rotation

from nullpose import Pose, min_sinr
from nullpose.solver.trajectory import Aim
from nullpose.study.between_instants import sample_between


def test_samples_hold_the_instants_and_what_is_between() -> None:
    """At the instants they have the flight's values; half-way the drone is half-way and half turned."""
    flight = flown()
    times_s, values = sample_between(flight, parts=4)
    assert times_s == pytest.approx(np.interp(np.arange(17) / 4, np.arange(5), TIMES_S))
    np.testing.assert_allclose(values[::4], flight.values, rtol=1e-9)
    first, second = (
        Rotation.from_euler("ZYX", (pose.yaw_rad, pose.pitch_rad, pose.roll_rad))
        for pose in flight.poses[1:3]
    )
    half_turned = first * (first.inv() * second) ** 0.5
    pose = Pose.from_axis(flight.poses[1].position_m, half_turned.apply([0.0, 0.0, 1.0]))  # it waits
    assert values[6] == pytest.approx(min_sinr(flight.scenario.at(6.0), pose), rel=1e-9)


def test_times_at_which_the_scene_is_none_are_left_out() -> None:
    """A jammer that drives through a node is at its place for a moment."""
    through = flown(Aim.WORST, "jammers.M.position_m=[-24, 0, 0]", "jammers.M.velocity_m_s=[4, 0, 0]")
    times_s, _ = sample_between(through, parts=2)
    assert 6.0 not in times_s
    assert len(times_s) == 8
