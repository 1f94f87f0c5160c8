"""The domain of positions: what is in it, and how far it is to its walls."""

from __future__ import annotations

import numpy as np

from nullpose.solver.kernels.jit import heap_kernel, kernel
from nullpose.solver.kernels.local_coordinates import choose_sides, side_slack
from nullpose.solver.kernels.vectors import minus, norm, over, store
from nullpose.solver.kernels.zones import in_zone

_CENTRE_M = 1e-9  # a position this near to the centre of a ball or a cylinder has a way out all the same


@kernel
def contains(domain, p):
    """Check whether a position is in the box, outside of every keep-out ball and in no zone."""
    for i in range(3):
        if not domain.low_m[i] <= p[i] <= domain.high_m[i]:
            return False
    for q in range(domain.keep_out_points_m.shape[0]):
        square = 0.0
        for i in range(3):
            square += (domain.keep_out_points_m[q, i] - p[i]) ** 2
        if not square >= domain.keep_out_m * domain.keep_out_m:
            return False
    forbidden = False
    for z in range(domain.zone_kind.shape[0]):
        forbidden = forbidden or in_zone(domain, z, p)
    return not forbidden


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
