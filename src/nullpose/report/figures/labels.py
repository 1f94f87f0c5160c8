"""Names of points in a picture of a scene, each beside its point and off the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullpose.physics.types import FloatArray

__all__ = ["Label", "place_labels"]

_SIZE_PT = 9.0
_LETTER = 0.6  # width of a letter, as a share of its height
_MARKER_PT = 5.0  # half of a marker
_AWAY_PT = 7.0  # from a point to its name
_FARTHEST_PT = 30.0  # from a point to the end of what is drawn around it; a name stands within what is wider

Box = tuple[float, float, float, float]  # left, bottom, right, top, points
_Place = tuple[float, float, str, str]  # offset across and up, points, and where the text is held


@dataclass(frozen=True, slots=True, eq=False)
class Label:
    """A name and the point that it belongs to.

    Args:
        text: the name.
        point_m: shape ``(3,)``, metres.
        colour: of the text.
        beside: whether it is written to the right of its point if it can be, and not above.
        on: whether it is written on its point, which has no marker, if it can be.
        size_pt: of the text.
        around_m: radius of a ball around the point that is drawn as well, metres.
    """

    text: str
    point_m: FloatArray
    colour: str
    beside: bool = False
    on: bool = False
    size_pt: float = _SIZE_PT
    around_m: float = 0.0


def place_labels(axes: Any, labels: Sequence[Label], centre_m: FloatArray, radius_m: float) -> None:
    """Write names where they cover least: of markers, of each other and of a ball.

    Args:
        axes: of a 3-D picture, with its limits, its view and its place in the figure set.
        labels: the names, the most important first.
        centre_m: of the ball to leave free, shape ``(3,)``, metres.
        radius_m: of the ball.
    """
    from matplotlib.patheffects import withStroke

    axes.apply_aspect()
    points = [_on_paper(axes, label.point_m) for label in labels]
    taken = [_around(at, _MARKER_PT) for label, at in zip(labels, points, strict=True) if not label.on]
    taken.append(_around(_on_paper(axes, centre_m), 0.9 * _size(axes, centre_m, radius_m)))
    for label, at in zip(labels, points, strict=True):
        around = _size(axes, label.point_m, label.around_m)
        places = _places(label, around if around <= _FARTHEST_PT else 0.0)
        boxes = [_box(label, at, place) for place in places]
        covered = [sum(_shared(box, other) for other in taken) for box in boxes]
        best = int(np.argmin(covered))  # the first of equals, so that habits are kept where there is room
        across, up, side, level = places[best]
        axes.annotate(
            label.text.replace("$", r"\$"),
            _flat(axes, label.point_m),
            xytext=(across, up),
            textcoords="offset points",
            color=label.colour,
            ha=side,
            va=level,
            fontsize=label.size_pt,
            zorder=8,
            annotation_clip=False,
            path_effects=[withStroke(linewidth=2.0, foreground="white")],
        )
        taken.append(boxes[best])


def _flat(axes: Any, point_m: FloatArray) -> tuple[float, float]:
    """Return where a point is in the plane that the axes project on."""
    from mpl_toolkits.mplot3d import proj3d

    x, y, _ = proj3d.proj_transform(*point_m, axes.get_proj())
    return float(x), float(y)


def _on_paper(axes: Any, point_m: FloatArray) -> FloatArray:
    """Return where a point is on the paper, shape ``(2,)``, typographic points."""
    pixels: FloatArray = np.asarray(axes.transData.transform(_flat(axes, point_m)))
    return np.asarray(pixels * 72.0 / axes.figure.dpi)


def _around(at: FloatArray, half: float) -> Box:
    return at[0] - half, at[1] - half, at[0] + half, at[1] + half


def _size(axes: Any, centre_m: FloatArray, radius_m: float) -> float:
    """Return the radius of a ball on the paper, points."""
    middle = _on_paper(axes, centre_m)
    ends = [_on_paper(axes, centre_m + radius_m * side) for side in np.eye(3)]
    return max(float(np.linalg.norm(end - middle)) for end in ends)


def _places(label: Label, around_pt: float) -> list[_Place]:
    """Return where a name may stand, the usual place first."""
    away = max(_AWAY_PT, around_pt) + (4.0 if label.on else 0.0)
    above, below = (0.0, away, "center", "bottom"), (0.0, -away, "center", "top")
    right, left = (away + 1.0, 0.0, "left", "center"), (-away - 1.0, 0.0, "right", "center")
    corners = [
        (across * away, up * away, "left" if across > 0 else "right", "bottom" if up > 0 else "top")
        for up in (0.7, -0.7)
        for across in (0.7, -0.7)
    ]
    usual = [right, left, above, below] if label.beside else [above, right, left, below]
    return [*([(0.0, 0.0, "center", "center")] if label.on else []), *usual, *corners]


def _box(label: Label, at: FloatArray, place: _Place) -> Box:
    across, up, side, level = place
    width, height = _LETTER * label.size_pt * len(label.text), 1.1 * label.size_pt
    left = at[0] + across - {"left": 0.0, "center": 0.5, "right": 1.0}[side] * width
    bottom = at[1] + up - {"bottom": 0.0, "center": 0.5, "top": 1.0}[level] * height
    return left, bottom, left + width, bottom + height


def _shared(one: Box, other: Box) -> float:
    """Return the area that two boxes share, square points."""
    across = min(one[2], other[2]) - max(one[0], other[0])
    up = min(one[3], other[3]) - max(one[1], other[1])
    return max(0.0, across) * max(0.0, up)
