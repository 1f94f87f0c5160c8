"""The domain of positions: what is in it, what forbids a box of them, and how far it is to its walls."""

from __future__ import annotations

import numpy as np

from nullpose.solver.kernels.jit import heap_kernel, inner_kernel, kernel
from nullpose.solver.kernels.local_coordinates import choose_sides, side_slack
from nullpose.solver.kernels.scratch import scratch, scratch_int
from nullpose.solver.kernels.symmetric import squared_distance
from nullpose.solver.kernels.vectors import minus, norm, over, square_range, store
from nullpose.solver.kernels.zones import FORBIDDEN, MOST_ALTERNATIVES, in_zone, zone_alternatives

_CENTRE_M = 1e-9  # a position this near to the centre of a ball or a cylinder has a way out all the same


@kernel
def contains(domain, p):
    """Check whether a position is in the box, outside of every keep-out ball and in no zone."""
    for i in range(3):
        if not domain.low_m[i] <= p[i] <= domain.high_m[i]:
            return False
    for point in domain.keep_out_points_m:
        if not squared_distance(point, p) >= domain.keep_out_m * domain.keep_out_m:
            return False
    for z in range(domain.zone_kind.shape[0]):  # noqa: SIM110  kernels have no generators
        if in_zone(domain, z, p):
            return False
    return True


@inner_kernel
def forbidding(domain, centre, half):
    """Find the ball, or the zone, numbered on from the balls, that holds all of a box; -1 if none does."""
    balls = domain.keep_out_points_m.shape[0]
    for q in range(balls):
        _, most = square_range(domain.keep_out_points_m[q], centre, half, 3)
        if most < domain.keep_out_m * domain.keep_out_m:
            return q
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    for z in range(domain.zone_kind.shape[0]):
        if zone_alternatives(domain, z, centre, half, sides, counts) == FORBIDDEN:
            return balls + z
    return -1


@heap_kernel
def walls(domain, x):
    """Measure how far a position is outside each keep-out ball and forbidden piece.

    Distances, (w,) metres, negative inside; and their slopes, (w, 3), unit vectors.
    """
    balls, pieces = len(domain.keep_out_points_m), len(domain.piece_start) - 1
    distances, ways = np.empty(balls + pieces), np.empty((balls + pieces, 3))
    chosen = np.empty(pieces, np.int64)
    choose_sides(domain, x, chosen)
    for w in range(balls + pieces):
        side = domain.piece_sides[chosen[w - balls]] if w >= balls else domain.keep_out_points_m[w]
        if w >= balls and side[0] == 0.0:
            distances[w], outward = side_slack(side, x), (side[1], side[2], side[3])
        else:
            away, radius = minus(x, side), domain.keep_out_m
            if w >= balls:
                away, radius = (x[0] - side[1], x[1] - side[2], 0.0), side[4]
            length = max(norm(away), _CENTRE_M)
            distances[w], outward = length - radius, over(away, length)
        store(outward, ways[w])
    return distances, ways
