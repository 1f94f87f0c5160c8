"""No-fly zones and the geofence in boxes of positions: simple constraints that what is allowed there meets.

Worked out from the zones alone: exact for polygons seen from above, outward-rounded for the rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray
from nullpose.certificate.constraint import Constraint
from nullpose.certificate.interval import Interval, dot, stack
from nullpose.certificate.outline import Outline, may_meet
from nullpose.family import Family

__all__ = ["Alternative", "forbidden", "zone_alternatives"]

_CYLINDER, _FENCE = 1, 2


@dataclass(frozen=True, slots=True, eq=False)
class Alternative:
    """One way for positions of some boxes to be allowed: constraints that all hold.

    Args:
        rows: (n,) which boxes.
        constraints: on their positions; none if anything in them may be allowed.
    """

    rows: IntArray
    constraints: tuple[Constraint, ...]


def zone_alternatives(family: Family, zone: IntArray, boxes: Boxes) -> list[Alternative]:
    """Return alternatives of which each allowed position of a box meets one that names the box.

    A box that none of them names is forbidden as a whole. Borders are allowed.

    Args:
        family: with its zones.
        zone: (b,) the zone that is looked at in each box.
        boxes: b of them.
    """
    low, high = boxes.corners
    bottom, top = low.low, high.high
    rows = np.arange(len(boxes))
    above, below = top[:, 2] >= family.zone_range_m[zone, 1], bottom[:, 2] <= family.zone_range_m[zone, 0]
    found = [
        Alternative(rows[above], (_height(boxes.chosen(above), family.zone_range_m[zone[above], 1], 1.0),)),
        Alternative(rows[below], (_height(boxes.chosen(below), family.zone_range_m[zone[below], 0], -1.0),)),
    ]
    is_cylinder = family.zone_kind[zone] == _CYLINDER
    if np.any(is_cylinder):
        found.append(_outside_cylinder(family, zone, boxes, rows[is_cylinder]))
    sides: dict[int, list[tuple[int, ...]]] = {0: [], 1: [], 2: []}  # box and edges, by how many edges
    for z in np.unique(zone[~is_cylinder]):
        here = rows[zone == z]
        for row, edges in _beyond_edges(family, int(z), here, bottom[here, :2], top[here, :2]):
            sides[len(edges)].append((row, *edges))
    for count, chosen in sides.items():
        table = np.array(chosen, dtype=np.int64).reshape(-1, 1 + count)
        some = boxes.chosen(table[:, 0])
        sign = np.where(family.zone_kind[zone[table[:, 0]]] == _FENCE, -1.0, 1.0)
        bounds = tuple(_right_of(some, family.zone_edges[table[:, 1 + c]], sign) for c in range(count))
        found.append(Alternative(table[:, 0], bounds))
    return [one for one in found if len(one.rows)]


def forbidden(family: Family, zone: IntArray, boxes: Boxes) -> np.ndarray:
    """Return which boxes a zone forbids as a whole.

    Args:
        family: with its zones.
        zone: (b,) the zone that is looked at in each box.
        boxes: b of them.
    """
    holds = np.ones(len(boxes), dtype=bool)
    for one in zone_alternatives(family, zone, boxes):
        holds[one.rows] = False
    return holds


def _beyond_edges(
    family: Family, zone: int, rows: IntArray, low: FloatArray, high: FloatArray
) -> list[tuple[int, tuple[int, ...]]]:
    """Return pairs of a box and the edges, by their index in the family, of an alternative."""
    first, last = family.zone_start[zone], family.zone_start[zone + 1]
    edges = family.zone_edges[first:last]
    outline = Outline.of(edges, bool(family.zone_kind[zone] == _FENCE))
    found: list[tuple[int, tuple[int, ...]]] = []
    for row, meets, south_west, north_east in zip(rows, may_meet(edges, low, high), low, high, strict=True):
        rectangle = _exact(south_west), _exact(north_east)
        chosen = outline.alternatives([int(e) for e in np.flatnonzero(meets)], rectangle)
        found += [(int(row), tuple(int(first) + e for e in each)) for each in chosen]
    return found


def _exact(point: FloatArray) -> tuple[Fraction, Fraction]:
    return Fraction(float(point[0])), Fraction(float(point[1]))


def _height(boxes: Boxes, end: FloatArray, sign: float) -> Constraint:
    """Return ``sign (z - end)``."""
    up = np.zeros((len(boxes), 3))
    up[:, 2] = sign
    return Constraint((Interval(boxes.centre[:, 2]) - end) * sign, Interval(up), np.zeros((len(boxes), 3)))


def _right_of(boxes: Boxes, edges: FloatArray, sign: FloatArray) -> Constraint:
    """Return how far a position is to the right of an edge, or with the other sign to its left; any scale."""
    x1, y1, x2, y2 = edges.T
    normal = [(Interval(y2) - y1) * sign, (Interval(x1) - x2) * sign]
    value = (Interval(boxes.centre[:, 0]) - x1) * normal[0] + (Interval(boxes.centre[:, 1]) - y1) * normal[1]
    zero = np.zeros(len(boxes))
    return Constraint(value, stack([*normal, Interval(zero)]), np.zeros((len(boxes), 3)))


def _outside_cylinder(family: Family, zone: IntArray, boxes: Boxes, rows: IntArray) -> Alternative:
    """Return ``|p_xy - c|^2 - r^2`` for boxes that are not inside as a whole."""
    circle = family.zone_edges[family.zone_start[zone[rows]]]
    low, high = boxes.chosen(rows).corners
    reach = [
        Interval((Interval(low.low[:, i], high.high[:, i]) - circle[:, i]).magnitude()) for i in range(2)
    ]
    farthest2 = (reach[0].squared() + reach[1].squared()).high
    out = ~(farthest2 < Interval(circle[:, 2]).squared().low)
    circle, some = circle[out], boxes.chosen(rows[out])
    away = Interval(some.centre[:, :2]) - circle[:, :2]
    value = dot(away, away) - Interval(circle[:, 2]).squared()
    zero = Interval(np.zeros(len(some)))
    slopes = stack([away[:, 0] * 2.0, away[:, 1] * 2.0, zero])
    return Alternative(rows[out], (Constraint(value, slopes, np.tile([1.0, 1.0, 0.0], (len(some), 1))),))
