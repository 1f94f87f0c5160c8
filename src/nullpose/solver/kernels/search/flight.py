"""What the search for a trajectory asks of each of its instants.

One instant of a trajectory is one pose, with the barrier problem of ``polish`` around it. Its domain holds at
both ends of the segments that meet there: each forbidden piece is a half space, of one side.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.barrier import add_constraints
from nullpose.solver.kernels.linear_algebra.links import row_count
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.search.domain import contains
from nullpose.solver.kernels.search.local_coordinates import local_coordinates, slack_count
from nullpose.solver.kernels.search.polish import Model, Point, Problem, fill_gaps, fill_values, linearise
from nullpose.solver.kernels.search.search import start_axis


@heap_kernel
def value_positions(family, domain, axis_field, positions_m, axes, values):
    """Fill a likely axis for each position, and the log value there; minus infinity outside the domain.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        positions_m: (n, 3).
        axes: output, (n, 3).
        values: output, (n,).
    """
    f, logs = np.empty(family.numerator_isotropic.shape[0]), np.empty(family.denominator_isotropic.shape[0])
    for i in range(positions_m.shape[0]):
        values[i] = -math.inf
        if contains(domain, positions_m[i]):
            values[i] = start_axis(family, axis_field, positions_m[i], axes[i], logs, f)


@inner_heap_kernel
def problem_at(family, domain, axis_field):
    """Return the problem of an instant, its pieces' only sides chosen."""
    ratios, pairs = family.numerator_isotropic.shape[0], family.pairs.shape[0]
    is_mean, pieces = family.shares.shape[0] > 0, domain.piece_start.shape[0] - 1
    free, chosen = np.empty(3, np.bool_), np.empty(pieces, np.int64)
    first = ratios if is_mean or pairs > 0 else 0
    last = first + (1 if is_mean else row_count(family))
    for c in range(pieces):
        chosen[c] = c
    for i in range(3):
        free[i] = domain.high_m[i] - domain.low_m[i] > 1e-9
    return Problem(family, domain, axis_field, chosen, free, first, last, np.zeros(1))


@heap_kernel
def value_pose(family, domain, axis_field, pose, values):
    """Fill the log ratios of a pose, and after them its slacks.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        pose: (6,) position and axis.
        values: output, (rows and slacks,).

    Returns:
        Where in the values begins and ends what is to be above the level.
    """
    problem = problem_at(family, domain, axis_field)
    fill_values(problem, pose, np.empty(family.denominator_isotropic.shape[0]), values)
    return problem.first, problem.last


@heap_kernel
def model_pose(family, domain, axis_field, pose, values, level, mu, directions, system, gradient):
    """Model the barrier ``mu sum log g_c`` of one instant around a pose and a level.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        pose: (6,) position and axis.
        values: (rows and slacks,) those of the pose.
        level: what the log ratios are to be above.
        mu: weight of the barrier.
        directions: output, (5, 6): change of the pose by each search variable.
        system: output, (6, 6): minus the second derivatives by these and, last, the level; the lower half.
        gradient: output, (6,) the first derivatives.

    Returns:
        How many search variables there are, and the barrier's value.
    """
    problem, groups = problem_at(family, domain, axis_field), family.denominator_isotropic.shape[0]
    ratios, count = family.numerator_isotropic.shape[0], problem.last + slack_count(domain)
    point = Point(pose, values, np.empty(count))
    fill_gaps(problem, point, level)
    model = Model(directions, np.zeros((count, 6)), np.empty(count), np.empty((6, 6)), np.empty(ratios))
    for c in range(count):
        model.duals[c] = mu / point.gaps[c]
    n = local_coordinates(family, axis_field, pose, problem.free, directions)
    h, grads, parts = scratch(5, 5), np.empty((count, 6)), np.empty((groups, 50))
    linearise(problem, point, grads, parts, n, model, h)
    system[:, :], gradient[:] = 0.0, 0.0
    for a in range(n):
        copy_into(h[a, :n], system[a, :n])
        for b in range(n):
            system[a, b] = -system[a, b]
    whole, slopes = np.zeros((6, 6)), np.zeros(6)
    add_constraints(point.gaps, model.duals, model.rates, n + 1, mu, whole, slopes)
    for a in range(n + 1):  # the level stands last
        i = a if a < n else 5
        gradient[i] = slopes[a]
        for b in range(a + 1):
            system[i, b if b < n else 5] += whole[a, b]
    value = 0.0
    for gap in point.gaps:
        value += mu * math.log(gap) if 0.0 < gap < math.inf else (0.0 if gap > 0.0 else -math.inf)
    return n, value
