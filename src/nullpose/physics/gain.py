"""The antenna's power gain towards a point (paper eqs. 1.2 to 1.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import SHORT_DIPOLE, Antenna
from nullpose.physics.types import FloatArray


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def elevation_cosine(position_m: ArrayLike, axis: ArrayLike, points_m: ArrayLike) -> FloatArray:
    """Return cos(gamma), gamma being the angle between the dipole and the direction to each point.

    ``cos gamma_i = <(p_i - p) / |p_i - p|, u>``

    Source: paper eq. 1.3.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the drone's position.

    Returns:
        Array of shape ``(..., m)``.
    """
    to_points = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    return np.asarray(np.sum(_unit(to_points) * np.asarray(axis, dtype=float)[..., None, :], axis=-1))


def antenna_gain(
    position_m: ArrayLike, axis: ArrayLike, points_m: ArrayLike, antenna: Antenna = SHORT_DIPOLE
) -> FloatArray:
    """Return the antenna's power gain towards each point, 1 broadside; of a short dipole, 0 along its axis.

    A short dipole has ``G(gamma_i) = sin^2(gamma_i) = 1 - <(p_i - p) / |p_i - p|, u>^2``, evaluated as the
    squared norm of the cross product ``(p_i - p) x u`` over ``|p_i - p|^2``: the same number, which keeps its
    digits beside the null, where the printed difference loses all of them. Other antennas say what becomes of
    that sine.

    Source: paper eqs. 1.2 and 1.4; the maximum is 1, not the 1.5 of a short dipole's directivity.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``; for an antenna with a pattern its attitude, the rotation
            to the world from its own axes, shape ``(..., 3, 3)``, as :meth:`Pose.orientation` has them.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the drone's position.
        antenna: which antenna the drone has.

    Returns:
        Array of shape ``(..., m)``: between 0 and 1 for a dipole.
    """
    if not antenna.is_quadratic:
        ways = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
        return antenna.gain(np.matmul(_unit(ways), np.asarray(axis, dtype=float)))
    to_points = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    u = np.asarray(axis, dtype=float)
    x, y, z = to_points[..., 0], to_points[..., 1], to_points[..., 2]
    ux, uy, uz = u[..., 0, None], u[..., 1, None], u[..., 2, None]
    across_sq = (y * uz - z * uy) ** 2 + (z * ux - x * uz) ** 2 + (x * uy - y * ux) ** 2  # m^2
    return np.asarray(antenna.gain(across_sq / (x * x + y * y + z * z)))
