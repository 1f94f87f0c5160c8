"""Buildings as upright prisms, and whether one stands between two points."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.channel.convex import FloatArray, convex_parts, edges_of, joined, sides_of

TOUCHING_M = 1e-9
"""What enters a prism by less than this touches it only [m]."""
OVERLAP_M = 1e-6
"""How far walls that touch reach into each other, so that no line slips between them [m]."""
HAIR_M = 1e-5
"""How far off the edge of a shadow a pose is found, so that the line of sight is sure there [m]."""
_BLOCK = 2_000_000  # numbers of an array
_IN_LINE = 1e-9  # the sine of an angle between two walls that are one


class Prisms(NamedTuple):
    """Convex upright prisms, of which buildings are made.

    Args:
        start: (n + 1,) int64, where the sides of each prism begin in ``sides``, and where the last ones end.
        sides: (s, 3) outward unit normal (east, north) and offset [m] of each side: ``n . x <= c`` inside.
        base_m: (n,) altitude of the floor of each [m].
        least_height_m: (n,) altitude of the roof, at the low end of what is known [m].
        most_height_m: (n,) the same at the high end.
        building: (n,) int64, which building each is a piece of.
    """

    start: NDArray[np.int64]
    sides: FloatArray
    base_m: FloatArray
    least_height_m: FloatArray
    most_height_m: FloatArray
    building: NDArray[np.int64]


def prisms_of(
    outlines_m: Sequence[FloatArray],
    courtyards_m: Sequence[Sequence[FloatArray]],
    bases_m: ArrayLike,
    heights_m: ArrayLike,
) -> Prisms:
    """Cut buildings into convex prisms; one of convex shape stays whole.

    Args:
        outlines_m: of each building, its vertices counter-clockwise, (v, 2), metres.
        courtyards_m: of each building, the vertices of its courtyards.
        bases_m: (b,) altitudes of the floors.
        heights_m: (b, 2) lowest and highest altitude that each roof may have.

    Example:
        >>> import numpy as np
        >>> square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
        >>> prisms_of([square], [[]], [0.0], [[20.0, 22.0]]).sides
        array([[ 0., -1.,  0.],
               [ 1.,  0., 10.],
               [ 0.,  1., 10.],
               [-1.,  0.,  0.]])
    """
    parts = [joined(convex_parts(*plan)) for plan in zip(outlines_m, courtyards_m, strict=True)]
    building = np.repeat(np.arange(len(parts)), [len(pieces) for pieces in parts])
    pieces = _overlapping(parts, building) if parts else []
    least_m, most_m = np.asarray(heights_m, dtype=np.float64).reshape(-1, 2)[building].T
    return Prisms(
        np.cumsum([0, *map(len, pieces)]).astype(np.int64),
        np.vstack([np.zeros((0, 3)), *pieces]),
        np.asarray(bases_m, dtype=np.float64).reshape(-1)[building],
        least_m,
        most_m,
        building,
    )


def _overlapping(parts: Sequence[Sequence[FloatArray]], building: NDArray[np.int64]) -> list[FloatArray]:
    """List the sides of the convex parts of all buildings, those moved outwards where parts touch.

    Of one building these are the sides that two parts have in common, and of several all sides that touch
    another building.
    """
    import shapely

    pieces = [piece for part in parts for piece in part]
    edges = [
        [(int(index), edge) for edge in edges_of([tuple(vertex) for vertex in piece.tolist()])]
        for index, piece in zip(building, pieces, strict=True)
    ]
    walls = [wall for piece in edges for wall in piece]
    edges_of_all = set(walls)
    touches = np.array([(index, edge[::-1]) in edges_of_all for index, edge in walls])
    tree = shapely.STRtree([shapely.Polygon(piece) for piece in pieces])
    lines = shapely.linestrings(np.reshape([edge for _, edge in walls], (-1, 2, 2)))
    wall, piece = tree.query(lines, predicate="dwithin", distance=OVERLAP_M)
    touches[wall[np.array([index for index, _ in walls])[wall] != building[piece]]] = True
    moved_m = np.split(OVERLAP_M * touches, np.cumsum([len(piece) for piece in pieces])[:-1])
    return [
        sides_of(piece) + np.outer(by_m, [0.0, 0.0, 1.0]) for piece, by_m in zip(pieces, moved_m, strict=True)
    ]


class Shadows(NamedTuple):
    """Where a building blocks the line of sight to each of several points: convex polyhedra.

    Args:
        of_point: (m + 1,) int64, where the shadows of each point begin in ``start``, and where the last end.
        start: (n + 1,) int64, where the sides of each shadow begin in ``sides``.
        sides: (s, 5) outward unit normal and offset [m] of each side: ``n . p <= c`` inside; and the offset
            ``HAIR_M`` off, outwards for nodes and inwards for interferers, where a pose counts as blocked.
    """

    of_point: NDArray[np.int64]
    start: NDArray[np.int64]
    sides: FloatArray


def shadows_of(prisms: Prisms, points_m: FloatArray, is_interferer: NDArray[np.bool_]) -> Shadows:
    """Find where each prism blocks the line of sight to each point.

    What a convex prism blocks from a point is convex: bounded by the sides that face the point, and by the
    planes through the point along the edges between those and the others.

    Args:
        prisms: the buildings.
        points_m: (m, 3), metres; in no prism.
        is_interferer: (m,) which points the lower roofs count for.
    """
    shadows: list[FloatArray] = []
    counts = [0]
    walls = [prisms.sides[begin:end] for begin, end in pairwise(prisms.start)]
    corners = list(map(_corners, walls))
    for point_m, is_low in zip(points_m, is_interferer, strict=True):
        roofs_m = prisms.least_height_m if is_low else prisms.most_height_m
        solid = np.flatnonzero(roofs_m > prisms.base_m)
        for index in solid:
            ends_m = (prisms.base_m[index], roofs_m[index])
            sides = _shadow(walls[index], corners[index], ends_m, point_m)
            shadows.append(np.column_stack([sides, sides[:, 3] + (-HAIR_M if is_low else HAIR_M)]))
        counts.append(len(shadows))
    starts = np.cumsum([0, *(len(sides) for sides in shadows)])
    sides = np.vstack([np.zeros((0, 5)), *shadows])
    return Shadows(np.array(counts, dtype=np.int64), starts.astype(np.int64), sides)


def _shadow(
    walls: FloatArray, corners: FloatArray, ends_m: tuple[float, float], point_m: FloatArray
) -> FloatArray:
    """List the sides of the shadow of one prism, (s, 4)."""
    base_m, roof_m = ends_m
    ends = np.array([[0.0, 0.0, 1.0, roof_m], [0.0, 0.0, -1.0, -base_m]])
    faces = np.vstack([np.insert(walls, 2, 0.0, axis=1), ends])
    # what faces the point, or has it in its plane
    kept = [faces[faces[:, :3] @ point_m >= faces[:, 3]]]
    top, bottom = (np.column_stack([corners, np.full(len(corners), z)]) - point_m for z in (roof_m, base_m))
    after = [np.roll(end, -1, axis=0) for end in (top, bottom)]
    normals = np.cross(np.vstack([top, bottom, top]), np.vstack([*after, bottom]))
    normals = np.vstack([normals, -normals])
    length = np.linalg.norm(normals, axis=1)
    normals = normals[length > 0.0] / length[length > 0.0, None]
    solid = np.vstack([top, bottom])
    reach = np.abs(solid).max()
    tangent = normals[np.all(normals @ solid.T <= 1e-12 * reach, axis=1)]
    return np.vstack([*kept, np.column_stack([tangent, tangent @ point_m])])


def _corners(walls: FloatArray) -> FloatArray:
    """Return the vertices of a convex polygon from its sides in order: where neighbours meet."""
    before = np.roll(walls, 1, axis=0)
    walls = walls[np.abs(before[:, 0] * walls[:, 1] - before[:, 1] * walls[:, 0]) > _IN_LINE]
    before = np.roll(walls, 1, axis=0)
    det = before[:, 0] * walls[:, 1] - before[:, 1] * walls[:, 0]
    east = (before[:, 2] * walls[:, 1] - walls[:, 2] * before[:, 1]) / det
    north = (before[:, 0] * walls[:, 2] - walls[:, 0] * before[:, 2]) / det
    return np.column_stack([east, north])


def is_blocked(
    prisms: Prisms, positions_m: ArrayLike, points_m: ArrayLike, heights_m: FloatArray
) -> NDArray[np.bool_]:
    """Check if a building stands on the straight line between positions and ground points.

    A line is clipped by the half-spaces of each prism; what is left of it lies inside. A line that touches
    an edge, a wall or a roof is clear.

    Args:
        prisms: the buildings.
        positions_m: of the drone, (..., 3), metres.
        points_m: on the ground, (m, 3), or (..., m, 3) where they differ, metres.
        heights_m: (n,) the roof of each prism: ``prisms.most_height_m`` where a building makes the value
            worse (nodes), ``prisms.least_height_m`` where it makes it better (jammers).

    Returns:
        Array of shape (..., m).

    Example:
        >>> import numpy as np
        >>> square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
        >>> tower = prisms_of([square], [[]], [0.0], [[20.0, 22.0]])
        >>> is_blocked(tower, [-10.0, 5.0, 30.0], [[20.0, 5.0, 11.0], [20.0, 5.0, 20.0]], tower.most_height_m)
        array([ True, False])
    """
    begins_m = np.asarray(positions_m, dtype=np.float64)[..., None, :]
    begins_m, ends_m = np.broadcast_arrays(begins_m, np.asarray(points_m, dtype=np.float64))
    blocked = np.zeros(begins_m.shape[:-1], dtype=np.bool_)
    begins_m, ends_m, links = begins_m.reshape(-1, 3), ends_m.reshape(-1, 3), blocked.reshape(-1)
    rows = max(1, _BLOCK // max(1, len(prisms.sides)))  # links at a time
    for first in range(0, len(links) if len(prisms.base_m) else 0, rows):
        part = slice(first, first + rows)
        links[part] = _meets(prisms, begins_m[part], ends_m[part], heights_m)
    return blocked


def _meets(
    prisms: Prisms, begin_m: FloatArray, end_m: FloatArray, heights_m: FloatArray
) -> NDArray[np.bool_]:
    """Clip the lines from begins to ends, (l, 3) each, by all prisms, (l,)."""
    enters, leaves = np.zeros((len(begin_m), len(heights_m))), np.ones((len(begin_m), len(heights_m)))
    for normals, offsets, start in (
        (np.insert(prisms.sides[:, :2], 2, 0.0, axis=1), prisms.sides[:, 2], prisms.start[:-1]),
        (np.array([[0.0, 0.0, 1.0]]), heights_m, np.arange(len(heights_m))),
        (np.array([[0.0, 0.0, -1.0]]), -prisms.base_m, np.arange(len(heights_m))),
    ):
        outside = offsets - TOUCHING_M
        at_begin, at_end = begin_m @ normals.T - outside, end_m @ normals.T - outside
        slope = at_begin - at_end
        crossing = np.divide(at_begin, slope, out=np.zeros_like(slope), where=slope != 0.0)
        enter = np.where(at_begin < 0.0, 0.0, np.where(at_end < 0.0, crossing, np.inf))
        leave = np.where(at_end < 0.0, 1.0, np.where(at_begin < 0.0, crossing, -np.inf))
        enters = np.maximum(enters, np.maximum.reduceat(enter, start, axis=1))
        leaves = np.minimum(leaves, np.minimum.reduceat(leave, start, axis=1))
    return np.asarray(np.any(enters < leaves, axis=1))
