"""Attitude and antenna axis: eq. 1.1, against SciPy's rotations and back again."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import Pose, antenna_axis, attitude_from_axis, rotation_world_from_body
from nullpose.physics.rotation import attitude_of, attitude_of_axis

QUARTER = math.pi / 2.0
MOUNTS = st.one_of(st.sampled_from([0.0, QUARTER]), st.floats(0.0, QUARTER))
ANGLES = st.floats(-math.pi, math.pi)
SEEDS = st.integers(0, 2**32 - 1)


@given(ANGLES, ANGLES, ANGLES)
def test_axis_is_equation_1_1(roll: float, pitch: float, yaw: float) -> None:
    """The antenna axis is eq. 1.1 as the paper prints it."""
    printed = [
        math.cos(roll) * math.sin(pitch) * math.cos(yaw) + math.sin(roll) * math.sin(yaw),
        math.cos(roll) * math.sin(pitch) * math.sin(yaw) - math.sin(roll) * math.cos(yaw),
        math.cos(roll) * math.cos(pitch),
    ]
    np.testing.assert_allclose(antenna_axis(roll, pitch, yaw), printed, atol=1e-15)


@given(ANGLES, ANGLES, ANGLES)
def test_order_is_yaw_pitch_roll(roll: float, pitch: float, yaw: float) -> None:
    """The rotation is SciPy's intrinsic ZYX: yaw about z, then pitch about the new y, then roll about x."""
    ours = rotation_world_from_body(roll, pitch, yaw)
    np.testing.assert_allclose(ours, Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix(), atol=1e-15)


@given(st.floats(-1.57, 1.57), st.floats(-1.57, 1.57), ANGLES)
def test_axis_of_an_attitude_gives_it_back(roll: float, pitch: float, yaw: float) -> None:
    """An attitude inside the chart is recovered from its axis."""
    back = attitude_from_axis(antenna_axis(roll, pitch, yaw), yaw)
    # beside roll = 90 degrees the pitch is read off a vector of length cos(roll)
    np.testing.assert_allclose(back, (roll, pitch), atol=1e-15 / math.cos(roll) + 1e-14)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(
    ("axis", "roll", "pitch"),
    [
        ([0.0, 0.0, 1.0], 0.0, 0.0),
        ([1.0, 0.0, 0.0], 0.0, math.pi / 2),
        ([0.0, 1.0, 0.0], math.pi / 2, 0.0),
        ([1e-300, 0.0, 1.0], 0.0, 1e-300),
        ([1.0, 0.0, 1e-300], 0.0, math.pi / 2),
    ],
)
def test_one_attitude_for_both_signs(sign: float, axis: list[float], roll: float, pitch: float) -> None:
    """An axis and its opposite have the same attitude, along the frame's axes and beside them too."""
    assert attitude_from_axis(sign * np.array(axis)) == pytest.approx((roll, pitch), abs=1e-300)


@given(SEEDS, st.one_of(st.just(0.0), st.floats(1e-9, math.pi)), st.floats(-16.0, -6.0))
def test_attitudes_keep_within_a_tilt(seed: int, tilt_max: float, error: float) -> None:
    """What is beyond a tilt by rounding is not beyond it as angles, and level is exactly level."""
    rng = np.random.default_rng(seed)
    yaw, towards = rng.uniform(-math.pi, math.pi, 2)
    tilt = min(tilt_max + 10.0**error, math.pi)
    stated = Rotation.from_euler("ZYZ", [towards, tilt, yaw - towards]).as_matrix()
    roll, pitch, found = attitude_of(stated, tilt_max)
    assert Pose([0.0, 0.0, 8.0], roll, pitch, found).tilt_rad <= tilt_max
    assert tilt_max > 0.0 or (roll, pitch) == (0.0, 0.0)
    moved = Rotation.from_matrix(rotation_world_from_body(roll, pitch, found).T @ stated).magnitude()
    assert moved <= 200.0 * 10.0**error + 1e-7


@given(st.floats(-1e-6, 1e-6), ANGLES, ANGLES, st.sampled_from([-QUARTER, QUARTER]))
def test_attitudes_with_the_nose_up_or_down_are_reproduced(
    off: float, roll: float, yaw: float, quarter: float
) -> None:
    """Where roll and yaw turn about one axis, and near there, the angles found still give the attitude."""
    stated = rotation_world_from_body(roll, quarter + off, yaw)
    np.testing.assert_allclose(rotation_world_from_body(*attitude_of(stated)), stated, atol=1e-14)


def _axis(angle: float, azimuth: float) -> np.ndarray:
    """Returns the axis at an angle from the vertical."""
    across = math.sin(angle)
    return np.array([across * math.cos(azimuth), across * math.sin(azimuth), math.cos(angle)])


@given(
    st.one_of(st.sampled_from([0.0, QUARTER, math.pi]), st.floats(0.0, math.pi)),
    ANGLES,
    MOUNTS,
    st.booleans(),
)
def test_the_attitude_of_an_axis_takes_the_least_tilt(
    angle: float, azimuth: float, mount: float, is_even: bool
) -> None:
    """The axis is reproduced, within the least tilt that reaches it, whether the limit is that or none."""
    axis, folded = _axis(angle, azimuth), min(angle, math.pi - angle) if is_even else angle
    least = abs(folded - mount)
    found = attitude_of_axis(axis, mount_rad=mount, is_even=is_even)
    assert Pose([0.0, 0.0, 8.0], *found, mount).tilt_rad == pytest.approx(least, abs=1e-12)
    for attitude in (found, attitude_of_axis(axis, least, mount, is_even=is_even)):
        reached = antenna_axis(*attitude, mount)
        sign = math.copysign(1.0, reached @ axis) if is_even else 1.0
        np.testing.assert_allclose(sign * reached, axis, atol=1e-12)
    assert Pose([0.0, 0.0, 8.0], *attitude, mount).tilt_rad <= least


@given(st.floats(0.0, math.pi), ANGLES, MOUNTS)
def test_both_signs_of_an_axis_have_one_attitude(angle: float, azimuth: float, mount: float) -> None:
    """An even antenna has the same angles for u and -u; no yaw if upright, at most a quarter turn if flat."""
    axis = _axis(angle, azimuth)
    found = attitude_of_axis(axis, mount_rad=mount)
    assert attitude_of_axis(-axis, mount_rad=mount) == found
    if mount == 0.0:
        assert found[2] == 0.0
        assert found[:2] == pytest.approx(attitude_from_axis(axis), abs=1e-12)
    if mount == QUARTER:
        assert -QUARTER <= found[2] < QUARTER
