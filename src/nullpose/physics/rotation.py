"""Attitude and antenna axis (paper eq. 1.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.types import FloatArray

__all__ = ["antenna_axis", "attitude_from_axis", "rotation_world_from_body"]


def rotation_world_from_body(roll_rad: ArrayLike, pitch_rad: ArrayLike, yaw_rad: ArrayLike) -> FloatArray:
    """Return the rotation that takes body coordinates to the world's.

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
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cr * sp * cy + sr * sy],
        [sy * cp, sy * sp * sr + cy * cr, cr * sp * sy - sr * cy],
        [-sp, cp * sr, cr * cp],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def antenna_axis(roll_rad: ArrayLike, pitch_rad: ArrayLike, yaw_rad: ArrayLike = 0.0) -> FloatArray:
    """Return the unit vector along the dipole, in world (ENU) coordinates.

    ``u = (cos roll sin pitch cos yaw + sin roll sin yaw,
    cos roll sin pitch sin yaw - sin roll cos yaw, cos roll cos pitch)``

    Source: paper eq. 1.1.

    Args:
        roll_rad: roll, any shape, radians.
        pitch_rad: pitch, broadcast with roll, radians.
        yaw_rad: yaw, broadcast with roll, radians.

    Returns:
        Array of shape ``(..., 3)``. ``u`` and ``-u`` are the same antenna.
    """
    return rotation_world_from_body(roll_rad, pitch_rad, yaw_rad)[..., 2]


def attitude_from_axis(axis: ArrayLike, yaw_rad: ArrayLike = 0.0) -> tuple[FloatArray, FloatArray]:
    """Return the roll and pitch, each in [-pi/2, pi/2], that put the dipole along an axis.

    The inverse of eq. 1.1 at a given yaw. Of ``u`` and ``-u`` the one that points up is taken; for a level
    axis, the one with the positive component along the yawed x axis.

    Args:
        axis: directions, shape ``(..., 3)``, not zero, not necessarily of unit length.
        yaw_rad: yaw, broadcast with the leading shape of ``axis``, radians.

    Returns:
        Roll and pitch, each of the leading shape, radians.
    """
    u = np.asarray(axis, dtype=float)
    cy, sy = np.cos(np.asarray(yaw_rad, dtype=float)), np.sin(np.asarray(yaw_rad, dtype=float))
    forward = cy * u[..., 0] + sy * u[..., 1]
    left = cy * u[..., 1] - sy * u[..., 0]
    up = u[..., 2]
    level = up == 0.0
    flip = np.where(level, np.where(forward == 0.0, left > 0.0, forward < 0.0), up < 0.0)
    sign = np.where(flip, -1.0, 1.0)
    forward, left, up = sign * forward, sign * left, np.abs(up)
    roll = np.arctan2(-left, np.hypot(forward, up))
    pitch = np.arctan2(forward, up)
    return roll, pitch
