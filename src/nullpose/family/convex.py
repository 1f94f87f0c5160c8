"""Simple polygons cut into convex parts."""

from __future__ import annotations

import numpy as np

from nullpose.family.ratios import FloatArray

__all__ = ["convex_parts", "hull_and_pockets"]


def convex_parts(outline_m: FloatArray) -> list[FloatArray]:
    """Return convex polygons that together are a simple polygon: itself, if it is convex, or triangles.

    Triangles by ear clipping: the widest of the ears is cut first, so that slivers are rare.

    Args:
        outline_m: vertices, (n, 2), counter-clockwise, metres.
    """
    if np.all(_turns(outline_m) >= 0.0):
        return [outline_m]
    left = list(range(len(outline_m)))
    parts: list[FloatArray] = []
    while len(left) > 3:
        ears = [i for i in range(len(left)) if _is_ear(outline_m, left, i)]
        if not ears:  # only where vertices coincide to rounding: what is left has no area
            break
        best = max(ears, key=lambda i: _smallest_angle(outline_m[_corner(left, i)]))
        parts.append(outline_m[_corner(left, best)])
        left.pop(best)
    return [*parts, outline_m[left]] if len(left) == 3 else parts


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


def _corner(left: list[int], i: int) -> list[int]:
    return [left[i - 1], left[i], left[(i + 1) % len(left)]]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _turns(outline_m: FloatArray) -> FloatArray:
    before = outline_m - np.roll(outline_m, 1, axis=0)
    return _cross(before, np.roll(before, -1, axis=0))


def _is_ear(outline_m: FloatArray, left: list[int], i: int) -> bool:
    corner = _corner(left, i)
    a, b, c = outline_m[corner]
    if not _cross(b - a, c - b) > 0.0:
        return False
    others = outline_m[[k for k in left if k not in corner]]
    sides = [_cross(end - start, others - start) for start, end in ((a, b), (b, c), (c, a))]
    return not np.any(np.min(sides, axis=0) >= 0.0)


def _smallest_angle(corner_m: FloatArray) -> float:
    ways = np.roll(corner_m, -1, axis=0) - corner_m
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    return float(np.min(_cross(ways, np.roll(ways, -1, axis=0))))


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
