"""Names of points in a picture of a scene, each beside its point and off the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import rcParams
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d import proj3d

from nullpose.physics.types import FloatArray

_MARKER_PT = 5.0  # half of a marker
_AWAY_PT = 7.0  # from a point to its name
_FARTHEST_PT = 30.0  # from a point to the end of what is drawn around it; a name stands within what is wider

_SIDES = {
    -1: "right",
    0: "center",
    1: "left",
}
_LEVELS = {-1: "top", 0: "center", 1: "bottom"}
_ABOUT = ((0, 1), (1, 0), (-1, 0), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
"""Where a name may stand about its point, across and up; of equal places the first is taken."""


@dataclass(frozen=True, slots=True, eq=False)
class Label:
    """A name and the point that it belongs to.

    Args:
        text: the name.
        point_m: shape ``(3,)``, metres.
        colour: of the text.
        beside: whether it is written to the right of its point if it can be, and not above.
        on: whether it is written on its point, which has no marker, if it can be.
        around_m: radius of a ball around the point that is drawn as well, metres.
    """

    text: str
    point_m: FloatArray
    colour: str
    beside: bool = False
    on: bool = False
    around_m: float = 0.0


def place_labels(axes: Any, labels: Sequence[Label], centre_m: FloatArray, radius_m: float) -> None:
    """Write names where they cover least: of markers, of each other and of a ball.

    Args:
        axes: of a picture in 3-D or from above, with its limits, its view and its place in the figure set.
        labels: the names, the most important first.
        centre_m: of the ball to leave free, shape ``(3,)``, metres.
        radius_m: of the ball.
    """
    axes.apply_aspect()
    pixels = axes.figure.dpi / 72.0
    spots = [_on_paper(axes, label.point_m)[1] for label in labels]
    taken = [
        _square(at, _MARKER_PT * pixels) for label, at in zip(labels, spots, strict=True) if not label.on
    ]
    taken.append(_square(_on_paper(axes, centre_m)[1], 0.9 * _radius(axes, centre_m, radius_m)))

    def covered(text: Any, place: tuple[int, int], away_pt: float) -> float:
        """Return how much a text covers, square pixels, after moving it to a place."""
        share = away_pt * (0.7 if all(place) else 1.0)
        text.set(position=(share * place[0], share * place[1]), ha=_SIDES[place[0]], va=_LEVELS[place[1]])
        own = text.get_window_extent()
        shared = [Bbox.intersection(own, box) for box in taken]
        return outside(own) + sum(_area(box) for box in shared)

    def outside(own: Any) -> float:
        """Return how much of a text is outside the axes, where the numbers are; nothing in 3-D."""
        return 0.0 if axes.name == "3d" else _area(own) - _area(Bbox.intersection(own, axes.bbox))

    for label in labels:
        text = axes.annotate(
            label.text,
            _on_paper(axes, label.point_m)[0],
            xytext=(0.0, 0.0),
            textcoords="offset points",
            color=label.colour,
            fontsize=rcParams["xtick.labelsize"],
            zorder=8,
            annotation_clip=False,
            parse_math=False,
            path_effects=[withStroke(linewidth=2.0, foreground="white")],
        )
        around_pt = _radius(axes, label.point_m, label.around_m) / pixels
        away_pt = max(_AWAY_PT, around_pt if around_pt <= _FARTHEST_PT else 0.0)
        places = [*((0, 0),) * label.on, *((1, 0),) * label.beside, *_ABOUT]
        covered(text, min(places, key=lambda place: covered(text, place, away_pt)), away_pt)
        taken.append(text.get_window_extent())


def _on_paper(axes: Any, point_m: FloatArray) -> tuple[tuple[float, float], FloatArray]:
    """Return where a point is in the plane that the axes project on, and on the paper, pixels."""
    x, y = point_m[:2]
    if axes.name == "3d":
        x, y, _ = proj3d.proj_transform(*point_m, axes.get_proj())
    return (float(x), float(y)), np.asarray(axes.transData.transform((x, y)))


def _area(box: Any) -> float:
    return 0.0 if box is None else float(box.width * box.height)


def _square(at: FloatArray, half: float) -> Any:
    return Bbox([at - half, at + half])


def _radius(axes: Any, centre_m: FloatArray, radius_m: float) -> float:
    """Return the radius of a ball on the paper, pixels."""
    middle = _on_paper(axes, centre_m)[1]
    ends = [_on_paper(axes, centre_m + radius_m * side)[1] for side in np.eye(3)]
    return max(float(np.linalg.norm(end - middle)) for end in ends)
