"""The radiation pattern of a file, in three cuts and as a surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes

from nullpose.antenna.harmonics import directions
from nullpose.antenna.table import PatternTable
from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import GREY, INK, NODE, Look, house_figure

_RANGE_DB, _TOP_STEP_DB, _RING_DB = 40.0, 5.0, 10.0
_COLOURS = colormaps["viridis"]
_SPOKES_DEG = np.arange(0, 360, 45)
_LARGEST = 91  # rows and columns of the surface; finer ones look the same


def draw_pattern(table: PatternTable) -> Figure:
    """Draw the cut nearest to theta 90, those nearest to phi 0 and 90, and the gain in dB as a surface."""
    gain_dbi = 10.0 * np.log10(np.maximum(table.gain, 1e-30))
    top_dbi = _TOP_STEP_DB * float(np.ceil(np.max(gain_dbi) / _TOP_STEP_DB))
    theta, phi = table.theta_deg, table.phi_deg
    level = int(np.argmin(np.abs(theta - 90.0)))
    x, y, back, right = (int(np.argmin(np.abs(phi - at))) for at in (0.0, 90.0, 180.0, 270.0))
    cuts: list[tuple[str, Literal[-1, 1], FloatArray, FloatArray]] = [
        (f"Azimuth phi at theta {theta[level]:g}, seen from above", 1, phi, gain_dbi[level])
    ]
    for near, far in ((x, back), (y, right)):
        title = f"Polar angle theta: phi {phi[near]:g} right, {phi[far]:g} left"
        whole = np.concatenate([gain_dbi[:, near], gain_dbi[-2:0:-1, far]])
        cuts.append((title, -1, np.concatenate([theta, 360.0 - theta[-2:0:-1]]), whole))
    with house_figure((8.4, 8.6)) as figure:
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
    closed = np.append(np.arange(len(at_deg)), 0)
    axes.plot(np.radians(at_deg[closed]), values_dbi[closed], color=NODE, linewidth=1.6)
    axes.set_ylim(top_dbi - _RANGE_DB, top_dbi)
    axes.set_thetagrids(
        _SPOKES_DEG, [f"{degrees if turn > 0 else min(degrees, 360 - degrees)}°" for degrees in _SPOKES_DEG]
    )
    rings = np.arange(top_dbi - _RANGE_DB + _RING_DB, top_dbi + 1.0, _RING_DB)
    axes.set_rgrids(rings, [])
    look: Look = {"color": GREY, "fontsize": 7.5, "ha": "center"}
    look["bbox"] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0}
    for ring in rings:  # above the line, which tick labels would be below
        axes.text(turn * np.radians(-22.5), ring, f"{ring:g}", **look)


def _draw_surface(
    figure: Figure, table: PatternTable, gain_dbi: FloatArray, ends: Sequence[tuple[int, int]]
) -> None:
    """Draw how far the gain in dB is above the range's end as a distance, body axes and a bar of colours."""
    axes = figure.add_subplot(2, 2, 4, projection="3d")
    around = np.append(np.arange(len(table.phi_deg)), 0)  # closed
    norm = Normalize(gain_dbi.max() - _RANGE_DB, gain_dbi.max())
    far = np.maximum(np.asarray(norm(gain_dbi)), 0.0)
    surface = np.moveaxis((far[..., None] * directions(table.theta_deg, table.phi_deg))[:, around], -1, 0)
    look: Look = {"facecolors": _COLOURS(norm(gain_dbi[:, around])), "edgecolor": (0.0, 0.0, 0.0, 0.15)}
    axes.plot_surface(*surface, rcount=_LARGEST, ccount=_LARGEST, linewidth=0.2, shade=False, **look)
    for axis, name, end in zip(np.eye(3), "xyz", ends, strict=True):
        axes.plot(*np.outer(axis, (far[end], 1.3)), color=INK, linewidth=1.0, zorder=10)
        axes.text(*(1.45 * axis), name, color=INK, ha="center", va="center")
    axes.set(xlim=(-0.8, 0.8), ylim=(-0.8, 0.8), zlim=(-0.8, 0.8), box_aspect=(1.0, 1.0, 1.0))
    axes.view_init(elev=25.0, azim=35.0)
    axes.set_axis_off()
    figure.colorbar(ScalarMappable(norm, _COLOURS), ax=axes, shrink=0.6).ax.set_title("dBi", fontsize=8.5)
