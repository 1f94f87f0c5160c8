"""What a box may use of the airspace's borders: multipliers of staying out of a ball or a zone.

A constraint ``g(p) >= 0`` that holds at every allowed position of a box, or, of several alternatives, each
in its turn, may be added with any multiplier ``nu >= 0`` to what must be negative there.
"""

from __future__ import annotations

import numpy as np

from nullpose.solver.kernels.jit import inner_kernel
from nullpose.solver.kernels.node import BALL, CENTRE, HALF, NU, reaching_ball
from nullpose.solver.kernels.scratch import scratch, scratch_int, zeroed
from nullpose.solver.kernels.zones import (
    FORBIDDEN,
    MOST_ALTERNATIVES,
    OUTSIDE,
    UNCLEAR,
    in_zone,
    zone_alternatives,
)


@inner_kernel
def choose_border(domain, row):
    """Fill the row's ball or zone: the one to be used in its box, or -1; return a zone that forbids it all.

    Zones are numbered after the balls. Without such a zone, -1 is returned.
    """
    keep_points, keep_radius = domain.keep_out_points_m, domain.keep_out_m
    balls, zones = keep_points.shape[0], domain.zone_kind.shape[0]
    row[BALL], row[NU] = reaching_ball(keep_points, keep_radius, row), 0.0
    if zones == 0:
        return -1
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    chosen, inside = -1, False
    for z in range(zones):
        count = zone_alternatives(domain, z, row, sides, counts)
        if count == FORBIDDEN:
            return balls + z
        if count != OUTSIDE and count != UNCLEAR and not inside:
            inside = in_zone(domain, z, row[CENTRE:HALF])
            chosen = z
    if chosen >= 0 and (inside or row[BALL] < 0.0):
        row[BALL] = balls + chosen
    return -1


@inner_kernel
def borders(domain, row, sides, counts):
    """Fill the alternatives of the row's ball or zone; return how many there are, 0 for none."""
    border = int(row[BALL])
    balls = domain.keep_out_points_m.shape[0]
    if border < 0:
        return 0
    if border < balls:
        counts[0] = 1
        sides[0, 0, 0] = 2.0
        for i in range(3):
            sides[0, 0, 1 + i] = domain.keep_out_points_m[border, i]
        sides[0, 0, 4] = domain.keep_out_m
        return 1
    return max(np.int64(0), zone_alternatives(domain, border - balls, row, sides, counts))


@inner_kernel
def slope_and_rest(side, row, slope):
    """Fill a constraint's gradient at the box's centre; return its value there and how curved it is.

    The second number is the second derivative along each of the first so many axes: 2 for a ball or a
    cylinder, 0 for a plane; the third is that number of axes.
    """
    centre = row[CENTRE:HALF]
    if side[0] == 0.0:
        value, size = -side[4], abs(side[4])
        for i in range(3):
            slope[i] = side[1 + i]
            value += side[1 + i] * centre[i]
            size += abs(side[1 + i] * centre[i])
        return value + 1e-14 * size, 0.0, np.int64(3)  # a hair on the safe side of its rounding
    axes = np.int64(2) if side[0] == 1.0 else np.int64(3)
    value = -(side[4] ** 2) * (1.0 - 1e-12)  # likewise
    slope[2] = 0.0
    for i in range(axes):
        n = centre[i] - side[1 + i]
        slope[i] = 2.0 * n
        value += n * n
    return value, 2.0, axes


@inner_kernel
def border_multipliers(slopes, count, gradient, nu):
    """Fill the multipliers of one or two constraints that cancel a gradient best; tell whether there are."""
    nu[0] = nu[1] = 0.0
    gram, pull = zeroed(2), zeroed(2)
    cross = 0.0
    for c in range(count):
        for i in range(3):
            gram[c] += slopes[c, i] ** 2
            pull[c] -= slopes[c, i] * gradient[i]
            if count == 2 and c == 0:
                cross += slopes[0, i] * slopes[1, i]
        if not gram[c] > 0.0:
            return False
    if count == 2:
        det = gram[0] * gram[1] - cross * cross
        if det > 1e-12 * gram[0] * gram[1]:
            nu[0] = (pull[0] * gram[1] - pull[1] * cross) / det
            nu[1] = (pull[1] * gram[0] - pull[0] * cross) / det
        if nu[0] > 0.0 and nu[1] > 0.0:
            return True
        nu[0], nu[1] = max(0.0, pull[0] / gram[0]), max(0.0, pull[1] / gram[1])
        lead = 0 if nu[0] * pull[0] >= nu[1] * pull[1] else 1
        nu[1 - lead] = 0.0
        return nu[lead] > 0.0
    nu[0] = max(0.0, pull[0] / gram[0])
    return nu[0] > 0.0
