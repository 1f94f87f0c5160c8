"""The domain of positions: what is in it, what forbids a box of them, and how far it is to its walls."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, copy_into, squared_distance
from nullpose.solver.kernels.linear_algebra.vectors import minus, norm, over, square_range, store
from nullpose.solver.kernels.search.local_coordinates import choose_sides, side_slack
from nullpose.solver.kernels.search.zones import FORBIDDEN, MOST_ALTERNATIVES, in_zone, zone_alternatives

_STEP = 1e-3  # m beyond a forbidden piece's side
_SPARE = 1e-2  # beyond a keep-out ball's radius, as a share of it
_FINER = (1.0, 1e-2, 3e-4, 1e-7)  # shares of both, and the most laps: where what is allowed is a sliver
_LAPS = (8, 32, 32, 32)
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


@inner_kernel
def push_away(centre, n, reach, fallback, p):
    """Move a position to a distance from a centre in its first n coordinates; from the centre along one."""
    away = 0.0
    for i in range(n):
        away += (p[i] - centre[i]) ** 2
    away = math.sqrt(away)
    for i in range(n):
        outwards = (p[i] - centre[i]) / away if away > 1e-9 else (1.0 if i == fallback else 0.0)
        p[i] = centre[i] + reach * outwards


@inner_kernel
def step_outside(p, domain, step, chosen):
    """Move a position to the outside of the forbidden pieces that it is in; return whether it was in none."""
    low, high, sides, q, best = domain.low_m, domain.high_m, domain.piece_sides, scratch(3), scratch(3)
    clear = True
    choose_sides(domain, p, chosen)
    for c in range(chosen.shape[0]):
        if side_slack(sides[chosen[c]], p) > 0.0:
            continue
        clear, least = False, math.inf
        copy_into(p, best)
        for s in range(domain.piece_start[c], domain.piece_start[c + 1]):  # beyond the nearest
            copy_into(p, q)
            if sides[s, 0] == 0.0:
                add_scaled(step - side_slack(sides[s], p), sides[s, 1:4], q)
            else:
                push_away(sides[s, 1:3], np.int64(2), sides[s, 4] + step, 0, q)
            moved = squared_distance(q, p)
            for i in range(3):
                moved = moved if low[i] <= q[i] <= high[i] else math.inf
            if moved < least:
                least = moved
                copy_into(q, best)
        copy_into(best, p)
    return clear


@heap_kernel
def push_out(p, domain):
    """Move a position into the box and out of keep-out balls and forbidden pieces; return whether it is."""
    start = p.copy()
    chosen = np.empty(domain.piece_start.shape[0] - 1, np.int64)
    for attempt in range(len(_FINER)):
        copy_into(start, p)
        if push_by(p, domain, _FINER[attempt], _LAPS[attempt], chosen):
            return True
    return False


@inner_kernel
def push_by(p, domain, share, laps, chosen):
    """Do what ``push_out`` does, by a share of the usual steps; return whether it came to an end."""
    margin = (1.0 + share * _SPARE) * domain.keep_out_m
    for _ in range(laps):
        for i in range(3):
            p[i] = min(max(p[i], domain.low_m[i]), domain.high_m[i])
        clear = step_outside(p, domain, share * _STEP, chosen)
        for point in domain.keep_out_points_m:
            if squared_distance(p, point) < margin * margin:
                clear = False
                upwards = 2 if domain.high_m[2] - point[2] > margin else 0
                push_away(point, np.int64(3), (1.0 + 2.0 * share * _SPARE) * margin, upwards, p)
        if clear:
            return True
    return False
