"""No-fly zones and the geofence in boxes of positions: simple constraints that what is allowed there meets.

Worked out from the zones alone: exact for polygons seen from above, outward-rounded for the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.interval import Interval, dot, stack
from nullpose.certificate.outline import Outline, may_meet
from nullpose.certificate.pose_value import exact
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.airspace import FENCE, FORBIDDEN_CYLINDER
from nullpose.problem.records import Domain

_FLAT = np.array([1.0, 1.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A quadratic of the position for each box, ``g(c + x) = value + slopes.x + sum_i bend_i x_i^2``.

    Args:
        value: (b,) at the boxes' centres.
        slopes: (3, b) its gradient there.
        bend: (3, b) not negative.
    """

    value: Interval
    slopes: Interval
    bend: FloatArray

    @classmethod
    def beyond(cls, away: Interval, normal: Interval) -> Constraint:
        """Return ``n.(p - q)``.

        Args:
            away: (3, b) from a point q of the plane to the boxes' centres.
            normal: (3, b) n, of any length.
        """
        return cls(dot(away, normal), normal, np.zeros(normal.low.shape))

    @classmethod
    def outside(cls, away: Interval, radius: FloatArray | float, counted: FloatArray) -> Constraint:
        """Return ``|p - q|^2 - R^2`` over the coordinates that count.

        Args:
            away: (3, b) from q to the boxes' centres, zero along the others.
            radius: (b,) or one R.
            counted: (3,) one for each coordinate that counts, zero for the others.
        """
        value = away.squared().total() - Interval(radius).squared()
        return cls(value, away * 2.0, np.outer(counted, np.ones(value.low.shape)))


Alternative: TypeAlias = tuple[IntArray, tuple[Constraint, ...]]
"""Rows of boxes, and constraints, perhaps none, that all hold at positions which are allowed there."""


def zone_alternatives(domain: Domain, zone: IntArray, boxes: Boxes) -> list[Alternative]:
    """Find alternatives of which each allowed position of a box meets one that names the box: lemma 4.

    A box that none of them names is forbidden as a whole. Borders are allowed.

    Args:
        domain: with its zones.
        zone: (b,) the zone that is looked at in each box.
        boxes: b of them.
    """
    hull, rows = boxes.hull, np.arange(len(boxes))
    floor, ceiling = domain.zone_range_m[zone].T
    found: list[Alternative] = []
    for mask, height, upwards in (
        (hull.high[2] >= ceiling, ceiling, 1.0),
        (hull.low[2] <= floor, floor, -1.0),
    ):
        corner = np.outer(height[mask], [0.0, 0.0, 1.0])
        up = Interval(np.tile([[0.0], [0.0], [upwards]], len(corner)))
        away = (Interval(boxes.centre[mask]) - corner).T
        found.append((rows[mask], (Constraint.beyond(away, up),)))
    is_cylinder = domain.zone_kind[zone] == FORBIDDEN_CYLINDER
    found.append(_outside_cylinder(domain, zone, boxes, rows[is_cylinder]))
    beyond = [
        (row, *edges)
        for z in np.unique(zone[~is_cylinder])
        for row, *edges in _beyond_edges(domain, int(z), rows[zone == z], boxes.chosen(zone == z))
    ]
    for count in range(3):
        table = np.array([choice for choice in beyond if len(choice) == 1 + count], dtype=np.int64).reshape(
            -1, 1 + count
        )
        row, *edges = table.T
        sign = np.where(domain.zone_kind[zone[row]] == FENCE, -1.0, 1.0)
        bounds = (_right_of(boxes.chosen(row), domain.zone_edges[edge], sign) for edge in edges)
        found.append((row, tuple(bounds)))
    return [(row, bounds) for row, bounds in found if len(row)]


def forbidden(domain: Domain, zone: IntArray, boxes: Boxes) -> np.ndarray:
    """Check which boxes a zone forbids as a whole.

    Args:
        domain: with its zones.
        zone: (b,) the zone that is looked at in each box.
        boxes: b of them.
    """
    holds = np.ones(len(boxes), dtype=bool)
    for rows, _ in zone_alternatives(domain, zone, boxes):
        holds[rows] = False
    return holds


def _beyond_edges(domain: Domain, zone: int, rows: IntArray, boxes: Boxes) -> Iterator[tuple[int, ...]]:
    """Yield a box's row and the edges, by their index in the domain, of an alternative."""
    first, last = domain.zone_start[zone], domain.zone_start[zone + 1]
    edges = domain.zone_edges[first:last]
    outline = Outline(exact(edges), bool(domain.zone_kind[zone] == FENCE))
    low, high = boxes.hull.low[:2].T, boxes.hull.high[:2].T
    for row, meets, south_west, north_east in zip(rows, may_meet(edges, low, high), low, high, strict=True):
        alternatives = outline.alternatives(np.flatnonzero(meets).tolist(), south_west, north_east)
        yield from ((int(row), *(int(first) + e for e in chosen)) for chosen in alternatives)


def _right_of(boxes: Boxes, edges: FloatArray, sign: FloatArray) -> Constraint:
    """Measure how far a position is to the right of an edge, or with the other sign to its left."""
    x1, y1, x2, y2 = edges.T
    zero = np.zeros(len(boxes))
    normal = stack([(Interval(y2) - y1) * sign, (Interval(x1) - x2) * sign, Interval(zero)])
    return Constraint.beyond(Interval(boxes.centre.T) - np.stack([x1, y1, zero]), normal)


def _outside_cylinder(domain: Domain, zone: IntArray, boxes: Boxes, rows: IntArray) -> Alternative:
    """Return ``|p_xy - c|^2 - r^2`` for boxes that are not inside as a whole."""
    circle = domain.zone_edges[domain.zone_start[zone[rows]]]
    reach = Interval((boxes.chosen(rows).hull[:2] - circle[:, :2].T).magnitude())
    out = ~(reach.squared().total().high < Interval(circle[:, 2]).squared().low)
    rows, circle = rows[out], circle[out]
    away = (Interval(boxes.centre[rows] * _FLAT) - circle[:, :3] * _FLAT).T
    return rows, (Constraint.outside(away, circle[:, 2], _FLAT),)
