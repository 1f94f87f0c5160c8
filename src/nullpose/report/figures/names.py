"""Names beside points: apart from each other, from marks and from all other letters."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from itertools import product

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation, Text

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK, Look

_LETTERS, _SHORT = 16, 2  # in a line of a name, and in one that its number is beside
_SIDES = (0.0, -0.25, 0.25, -0.5, 0.5, -1.0, 1.0)
_PLACES = np.array(
    [(0.0, 0.0, 0.0, 0.0)]
    + [
        (x, y, gap_pt, cost)
        for gap_pt, cost in ((4.5, 0.0), (3.5, 0.1), (9.0, 0.6), (16.0, 2.0))
        for x, y in product(_SIDES, reversed(_SIDES))
        if max(abs(x), abs(y)) == 1.0
    ]
)
"""Where a name may stand: from its point, over its half size, with a gap in points, and what that costs."""
_SAMPLES, _CROSSED, _BESIDE = 60, 0.05, 0.15  # points on a line; costs of one below a name, of a mark beside
_MARK_PT, _BESIDE_PT, _TINY_PT = 3.0, 9.0, 18.0  # half of a mark; how far one is beside a name; a small zone


def write_name(
    axes: Axes,
    name: str,
    point_m: FloatArray,
    *,
    number: str = "",
    is_bold: bool = False,
    is_area: bool = False,
    colour: str = INK,
) -> None:
    """Write a name at its point as it is, no part of it a formula, for ``place_names`` to move.

    Args:
        axes: with its limits set.
        name: of the point or the area.
        point_m: shape ``(2,)`` or ``(3,)``, metres.
        number: beside it, or below a long one.
        is_bold: whether it is that of the worst node.
        is_area: whether it is slanted.
        colour: of the letters.
    """
    words = ("\n" if len(name) > _SHORT else " ").join(filter(None, (textwrap.fill(name, _LETTERS), number)))
    look: Look = {
        "fontsize": rcParams["xtick.labelsize"],
        "fontweight": "bold" if is_bold else "normal",
        "fontstyle": "italic" if is_area else "normal",
        "path_effects": [withStroke(linewidth=2.0, foreground="white")],
        "annotation_clip": True,
        "parse_math": False,
        "in_layout": False,
        "xytext": (0.0, 0.0),
        "textcoords": "offset points",
        "ha": "center",
        "va": "center",
    }
    axes.annotate(words, (float(point_m[0]), float(point_m[1])), color=colour, zorder=8, **look)


def place_names(axes: Axes) -> None:
    """Move each name to where it is in the frame, over no mark and no letters, and nearest its own point.

    Names of the worst nodes are placed first, those of areas last. One that finds no place is not drawn.
    """
    names = [
        text
        for text in axes.texts
        if isinstance(text, Annotation) and axes.viewLim.contains(*text.xy)  # others are not drawn
    ]
    names.sort(key=lambda name: (name.get_fontstyle() == "italic", name.get_fontweight() != "bold"))
    for name in names:
        name.set(visible=True, position=(0.0, 0.0))
    root = axes.get_figure(root=True)
    assert root is not None, "axes are in a figure"
    root.draw_without_rendering()  # for the layout
    point_px = root.dpi / 72.0
    points = axes.transData.transform([name.xy for name in names])
    marks, lines, corners = _in_the_way(axes, names, point_px)
    middles, halves = corners.mean(axis=1), 0.5 * np.ptp(corners, axis=1)
    middles[: len(names)] = np.nan
    for index, (name, point) in enumerate(zip(names, points, strict=True)):
        half = halves[index]
        places = point + _PLACES[:, :2] * (half + point_px * _PLACES[:, 2:3])
        low, high = axes.bbox.min + half + point_px, axes.bbox.max - half - point_px
        places = np.clip(places, low, high)[:, None]
        rivals = [point, *marks, *(points if name.get_fontstyle() == "italic" else ())]
        beyond = np.maximum(np.abs(places - rivals) - half, 0.0)
        is_wrong = np.argmin(np.linalg.norm(beyond, axis=-1), axis=1) > 0  # nearer to another
        is_wrong |= np.any(np.all(np.abs(places - middles) < halves + half, axis=-1), axis=1)
        crossed = np.all(np.abs(places - lines) < half, axis=-1).sum(axis=1)
        beside = np.all(np.abs(places - marks) < half + _BESIDE_PT * point_px, axis=-1).sum(axis=1)
        costs = _PLACES[:, 3] + _CROSSED * crossed + _BESIDE * beside + np.where(is_wrong, np.inf, 0.0)
        best = int(np.argmin(costs))
        middles[index] = places[best, 0] if costs[best] < np.inf else np.nan
        name.set(position=(middles[index] - point) / point_px, visible=bool(costs[best] < np.inf))


def _in_the_way(
    axes: Axes, names: Sequence[Text], point_px: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """List marks and points on lines, (n, 2), and corners of letters, small zones and marks, (n, 2, 2)."""
    dots = [each.get_offsets() for each in axes.collections if isinstance(each, PathCollection)]
    letters = [text for text in axes.findobj(Text) if text.get_text() and not isinstance(text, Annotation)]
    zones = (zone.get_window_extent() for zone in axes.patches)
    boxes = [text.get_window_extent() for text in (*names, *letters)]
    boxes += [box for box in zones if max(box.size) < _TINY_PT * point_px]
    marks, rim = axes.transData.transform(np.vstack(dots)), point_px * _MARK_PT
    corners = [*((box.min, box.max) for box in boxes), *((mark - rim, mark + rim) for mark in marks)]
    paths = np.vstack([_along(np.asarray(line.get_xydata())) for line in axes.lines])
    return marks, axes.transData.transform(paths), np.array(corners)


def _along(ends: FloatArray) -> FloatArray:
    """List points along a path, (n, 2)."""
    steps = np.linspace(0.0, len(ends) - 1.0, _SAMPLES)
    return np.stack([np.interp(steps, np.arange(len(ends)), each) for each in ends.T], axis=-1)
