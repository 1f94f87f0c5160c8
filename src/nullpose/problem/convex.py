"""Simple polygons cut into convex parts."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullpose.objectives import FloatArray

# shapely is imported where there is a polygon: most scenarios have none.


def convex_parts(outline_m: FloatArray) -> list[FloatArray]:
    """Return convex polygons that together are a simple polygon: itself, if it is convex, or triangles.

    Args:
        outline_m: vertices, (n, 2), counter-clockwise, metres.
    """
    import shapely

    along = np.roll(outline_m, -1, axis=0) - outline_m
    after = np.roll(along, -1, axis=0)
    if np.all(along[:, 0] * after[:, 1] >= along[:, 1] * after[:, 0]):
        return [outline_m]
    return _outlines(shapely.constrained_delaunay_triangles(shapely.Polygon(outline_m)))


def hull_and_pockets(outline_m: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
    """Return the convex hull of a simple polygon and the parts of the hull outside the polygon.

    Args:
        outline_m: vertices, (n, 2), counter-clockwise, metres.

    Returns:
        The hull's vertices and the pockets', each counter-clockwise.
    """
    import shapely

    polygon = shapely.Polygon(outline_m)
    return _outlines(polygon.convex_hull)[0], _outlines(polygon.convex_hull - polygon)


def _outlines(shapes: Any) -> list[FloatArray]:
    """Return the vertices of shapely's polygons, each counter-clockwise."""
    import shapely

    parts = shapely.get_parts(shapely.orient_polygons(shapes))
    return [shapely.get_coordinates(part)[:-1] for part in parts if part.geom_type == "Polygon" and part.area]
