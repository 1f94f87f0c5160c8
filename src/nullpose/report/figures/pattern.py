"""Radiation patterns: as surfaces at a pose, and of a file in three cuts and as a surface."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import Antenna
from nullpose.antenna.harmonics import directions
from nullpose.antenna.table import PatternTable
from nullpose.physics import Pose
from nullpose.physics.array import steering_vectors
from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import GREY, INK, NODE, Look, house_style

_DOWN, _RINGS, _AROUND = 61, 91, 241  # steps of a dipole's and of a beam's: lobes of many elements are narrow
_RANGE_DB, _TOP_STEP_DB, _RING_DB = 40.0, 5.0, 10.0
_COLOURS = colormaps["viridis"]
_SPOKES_DEG = np.arange(0, 360, 45)
_LARGEST = 91  # rows and columns of the surface; finer ones look the same


def ball_rings(down: int, around_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Compute unit vectors in rings about z from the zenith down, (3, n, m), and sines of their angles."""
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
    """Compute points on the antenna's pattern around a pose, ``(3, n, m)``, metres: of a dipole, a doughnut.

    In each direction the distance from the drone is ``radius_m`` times the gain (paper eq. 1.2), of a pattern
    over its largest.

    Args:
        antenna: whose pattern it is.
        pose: of the drone.
        radius_m: distance drawn where the gain is 1.
        around_rad: the angles about a dipole's axis to draw, shape ``(m,)``; 0 faces the camera.
        camera: direction towards it, shape ``(3,)``.
    """
    if not antenna.is_quadratic:
        local, _ = ball_rings(_RINGS, np.linspace(0.0, math.tau, _AROUND))
        gain = antenna.gain(np.moveaxis(local, 0, -1)) / antenna.peak
        turned: FloatArray = np.einsum("ck,kij->cij", pose.orientation(antenna), radius_m * gain * local)
        return turned + pose.position_m[:, None, None]
    axis = pose.antenna_axis
    beside = np.cross(axis, np.asarray(camera))
    beside /= np.linalg.norm(beside)
    frame = np.stack([np.cross(beside, axis), beside, axis])
    local, sine = ball_rings(_DOWN, around_rad)
    surface: FloatArray = np.einsum("kij,kc->cij", radius_m * antenna.gain(sine**2) * local, frame)
    return surface + pose.position_m[:, None, None]


def beam_surface_m(
    position_m: FloatArray, elements_wavelengths: FloatArray, weights: NDArray[np.complex128], radius_m: float
) -> FloatArray:
    """Compute points on the pattern of an array of upright dipoles, ``(3, n, m)``: rings from the zenith.

    In each direction the distance from the array is proportional to ``sin^2(gamma) |w^H a|^2``, the gain of a
    dipole times that of the combined elements.

    Args:
        position_m: the array's centre, shape ``(3,)``.
        elements_wavelengths: where the elements are, shape ``(K, 3)``.
        weights: of the elements, complex, shape ``(K,)``.
        radius_m: distance drawn where the gain is largest.
    """
    local, sine = ball_rings(_RINGS, np.linspace(0.0, math.tau, _AROUND))
    heard = steering_vectors(np.zeros(3), elements_wavelengths, local.reshape(3, -1).T)
    gain = sine**2 * np.abs(heard @ np.conj(weights)).reshape(sine.shape) ** 2
    return np.asarray(radius_m * gain / max(gain.max(), 1e-300) * local + position_m[:, None, None])


def draw_surface(
    axes: Axes3D, surface_m: FloatArray, colour: str, lines_m: Iterable[FloatArray], edge: str
) -> None:
    """Draw a pattern, ``(3, n, m)``, as a surface that can be seen through, and lines on it, ``(3, k)``."""
    _, rings, around = surface_m.shape
    look = {"color": colour, "alpha": 0.45, "linewidth": 0.0, "antialiased": False, "zorder": 5}
    axes.plot_surface(*surface_m, rcount=rings, ccount=around, **look)
    for line_m in lines_m:
        axes.plot(*line_m, color=edge, linewidth=0.9, zorder=6)


def draw_pattern(table: PatternTable) -> Figure:
    """Draw the cut nearest to theta 90, those nearest to phi 0 and 90, and the gain in dB as a surface."""
    gain_dbi = 10.0 * np.log10(np.maximum(table.gain, 1e-30))
    top_dbi = _TOP_STEP_DB * float(np.ceil(np.max(gain_dbi) / _TOP_STEP_DB))
    theta, phi = table.theta_deg, table.phi_deg
    level = int(np.argmin(np.abs(theta - 90.0)))
    x, y, back, right = (int(np.argmin(np.abs(phi - at))) for at in (0.0, 90.0, 180.0, 270.0))
    title = f"Azimuth phi at theta {theta[level]:g}, seen from above"
    cuts: list[tuple[str, Literal[-1, 1], FloatArray, FloatArray]] = [(title, 1, phi, gain_dbi[level])]
    for near, far in ((x, back), (y, right)):
        title = f"Polar angle theta: phi {phi[near]:g} right, {phi[far]:g} left"
        whole = np.concatenate([gain_dbi[:, near], gain_dbi[-2:0:-1, far]])
        cuts.append((title, -1, np.concatenate([theta, 360.0 - theta[-2:0:-1]]), whole))
    with house_style():
        figure = Figure(figsize=(8.4, 8.6), layout="constrained")
        figure.suptitle(
            f"{table.source}: {table.quantity} in dBi", fontsize=11.0, parse_math=False, wrap=True
        )
        for place, (title, turn, at_deg, values_dbi) in enumerate(cuts, start=1):
            axes: Any = figure.add_subplot(2, 2, place, polar=True)
            axes.set_title(title, fontsize=9.5, pad=12.0)
            _draw_cut(axes, turn, at_deg, np.maximum(values_dbi, top_dbi - _RANGE_DB), top_dbi)
        _draw_surface(figure, table, gain_dbi, [(level, x), (level, y), (0, 0)])
    return figure


def _draw_cut(
    axes: PolarAxes, turn: Literal[-1, 1], at_deg: FloatArray, values_dbi: FloatArray, top_dbi: float
) -> None:
    """Draw a cut, 0 degrees up: azimuths grow to the left, as seen from above, polar angles to both sides."""
    axes.set(theta_zero_location="N", theta_direction=turn)
    closed = np.append(np.radians(at_deg), np.radians(at_deg[0])), np.append(values_dbi, values_dbi[0])
    axes.plot(*closed, color=NODE, linewidth=1.6)
    axes.set_ylim(top_dbi - _RANGE_DB, top_dbi)
    angles_deg = _SPOKES_DEG if turn > 0 else np.minimum(_SPOKES_DEG, 360 - _SPOKES_DEG)
    axes.set_thetagrids(_SPOKES_DEG, [f"{degrees}°" for degrees in angles_deg])
    rings = np.arange(top_dbi - _RANGE_DB + _RING_DB, top_dbi + 1.0, _RING_DB)
    axes.set_rgrids(rings, [])
    white = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0}
    look: Look = {"color": GREY, "fontsize": 7.5, "bbox": white, "ha": "center"}
    for ring in rings:  # above the line, which tick labels would be below
        axes.text(turn * np.radians(-22.5), ring, f"{ring:g}", **look)


def _draw_surface(
    figure: Figure, table: PatternTable, gain_dbi: FloatArray, ends: Sequence[tuple[int, int]]
) -> None:
    """Draw how far the gain in dB is above the range's end as a distance, body axes and a bar of colours."""
    axes = figure.add_subplot(2, 2, 4, projection="3d")
    peak_dbi = float(np.max(gain_dbi))
    around = np.append(np.arange(len(table.phi_deg)), 0)  # closed
    far = np.maximum((gain_dbi - peak_dbi) / _RANGE_DB + 1.0, 0.0)
    surface = np.moveaxis((far[..., None] * directions(table.theta_deg, table.phi_deg))[:, around], -1, 0)
    norm = Normalize(peak_dbi - _RANGE_DB, peak_dbi)
    look: Look = {"facecolors": _COLOURS(norm(gain_dbi[:, around])), "edgecolor": (0.0, 0.0, 0.0, 0.15)}
    axes.plot_surface(*surface, rcount=_LARGEST, ccount=_LARGEST, linewidth=0.2, shade=False, **look)
    for axis, name, end in zip(np.eye(3), "xyz", ends, strict=True):
        axes.plot(*np.outer(axis, (far[end], 1.3)), color=INK, linewidth=1.0, zorder=10)
        axes.text(*(1.45 * axis), name, color=INK, ha="center", va="center")
    axes.set(xlim=(-0.8, 0.8), ylim=(-0.8, 0.8), zlim=(-0.8, 0.8), box_aspect=(1.0, 1.0, 1.0))
    axes.view_init(elev=25.0, azim=35.0)
    axes.set_axis_off()
    figure.colorbar(ScalarMappable(norm, _COLOURS), ax=axes, shrink=0.6).ax.set_title("dBi", fontsize=8.5)
