"""Outlines further out or further in: what a margin makes of zones and fence."""

from __future__ import annotations

import numpy as np

from nullpose.scenario.arrays import Floats

_MITRE_LIMIT = 1.5  # a right angle's mitre, 1.42 times the distance, stays whole
_SLACK = 1e-5  # GEOS rounds its offsets by 2e-6 of the distance
_SIMPLER = 1e-6


def offset_outlines_m(outline_m: Floats, by_m: float) -> list[tuple[tuple[float, float], ...]]:
    """Returns a polygon's outline further out, or further in: one for each part that it falls into.

    No point of the new border is nearer to the old one than the distance. At a corner it is up to 1.81 times
    as far away: edges are joined by mitres, which are cut off at 1.5 times the distance. A pocket whose mouth
    closes counts as inside.

    Args:
        outline_m: vertices of a simple polygon [m], (n, 2).
        by_m: how far each edge is moved outwards [m]; inwards if negative.
    """
    from shapely import Polygon  # imported here: most scenarios have no margin

    moved = Polygon(outline_m).buffer(by_m * (1.0 + _SLACK), join_style="mitre", mitre_limit=_MITRE_LIMIT)
    moved = moved.simplify(_SIMPLER * abs(by_m))  # edges of no length have no direction
    parts = getattr(moved, "geoms", [moved])
    return [tuple(part.exterior.coords[:-1]) for part in parts if not part.is_empty]


def largest_margin_m(outline_m: Floats, below_m: float) -> float:
    """Returns the largest margin, to a hundredth, that leaves one part inside an outline [m]; 0 if none does.

    Args:
        outline_m: vertices of a simple polygon [m], (n, 2).
        below_m: what it is smaller than [m].
    """
    most_m = min(below_m, 0.5 * float(np.ptp(outline_m, axis=0).min()))
    tried_m = (float(f"{most_m * percent / 100:.3g}") for percent in range(99, 0, -1))
    return next((each_m for each_m in tried_m if len(offset_outlines_m(outline_m, -each_m)) == 1), 0.0)
