"""Radiation patterns as surfaces: of the drone's antenna at a pose, and of an array's beam."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import Antenna
from nullpose.physics import Pose
from nullpose.physics.array import steering_vectors
from nullpose.physics.types import FloatArray

_DOWN, _RINGS, _AROUND = 61, 91, 241  # steps of a dipole's and of a beam's: lobes of many elements are narrow


def _directions(down: int, around_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return unit vectors in rings about z from the zenith down, (3, n, m), and the sines of their angles."""
    gamma, around = np.meshgrid(np.linspace(0.0, math.pi, down), around_rad, indexing="ij")
    sine = np.sin(gamma)
    return np.stack([sine * np.cos(around), sine * np.sin(around), np.cos(gamma)]), sine


def pattern_surface_m(
    antenna: Antenna,
    pose: Pose,
    radius_m: float,
    around_rad: FloatArray,
    camera: ArrayLike = (0.3, -0.5, 0.8),
) -> FloatArray:
    """Return points on the antenna's radiation pattern drawn around a pose: of a dipole, a doughnut.

    In each direction the distance from the drone is ``radius_m`` times the gain (paper eq. 1.2), of a pattern
    over its largest.

    Args:
        antenna: whose pattern it is.
        pose: where the drone is and its attitude.
        radius_m: distance drawn where the gain is 1, metres.
        around_rad: the angles about a dipole's axis to draw, shape ``(m,)``, radians; 0 faces the camera.
        camera: direction towards it, shape ``(3,)``.

    Returns:
        Array of shape ``(3, n, m)``, world frame, metres.
    """
    if not antenna.is_quadratic:
        local, _ = _directions(_RINGS, np.linspace(0.0, math.tau, _AROUND))
        gain = antenna.gain(np.moveaxis(local, 0, -1)) / antenna.peak
        turned: FloatArray = np.einsum("ck,kij->cij", pose.orientation(antenna), radius_m * gain * local)
        return turned + pose.position_m[:, None, None]
    axis = pose.antenna_axis
    towards = np.asarray(camera)
    facing = towards - axis * (towards @ axis)
    facing = facing / np.linalg.norm(facing)
    frame = np.stack([facing, np.cross(axis, facing), axis])
    local, sine = _directions(_DOWN, around_rad)
    surface: FloatArray = np.einsum("kij,kc->cij", radius_m * antenna.gain(sine**2) * local, frame)
    return surface + pose.position_m[:, None, None]


def beam_surface_m(
    position_m: FloatArray, elements_wavelengths: FloatArray, weights: NDArray[np.complex128], radius_m: float
) -> FloatArray:
    """Return points on the pattern of an array of upright dipoles with given weights.

    In each direction the distance from the array is proportional to ``sin^2(gamma) |w^H a|^2``, the gain of a
    dipole times that of the combined elements.

    Args:
        position_m: the array's centre, shape ``(3,)``, metres.
        elements_wavelengths: where the elements are, shape ``(K, 3)``, wavelengths.
        weights: of the elements, complex, shape ``(K,)``.
        radius_m: distance drawn where the gain is largest, metres.

    Returns:
        Array of shape ``(3, n, m)``: rings from the zenith down, each once around; metres.
    """
    directions, sine = _directions(_RINGS, np.linspace(0.0, math.tau, _AROUND))
    heard = steering_vectors(np.zeros(3), elements_wavelengths, directions.reshape(3, -1).T)
    gain = sine**2 * np.abs(heard @ np.conj(weights)).reshape(sine.shape) ** 2
    surface: FloatArray = radius_m * gain / max(float(gain.max()), 1e-300) * directions
    return surface + position_m[:, None, None]


def draw_surface(
    axes: Any, surface_m: FloatArray, colour: str, lines_m: Iterable[FloatArray], edge: str
) -> None:
    """Draw a pattern as a surface that can be seen through, and lines on it.

    Args:
        axes: where to draw.
        surface_m: shape ``(3, n, m)``, metres.
        colour: of the surface.
        lines_m: each of shape ``(3, k)``, metres.
        edge: colour of the lines.
    """
    _, rings, around = surface_m.shape
    look = {"color": colour, "alpha": 0.45, "linewidth": 0.0, "antialiased": False, "zorder": 5}
    axes.plot_surface(*surface_m, rcount=rings, ccount=around, **look)
    for line_m in lines_m:
        axes.plot(*line_m, color=edge, linewidth=0.9, zorder=6)
