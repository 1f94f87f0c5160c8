"""Convex pieces of polygons in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

FloatArray: TypeAlias = NDArray[np.float64]
_Vertex: TypeAlias = tuple[float, ...]

# shapely is imported where there is a polygon: most scenarios have none.


def is_convex(outline_m: FloatArray) -> bool:
    """Check if a polygon, counter-clockwise, turns left or goes on straight at every vertex.

    Args:
        outline_m: vertices, (n, 2), metres.
    """
    along = np.roll(outline_m, -1, axis=0) - outline_m
    after = np.roll(along, -1, axis=0)
    turn = along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0]
    return bool(np.all((turn > 0.0) | ((turn == 0.0) & (np.sum(along * after, axis=1) > 0.0))))


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


def joined(parts_m: Sequence[FloatArray]) -> list[FloatArray]:
    """Join convex parts of a polygon over common edges as long as they stay convex (Hertel and Mehlhorn).

    Args:
        parts_m: vertices of each, (n, 2), metres, counter-clockwise; neighbours have whole edges in common.
    """
    parts = {index: [tuple(vertex) for vertex in part.tolist()] for index, part in enumerate(parts_m)}
    owners = {edge: index for index, part in parts.items() for edge in edges_of(part)}
    for begin, end in list(owners):
        part, other = owners[begin, end], owners.get((end, begin))
        if other is None or other == part:
            continue
        first, second = _from(parts[part], end), _from(parts[other], begin)
        both = [*first, *second[1:-1]]
        if is_convex(np.array(both)):
            owners |= dict.fromkeys(edges_of(second), part)
            parts[part] = both
            del parts[other]
    return [np.array(part) for part in parts.values()]


def edges_of(part: Sequence[_Vertex]) -> list[tuple[_Vertex, _Vertex]]:
    """List the pairs of vertices that follow each other around a polygon."""
    return list(zip(part, [*part[1:], part[0]], strict=True))


def sides_of(part_m: FloatArray) -> FloatArray:
    """List the outward unit normal and the offset of each edge of a convex polygon, (n, 3).

    Args:
        part_m: vertices, (n, 2), metres, counter-clockwise.
    """
    along = np.roll(part_m, -1, axis=0) - part_m
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    return np.column_stack([normal, np.sum(normal * part_m, axis=1)])


def _from(part: list[_Vertex], vertex: _Vertex) -> list[_Vertex]:
    place = part.index(vertex)
    return part[place:] + part[:place]


def outlines_of(shapes: BaseGeometry) -> list[FloatArray]:
    """List the vertices of shapely's polygons, each counter-clockwise."""
    import shapely

    parts = shapely.get_parts(shapely.orient_polygons(shapes))
    return [shapely.get_coordinates(part)[:-1] for part in parts if part.geom_type == "Polygon" and part.area]
