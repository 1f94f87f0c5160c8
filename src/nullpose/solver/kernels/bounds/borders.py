"""What a box may use of the airspace's borders: multipliers of staying out of a ball or a zone.

A constraint ``g(p) >= 0`` that holds at every allowed position of a box, or, of several alternatives, each
in its turn, may be added with any multiplier ``nu >= 0`` to what must be negative there.
"""

from __future__ import annotations

import numpy as np

from nullpose.solver.kernels.bounds.node import BALL, CENTRE, HALF, LEVEL
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int, zeroed
from nullpose.solver.kernels.linear_algebra.vectors import square_range
from nullpose.solver.kernels.search.zones import MOST_ALTERNATIVES, in_zone, zone_alternatives


@inner_kernel
def choose_border(domain, row):
    """Fill the ball or zone to be used in a row's box, or -1; zones are numbered on from the balls."""
    balls, zones = domain.keep_out_points_m.shape[0], domain.zone_kind.shape[0]
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    row[BALL], least = -1.0, domain.keep_out_m * domain.keep_out_m
    for q in range(balls):
        near, _ = square_range(domain.keep_out_points_m[q], centre, half, 3)
        if near < least:
            row[BALL], least = q, near
    if zones == 0:
        return
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    chosen, inside = -1, False
    for z in range(zones):
        if not inside and zone_alternatives(domain, z, centre, half, sides, counts) > 0:
            chosen, inside = z, in_zone(domain, z, centre)
    if chosen >= 0 and (inside or row[BALL] < 0.0):
        row[BALL] = balls + chosen


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
    count = zone_alternatives(domain, border - balls, row[CENTRE:HALF], row[HALF:LEVEL], sides, counts)
    return max(np.int64(0), count)


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


@inner_kernel
def weigh_borders(sides, count, row, gradient, total):
    """Fill the sum of constraints that cancels a gradient best, (7,): value, slopes and second derivatives.

    Return the first one's multiplier; -1 if none helps.
    """
    nu, slopes, values, bends, axes = scratch(2), scratch(2, 3), scratch(2), scratch(2), scratch_int(2)
    for c in range(count):
        values[c], bends[c], axes[c] = slope_and_rest(sides[c], row, slopes[c])
    if not border_multipliers(slopes, count, gradient, nu):
        return -1.0
    total[:] = 0.0
    for c in range(count):
        total[0] += nu[c] * values[c]
        for i in range(3):
            total[1 + i] += nu[c] * slopes[c, i]
            total[4 + i] += nu[c] * bends[c] if i < axes[c] else 0.0
    return nu[0]
