"""Radiation patterns as surfaces: of the dipole at a pose, and of an array's beam."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import Pose
from nullpose.physics.array import steering_vectors
from nullpose.physics.types import FloatArray
from nullpose.report.figures.scene import DRONE, PANELS, SURFACE, View

__all__ = ["beam_surface_m", "draw_beam", "draw_pattern", "pattern_surface_m"]

_CUT_RAD = math.radians(110.0)  # the part of the pattern that is left open towards the camera
_RINGS, _AROUND = 91, 241  # of a beam: lobes of many elements are narrow


def _to_camera(view: View) -> FloatArray:
    elevation, azimuth = math.radians(view.elevation_deg), math.radians(view.azimuth_deg)
    return np.array(
        [
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        ]
    )


def pattern_surface_m(pose: Pose, radius_m: float, around_rad: FloatArray, view: View = PANELS) -> FloatArray:
    """Return points on the dipole's radiation pattern drawn around a pose, a doughnut about its axis.

    In each direction the distance from the drone is ``radius_m * sin^2(gamma)`` (paper eq. 1.2).

    Args:
        pose: where the drone is and how it is turned.
        radius_m: distance drawn where the gain is 1, metres.
        around_rad: the turns about the axis to draw, shape ``(m,)``, radians; 0 faces the camera.
        view: where the camera stands.

    Returns:
        Array of shape ``(3, n, m)``, world frame, metres.
    """
    axis = pose.antenna_axis
    camera = _to_camera(view)
    facing = camera - axis * (camera @ axis)
    facing = facing / np.linalg.norm(facing)
    frame = np.stack([facing, np.cross(axis, facing), axis])
    gamma, around = np.meshgrid(np.linspace(0.0, math.pi, 61), around_rad, indexing="ij")
    local = np.stack([np.sin(gamma) * np.cos(around), np.sin(gamma) * np.sin(around), np.cos(gamma)])
    points = np.einsum("kij,kc->cij", radius_m * np.sin(gamma) ** 2 * local, frame)
    return np.asarray(points + pose.position_m[:, None, None])


def draw_pattern(axes: Any, pose: Pose, radius_m: float, view: View) -> None:
    """Draw the doughnut with its near side cut away, so that the null on its axis can be seen.

    Args:
        axes: where to draw.
        pose: where the drone is and how it is turned.
        radius_m: distance drawn where the gain is 1, metres.
        view: where the camera stands.
    """
    half = 0.5 * _CUT_RAD
    around = np.linspace(half, math.tau - half, 49)
    surface = pattern_surface_m(pose, radius_m, around, view)
    axes.plot_surface(
        *surface,
        color=SURFACE,
        alpha=0.45,
        linewidth=0.0,
        antialiased=False,
        rcount=61,
        ccount=49,
        zorder=5,
    )
    for edge in (surface[:, :, 0], surface[:, :, -1]):
        axes.plot(*edge, color=DRONE, linewidth=0.9, zorder=6)


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
    gamma, around = np.meshgrid(
        np.linspace(0.0, math.pi, _RINGS), np.linspace(0.0, math.tau, _AROUND), indexing="ij"
    )
    directions = np.stack(
        [np.sin(gamma) * np.cos(around), np.sin(gamma) * np.sin(around), np.cos(gamma)], axis=-1
    )
    heard = steering_vectors(np.zeros(3), elements_wavelengths, directions.reshape(-1, 3))
    gain = np.sin(gamma) ** 2 * np.abs(heard @ np.conj(weights)).reshape(gamma.shape) ** 2
    surface = radius_m * (gain / max(float(gain.max()), 1e-300))[..., None] * directions
    return np.asarray(np.moveaxis(surface + position_m, -1, 0))


def draw_beam(axes: Any, surface_m: FloatArray, colour: str, edge: str) -> None:
    """Draw the pattern of an array's beam, and its level cut as a line.

    Args:
        axes: where to draw.
        surface_m: from :func:`beam_surface_m`.
        colour: of the surface.
        edge: of the line.
    """
    axes.plot_surface(
        *surface_m,
        color=colour,
        alpha=0.40,
        linewidth=0.0,
        antialiased=False,
        rcount=_RINGS,
        ccount=_AROUND,
        zorder=5,
    )
    axes.plot(*surface_m[:, _RINGS // 2], color=edge, linewidth=0.9, zorder=6)
