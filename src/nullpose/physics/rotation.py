"""Attitude and antenna axis (paper eq. 1.1)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.physics.types import FloatArray


def rotation_world_from_body(roll_rad: ArrayLike, pitch_rad: ArrayLike, yaw_rad: ArrayLike) -> FloatArray:
    """Build the rotation that takes body coordinates to the world's.

    ``R = Rz(yaw) Ry(pitch) Rx(roll)``; its third column is the antenna axis of eq. 1.1.

    Source: paper eq. 1.1 (the convention is read off that column).

    Args:
        roll_rad: roll about the body's x axis, any shape, radians.
        pitch_rad: pitch about y, broadcast with roll, radians.
        yaw_rad: yaw about z, broadcast with roll, radians.

    Returns:
        Array of shape ``(..., 3, 3)``.
    """
    roll, pitch, yaw = np.broadcast_arrays(
        np.asarray(roll_rad, dtype=float),
        np.asarray(pitch_rad, dtype=float),
        np.asarray(yaw_rad, dtype=float),
    )
    cr, sr = np.cos(roll), np.sin(roll)
    cp, sp = np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    matrix = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cr * sp * cy + sr * sy],
            [sy * cp, sy * sp * sr + cy * cr, cr * sp * sy - sr * cy],
            [-sp, cp * sr, cr * cp],
        ]
    )
    return matrix.transpose(*range(2, matrix.ndim), 0, 1)


def rotation_about(vector_rad: ArrayLike) -> FloatArray:
    """Build the rotation about a vector by its length (Rodrigues' formula).

    Args:
        vector_rad: shape ``(..., 3)``, radians.

    Returns:
        Array of shape ``(..., 3, 3)``.
    """
    x, y, z = np.moveaxis(np.asarray(vector_rad, dtype=float), -1, 0)
    angle, zero = np.sqrt(x * x + y * y + z * z)[..., None, None], np.zeros(x.shape)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    sine, half = np.sinc(angle / np.pi), np.sinc(0.5 * angle / np.pi)  # over the angle, over half of it
    return np.asarray(np.eye(3) + sine * cross + 0.5 * half**2 * (cross @ cross))


def attitude_of(rotation: ArrayLike, tilt_max_rad: float = math.pi) -> tuple[float, float, float]:
    """Find the roll, pitch and yaw of a rotation, radians, the pitch in [-pi/2, pi/2].

    The inverse of :func:`rotation_world_from_body`. What tilts beyond a limit by rounding is turned back to
    it; roll and pitch are exactly zero if it is zero.

    Args:
        rotation: to the world from the body's axes, shape ``(3, 3)``.
        tilt_max_rad: largest angle between the body's vertical and the world's, in [0, pi], radians.
    """
    r = np.asarray(rotation, dtype=float)
    level = np.hypot(r[2, 0], r[2, 1])
    # so far inside that the tilt of the angles, rounded again, is not beyond
    tilt = min(np.arctan2(level, r[2, 2]), tilt_max_rad * (1.0 - 1e-15))
    forward, left = (r[2, :2] * (np.sin(tilt) / level) if level > 0.0 else np.zeros(2)) + 0.0
    pitch = np.arctan2(-forward, np.hypot(left, np.cos(tilt)))
    roll = np.arctan2(left, np.cos(tilt))
    turn = r @ rotation_world_from_body(roll, pitch, 0.0).T  # about z, also where roll and yaw do the same
    yaw = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    return float(roll), float(pitch) + 0.0, float(yaw)


def antenna_axis(
    roll_rad: ArrayLike, pitch_rad: ArrayLike, yaw_rad: ArrayLike = 0.0, mount_rad: float = 0.0
) -> FloatArray:
    """Evaluate the unit vector along the dipole, in world (ENU) coordinates.

    ``u = R (sin a, 0, cos a)`` for a dipole mounted at an angle a from the body's vertical, towards its x
    axis. For ``a = 0``, as in the paper, ``u = (cos roll sin pitch cos yaw + sin roll sin yaw,
    cos roll sin pitch sin yaw - sin roll cos yaw, cos roll cos pitch)``

    Source: paper eq. 1.1.

    Args:
        roll_rad: roll, any shape, radians.
        pitch_rad: pitch, broadcast with roll, radians.
        yaw_rad: yaw, broadcast with roll, radians.
        mount_rad: angle between the dipole and the body's z axis, radians.

    Returns:
        Array of shape ``(..., 3)``. ``u`` and ``-u`` are the same antenna.
    """
    rotation = rotation_world_from_body(roll_rad, pitch_rad, yaw_rad)
    if mount_rad == 0.0:
        return rotation[..., 2]
    return np.asarray(np.sin(mount_rad) * rotation[..., 0] + np.cos(mount_rad) * rotation[..., 2])


def attitude_of_axis(
    axis: ArrayLike, tilt_max_rad: float = math.pi, mount_rad: float = 0.0, *, is_even: bool = True
) -> tuple[float, float, float]:
    """Find the roll, pitch and yaw of least tilt, and then of least yaw, that put a dipole along an axis.

    An upright dipole leaves the yaw free: it is zero. A mounted one leans towards the body's x axis, so an
    axis at an angle t from the vertical takes a pitch of ``t - mount`` at the yaw of its azimuth. Of ``u``
    and ``-u`` the one that points up takes less tilt. If both take the same, the yaw is in [-pi/2, pi/2).

    Args:
        axis: direction, shape ``(3,)``, not zero, one that the vehicle reaches.
        tilt_max_rad: largest angle between the body's vertical and the world's, radians.
        mount_rad: angle between the dipole and the body's vertical, in [0, pi/2], radians.
        is_even: whether ``u`` and ``-u`` are the same antenna.
    """
    x, y, z = np.asarray(axis, dtype=float).tolist()
    order = (x, -y, z) if mount_rad == math.pi / 2.0 else (z, x, -y)
    if is_even and order < (0.0, 0.0, 0.0):
        x, y, z = -x, -y, -z
    across, limit = math.hypot(x, y), tilt_max_rad * (1.0 - 1e-15)  # rounded again, it is not beyond
    tilt = math.atan2(across, z) - mount_rad
    if mount_rad == 0.0:
        if tilt > limit:
            inwards = math.sin(limit) / across
            x, y, z = x * inwards, y * inwards, math.cos(limit)
        up = -1.0 if z < 0.0 else 1.0
        return math.atan2(0.0 - y, up * math.hypot(x, z)), math.atan2(up * x, up * z) + 0.0, 0.0
    pitch, yaw = min(max(tilt, -limit), limit), math.atan2(y, x) if across > 0.0 else 0.0
    if pitch > math.pi / 2.0:  # upside down: the same attitude with a pitch in [-pi/2, pi/2]
        return math.pi, math.pi - pitch, yaw - math.copysign(math.pi, yaw)
    return 0.0, pitch + 0.0, yaw + 0.0


def attitude_from_axis(axis: ArrayLike, yaw_rad: ArrayLike = 0.0) -> tuple[FloatArray, FloatArray]:
    """Find the roll and pitch, each in [-pi/2, pi/2], that put the dipole along an axis.

    The inverse of eq. 1.1 at a given yaw. Of ``u`` and ``-u`` the one that points up is taken; for a level
    axis, the one with the positive component along the yawed x axis.

    Args:
        axis: directions, shape ``(..., 3)``, not zero, not necessarily of unit length.
        yaw_rad: yaw, broadcast with the leading shape of ``axis``, radians.

    Returns:
        Roll and pitch, each of the leading shape, radians.
    """
    u = np.asarray(axis, dtype=float)
    if u.shape[-1:] != (3,) or not np.all(np.any(u, axis=-1)):
        raise UsageError(
            f"axis: given {np.array2string(u, threshold=9)}; allowed: three numbers, not all zero"
        )
    cy, sy = np.cos(np.asarray(yaw_rad, dtype=float)), np.sin(np.asarray(yaw_rad, dtype=float))
    forward = cy * u[..., 0] + sy * u[..., 1]
    left = cy * u[..., 1] - sy * u[..., 0]
    up = u[..., 2]
    flip = (up < 0.0) | ((up == 0.0) & ((forward < 0.0) | ((forward == 0.0) & (left > 0.0))))
    sign = 1.0 - 2.0 * flip
    forward, left, up = sign * forward, sign * left, np.abs(up)
    roll = np.arctan2(-left, np.hypot(forward, up))
    return roll, np.arctan2(forward, up)
