"""A quick climb on the smallest log ratio of an array: BFGS on its soft minimum, the walls as penalties.

Good to a thousandth or so; the last digits are left to a method that knows the constraints. Positions may end
a little outside.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.array_response import array_value, respond
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel, kernel
from nullpose.solve.kernels.local_coordinates import choose_sides, side_slack

__all__ = ["climb", "judge"]

_LENGTH_M2 = 25.0  # first guess at the inverse curvature of a position
_ANGLE = 0.05  # and of an angle
_LONGEST_M = 20.0
_SHRINK = 0.4
_TRIES = 12
_FLAT = 1e-6
_GAIN = 1e-5


@inner_kernel
def walls(domain, x, stiffness, chosen, slope):
    """Return half the stiffness times the square of how far a position is outside; take its slope away."""
    low, high, keep_points = domain.low_m, domain.high_m, domain.keep_out_points_m
    keep_radius = domain.keep_out_m
    total = 0.0
    for i in range(3):
        over = max(low[i] - x[i], 0.0) - max(x[i] - high[i], 0.0)
        slope[i] += stiffness * over
        total += over * over
    for q in range(keep_points.shape[0]):
        square = 0.0
        for i in range(3):
            square += (x[i] - keep_points[q, i]) ** 2
        if square < keep_radius * keep_radius:
            away = max(math.sqrt(square), 1e-9)
            over = keep_radius - away
            total += over * over
            for i in range(3):
                slope[i] += stiffness * over * (x[i] - keep_points[q, i]) / away
    choose_sides(domain, x, chosen)
    for c in range(chosen.shape[0]):
        side = domain.piece_sides[chosen[c]]
        slack = side_slack(side, x)
        if slack >= 0.0:
            continue
        if side[0] == 0.0:
            total += slack * slack
            for i in range(3):
                slope[i] -= stiffness * slack * side[1 + i]
        else:
            away = max(math.hypot(x[0] - side[1], x[1] - side[2]), 1e-9)
            over = side[4] - away
            total += over * over
            for i in range(2):
                slope[i] += stiffness * over * (x[i] - side[1 + i]) / away
    return 0.5 * stiffness * total


@inner_kernel
def soften(scene, base, domain, shared, x, beta, work, slope):
    """Return ``-log(sum_k exp(-beta f_k)) / beta`` less the walls' penalty, and the worst f_k less it."""
    logs, slopes, chosen = work
    worst = respond(scene, base, shared, x, logs, slopes)
    slope[:] = 0.0
    if not worst > -math.inf:
        return -math.inf, -math.inf
    total = 0.0
    for q in range(logs.shape[0]):
        share = math.exp(-beta * (logs[q] - worst))
        total += share
        for a in range(slope.shape[0]):
            slope[a] += share * slopes[q, a]
    for a in range(slope.shape[0]):
        slope[a] /= total
    penalty = walls(domain, x, beta, chosen, slope)
    return worst - math.log(total) / beta - penalty, worst - penalty


@inner_kernel
def begin_matrix(matrix, scale):
    """Fill the first inverse curvature."""
    matrix[:] = 0.0
    for i in range(matrix.shape[0]):
        matrix[i, i] = scale * (_LENGTH_M2 if i < 3 else _ANGLE)


@inner_kernel
def direction(matrix, slope, step):
    """Fill the quasi-Newton step; return its climb and the longest share of it that is not too far."""
    rise, largest = 0.0, 0.0
    for i in range(slope.shape[0]):
        step[i] = 0.0
        for j in range(slope.shape[0]):
            step[i] += matrix[i, j] * slope[j]
        rise += step[i] * slope[i]
        largest = max(largest, abs(step[i]) / (_LONGEST_M if i < 3 else 1.0))
    return rise, 1.0 / max(1.0, largest)


@inner_heap_kernel
def learn(matrix, step, bend):
    """BFGS update of the inverse curvature by a step and the change of slope, downhill, along it."""
    n = step.shape[0]
    product = np.zeros(n)
    agreement, size = 0.0, 0.0
    for i in range(n):
        for j in range(n):
            product[i] += matrix[i, j] * bend[j]
        agreement += step[i] * bend[i]
        size += product[i] * bend[i]
    if agreement > 1e-12:
        for i in range(n):
            for j in range(n):
                matrix[i, j] += (
                    (1.0 + size / agreement) * step[i] * step[j] - product[i] * step[j] - step[i] * product[j]
                ) / agreement


@heap_kernel
def climb(scene, base, domain, shared, x, betas, most):
    """Climb from a state, in place; return its smallest log ratio less the walls' penalty, and evaluations.

    Args:
        scene: as for :func:`respond`.
        base: (k, 2).
        domain: box, keep-out balls and forbidden pieces of a family.
        shared: whether one beam serves all nodes.
        x: the state, overwritten.
        betas: sharpness of the soft minimum, and stiffness of the walls, in each round.
        most: steps in each round.
    """
    n, nodes = x.shape[0], scene[2]
    work = (np.empty(nodes), np.empty((nodes, n)), np.empty(domain.piece_start.shape[0] - 1, np.int64))
    slope, new_slope, step, new_x = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    matrix = np.empty((n, n))
    worst = -math.inf
    evaluations = 0
    for beta in betas:
        begin_matrix(matrix, betas[0] / beta)
        value, worst = soften(scene, base, domain, shared, x, beta, work, slope)
        evaluations += 1
        if not value > -math.inf:
            break
        for _ in range(most):
            rise, scale = direction(matrix, slope, step)
            if rise < _FLAT:
                break
            climbed = False
            for _ in range(_TRIES):
                for i in range(n):
                    new_x[i] = x[i] + scale * step[i]
                new, new_worst = soften(scene, base, domain, shared, new_x, beta, work, new_slope)
                evaluations += 1
                climbed = new >= value + 1e-4 * scale * rise
                if climbed:
                    break
                scale *= _SHRINK
            if not climbed:
                break
            for i in range(n):
                step[i] = new_x[i] - x[i]
                slope[i] -= new_slope[i]
            learn(matrix, step, slope)
            x[:] = new_x
            slope[:] = new_slope
            gain, value, worst = new - value, new, new_worst
            if gain < _GAIN:
                break
    return worst, evaluations


@kernel
def judge(scene, base, shared, states, values):
    """Fill the smallest log ratio at each state, (s, n) into (s,)."""
    for s in range(states.shape[0]):
        values[s] = array_value(scene, base, shared, states[s])
