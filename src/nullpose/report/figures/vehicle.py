"""The figure of the least tilt: what each mount reaches by its tilt, and the loss by tilt and mount."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.objectives import FloatArray
from nullpose.report.figures.style import GREY, INK, VEHICLES, draw_curve, house_style, inches, is_column
from nullpose.study.least_tilt import LeastTilt

_TILTS_DEG, _MOUNTS_DEG = np.linspace(0.0, 90.0, 181), np.linspace(0.0, 90.0, 91)
_FINE_DEG, _HALF_STEP_DEG = np.linspace(0.0, 90.0, 361), 0.126  # every quarter of a degree
_LINES = {0.05: INK, 0.5: INK, 1.0: INK, 3.0: "white"}  # the last loss, in dB, is on dark ground
MOUNT_CURVES = tuple(
    VEHICLES[name]
    for name in ("level-vertical", "stated", "level-horizontal", "tilt-10-horizontal", "tilt-30-horizontal")
)
"""How mounts are drawn, in their order."""
_LEAST = 1e-3  # share that is drawn
_EDGE_DEG = 8.0  # nearer to it a number would be cut


def draw_least_tilt(
    found: LeastTilt, values: tuple[FloatArray, FloatArray], width: str | None = None
) -> Figure:
    """Draw the share that each mount reaches against the tilt, and the loss by tilt and mount.

    Args:
        found: the least tilt of several mounts.
        values: angles from the vertical [deg] and the best values there.
        width: a key of ``WIDTHS_MM``; None for screens.
    """
    angles_deg, shares = values[0], values[1] / found.omnidirectional.objective.value
    with house_style(width):
        share, grid = (1.6, (2, 1)) if is_column(width) else (0.45, (1, 2))
        figure = Figure(figsize=inches((9.0, 4.0), width, share), layout="constrained")
        first, second = figure.subplots(*grid)
        _draw_shares(first, found, angles_deg, shares)
        _draw_losses(second, angles_deg, shares)
        if width is None:
            figure.suptitle(
                found.omnidirectional.scenario.name, fontweight="bold", parse_math=False, wrap=True
            )
    return figure


def reached(
    angles_deg: FloatArray, shares: FloatArray, tilts_deg: FloatArray, mount_deg: float
) -> FloatArray:
    """Find the best share within each tilt of a mount, (t,): at the angles from m - t to m + t.

    Between the angles the share is interpolated.
    """
    order = np.argsort(angles_deg)
    between = np.interp(_FINE_DEG, angles_deg[order], shares[order])
    within = np.abs(_FINE_DEG - mount_deg)[None] <= tilts_deg[:, None] + _HALF_STEP_DEG
    return np.asarray(np.where(within, between, 0.0).max(axis=1))


def _draw_shares(axes: Axes, found: LeastTilt, angles_deg: FloatArray, shares: FloatArray) -> None:
    mounts = found.mounts or tuple(filter(None, [found.best]))
    for mount, look in zip(mounts, cycle(MOUNT_CURVES), strict=False):
        curve = reached(angles_deg, shares, _TILTS_DEG, mount.mount_deg)
        draw_curve(axes, replace(look, label=f"mount {mount.mount_deg:.4g}°"), _TILTS_DEG, curve, every=20)
        for side_deg, mark, size in ((mount.suffices_deg, "o", 5.0), (mount.fails_deg, "|", 11.0)):
            if side_deg is not None:
                axes.plot(side_deg, found.share, mark, color=look.colour, markersize=size, zorder=4.0)
    axes.axhline(found.share, color=GREY, linewidth=0.9, linestyle="--")
    axes.set(xlim=(0.0, 90.0), xlabel="Largest tilt (deg)", ylim=(None, 1.02))
    axes.set_ylabel("Share of the omnidirectional value")
    axes.legend(loc="lower right", handlelength=3.2)
    axes.set_title(f"Dot: enough for {found.share:.4g}; bar: proved too little", fontsize="small", wrap=True)


def _draw_losses(axes: Axes, angles_deg: FloatArray, shares: FloatArray) -> None:
    table = np.array([reached(angles_deg, shares, _TILTS_DEG, mount) for mount in _MOUNTS_DEG])
    loss_db = -10.0 * np.log10(np.maximum(table, _LEAST))
    shown = axes.pcolormesh(
        _TILTS_DEG, _MOUNTS_DEG, loss_db, cmap="viridis_r", vmin=0.0, vmax=3.0, rasterized=True
    )
    if seen := {db: look for db, look in _LINES.items() if loss_db.min() < db < loss_db.max()}:
        lines = axes.contour(
            _TILTS_DEG, _MOUNTS_DEG, loss_db, levels=[*seen], colors=[*seen.values()], linewidths=0.9
        )
        middles = [tuple(part[len(part) // 2]) for part in (max(parts, key=len) for parts in lines.allsegs)]
        inside = [middle for middle in middles if min(middle) > _EDGE_DEG]
        axes.clabel(lines, fmt=lambda level: f"{level:g} dB", fontsize="small", manual=inside)
    axes.set(xlabel="Largest tilt (deg)", ylabel="Mount of the antenna (deg)")
    axes.set_title("Loss against an omnidirectional vehicle", fontsize="small", wrap=True)
    axes.figure.colorbar(shown, ax=axes, label="dB", extend="max")
