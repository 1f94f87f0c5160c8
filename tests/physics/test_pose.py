"""Poses: frozen values whose axis is eq. 1.1."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose import Airframe, Scenario
from nullpose.physics import Pose

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, yaw=st.floats(-math.pi, math.pi), length=st.floats(1e-6, 1e6))
def test_a_pose_from_an_axis_has_that_axis(seed: int, yaw: float, length: float) -> None:
    """The pose built from an axis of any length and sign has it, pointing up, at the yaw asked for."""
    axis = np.random.default_rng(seed).normal(size=3)
    pose = Pose.from_axis([1.0, 2.0, 3.0], length * axis, yaw)
    unit = axis / np.linalg.norm(axis)
    np.testing.assert_allclose(pose.antenna_axis, unit if unit[2] > 0.0 else -unit, atol=1e-15)
    assert pose.yaw_rad == yaw
    assert abs(pose.roll_rad) <= math.pi / 2
    assert abs(pose.pitch_rad) <= math.pi / 2


@given(seed=SEEDS, tilt_deg=st.floats(0.0, 180.0), mount_deg=st.floats(0.0, 90.0))
def test_a_vehicle_has_its_dipole_along_every_axis_that_it_reaches(
    seed: int, tilt_deg: float, mount_deg: float
) -> None:
    """The axis is reproduced within the tilt; a dipole gives u and -u the same pose."""
    rng = np.random.default_rng(seed)
    scenario = Scenario.from_arrays([[0, 0, 0]], noise_w=1e-3, altitude_m=(8, 30)).model_copy(
        update={"airframe": Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg)}
    )
    angle = math.radians(rng.uniform(max(0.0, mount_deg - tilt_deg), min(90.0, mount_deg + tilt_deg)))
    azimuth, across = rng.uniform(-math.pi, math.pi), math.sin(angle)
    axis = np.array([across * math.cos(azimuth), across * math.sin(azimuth), math.cos(angle)])
    pose = Pose.of_airframe(scenario, [1.0, 2.0, 3.0], axis)
    assert pose == Pose.of_airframe(scenario, [1.0, 2.0, 3.0], -axis)
    assert pose.tilt_rad <= scenario.airframe.tilt_max_rad
    sign = math.copysign(1.0, pose.antenna_axis @ axis)
    np.testing.assert_allclose(sign * pose.antenna_axis, axis, atol=1e-12)


@given(seed=SEEDS)
def test_a_vehicle_that_takes_any_attitude_need_not_be_stated(seed: int) -> None:
    """Omnidirectional, stated or left out: the same axis has the same angles, with no yaw."""
    axis = np.random.default_rng(seed).normal(size=3)
    free = Scenario.from_arrays([[0, 0, 0]], noise_w=1e-3, altitude_m=(8, 30))
    stated = free.model_copy(update={"airframe": Airframe(preset="omnidirectional")})
    poses = [Pose.of_airframe(scenario, [1.0, 2.0, 3.0], axis) for scenario in (free, stated)]
    assert poses[0] == poses[1]
    assert poses[0].yaw_rad == 0.0


def test_a_pose_is_a_frozen_value() -> None:
    """Its six numbers make equality and hash, cannot be set, and do not follow the array given."""
    given_m = np.array([1.0, 2.0, 3.0])
    pose = Pose(given_m, 0.1, 0.2)
    given_m[0] = 9.0
    same = Pose([1, 2, 3], np.float64(0.1), 0.2, 0.0)
    others = [
        Pose([1.0, 2.0, 3.5], 0.1, 0.2),
        Pose(same.position_m, 0.15, 0.2),
        Pose(same.position_m, 0.1, 0.25),
    ]
    assert pose == same
    assert len({pose, same, *others}) == 4
    assert pose != "a pose"
    with pytest.raises(ValueError, match="read-only"):
        pose.position_m[0] = 5.0
    with pytest.raises(AttributeError):
        pose.roll_rad = 0.0


@pytest.mark.parametrize(
    ("position_m", "angles"),
    [
        ([1.0, 2.0], (0.0, 0.0, 0.0)),
        ([[1.0, 2.0, 3.0]], (0.0, 0.0, 0.0)),
        ([1.0, 2.0, math.nan], (0.0, 0.0, 0.0)),
        ([1.0, 2.0, 3.0], (0.0, math.inf, 0.0)),
    ],
)
def test_bad_numbers_are_refused(position_m: list, angles: tuple[float, float, float]) -> None:
    """A position not of three components, or a number that is not finite, is refused with what was given."""
    with pytest.raises(ValueError, match=r"three finite numbers|finite angles"):
        Pose(position_m, *angles)
