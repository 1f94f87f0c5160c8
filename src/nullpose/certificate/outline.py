"""Polygons seen from above, in exact arithmetic: what they forbid of a rectangle."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from nullpose.certificate.certificate import FloatArray
from nullpose.certificate.interval import Interval

__all__ = ["Outline", "Rectangle", "may_meet"]

Point: TypeAlias = tuple[Fraction, Fraction]
Rectangle: TypeAlias = tuple[Point, Point]


def may_meet(edges: FloatArray, low: FloatArray, high: FloatArray) -> np.ndarray:
    """Return which edges may meet which rectangles, (b, e): false only where they certainly do not.

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
    return np.asarray(~apart)


@dataclass(frozen=True, slots=True)
class Outline:
    """A polygon whose inside is forbidden, or whose outside is.

    Args:
        edges: ends (x1, y1, x2, y2), in order around it, counter-clockwise.
        is_fence: whether it is the outside.
    """

    edges: tuple[tuple[Fraction, Fraction, Fraction, Fraction], ...]
    is_fence: bool

    @classmethod
    def of(cls, edges: FloatArray, is_fence: bool) -> Outline:
        """Return the outline of edges in floating point.

        Args:
            edges: (e, 4).
            is_fence: whether the outside is forbidden.
        """
        exact = (
            (Fraction(float(a)), Fraction(float(b)), Fraction(float(c)), Fraction(float(d)))
            for a, b, c, d in edges
        )
        return cls(tuple(exact), is_fence)

    def allowance(self, edge: int, point: Point) -> Fraction:
        """Return a multiple of how far a point is on the allowed side of an edge's line.

        Args:
            edge: which.
            point: the point.
        """
        x1, y1, x2, y2 = self.edges[edge]
        left = (x2 - x1) * (point[1] - y1) - (y2 - y1) * (point[0] - x1)
        return left if self.is_fence else -left

    def forbids(self, point: Point) -> bool:
        """Return whether a point that is on no edge is forbidden (even-odd rule).

        Args:
            point: the point.
        """
        x, y = point
        inside = False
        for x1, y1, x2, y2 in self.edges:
            if (y1 > y) != (y2 > y):
                left = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
                inside ^= (left > 0) == (y2 > y1)
        return inside != self.is_fence

    def alternatives(self, met: list[int], rectangle: Rectangle) -> list[tuple[int, ...]]:
        """Return edges of which an allowed point of a rectangle is on the allowed side.

        Of one of the tuples it is, for all edges in it. An empty tuple says nothing; no tuple at all, that
        the rectangle is forbidden.

        Args:
            met: every edge that may meet the rectangle.
            rectangle: lower and upper corner.
        """
        if not met:
            return [] if self.forbids(rectangle[0]) else [()]
        if len(met) == 1 and self._forbids_beyond(met[0], rectangle):
            return [(met[0],)]
        if len(met) == 2:
            one, two = met
            if self._keeps_to(one, two, rectangle) and self._keeps_to(two, one, rectangle):
                if self._forbids_beyond(one, rectangle) and self._forbids_beyond(two, rectangle):
                    return [(one, two)]
            elif self._forbids_beyond_both(one, two, rectangle):
                return [(one,), (two,)]
        return [()]

    def _forbids_beyond(self, edge: int, rectangle: Rectangle) -> bool:
        """Return whether all of a rectangle beyond an edge's line is forbidden, no other edge being there."""
        worst = min(corners(rectangle), key=lambda corner: self.allowance(edge, corner))
        return self.allowance(edge, worst) >= 0 or self.forbids(worst)

    def _keeps_to(self, one: int, two: int, rectangle: Rectangle) -> bool:
        """Return whether the part of an edge in a rectangle is on the allowed side of another's line."""
        x1, y1, x2, y2 = self.edges[one]
        if self.allowance(two, (x1, y1)) >= 0 and self.allowance(two, (x2, y2)) >= 0:
            return True
        return all(self.allowance(two, end) >= 0 for end in clipped(self.edges[one], rectangle))

    def _forbids_beyond_both(self, one: int, two: int, rectangle: Rectangle) -> bool:
        """Return whether all of a rectangle beyond the lines of the two edges that meet it is forbidden."""
        region = corners(rectangle)
        for edge in (one, two):
            region = self._beyond(edge, region)
        if not region:
            return True
        # the mean of its vertices is beyond a line if any of them is
        mean = (_mean([x for x, _ in region]), _mean([y for _, y in region]))
        if self.allowance(one, mean) >= 0 or self.allowance(two, mean) >= 0:
            return True
        return self.forbids(mean)

    def _beyond(self, edge: int, region: list[Point]) -> list[Point]:
        """Return the vertices of a convex polygon's part beyond an edge's line, or on it."""
        part: list[Point] = []
        values = [self.allowance(edge, point) for point in region]
        for i, (point, value) in enumerate(zip(region, values, strict=True)):
            before, other = values[i - 1], region[i - 1]
            if (before < 0 < value) or (value < 0 < before):
                share = before / (before - value)
                (x1, y1), (x2, y2) = other, point
                part.append((x1 + share * (x2 - x1), y1 + share * (y2 - y1)))
            if value <= 0:
                part.append(point)
        return part


def _mean(numbers: list[Fraction]) -> Fraction:
    return sum(numbers, Fraction(0)) / len(numbers)


def corners(rectangle: Rectangle) -> list[Point]:
    """Return the corners of a rectangle in order around it.

    Args:
        rectangle: lower and upper corner.
    """
    (west, south), (east, north) = rectangle
    return [(west, south), (east, south), (east, north), (west, north)]


def clipped(edge: tuple[Fraction, Fraction, Fraction, Fraction], rectangle: Rectangle) -> list[Point]:
    """Return the ends of the part of an edge in a rectangle, none if they do not meet.

    Args:
        edge: its ends.
        rectangle: lower and upper corner.
    """
    first, last = Fraction(0), Fraction(1)
    for i in range(2):
        start, way = edge[i], edge[2 + i] - edge[i]
        low, high = rectangle[0][i] - start, rectangle[1][i] - start
        if way == 0:
            if low > 0 or high < 0:
                return []
            continue
        a, b = sorted((low / way, high / way))
        first, last = max(first, a), min(last, b)
    if first > last:
        return []
    x1, y1, x2, y2 = edge
    return [(x1 + share * (x2 - x1), y1 + share * (y2 - y1)) for share in (first, last)]
