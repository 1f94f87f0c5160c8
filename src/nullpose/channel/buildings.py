"""Buildings as upright prisms, and whether one stands between two points."""

from __future__ import annotations

from collections.abc import Sequence
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
        margin_m: distance from the drone within which the line of sight is as poor as at its worst [m].
    """

    start: NDArray[np.int64]
    sides: FloatArray
    base_m: FloatArray
    least_height_m: FloatArray
    most_height_m: FloatArray
    building: NDArray[np.int64]
    margin_m: float = 0.0


def prisms_of(
    outlines_m: Sequence[FloatArray],
    courtyards_m: Sequence[Sequence[FloatArray]],
    bases_m: ArrayLike,
    heights_m: ArrayLike,
    margin_m: float = 0.0,
) -> Prisms:
    """Cut buildings into convex prisms; one of convex shape stays whole.

    Args:
        outlines_m: of each building, its vertices counter-clockwise, (v, 2), metres.
        courtyards_m: of each building, the vertices of its courtyards.
        bases_m: (b,) altitudes of the floors.
        heights_m: (b, 2) lowest and highest altitude that each roof may have.
        margin_m: distance from the drone within which the line of sight is as poor as at its worst.

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
    pieces = list(map(_distinct, _overlapping(parts, building))) if parts else []
    least_m, most_m = np.asarray(heights_m, dtype=np.float64).reshape(-1, 2)[building].T
    return Prisms(
        np.cumsum([0, *map(len, pieces)]).astype(np.int64),
        np.vstack([np.zeros((0, 3)), *pieces]),
        np.asarray(bases_m, dtype=np.float64).reshape(-1)[building],
        least_m,
        most_m,
        building,
        margin_m,
    )


def _distinct(walls: FloatArray) -> FloatArray:
    """Leave out walls that lie in one line with the wall before."""
    before = np.roll(walls, 1, axis=0)
    return walls[np.abs(before[:, 0] * walls[:, 1] - before[:, 1] * walls[:, 0]) > _IN_LINE]


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

    To a node a link counts as clear where it is so for the drone anywhere within the margin: its shadows are
    grown by it, and their edges stay sharp. To an interferer it counts as blocked likewise: its shadows are
    shrunk by the margin.

    Args:
        of_point: (m + 1,) int64, where the shadows of each point begin in ``start``, and where the last end.
        start: (n + 1,) int64, where the sides of each shadow begin in ``sides``.
        sides: (s, 5) outward unit normal and offset [m] of each side: ``n . p <= c`` inside; and the offset
            ``HAIR_M`` off, outwards for nodes and inwards for interferers, where a pose counts as blocked.
    """

    of_point: NDArray[np.int64]
    start: NDArray[np.int64]
    sides: FloatArray

    def hold(self, along_m: FloatArray) -> NDArray[np.bool_]:
        """Check which points a building hides from each of several positions, (..., m).

        Args:
            along_m: (..., s) each side's normal times the position [m].
        """
        inside = np.maximum.reduceat(along_m - self.sides[:, 3], self.start[:-1], axis=-1) < -TOUCHING_M
        count = np.insert(np.cumsum(inside, axis=-1), 0, 0, axis=-1)
        return np.asarray(np.diff(count[..., self.of_point], axis=-1) > 0)


def shadows_of(prisms: Prisms, points_m: FloatArray, is_interferer: ArrayLike) -> Shadows:
    """Find where each prism blocks the line of sight to each point.

    What a convex prism blocks from a point is convex: bounded by the faces that face the point, and by the
    planes through the point and the edges between those and the others. From inside a prism everything is
    blocked: such a shadow has a side at infinity.

    Args:
        prisms: the buildings.
        points_m: (m, 3), metres.
        is_interferer: (m,) which points the lower roofs count for; or whether for all.
    """
    is_low = np.broadcast_to(is_interferer, len(points_m))
    roofs_m = np.where(is_low[:, None], prisms.least_height_m, prisms.most_height_m)
    piece, planes, offsets_m, is_side = _planes(prisms, points_m, roofs_m)
    point, row = np.nonzero(is_side & (roofs_m > prisms.base_m)[:, piece])
    order = np.lexsort((piece[row], point))  # those of a shadow together
    point, row = point[order], row[order]
    normal, offset_m = planes[point, row], offsets_m[point, row]
    length = np.linalg.norm(normal, axis=1)
    normal = normal / np.where(length > 0.0, length, 1.0)[:, None]
    offset_m = np.divide(offset_m, length, out=np.full(len(length), np.inf), where=length > 0.0)
    grown_m = np.where(is_low, -1.0, 1.0)[point, None] * [prisms.margin_m, prisms.margin_m + HAIR_M]
    first = np.flatnonzero(np.diff(point * len(prisms.base_m) + piece[row], prepend=-1))
    of_point = np.searchsorted(point[first], np.arange(len(points_m) + 1))
    sides = np.column_stack([normal, offset_m[:, None] + grown_m])
    return Shadows(of_point, np.append(first, len(row)), sides)


def _planes(
    prisms: Prisms, points_m: FloatArray, roofs_m: FloatArray
) -> tuple[NDArray[np.int64], FloatArray, FloatArray, NDArray[np.bool_]]:
    """List the planes that may bound the shadow of each prism from each point.

    Returns:
        Of each plane its prism, (k,); for each point the normal of any length, (m, k, 3), which is zero for
        the side at infinity, times it a point of the plane, (m, k), and whether it is a side, (m, k).
    """
    walls, count, pieces = prisms.sides, len(prisms.sides), np.arange(len(prisms.base_m))
    piece, onward = np.repeat(pieces, np.diff(prisms.start)), np.arange(1, count + 1)
    onward[prisms.start[1:] - 1] = prisms.start[:-1]
    up = np.outer(pieces >= 0, [0.0, 0.0, 1.0])
    faces = np.vstack([np.insert(walls[:, :2], 2, 0.0, axis=1), up, -up])
    walls_m, floors_m = (each + np.zeros((len(points_m), 1)) for each in (walls[:, 2], prisms.base_m))
    faces_m = np.hstack([walls_m, roofs_m, -floors_m])
    is_front = points_m @ faces.T >= faces_m
    of_walls, of_roofs, of_floors = np.split(is_front, [count, count + len(pieces)], axis=1)
    is_outside = np.logical_or.reduceat(of_walls, prisms.start[:-1], axis=1) | of_roofs | of_floors
    # edges of each wall: with the next, with the roof and with the floor
    first = np.tile(np.arange(count), 3)
    other = np.hstack([onward, count + piece, count + len(pieces) + piece])
    heights_m = np.hstack([0.0 * walls_m, roofs_m[:, piece], floors_m[:, piece]])
    corners_m = np.tile(_corners(walls, walls[onward]), (len(points_m), 3, 1))
    to_edges_m = np.dstack([corners_m, heights_m]) - points_m[:, None]
    away = np.where(is_front[:, first], -1.0, 1.0)[..., None]
    tangent = away * np.cross(np.cross(faces[first], faces[other]), to_edges_m)
    planes = np.hstack([faces + 0.0 * faces_m[..., None], 0.0 * (up + roofs_m[..., None]), tangent])
    offsets_m = np.hstack([faces_m, 0.0 * roofs_m, np.einsum("mki,mi->mk", tangent, points_m)])
    is_side = np.hstack([is_front, ~is_outside, is_front[:, first] != is_front[:, other]])
    return np.hstack([piece, pieces, pieces, pieces, piece[first]]), planes, offsets_m, is_side


def _corners(walls: FloatArray, onward: FloatArray) -> FloatArray:
    """List the corners in which walls meet others, (w, 2)."""
    det = walls[:, 0] * onward[:, 1] - onward[:, 0] * walls[:, 1]
    east = (walls[:, 2] * onward[:, 1] - onward[:, 2] * walls[:, 1]) / det
    north = (walls[:, 0] * onward[:, 2] - onward[:, 0] * walls[:, 2]) / det
    return np.column_stack([east, north])


def is_blocked(
    prisms: Prisms, positions_m: ArrayLike, points_m: ArrayLike, is_interferer: ArrayLike
) -> NDArray[np.bool_]:
    """Check if a building stands on the straight line between positions and ground points.

    Without a margin a line that touches an edge, a wall or a roof is clear.

    Args:
        prisms: the buildings, with the margin.
        positions_m: of the drone, (..., 3), metres.
        points_m: on the ground, (m, 3), or (..., m, 3) where they differ, metres.
        is_interferer: (m,) whether each is a jammer or an eavesdropper, for which the lower roofs count and
            shadows are shrunk by the margin; to a node the higher roofs, and shadows are grown. Or whether
            all are.

    Returns:
        Array of shape (..., m).

    Example:
        >>> import numpy as np
        >>> square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
        >>> tower = prisms_of([square], [[]], [0.0], [[20.0, 22.0]])
        >>> is_blocked(tower, [-10.0, 5.0, 30.0], [[20.0, 5.0, 11.0], [20.0, 5.0, 20.0]], False)
        array([ True, False])
    """
    at_m, to_m = np.asarray(positions_m, dtype=np.float64), np.asarray(points_m, dtype=np.float64)
    is_low = np.broadcast_to(is_interferer, to_m.shape[-2:-1])
    if to_m.ndim == 2:
        shadows = shadows_of(prisms, to_m, is_low)
        parts = np.array_split(at_m.reshape(-1, 3), 1 + at_m.size * len(shadows.sides) // _BLOCK)
        found = [shadows.hold(part @ shadows.sides[:, :3].T) for part in parts]
        return np.concatenate(found).reshape(*at_m.shape[:-1], len(to_m))
    at_m, to_m = np.broadcast_arrays(at_m[..., None, :], to_m)
    links = at_m.reshape(-1, 3), to_m.reshape(-1, 3), np.broadcast_to(is_low, to_m.shape[:-1]).reshape(-1)
    count = 1 + to_m.size * len(prisms.sides) // _BLOCK
    parts_of_each = zip(*(np.array_split(each, count) for each in links), strict=True)
    found = [_is_each_blocked(prisms, *part) for part in parts_of_each]
    return np.concatenate(found).reshape(to_m.shape[:-1])


def _is_each_blocked(
    prisms: Prisms, positions_m: FloatArray, points_m: FloatArray, is_interferer: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Check the lines from positions to points, (l, 3) each, (l,)."""
    shadows = shadows_of(prisms, points_m, is_interferer)
    at_sides_m = np.repeat(positions_m, np.diff(shadows.start[shadows.of_point]), axis=0)
    return shadows.hold(np.sum(at_sides_m * shadows.sides[:, :3], axis=1))
