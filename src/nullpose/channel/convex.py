"""Convex pieces of polygons in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from nullpose.channel.model import FloatArray

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

# shapely is imported where there is a polygon: most scenarios have none.


def is_convex(outline_m: FloatArray) -> bool:
    """Check if a simple polygon, counter-clockwise, turns left or goes on straight at every vertex.

    Args:
        outline_m: vertices, (n, 2), metres.
    """
    along = np.roll(outline_m, -1, axis=0) - outline_m
    after = np.roll(along, -1, axis=0)
    return bool(np.all(along[:, 0] * after[:, 1] >= along[:, 1] * after[:, 0]))


def convex_parts(outline_m: FloatArray, courtyards_m: Sequence[FloatArray] = ()) -> list[FloatArray]:
    """Cut a simple polygon, counter-clockwise, into triangles; leave a convex one as it is.

    Args:
        outline_m: vertices, (n, 2), metres.
        courtyards_m: the same of holes in it, in either sense of rotation.
    """
    if not len(courtyards_m) and is_convex(outline_m):
        return [outline_m]
    import shapely

    return outlines_of(shapely.constrained_delaunay_triangles(shapely.Polygon(outline_m, courtyards_m)))


def outlines_of(shapes: BaseGeometry) -> list[FloatArray]:
    """List the vertices of shapely's polygons, each counter-clockwise."""
    import shapely

    parts = shapely.get_parts(shapely.orient_polygons(shapes))
    return [shapely.get_coordinates(part)[:-1] for part in parts if part.geom_type == "Polygon" and part.area]
