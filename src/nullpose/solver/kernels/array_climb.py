"""A quick climb on the smallest log ratio of an array: BFGS on its soft minimum, the walls as penalties.

Good to a thousandth or so; the last digits are left to a method that knows the constraints. Positions may end
a little outside.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.array_response import array_value, respond
from nullpose.solver.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solver.kernels.local_coordinates import choose_sides, side_slack
from nullpose.solver.kernels.vectors import minus, norm, over, store

_LENGTH_M2 = 25.0  # first guess at the inverse curvature of a position
_ANGLE = 0.05  # and of an angle
_LONGEST_M = 20.0
_SHRINK = 0.4
_TRIES = 12
_FLAT = 1e-6
_GAIN = 1e-5
_CENTRE_M = 1e-9  # a position this near to the centre of a ball or a cylinder has a way out all the same


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


@inner_heap_kernel
def penalise(domain, x, stiffness, slope):
    """Evaluate half the stiffness times the square of how far a position is outside; take its slope away."""
    total = 0.0
    for i in range(3):
        beyond = max(domain.low_m[i] - x[i], 0.0) - max(x[i] - domain.high_m[i], 0.0)
        slope[i] += stiffness * beyond
        total += beyond * beyond
    distances, ways = walls(domain, x)
    for w in range(len(distances)):
        inside = max(0.0, -distances[w])
        total += inside * inside
        for i in range(3):
            slope[i] += stiffness * inside * ways[w, i]
    return 0.5 * stiffness * total


@inner_heap_kernel
def soften(problem, domain, x, beta, slope):
    """Evaluate ``-log(sum_k exp(-beta f_k)) / beta`` less the walls' penalty, and the worst f_k less it."""
    logs, slopes = np.empty(problem.nodes), np.empty((problem.nodes, len(x)))
    worst = respond(problem, x, logs, slopes)
    slope[:] = 0.0
    if not worst > -math.inf:
        return -math.inf, -math.inf
    total = 0.0
    for q in range(len(logs)):
        share = math.exp(-beta * (logs[q] - worst))
        total += share
        for a in range(len(x)):
            slope[a] += share * slopes[q, a]
    for a in range(len(x)):
        slope[a] /= total
    penalty = penalise(domain, x, beta, slope)
    return worst - math.log(total) / beta - penalty, worst - penalty


@inner_kernel
def direction(inverse, slope, step):
    """Fill the quasi-Newton step; return its climb and the longest share of it that is not too far."""
    rise, largest = 0.0, 0.0
    for i in range(len(slope)):
        step[i] = 0.0
        for j in range(len(slope)):
            step[i] += inverse[i, j] * slope[j]
        rise += step[i] * slope[i]
        largest = max(largest, abs(step[i]) / (_LONGEST_M if i < 3 else 1.0))
    return rise, 1.0 / max(1.0, largest)


@inner_heap_kernel
def learn(inverse, step, bend):
    """BFGS update of the inverse curvature by a step and the change of slope, downhill, along it."""
    n = len(step)
    product = np.zeros(n)
    agreement, size = 0.0, 0.0
    for i in range(n):
        for j in range(n):
            product[i] += inverse[i, j] * bend[j]
        agreement += step[i] * bend[i]
        size += product[i] * bend[i]
    if agreement > 1e-12:
        stretch = 1.0 + size / agreement
        for i in range(n):
            for j in range(n):
                change = stretch * step[i] * step[j] - product[i] * step[j] - step[i] * product[j]
                inverse[i, j] += change / agreement


@inner_heap_kernel
def best_of(problem, states):
    """Find the state with the highest value, a copy; of one alone, that one."""
    at, best = 0, -math.inf
    for s in range(len(states) if len(states) > 1 else 0):
        value = array_value(problem, states[s])
        if value > best:
            at, best = s, value
    return states[at].copy()


@heap_kernel
def climb(problem, domain, states, betas, most):
    """Climb from the best of several states: its end, the value there, and evaluations.

    The value is the smallest log ratio less the walls' penalty.

    Args:
        problem: the array and its scene.
        domain: box, keep-out balls and forbidden pieces of a family.
        states: (s, n) where to begin.
        betas: sharpness of the soft minimum, and stiffness of the walls, in each round.
        most: steps in each round.
    """
    x = best_of(problem, states)
    n = len(x)
    slope, new_slope, step, new_x = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    inverse, worst, evaluations = np.empty((n, n)), -math.inf, len(states) - 1
    for beta in betas:
        inverse[:] = 0.0
        for i in range(n):
            inverse[i, i] = betas[0] / beta * (_LENGTH_M2 if i < 3 else _ANGLE)
        value, worst = soften(problem, domain, x, beta, slope)
        evaluations += 1
        if not value > -math.inf:
            break
        for _ in range(most):
            rise, scale = direction(inverse, slope, step)
            if rise < _FLAT:
                break
            for _ in range(_TRIES):
                for i in range(n):
                    new_x[i] = x[i] + scale * step[i]
                new, new_worst = soften(problem, domain, new_x, beta, new_slope)
                evaluations += 1
                if new >= value + 1e-4 * scale * rise:
                    break
                scale *= _SHRINK
            else:
                break
            for i in range(n):
                step[i] = new_x[i] - x[i]
                slope[i] -= new_slope[i]
            learn(inverse, step, slope)
            x[:] = new_x
            slope[:] = new_slope
            gain, value, worst = new - value, new, new_worst
            if gain < _GAIN:
                break
    return x, worst, evaluations
