"""Simple polygons in the plane: what may be one, and how far points are from its border."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario.arrays import Floats, read_only
from nullpose.scenario.faults import rejection
from nullpose.scenario.rules import ListOf
from nullpose.scenario.units import LatLon, PlanePoint

MOST_CORNERS = 5000
"""Vertices of a polygon, and of all that an airspace has: more take too long to check and to cut."""
_APART_M = 1e-6
"""Vertices and edges closer than this meet [m]."""
_MOST_AT_ONCE = 1_000_000  # coordinates of points times vertices, for the memory that it takes
_BATCH = 64  # edges compared with all others together, likewise


def area_m2(vertices_m: Floats) -> float:
    """Returns the area [m²] inside a closed chain of vertices, positive when they run counter-clockwise.

    The shoelace formula, about the first vertex so that a distant origin costs no digits.

    Args:
        vertices_m: vertices [m], (n, 2).
    """
    x, y = (vertices_m - vertices_m[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def counter_clockwise_m(polygon: Sequence[tuple[float, float]] | None) -> Floats:
    """Returns the vertices of a polygon [m], (n, 2), counter-clockwise and read-only; none without one."""
    vertices_m = np.asarray(polygon or (), dtype=np.float64).reshape(-1, 2)
    clockwise = len(vertices_m) > 0 and area_m2(vertices_m) < 0.0
    return read_only(vertices_m[::-1] if clockwise else vertices_m, (-1, 2))


def depth_m(points_m: Floats, vertices_m: Floats) -> Floats:
    """Returns how deep each point lies in the polygon [m]: its distance from the border, negative outside.

    Args:
        points_m: points [m], (..., 2).
        vertices_m: vertices of a simple polygon [m], (n, 2), in either sense of rotation.

    Returns:
        Array of shape ``(...)``.
    """
    if points_m.size > 2 and points_m.size * len(vertices_m) > _MOST_AT_ONCE:
        parts = np.array_split(points_m.reshape(-1, 2), 2)
        return np.concatenate([depth_m(part, vertices_m) for part in parts]).reshape(points_m.shape[:-1])
    start, end = vertices_m, np.roll(vertices_m, -1, axis=0)
    points = points_m[..., None, :]
    distance = _distance_m(points, start, end).min(axis=-1)
    # Even-odd rule: edges that cross the ray from the point towards +x.
    spans = (start[:, 1] > points[..., 1]) != (end[:, 1] > points[..., 1])
    above, rise = points[..., 1] - start[:, 1], end[:, 1] - start[:, 1]
    share = np.divide(above, rise, out=np.zeros_like(above), where=spans)
    crossing = start[:, 0] + share * (end[:, 0] - start[:, 0])
    inside = np.count_nonzero(spans & (points[..., 0] < crossing), axis=-1) % 2 == 1
    return np.asarray(np.where(inside, distance, -distance))


def _distance_m(points: Floats, start: Floats, end: Floats) -> Floats:
    """Returns the distances from points to segments, broadcast [m]."""
    along = end - start
    length_squared = np.sum(along**2, axis=-1)
    share = np.sum((points - start) * along, axis=-1) / np.where(length_squared > 0.0, length_squared, 1.0)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * along
    return np.asarray(np.linalg.norm(points - nearest, axis=-1))


@lru_cache(maxsize=64)  # a scenario reads its polygons more than once
def _first_meeting(corners: tuple[tuple[float, float], ...]) -> tuple[int, int] | None:
    """Returns the first two edges that have more in common than the vertex between neighbours."""
    vertices = np.asarray(corners)
    count, ends = len(vertices), np.roll(vertices, -1, axis=0)
    for one, other in _near(np.minimum(vertices, ends), np.maximum(vertices, ends)):
        first, second = (vertices[one], ends[one]), (vertices[other], ends[other])
        # Neither lies on one side of the other's line: they meet there, or are on one line and overlap.
        met = ~(_beside(*first, *second) | _beside(*second, *first))
        follows, closes = other == one + 1, other - one == count - 1
        met[follows] = _folds(vertices[one[follows]], ends[one[follows]], ends[other[follows]])
        met[closes] = _folds(vertices[-1:], vertices[:1], vertices[1:2])
        if met.any():
            return int(one[met.argmax()]), int(other[met.argmax()])
    return None


def _near(low: Floats, high: Floats) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Yields the pairs of rectangles that overlap or nearly do, in order, in batches."""
    for first in range(0, len(low), _BATCH):
        some, later = np.s_[first : first + _BATCH, None], np.s_[first:]
        near = (low[some] - _APART_M <= high[later]) & (high[some] >= low[later] - _APART_M)
        one, other = np.nonzero(np.triu(near.all(axis=-1), 1))
        yield one + first, other + first


def _beside(p: Floats, q: Floats, start: Floats, end: Floats) -> NDArray[np.bool_]:
    """Returns which segments lie on one side of the line pq, and not near it."""
    along, near = q - p, _APART_M * np.linalg.norm(q - p, axis=-1)
    offsets = np.stack([start - p, end - p])
    sides = along[..., 0] * offsets[..., 1] - along[..., 1] * offsets[..., 0]
    return np.asarray((sides > near).all(axis=0) | (sides < -near).all(axis=0))


def _folds(before: Floats, corner: Floats, after: Floats) -> NDArray[np.bool_]:
    """Returns at which corners the edge after it runs back along the edge before it."""
    backs = np.minimum(_distance_m(after, before, corner), _distance_m(before, corner, after))
    return np.asarray(backs < _APART_M)


class _Outline(ListOf):
    """The vertices of a simple polygon, as the metadata of an annotated tuple."""

    def judge(self, value: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """Returns the vertices, or raises the fault that keeps them from bounding one area."""
        count, met = len(value), _first_meeting(value)
        if met:
            first, second = met
            raise rejection(
                f"the edge from vertex [{first}] to [{(first + 1) % count}] meets the one from [{second}] to "
                f"[{(second + 1) % count}], so the border crosses or touches itself; list every vertex "
                "once, in order around the area (the last is joined to the first)"
            )
        return value


Polygon = Annotated[
    tuple[PlanePoint, ...],
    _Outline(f"a list of at least three and at most {MOST_CORNERS} vertices [x, y] in m", 3, MOST_CORNERS),
]
"""The vertices [x, y] of a polygon in order, in m; the last is joined to the first."""
EarthlyPolygon = Annotated[
    tuple[LatLon, ...],
    _Outline(
        f"a list of at least three and at most {MOST_CORNERS} vertices [latitude, longitude] in degrees",
        3,
        MOST_CORNERS,
    ),
]
"""The vertices [latitude, longitude] of a polygon in order, in degrees; the last is joined to the first."""
