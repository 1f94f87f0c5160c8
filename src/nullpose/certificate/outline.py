"""Polygons seen from above, in exact arithmetic: what they forbid of a rectangle."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from nullpose.certificate.interval import Interval
from nullpose.certificate.pose_value import Exact, exact
from nullpose.physics.types import FloatArray

Point: TypeAlias = Exact


def may_meet(edges: FloatArray, low: FloatArray, high: FloatArray) -> np.ndarray:
    """Check which edges may meet which rectangles, (b, e): false only where they certainly do not.

    All do that are not of finite numbers.

    Two convex sets are apart if their ranges are, along x, along y or across the edge.

    Args:
        edges: (e, 4) ends (x1, y1, x2, y2).
        low: (b, 2) the rectangles' lower corners.
        high: (b, 2) their upper corners.
    """
    x1, y1, x2, y2 = edges.T
    over_x, over_y = (Interval(low[:, i : i + 1], high[:, i : i + 1]) for i in range(2))
    across = (Interval(x2) - x1) * (over_y - y1) - (Interval(y2) - y1) * (over_x - x1)
    apart = (across.low > 0.0) | (across.high < 0.0)
    for over, first, second in ((over_x, x1, x2), (over_y, y1, y2)):
        apart |= (np.maximum(first, second) < over.low) | (np.minimum(first, second) > over.high)
    return np.asarray(~apart | ~np.all(np.isfinite(low + high), axis=1, keepdims=True))


@dataclass(frozen=True, slots=True)
class Outline:
    """A polygon whose inside is forbidden, or whose outside is.

    Args:
        edges: ends (x1, y1, x2, y2), in order around it, counter-clockwise.
        is_fence: whether it is the outside.
    """

    edges: Exact
    is_fence: bool

    def allowance(self, edge: int, point: Point) -> Fraction:
        """Return a multiple of how far a point is on the allowed side of an edge's line.

        Args:
            edge: which.
            point: the point.
        """
        left = left_of(self.edges[edge], point)
        return left if self.is_fence else -left

    def forbids(self, point: Point) -> bool:
        """Check whether a point that is on no edge is forbidden (even-odd rule).

        Args:
            point: the point.
        """
        inside = False
        for edge in self.edges:
            upwards = edge[3] > point[1]
            if (edge[1] > point[1]) != upwards:
                inside ^= (left_of(edge, point) > 0) == upwards
        return inside != self.is_fence

    def alternatives(self, met: list[int], low: FloatArray, high: FloatArray) -> list[tuple[int, ...]]:
        """Return edges of which an allowed point of a rectangle is on the allowed side.

        Of one of the tuples it is, for all edges in it. An empty tuple says nothing; no tuple at all, that
        the rectangle is forbidden.

        Args:
            met: every edge that may meet the rectangle.
            low: (2,) its lower corner.
            high: (2,) its upper corner.
        """
        if len(met) > 2:
            return [()]
        region = corners(exact(low), exact(high))
        if len(met) == 2 and self._keep_apart(met[0], met[1], region):  # a corner of the allowed set: both
            return [tuple(met)] if all(self._forbids_beyond([edge], region) for edge in met) else [()]
        # a corner of the forbidden set: either; one edge; or none: all or nothing
        return [(edge,) for edge in met] if self._forbids_beyond(met, region) else [()]

    def _keep_apart(self, first: int, second: int, region: list[Point]) -> bool:
        """Check that the part of each edge in a rectangle is on the allowed side of the other's line."""
        return all(
            self.allowance(other, end) >= 0
            for edge, other in ((first, second), (second, first))
            for end in clipped(self.edges[edge], region[0], region[2])
        )

    def _forbids_beyond(self, edges: list[int], region: list[Point]) -> bool:
        """Check that all of a rectangle beyond the lines of edges is forbidden, no other edge being there."""
        for edge in edges:
            region = cut(region, [-self.allowance(edge, point) for point in region])
        # the mean of its vertices is beyond a line if any of them is
        mean = np.sum(region, axis=0) / max(len(region), 1)
        is_empty = not region or any(self.allowance(edge, mean) >= 0 for edge in edges)
        return is_empty or self.forbids(mean)


def left_of(edge: Point, point: Point) -> Fraction:
    """Return a multiple of how far a point is to the left of an edge's line."""
    x1, y1, x2, y2 = edge
    return Fraction((x2 - x1) * (point[1] - y1) - (y2 - y1) * (point[0] - x1))


def corners(low: Point, high: Point) -> list[Point]:
    """Return the corners of a rectangle in order around it, the lower one first."""
    return [low, np.array([high[0], low[1]]), high, np.array([low[0], high[1]])]


def cut(region: list[Point], values: list[Fraction]) -> list[Point]:
    """Return the vertices of a convex polygon's part where a linear function is not negative.

    Args:
        region: the polygon's vertices, in order around it.
        values: the function's at each.
    """
    part: list[Point] = []
    for i, (point, value) in enumerate(zip(region, values, strict=True)):
        before, other = values[i - 1], region[i - 1]
        if before * value < 0:
            share = before / (before - value)
            part.append(other + share * (point - other))
        if value >= 0:
            part.append(point)
    return part


def clipped(edge: Point, low: Point, high: Point) -> list[Point]:
    """Return points of which the part of an edge in a rectangle is the hull, none if they do not meet."""
    part = [edge[:2], edge[2:]]
    for i in range(2):
        part = cut(part, [point[i] - low[i] for point in part])
        part = cut(part, [high[i] - point[i] for point in part])
    return part
