"""A pattern file as a figure: three cuts, and the surface."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from nullpose.antenna.harmonics import fit, highest_degree
from nullpose.antenna.table import PatternTable
from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK

_RANGE_DB = 40.0  # from the outer ring to the middle
_RING_DB = 10.0
_HIGHEST = 48
_CUTS = {
    "azimuth cut, theta 90": ("phi", 0.0),
    "elevation cut, phi 0 and 180": ("theta", 0.0),
    "elevation cut, phi 90 and 270": ("theta", 90.0),
}


def draw_pattern(table: PatternTable) -> Figure:
    """Return the figure of a pattern: cuts in dBi, and the surface of its gain in dB.

    Args:
        table: over the whole sphere.
    """
    figure = Figure(figsize=(9.0, 7.6), layout="constrained")
    harmonics = fit(table, min(_HIGHEST, highest_degree(table)))
    top_dbi = float(np.ceil(10.0 * np.log10(np.max(table.gain)) / 5.0) * 5.0)
    turn = np.radians(np.arange(0.0, 361.0))
    for place, (title, (angle, phi_deg)) in enumerate(_CUTS.items(), 1):
        axes: Any = figure.add_subplot(2, 2, place, projection="polar")
        ones, phi = np.ones_like(turn), np.radians(phi_deg)
        if angle == "phi":
            ways = np.stack([np.cos(turn), np.sin(turn), 0.0 * ones], axis=-1)
        else:  # theta grows from the zenith, drawn clockwise from the top
            ways = np.stack([np.sin(turn) * np.cos(phi), np.sin(turn) * np.sin(phi), np.cos(turn)], axis=-1)
            axes.set_theta_zero_location("N")
            axes.set_theta_direction(-1)
        gain_dbi = _dbi(harmonics.gain(ways))
        axes.plot(turn, np.maximum(gain_dbi, top_dbi - _RANGE_DB), color="#0a3fd6", linewidth=1.6)
        axes.set_ylim(top_dbi - _RANGE_DB, top_dbi)
        axes.set_yticks(np.arange(top_dbi - _RANGE_DB + _RING_DB, top_dbi + 1.0, _RING_DB))
        axes.set_rlabel_position(22.5)
        axes.tick_params(labelsize=8, colors=INK)
        axes.set_title(f"{title} (dBi)", fontsize=10, color=INK, pad=12)
        axes.grid(color="#d5d8de", linewidth=0.6)
    _draw_surface(figure, harmonics.on_grid(*_sphere()), top_dbi)
    figure.suptitle(table.source, fontsize=11, color=INK)
    return figure


def _sphere() -> tuple[FloatArray, FloatArray]:
    return np.radians(np.linspace(0.0, 180.0, 91)), np.radians(np.linspace(0.0, 360.0, 181))


def _dbi(gain: FloatArray) -> FloatArray:
    return np.asarray(10.0 * np.log10(np.maximum(gain, 1e-12)))


def _draw_surface(figure: Figure, gain: FloatArray, top_dbi: float) -> None:
    """Draw the surface: the distance is how far the gain is above the least that is drawn, in dB."""
    from matplotlib import colormaps

    axes: Any = figure.add_subplot(2, 2, 4, projection="3d")
    theta, phi = _sphere()
    reach = np.clip(_dbi(gain) - top_dbi + _RANGE_DB, 0.0, None)
    x = reach * np.outer(np.sin(theta), np.cos(phi))
    y = reach * np.outer(np.sin(theta), np.sin(phi))
    z = reach * np.outer(np.cos(theta), np.ones_like(phi))
    colours = colormaps["viridis"](reach / _RANGE_DB)
    axes.plot_surface(x, y, z, facecolors=colours, rcount=91, ccount=181, linewidth=0.0, shade=False)
    most = float(np.max(reach))
    for (dx, dy, dz), name in zip(np.eye(3) * 1.25 * most, "xyz", strict=True):
        axes.plot([0.0, dx], [0.0, dy], [0.0, dz], color=INK, linewidth=0.8)
        axes.text(1.08 * dx, 1.08 * dy, 1.08 * dz, name, color=INK, fontsize=9)
    axes.set_box_aspect((1, 1, 1))
    axes.set(xlim=(-most, most), ylim=(-most, most), zlim=(-most, most))
    axes.set_axis_off()
    axes.set_title(f"gain in dB, middle {top_dbi - _RANGE_DB:g} dBi", fontsize=10, color=INK, pad=0)
