"""A pose in ENU with quaternions, in NED and on the Earth, against scipy's rotations and pymap3d."""

import json
import math

import numpy as np
import pymap3d
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import Pose, flu_from_frd, frd_from_flu, pose_frames, rotation_world_from_body
from nullpose.scenario import Origin, Scenario
from nullpose.scenario.geodesy import ned_from_enu
from scenes import small

LOCAL = Scenario.from_dict(small())
ON_EARTH = LOCAL.model_copy(update={"origin": Origin(lat_deg=50.0, lon_deg=14.5, alt_m=230.0)})

angles = st.floats(-math.pi, math.pi)
metres = st.floats(-1e4, 1e4)
poses = st.builds(Pose, st.tuples(metres, metres, metres), angles, angles, angles)
vectors = st.tuples(metres, metres, metres)


@given(poses)
def test_the_quaternion_is_the_rotation(pose: Pose) -> None:
    """As scipy reads it, scalar last, it is the matrix of the conventions; its two orders are one."""
    enu = pose_frames(LOCAL, pose).enu
    matrix = rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    np.testing.assert_allclose(Rotation.from_quat(enu.quaternion_xyzw).as_matrix(), matrix, atol=1e-14)
    w, x, y, z = enu.quaternion_wxyz
    assert enu.quaternion_xyzw == (x, y, z, w)
    assert math.hypot(w, x, y, z) == pytest.approx(1.0, abs=1e-15)
    assert w >= 0.0


@given(poses, vectors)
def test_ned_and_frd_see_the_same_vehicle(pose: Pose, body: tuple[float, float, float]) -> None:
    """A vector in FRD turned to NED is that in FLU turned to ENU; roll stays, and pitch changes its sign."""
    frames = pose_frames(LOCAL, pose)
    enu = Rotation.from_quat(frames.enu.quaternion_xyzw).apply(body)
    ned = Rotation.from_quat(frames.ned.quaternion_xyzw).apply(frd_from_flu(body))
    np.testing.assert_allclose(ned, ned_from_enu(enu), atol=1e-10)
    assert flu_from_frd(frd_from_flu(body)).tolist() == list(body)
    assert (frames.ned.roll_rad, frames.ned.pitch_rad) == (pose.roll_rad, -pose.pitch_rad)


@pytest.mark.parametrize("turns", range(-3, 4))
@pytest.mark.parametrize("yaw_rad", [0.0, 0.5, 1.0])
def test_yaw_is_the_bearing_of_the_nose_within_one_turn(yaw_rad: float, turns: int) -> None:
    """It counts clockwise from north in NED; no zero has a sign."""
    frames = pose_frames(LOCAL, Pose((0.0, 0.0, 0.0), 0.0, 0.0, yaw_rad + turns * math.tau))
    assert frames.enu.yaw_rad == pytest.approx(yaw_rad, abs=1e-12)
    assert frames.ned.yaw_rad == pytest.approx(math.pi / 2.0 - yaw_rad, abs=1e-12)
    assert math.copysign(1.0, frd_from_flu([0.0, 0.0, 0.0])[1]) == 1.0


def test_a_level_vehicle_that_faces_north() -> None:
    """It has no rotation at all in NED, and a quarter turn in ENU."""
    frames = pose_frames(LOCAL, Pose((1.0, 2.0, 3.0), 0.0, 0.0, math.pi / 2.0))
    assert frames.ned.quaternion_wxyz == (1.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(frames.enu.quaternion_wxyz, [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)])
    assert frames.enu.position_m == (1.0, 2.0, 3.0)
    assert frames.ned.position_m == (2.0, 1.0, -3.0)
    assert list(frames.to_dict()) == ["enu", "ned"]  # without an origin no place on the Earth
    earthly = pose_frames(ON_EARTH, Pose((1.0, 2.0, 3.0), 0.1, 0.2, 0.3)).to_dict()
    assert list(earthly["geodetic"]) == ["lat_deg", "lon_deg", "alt_m"]
    assert json.loads(json.dumps(earthly, allow_nan=False)) == earthly


@given(poses)
def test_the_place_on_the_earth_is_that_of_the_position(pose: Pose) -> None:
    """Latitude, longitude and altitude are pymap3d's for the position and the scenario's origin."""
    place = pose_frames(ON_EARTH, pose).geodetic
    assert place is not None
    theirs = pymap3d.enu2geodetic(*pose.position_m, 50.0, 14.5, 230.0)
    assert (place.lat_deg, place.lon_deg, place.alt_m) == pytest.approx(tuple(map(float, theirs)), abs=1e-12)
