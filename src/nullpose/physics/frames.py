"""A pose in the frames of other programs: ENU with quaternions, NED, and on the Earth."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import checked
from nullpose.physics.pose import Pose
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario
from nullpose.scenario.geodesy import ned_from_enu


@dataclass(frozen=True, slots=True)
class FramePose:
    """A pose in one pair of frames, the world's and the body's.

    Args:
        position_m: in the world frame [m], (3,).
        roll_rad: about the body's x axis [rad].
        pitch_rad: about y [rad].
        yaw_rad: about z, in (-pi, pi] [rad].
        quaternion_wxyz: the rotation that takes body coordinates to the world's, scalar first, unit length;
            the one of q and -q whose first component that is not zero is positive.
    """

    position_m: tuple[float, float, float]
    roll_rad: float
    pitch_rad: float
    yaw_rad: float
    quaternion_wxyz: tuple[float, float, float, float]

    @property
    def quaternion_xyzw(self) -> tuple[float, float, float, float]:
        """The same quaternion with the scalar last, as ROS messages and scipy have it."""
        w, x, y, z = self.quaternion_wxyz
        return x, y, z, w

    def to_dict(self) -> dict[str, object]:
        """Return the pose as plain data, with the quaternion in both orders."""
        return {
            "position_m": list(self.position_m),
            "roll_rad": self.roll_rad,
            "pitch_rad": self.pitch_rad,
            "yaw_rad": self.yaw_rad,
            "quaternion_wxyz": list(self.quaternion_wxyz),
            "quaternion_xyzw": list(self.quaternion_xyzw),
        }


@dataclass(frozen=True, slots=True)
class Geodetic:
    """A place on the Earth (WGS-84).

    Args:
        lat_deg: latitude [degrees], north positive.
        lon_deg: longitude [degrees], east positive.
        alt_m: altitude over the ellipsoid [m]; None if the scenario's origin does not state it.
        alt_msl_m: altitude over the sea [m]; None likewise.
    """

    lat_deg: float
    lon_deg: float
    alt_m: float | None = None
    alt_msl_m: float | None = None

    def to_dict(self) -> dict[str, object]:
        """Return the place as plain data, without an altitude that is not known."""
        return {key: value for key, value in asdict(self).items() if value is not None}


@dataclass(frozen=True, slots=True)
class PoseFrames:
    """One pose in every frame.

    Args:
        enu: world east, north, up; body forward, left, up: nullpose's own frames, and those of ROS.
        ned: world north, east, down; body forward, right, down: those of PX4 and MAVLink.
        geodetic: the place on the Earth; None if the scenario has no origin.
    """

    enu: FramePose
    ned: FramePose
    geodetic: Geodetic | None = None

    def to_dict(self) -> dict[str, object]:
        """Return the frames as plain data; without an origin there is no key ``geodetic``."""
        frames: dict[str, object] = {"enu": self.enu.to_dict(), "ned": self.ned.to_dict()}
        return frames if self.geodetic is None else frames | {"geodetic": self.geodetic.to_dict()}


@checked
def pose_frames(scenario: Scenario, pose: Pose) -> PoseFrames:
    """Convert a pose to east-north-up, to north-east-down and, if the scenario has an origin, on the Earth.

    With ``P`` the exchange of ENU and NED and ``F = diag(1, -1, -1)`` that of the bodies,
    ``P R(roll, pitch, yaw) F = Rz(pi/2 - yaw) Ry(-pitch) Rx(roll)``, because ``P = Rz(pi/2) F`` and F turns
    the sense of y and z: roll stays, pitch changes its sign, yaw becomes the heading, clockwise from north.

    Args:
        scenario: for its origin.
        pose: position and attitude, world ENU, body forward-left-up.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> pose = nullpose.Pose(position_m=[2.0, 25.0, 8.0], roll_rad=0.1, pitch_rad=-0.2)
        >>> ned = nullpose.pose_frames(scenario, pose).ned
        >>> ned.position_m, round(ned.pitch_rad, 3), round(ned.yaw_rad, 3)
        ((25.0, 2.0, -8.0), 0.2, 1.571)
    """
    east_north_up = _frame_pose(pose.position_m, pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    heading_rad = math.pi / 2.0 - pose.yaw_rad
    north_east_down = _frame_pose(ned_from_enu(pose.position_m), pose.roll_rad, -pose.pitch_rad, heading_rad)
    place = None if scenario.origin is None else Geodetic(**scenario.origin.place(pose.position_m))
    return PoseFrames(enu=east_north_up, ned=north_east_down, geodetic=place)


def frd_from_flu(vector: ArrayLike) -> FloatArray:
    """Convert body vectors to forward, right, down: the last two components are negated.

    Args:
        vector: components forward, left and up, in any unit, shape ``(..., 3)``.

    Returns:
        Array of shape ``(..., 3)``.
    """
    return np.asarray(vector, dtype=float) * [1.0, -1.0, -1.0] + 0.0  # no negative zeros


flu_from_frd = frd_from_flu
"""The same exchange undoes itself."""


def _frame_pose(position_m: FloatArray, roll_rad: float, pitch_rad: float, yaw_rad: float) -> FramePose:
    x, y, z = (float(component) for component in position_m)
    return FramePose(
        position_m=(x, y, z),
        roll_rad=roll_rad,
        pitch_rad=pitch_rad + 0.0,
        yaw_rad=math.remainder(yaw_rad, math.tau),
        quaternion_wxyz=_quaternion_wxyz(roll_rad, pitch_rad, yaw_rad),
    )


def _quaternion_wxyz(roll_rad: float, pitch_rad: float, yaw_rad: float) -> tuple[float, float, float, float]:
    """Multiply ``qz(yaw) qy(pitch) qx(roll)`` of half-angle quaternions, its sign settled."""
    cr, sr = math.cos(roll_rad / 2.0), math.sin(roll_rad / 2.0)
    cp, sp = math.cos(pitch_rad / 2.0), math.sin(pitch_rad / 2.0)
    cy, sy = math.cos(yaw_rad / 2.0), math.sin(yaw_rad / 2.0)
    q = (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
    sign = math.copysign(1.0, next(component for component in q if component != 0.0))
    w, x, y, z = (sign * component + 0.0 for component in q)
    return w, x, y, z
