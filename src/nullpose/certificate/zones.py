"""No-fly zones and the geofence in boxes of positions: functions that are not negative where it is allowed.

Worked out from the zones alone: exact for polygons seen from above, outward-rounded for the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.interval import Interval
from nullpose.certificate.outline import Outline, may_meet
from nullpose.certificate.pose_value import exact
from nullpose.certificate.taylor import Taylor
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.airspace import FENCE, FORBIDDEN_CYLINDER
from nullpose.problem.records import Domain

Alternative: TypeAlias = tuple[IntArray, tuple[Taylor, ...]]
"""Rows of boxes, and functions of the position, perhaps none: none is negative where it is allowed there."""


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
    # an undefined height may be anywhere: it leaves out no alternative
    ends = (~(hull.high[2] < ceiling), ceiling, 1.0), (~(hull.low[2] > floor), floor, -1.0)
    found: list[Alternative] = [
        (rows[mask], ((boxes.chosen(mask).position[2] - height[mask]) * upwards,))
        for mask, height, upwards in ends
    ]
    is_cylinder = domain.zone_kind[zone] == FORBIDDEN_CYLINDER
    found.append(_outside_cylinder(domain, zone, boxes, rows[is_cylinder]))
    choices = [
        (row, *edges)
        for z in np.unique(zone[~is_cylinder])
        for row, *edges in _beyond_edges(domain, int(z), rows[zone == z], boxes.chosen(zone == z))
    ]
    for count in range(3):
        table = np.array([choice for choice in choices if len(choice) == 1 + count], dtype=np.int64).reshape(
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


def _right_of(boxes: Boxes, edges: FloatArray, sign: FloatArray) -> Taylor:
    """Measure how far a position is to the right of an edge, or with the other sign to its left."""
    x1, y1, x2, y2 = (Interval(end) for end in edges.T)
    x, y = boxes.position[0] - x1, boxes.position[1] - y1
    return (x * (y2 - y1) - y * (x2 - x1)) * sign


def _outside_cylinder(domain: Domain, zone: IntArray, boxes: Boxes, rows: IntArray) -> Alternative:
    """Return ``|p_xy - c|^2 - r^2`` for boxes that are not inside as a whole."""
    circle = domain.zone_edges[domain.zone_start[zone[rows]]].T
    reach2 = (boxes.chosen(rows).hull[:2] - circle[:2]).squared().total()
    out = ~(reach2.high < Interval(circle[2]).squared().low)
    rows, circle = rows[out], circle[:, out]
    return rows, (beyond(boxes.chosen(rows).position[:2], circle[:2], circle[2]),)


def beyond(position: Taylor, centre: FloatArray, radius: FloatArray | float) -> Taylor:
    """Measure ``|p - c|^2 - R^2``, over the coordinates that count."""
    return (position - centre).squared().total() - Interval(radius).squared()
