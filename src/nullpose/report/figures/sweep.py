"""The figures of curves: a sweep of any setting, and the least tilt of each mount."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable
from dataclasses import replace
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from nullpose.physics.types import FloatArray
from nullpose.report.answer import certainty_lines
from nullpose.report.figures.style import (
    GREY,
    INK,
    VEHICLES,
    Look,
    curve_of,
    draw_curve,
    house_figure,
    inches,
    is_column,
)
from nullpose.report.numbers import axis_label, capitalised
from nullpose.study import ResultRow, ResultTable
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
    share, grid = (1.6, (2, 1)) if is_column(width) else (0.45, (1, 2))
    with house_figure(inches((9.0, 4.0), width, share), width) as figure:
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


_VISIBLE = 0.02  # a bound closer to its value, in dB, lies within the width of the line
_FREE = 3.0  # at least so many dB above the curves are shown
_CARET_UP, _CARET_DOWN = 6, 7  # Matplotlib's names for them
_CAPTION_LETTERS = 125  # letters in a line of the caption
_MARKS: Look = {"linestyle": "", "markersize": 3.5, "alpha": 0.7, "zorder": 5.0}  # above curves
_BELOW: Look = {"marker": _CARET_UP, "markersize": 7.0, "zorder": 1.5}  # seen below the curve's own marker
_MARKERS = 13  # at most so many markers on a curve, so that they do not merge into a band


def value_label(table: ResultTable) -> str:
    """Name what a sweep found, with its unit."""
    quantity, tilt = table.rows[0].objective.quantity, table.rows[0].tilt
    return "Least tilt (deg)" if tilt else f"{capitalised(quantity.smallest_over)} ({quantity.unit})"


def _numbers(rows: Iterable[ResultRow]) -> FloatArray:
    """List values and bounds in their unit, (2, n); NaN, which Matplotlib draws as a gap, for no number."""
    pairs = [(row.objective.quantity, row.objective.value, row.objective.upper_bound) for row in rows]
    found = [[math.nan if x is None else unit.in_unit(x) for x in pair] for unit, *pair in pairs]
    return np.where(np.isfinite(found), found, math.nan).T


def _draw_tilts(axes: Axes, table: ResultTable) -> None:
    """Draw a curve of the least tilt for each mount, and a mark at each tilt that is proved too little."""
    for look, name in zip(cycle(MOUNT_CURVES), table.names, strict=False):
        columns = [[row.value, *row.tilts.values()] for row in table.of(name)]
        values, _, _, enough_deg, little_deg = np.array(columns, dtype=float).T
        every = math.ceil(len(values) / _MARKERS)
        draw_curve(axes, replace(look, label=name), values, enough_deg, (little_deg, enough_deg), every=every)
        little_deg[np.isnan(enough_deg)] = math.nan
        axes.plot(values, little_deg, color=look.colour, markevery=every, **_MARKS | _BELOW)


def draw_curves(axes: Axes, table: ResultTable, *, bounds: bool = False) -> None:
    """Draw a curve for each scheme, with a band up to its upper bounds if they are asked for."""
    highest_rate = float(np.max(_numbers(table.rows)[0]))
    apart = 0.01 * highest_rate if table.rows[0].objective.quantity.is_rate else _VISIBLE
    for index, scheme in enumerate(table.names):
        rows, look = table.of(scheme), curve_of(scheme)
        values, highest = _numbers(rows)
        levels = [row.value for row in rows]
        step = max(len(table.names), math.ceil(len(rows) / _MARKERS))
        every = 1 if len(rows) <= _MARKERS else (index, step)  # staggered: curves that coincide stay visible
        draw_curve(axes, look, levels, values, (values, highest) if bounds else None, every=every)
        if bounds:  # no line: between two points nothing is proved
            seen = np.where(highest - values > apart, highest, math.nan)
            axes.plot(levels, seen, color=look.colour, marker=_CARET_DOWN, **_MARKS)


def draw_caption(figure: Figure, lines: Iterable[str], width: str | None = None) -> None:
    """Write sentences in small letters under the axes, broken into lines."""
    letters, size = (_CAPTION_LETTERS, 7.5) if width is None else (int(18.0 * figure.get_figwidth()), 6.5)
    text = "\n".join(wrapped for line in lines for wrapped in textwrap.wrap(line, letters))
    figure.supxlabel(text, x=0.01, ha="left", fontsize=size, color=GREY, linespacing=1.35)


def _keep_curves_large(axes: Axes, table: ResultTable) -> None:
    """Let bounds that are far above every curve leave the picture, rather than flatten the curves."""
    values, bounds = _numbers(table.rows)
    low, high = np.fmin.reduce(values), np.fmax.reduce(values)  # unlike the maximum, they pass over NaN
    least = max(0.5 * high, 1e-3) if table.rows[0].objective.quantity.is_rate else _FREE
    free = max(least, high - low)
    if np.fmax.reduce(bounds) > high + free:
        axes.set_ylim(low - 0.05 * free, high + free)


def draw_sweep(
    table: ResultTable, *, log: bool = False, width: str | None = None, bounds: bool = False
) -> Figure:
    """Draw a sweep, its legend above the axes and what is proved below.

    Args:
        table: of at least one row.
        log: draw the swept setting on a logarithmic axis.
        width: in print, a key of ``WIDTHS_MM``; None for a screen.
        bounds: draw a band from each curve up to its upper bounds.
    """
    lines = [f"{line}." for line in certainty_lines(table)]
    if bounds or table.rows[0].tilt:
        lines.append(
            "Each small triangle points to a tilt that is proved too little."
            if table.rows[0].tilt
            else "Each band ends at the upper bound, a small triangle."
        )
    share, columns = (0.8, 2) if is_column(width) else (0.5, 4)
    with house_figure(inches((7.0, 4.6), width, share), width) as figure:
        draw_sweep_axes(figure.add_subplot(), table, log=log, bounds=bounds)
        figure.legend(loc="outside upper center", ncols=columns, handlelength=3.2)
        draw_caption(figure, lines, width)
    return figure


def draw_sweep_axes(axes: Axes, table: ResultTable, *, log: bool = False, bounds: bool = False) -> None:
    """Draw a sweep with the names of its axes."""
    if table.rows[0].tilt is not None:
        _draw_tilts(axes, table)
    else:
        draw_curves(axes, table, bounds=bounds)
        if bounds:
            _keep_curves_large(axes, table)
    axes.set(xscale="log" if log else "linear", ylabel=value_label(table))
    axes.set_xlabel(axis_label(table.path), parse_math=False, wrap=True)
    if not log:
        axes.xaxis.set_major_formatter("{x:.10g}")  # also of powers of some nW
    axes.margins(x=0.02)
