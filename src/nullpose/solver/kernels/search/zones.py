"""No-fly zones and geofences in a box of positions: which simple constraints they amount to there.

Every position of the box that a zone allows meets one of a few alternatives, each of one or two constraints
``g(p) >= 0``: beyond an edge, outside a cylinder, above or below. A box that holds more than two edges of a
polygon has none, and is split. Constraints are rows (0, a, b) for ``a.p - b`` with a of unit length, and
(1, x, y, 0, r) for ``|p_xy - c|^2 - r^2``.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import square_range

OUTSIDE = -1  # the zone does not reach into the box
UNCLEAR = -2  # it does, in a way that is not simple
FORBIDDEN = 0  # the whole box is forbidden
MOST_ALTERNATIVES = 4

_FENCE = 2
_CYLINDER = 1
_ROUNDING = 1e-9  # relative: what an edge may miss a box by and still count as meeting it


@kernel
def in_polygon(edges, first, last, x, y):
    """Check whether a point lies inside a closed chain of edges (even-odd rule)."""
    inside = False
    for e in range(first, last):
        x1, y1, x2, y2 = edges[e]
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            inside = not inside
    return inside


@kernel
def in_zone(domain, z, p):
    """Check whether a zone forbids a position."""
    first, last, edges = domain.zone_start[z], domain.zone_start[z + 1], domain.zone_edges
    low, high = domain.zone_range_m[z]
    if not low < p[2] < high:
        return False
    if domain.zone_kind[z] == _CYLINDER:
        return (p[0] - edges[first, 0]) ** 2 + (p[1] - edges[first, 1]) ** 2 < edges[first, 2] ** 2
    return in_polygon(edges, first, last, p[0], p[1]) != (domain.zone_kind[z] == _FENCE)


@inner_kernel
def meets(edge, centre, half):
    """Check whether a segment meets the rectangle of a box, or comes within a hair of it."""
    x, y, hx, hy = centre[0], centre[1], half[0], half[1]
    x1, y1, x2, y2 = edge[0] - x, edge[1] - y, edge[2] - x, edge[3] - y
    slack = _ROUNDING * (1.0 + abs(x) + abs(y) + hx + hy)
    if min(x1, x2) > hx + slack or max(x1, x2) < -hx - slack:
        return False
    if min(y1, y2) > hy + slack or max(y1, y2) < -hy - slack:
        return False
    nx, ny = y2 - y1, x1 - x2
    length = math.hypot(nx, ny)
    return abs(nx * x1 + ny * y1) <= length * slack + abs(nx) * hx + abs(ny) * hy


@inner_kernel
def middle_inside(edge, centre, half):
    """Return the middle of the part of a segment that lies in the rectangle of a box."""
    low, high = 0.0, 1.0
    for i in range(2):
        start, change = edge[i] - centre[i], edge[2 + i] - edge[i]
        if change != 0.0:
            a, b = (-half[i] - start) / change, (half[i] - start) / change
            low, high = max(low, min(a, b)), min(high, max(a, b))
    share = 0.5 * (low + high)
    return edge[0] + share * (edge[2] - edge[0]), edge[1] + share * (edge[3] - edge[1])


@inner_kernel
def fill_side(edge, allowed_right, out):
    """Fill the constraint of being on one side of an edge, its right or its left."""
    nx, ny = edge[3] - edge[1], edge[0] - edge[2]
    length = math.hypot(nx, ny) if allowed_right else -math.hypot(nx, ny)
    out[0], out[1], out[2], out[3] = 0.0, nx / length, ny / length, 0.0
    out[4] = out[1] * edge[0] + out[2] * edge[1]


@inner_kernel
def polygon_alternatives(domain, z, centre, half, sides, counts):
    """Fill the alternatives of a polygon seen from above; return how many, or one of the words."""
    first, last, edges = domain.zone_start[z], domain.zone_start[z + 1], domain.zone_edges
    fence = domain.zone_kind[z] == _FENCE
    met = 0
    earlier = later = first
    for e in range(first, last):
        if meets(edges[e], centre, half):
            met += 1
            if met > 2:
                return UNCLEAR
            earlier, later = later if met == 2 else e, e
    if met == 0:
        inside = in_polygon(edges, first, last, centre[0], centre[1])
        return OUTSIDE if inside == fence else FORBIDDEN
    fill_side(edges[earlier], not fence, sides[0, 0])
    counts[0] = 1
    if met == 1:
        return 1
    fill_side(edges[later], not fence, sides[0, 1])
    x, y = middle_inside(edges[later], centre, half)
    beyond_first = sides[0, 0, 1] * x + sides[0, 0, 2] * y - sides[0, 0, 4]
    x, y = middle_inside(edges[earlier], centre, half)
    beyond_second = sides[0, 1, 1] * x + sides[0, 1, 2] * y - sides[0, 1, 4]
    if beyond_first > 0.0 and beyond_second > 0.0:  # each edge on the other's allowed side: both hold
        counts[0] = 2
        return 1
    if beyond_first < 0.0 and beyond_second < 0.0:
        copy_into(sides[0, 1], sides[1, 0])
        counts[1] = 1
        return 2
    return UNCLEAR


@inner_kernel
def zone_alternatives(domain, z, centre, half, sides, counts):
    """Fill the alternatives of a zone in a box; return how many, or one of the words.

    Args:
        domain: with the zones.
        z: which of them.
        centre: of the box.
        half: its half sides.
        sides: output, (MOST_ALTERNATIVES, 2, 5): constraints.
        counts: output, (MOST_ALTERNATIVES,): how many each alternative has.
    """
    low, high = domain.zone_range_m[z]
    bottom, top = centre[2] - half[2], centre[2] + half[2]
    if bottom >= high or top <= low:
        return OUTSIDE
    if domain.zone_kind[z] == _CYLINDER:
        cylinder = domain.zone_edges[domain.zone_start[z]]
        near, far = square_range(cylinder, centre, half, 2)
        if near >= cylinder[2] ** 2:
            return OUTSIDE
        count = np.int64(0)
        if not far < cylinder[2] ** 2 * (1.0 - 1e-12):
            sides[0, 0, 0], sides[0, 0, 1], sides[0, 0, 2] = 1.0, cylinder[0], cylinder[1]
            sides[0, 0, 3], sides[0, 0, 4] = 0.0, cylinder[2]
            counts[0], count = 1, np.int64(1)
    else:
        count = polygon_alternatives(domain, z, centre, half, sides, counts)
        if count < 0:
            return count
    slack = _ROUNDING * (1.0 + abs(bottom) + abs(top))
    for end in range(2):
        if top > high - slack if end == 1 else bottom < low + slack:
            sides[count, 0, :] = 0.0
            sides[count, 0, 3] = 1.0 if end == 1 else -1.0
            sides[count, 0, 4] = high if end == 1 else -low
            counts[count] = 1
            count += 1
    return count
