"""Simple polygons cut into convex parts."""

from __future__ import annotations

from heapq import heapify, heappop, heappush

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import FloatArray

_NEXT = [1, 2, 0]  # the corners after the three of a triangle


def convex_parts(outline_m: FloatArray) -> list[FloatArray]:
    """Return convex polygons that together are a simple polygon: itself, if it is convex, or triangles.

    Triangles by ear clipping: the widest of the ears is cut first, so that slivers are rare.

    Args:
        outline_m: vertices, (n, 2), counter-clockwise, metres.
    """
    if np.all(_turns(outline_m) >= 0.0):
        return [outline_m]
    every = np.arange(len(outline_m))
    before, after = np.roll(every, 1).tolist(), np.roll(every, -1).tolist()
    inward = _turns(outline_m) <= 0.0  # if an ear holds any vertex, it holds one of these
    corners = list(zip(every.tolist(), after, before, strict=True))
    widest = list(zip(-_smallest_angle(outline_m[np.array(corners)]), corners, strict=True))
    heapify(widest)
    parts: list[FloatArray] = []
    while widest and len(parts) < len(outline_m) - 2:
        corner = heappop(widest)[1]
        i, last, first = corner
        if (after[i], before[i]) != (last, first) or not _is_ear(outline_m, corner, inward):
            continue
        parts.append(outline_m[list(corner)])
        after[i] = before[i] = -1
        after[first], before[last] = last, first
        corners = [(k, after[k], before[k]) for k in (first, last)]  # no other vertex becomes an ear by this
        inward[[first, last]] = _turn(outline_m[corners]) <= 0.0
        if len(parts) < len(outline_m) - 2:
            for each in zip((-_smallest_angle(outline_m[corners])).tolist(), corners, strict=True):
                heappush(widest, each)
    return parts


def hull_and_pockets(outline_m: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
    """Return the convex hull of a simple polygon and the parts of the hull outside the polygon.

    Args:
        outline_m: vertices, (n, 2), counter-clockwise, metres.

    Returns:
        The hull's vertices and the pockets', each counter-clockwise.
    """
    on_hull = np.sort(_hull(outline_m))
    pockets = []
    for first, last in zip(on_hull, np.roll(on_hull, -1), strict=True):
        count = int((last - first) % len(outline_m))
        if count > 1:  # the chain between two hull vertices, walked backwards
            chain = (first + np.arange(count + 1)) % len(outline_m)
            pockets.append(outline_m[chain[::-1]])
    return outline_m[on_hull], pockets


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _turns(outline_m: FloatArray) -> FloatArray:
    before = outline_m - np.roll(outline_m, 1, axis=0)
    return _cross(before, np.roll(before, -1, axis=0))


def _turn(corners_m: FloatArray) -> FloatArray:
    """Return twice the areas of triangles, (..., 3, 2), negative where they are clockwise."""
    a = corners_m[..., 0, :]
    return _cross(corners_m[..., 1, :] - a, corners_m[..., 2, :] - a)


def _is_ear(outline_m: FloatArray, corner: tuple[int, int, int], inward: NDArray[np.bool_]) -> bool:
    if inward[corner[0]]:
        return False
    corner_m = outline_m[list(corner)]
    x, (west, east) = outline_m[:, 0], (corner_m[:, 0].min(), corner_m[:, 0].max())
    others = inward & (x >= west) & (x <= east)
    others[list(corner)] = False
    sides, ways = corner_m[_NEXT] - corner_m, outline_m[others] - corner_m[:, None]
    return not np.any(np.min(_cross(sides[:, None], ways), axis=0) >= 0.0)


def _smallest_angle(corners_m: FloatArray) -> FloatArray:
    """Return the sines of the smallest angles of triangles, (..., 3, 2), or what is least of the three."""
    ways = corners_m[..., _NEXT, :] - corners_m
    ways /= np.linalg.norm(ways, axis=-1)[..., None]
    return np.asarray(np.min(_cross(ways, ways[..., _NEXT, :]), axis=-1))


def _hull(outline_m: FloatArray) -> FloatArray:
    """Return the indices of the vertices on the convex hull (monotone chain)."""
    order = np.lexsort((outline_m[:, 1], outline_m[:, 0]))
    chains: list[list[int]] = []
    for way in (order, order[::-1]):
        chain: list[int] = []
        for k in way:
            while (
                len(chain) > 1
                and not _cross(
                    outline_m[chain[-1]] - outline_m[chain[-2]], outline_m[k] - outline_m[chain[-1]]
                )
                > 0.0
            ):
                chain.pop()
            chain.append(int(k))
        chains.append(chain[:-1])
    return np.array(chains[0] + chains[1], dtype=np.int64)
