"""Local maximum of the smallest ratio, by the epigraph form ``maximise t: f_k(p, u) >= t, p in P``.

A primal-dual interior-point method with exact second derivatives walks to a Karush-Kuhn-Tucker point. ``f_k``
is the logarithm of ratio k. Nothing is smoothed: at the end the active ratios are equal but for the last
barrier weight, each with its multiplier.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import FloatArray
from nullpose.objectives.ratios import Ratios
from nullpose.problem.records import BAND_AXIS, CONE_AXIS, NARROW_AXIS, Axes, Domain
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel, inner_kernel, rare_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.barrier import (
    barrier_value,
    bent_step,
    best_level,
    newton_step,
    residual,
    update_duals,
)
from nullpose.solver.kernels.linear_algebra.links import (
    derivatives,
    log_objective,
    pair_log,
    row_count,
    shifted_log,
)
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, copy_into, inner, smallest_of
from nullpose.solver.kernels.search.local_coordinates import (
    add_slack_slopes,
    axis_at,
    choose_sides,
    clamp_axis,
    clamp_elevation,
    domain_slacks,
    local_coordinates,
    move,
    reduce_hessian,
    slack_count,
)
from nullpose.solver.kernels.search.shadows import domain_in_sight

_MU_END = 1e-12
_LONGEST = 0.7
_INSIDE = 0.995
_ATTEMPTS = 31
_EASE = 0.1  # of the least gap over a requirement that is left when the pose has followed
_BAND_EDGE = 1e-12  # an axis put on the end of a band is off it by rounding
_ACTIVE = 1e-5  # the least multiplier of a face on which a pose is put
_FACE_LOSS = 1e-12  # what that may cost


class Problem(NamedTuple):
    """What is polished: the chosen sides of forbidden pieces, and which coordinates are free.

    Of a pose's values those from ``first`` to ``last`` are to be above the level: the log ratios, or the one
    of a mean or those of pairs that stand behind them. After them come the slacks. A mean's ratios are to be
    above their requirements, by which ``ease`` is taken off as long as the pose misses one: (1,), of the
    logarithms.
    """

    family: Ratios
    domain: Domain
    axis_field: Axes
    chosen: NDArray[np.int64]
    free: NDArray[np.bool_]
    first: int
    last: int
    ease: FloatArray


class Point(NamedTuple):
    """A pose (6,), its log ratios and after them its slacks, and its gaps: the ratios' above the level."""

    pose: FloatArray
    values: FloatArray
    gaps: FloatArray


class Model(NamedTuple):
    """The problem around a point: change of the pose by each variable, gaps' rates and multipliers.

    And the weight of each log ratio in the Lagrangian: its multiplier, or what it has by the mean's as well.
    """

    directions: FloatArray
    rates: FloatArray
    duals: FloatArray
    factor: FloatArray
    weights: FloatArray


@inner_kernel
def enter(problem, pose):
    """Move a pose strictly inside its faces and its band; fill which coordinates are free."""
    domain, ends = problem.domain, problem.axis_field.offset
    for i in range(3):
        low, high = domain.low_m[i], domain.high_m[i]
        problem.free[i] = high - low > 1e-9
        margin = min(1e-2, 1e-3 * (high - low)) if problem.free[i] else 0.0
        pose[i] = min(max(pose[i], low + margin), high - margin)
    if BAND_AXIS <= problem.axis_field.kind < CONE_AXIS:
        margin = min(1e-3, 1e-2 * (ends[1] - ends[0]))
        least = ends[0] + margin if ends[0] > 0.0 else 0.0
        greatest = ends[1] - margin if ends[1] < 1.0 else 1.0
        clamp_elevation(least, greatest, pose[3:])


@inner_kernel
def fill_values(problem, pose, logs, values):
    """Fill the log ratios of a pose and after them its slacks, infinite for a coordinate not free."""
    p, u, last = pose[:3], pose[3:], problem.last
    ratios = values[: problem.family.numerator_point.shape[0]]
    value = log_objective(problem.family, p, u, logs, ratios)
    if problem.family.shares.shape[0] > 0:
        values[problem.first] = value
    for q in range(problem.family.pairs.shape[0]):
        values[problem.first + q] = pair_log(problem.family, q, ratios)
    domain_slacks(p, u, problem.domain, problem.axis_field, problem.chosen, values[last:])
    for i in range(3):
        if not problem.free[i]:
            values[last + i] = values[last + 3 + i] = math.inf


@inner_kernel
def reached(problem, values):
    """Return the logarithm of what is maximised, minus infinity outside the domain."""
    band = values.shape[0] - 2
    if smallest_of(values[problem.last : band]) >= 0.0 and smallest_of(values[band:]) >= -_BAND_EDGE:
        return smallest_of(values[problem.first : problem.last])
    return -math.inf


@inner_kernel
def begin(problem, point, logs, best_pose):
    """Move a pose strictly inside; fill the better of it and the start; return both values."""
    pose = point.pose
    best = value = -math.inf
    problem.free[:] = True
    clamp_axis(problem.axis_field, pose[3:])
    for attempt in range(2):  # the start itself is the first incumbent
        if attempt == 1:
            enter(problem, pose)
        choose_sides(problem.domain, pose[:3], problem.chosen)
        axis_at(problem.axis_field, pose[:3], pose[3:])
        fill_values(problem, pose, logs, point.values)
        value = reached(problem, point.values)
        if attempt == 0 or value > best:
            best = value
            copy_into(pose, best_pose)
    return best, value


@inner_kernel
def fill_gaps(problem, point, t):
    """Fill the gaps of a point at a level; those of a mean's ratios are above their requirements."""
    requirements = problem.family.requirements
    for c in range(problem.first):
        point.gaps[c] = math.inf
    for c in range(requirements.shape[0]):
        if requirements[c] > 0.0:
            point.gaps[c] = point.values[c] - math.log(requirements[c]) + problem.ease[0]
    for c in range(problem.first, point.values.shape[0]):
        point.gaps[c] = point.values[c] - (t if c < problem.last else 0.0)


@inner_kernel
def ease_requirements(problem, point, t, least):
    """Ease requirements, or make them as strict as they are, so that each has a gap of at least this."""
    problem.ease[0] = 0.0
    fill_gaps(problem, point, t)
    problem.ease[0] = max(0.0, least - smallest_of(point.gaps[: problem.first]))
    fill_gaps(problem, point, t)


@inner_kernel
def slope_of_mean(family, k, log):
    """Return the derivative of a mean's logarithm by that of ratio k."""
    return family.shares[k] * math.exp(log - shifted_log(family.offset, log))


@rare_kernel
def mix_slopes(family, logs, dual, grads, hess):
    """Fill the gradient of a mean's logarithm from the ratios'; add what bends it by their logarithms."""
    ratios = logs.shape[0]
    grads[ratios, :] = 0.0
    for k in range(ratios):
        slope = slope_of_mean(family, k, logs[k])
        bend = dual * slope * (1.0 - slope / family.shares[k])
        add_scaled(slope, grads[k], grads[ratios])
        for i in range(6):
            add_scaled(bend * grads[k, i], grads[k], hess[i])


@inner_kernel
def linearise(problem, point, grads, parts, n, model, h):
    """Fill the rates of all gaps in the n search variables and the level, and the Lagrangian's Hessian."""
    ratios, first, last = problem.family.numerator_point.shape[0], problem.first, problem.last
    pose, duals, hess, f = point.pose, model.duals, scratch(6, 6), point.values[:ratios]
    is_mean, pairs = problem.family.shares.shape[0] > 0, problem.family.pairs
    for k in range(ratios):
        of_mean = duals[first] * slope_of_mean(problem.family, k, f[k]) if is_mean else 0.0
        model.weights[k] = duals[k] + of_mean
    for q in range(pairs.shape[0]):
        model.weights[pairs[q, 0]] += duals[first + q]
        model.weights[pairs[q, 1]] -= duals[first + q]
    derivatives(problem.family, pose[:3], pose[3:], model.weights, f, grads[:ratios], hess, parts)
    if is_mean:
        mix_slopes(problem.family, f, duals[first], grads, hess)
    for q in range(pairs.shape[0]):
        copy_into(grads[pairs[q, 0]], grads[first + q])
        add_scaled(-1.0, grads[pairs[q, 1]], grads[first + q])
    add_slack_slopes(
        problem.domain, problem.axis_field, problem.chosen, pose, duals[last:], grads[last:], hess
    )
    reduce_hessian(hess, model.directions, n, h)
    for c in range(duals.shape[0]):
        if point.gaps[c] < math.inf:
            for m in range(n):
                model.rates[c, m] = inner(grads[c], model.directions[m], 6)
        model.rates[c, n] = -1.0 if first <= c < last else 0.0
    if problem.axis_field.kind >= NARROW_AXIS:  # a step at one height bends away from the straight one
        bend = pose[5] * inner(duals, grads[:, 5], duals.shape[0]) / (pose[3] ** 2 + pose[4] ** 2)
        for m in range(n - 2 if problem.axis_field.kind == NARROW_AXIS else n - 1, n):
            h[m, m] += bend


@inner_kernel
def longest_scale(problem, gaps, rates, step, n):
    """Return the largest share of a step that stays inside all but the balls, and the step's size."""
    first, last, balls = problem.first, problem.last, problem.domain.keep_out_points_m.shape[0]
    largest = 0.0
    for m in range(n):
        largest = max(largest, abs(step[m]))
    scale = min(1.0, _LONGEST / largest)
    for c in range(gaps.shape[0]):
        change = 0.0 if first <= c < last else inner(rates[c], step, n)
        if change < 0.0 and not last + 6 <= c < last + 6 + balls:
            scale = min(scale, -_INSIDE * gaps[c] / change)
    return scale, largest


@inner_kernel
def line_search(problem, point, t, trial, model, n, mu, step, slope, scale, logs):
    """Return the share of a step that climbs the barrier enough, and the level there; fill the point reached.

    Before the step is shortened it is bent once, to follow a curved ridge. A share of zero: none climbs.
    """
    first = problem.first
    f, new_f, bent = point.values[first : problem.last], trial.values[first : problem.last], scratch(6)
    floor = barrier_value(point.gaps, t, mu)
    for attempt in range(_ATTEMPTS):
        if attempt == 1:
            gaps, duals, rates = point.gaps[first:], model.duals[first:], model.rates[first:]
            bent_step(f, new_f, gaps, duals, rates, model.factor, n, scale, step, bent)
            share, _ = longest_scale(problem, point.gaps, model.rates, bent, n)
            move(problem.axis_field, point.pose, model.directions, n, bent, share, trial.pose)
        else:
            scale *= 0.5 if attempt > 1 else 1.0
            move(problem.axis_field, point.pose, model.directions, n, step, scale, trial.pose)
        fill_values(problem, trial.pose, logs, trial.values)
        new_t = best_level(new_f, mu)
        fill_gaps(problem, trial, new_t)
        value = barrier_value(trial.gaps, new_t, mu)
        if value >= floor + 1e-4 * scale * slope - 1e-15 * (1.0 + abs(floor)):
            return scale, new_t
    return 0.0, t


@inner_kernel
def put_on_faces(problem, point, trial, model, logs, best, best_pose):
    """Put the last pose on the faces that hold it, as the best unless that loses anything; return its value.

    A step in the search variables does so, since the axis must follow.
    """
    last, m = problem.last, 0
    step, goal = zeroed(6), scratch(3)
    copy_into(point.pose[:3], goal)
    for i in range(3):
        if problem.free[i]:
            length = model.directions[m, i]
            if model.duals[last + i] * length > _ACTIVE:
                goal[i] = problem.domain.low_m[i]
            if model.duals[last + 3 + i] * length > _ACTIVE:
                goal[i] = problem.domain.high_m[i]
            step[m] = (goal[i] - point.pose[i]) / length
            m += 1
    move(problem.axis_field, point.pose, model.directions, m, step, 1.0, trial.pose)
    copy_into(goal, trial.pose)  # exactly
    axis_at(problem.axis_field, goal, trial.pose[3:])
    fill_values(problem, trial.pose, logs, trial.values)
    value = reached(problem, trial.values)
    if value >= best - _FACE_LOSS:
        copy_into(trial.pose, best_pose)
        return value
    return best


@inner_kernel
def fill_multipliers(problem, duals, multipliers):
    """Fill the multipliers of ratios or pairs, scaled; those of a mean in place of their logarithms."""
    total, requirements = 0.0, problem.family.requirements
    for c in range(problem.first, problem.last):
        total += duals[c]
    for k in range(multipliers.shape[0]):
        is_mean = problem.family.shares.shape[0] > 0
        multipliers[k] = 0.0 if is_mean else duals[problem.first + k] / total
    for k in range(requirements.shape[0]):
        if requirements[k] > 0.0:
            multipliers[k] = duals[k] / (total * requirements[k])


@heap_kernel
def polish(family, domain, axis_field, p, u, mu_start, max_steps, multipliers):
    """Improve a pose in place to a local maximum; return its smallest log ratio and the steps taken.

    Where buildings stand, every line of sight stays as good as at the start.

    Args:
        family: arrays of the family.
        domain: box, keep-out balls and forbidden pieces, as ``Family.domain`` has them.
        axis_field: kind, offset (3,) and matrix (3, 3), as ``AxisField.arrays`` has them.
        p: position, (3,), updated; must lie in the domain.
        u: unit axis, (3,), updated; ignored on entry when the field is affine.
        mu_start: first barrier weight, in units of the log ratio.
        max_steps: limit on interior-point steps.
        multipliers: output, (ratios,): the ratios' multipliers at the end, which sum to one, or (pairs,) the
            pairs'; of a mean those of ``ratio - requirement``, the multiplier of its logarithm being one.
    """
    sight = domain_in_sight(family, domain, p)
    return polish_within(family, sight, axis_field, p, u, mu_start, max_steps, multipliers)


@inner_heap_kernel
def polish_within(family, domain, axis_field, p, u, mu_start, max_steps, multipliers):
    """Do what ``polish`` does in a domain."""
    ratios, groups = family.numerator_isotropic.shape[0], family.denominator_isotropic.shape[0]
    chosen = np.empty(domain.piece_start.shape[0] - 1, np.int64)
    is_mean, pairs = family.shares.shape[0] > 0, family.pairs.shape[0]
    first = ratios if is_mean or pairs > 0 else 0
    last = first + (1 if is_mean else row_count(family))
    problem = Problem(family, domain, axis_field, chosen, np.empty(3, np.bool_), first, last, np.zeros(1))
    count = last + slack_count(domain)
    point = Point(np.empty(6), np.empty(count), np.empty(count))
    trial = Point(np.empty(6), np.empty(count), np.empty(count))
    directions, rates, factor = np.zeros((5, 6)), np.zeros((count, 6)), np.empty((6, 6))
    model = Model(directions, rates, np.empty(count), factor, np.empty(ratios))
    best_pose, logs, duals = scratch(6), np.empty(groups), model.duals
    copy_into(p, point.pose)
    copy_into(u, point.pose[3:])
    best, value = begin(problem, point, logs, best_pose)
    f, mu = point.values[first:last], mu_start
    steps = stalled = 0
    if value > -math.inf and smallest_of(point.values[last:]) > 0.0:
        t = best_level(f, mu)
        fill_gaps(problem, point, t)
        if family.requirements.shape[0] > 0:
            ease_requirements(problem, point, t, mu)
            mu = max(mu, problem.ease[0])
        for c in range(count):
            duals[c] = mu / point.gaps[c]
        grads, parts, h, step = np.empty((count, 6)), np.empty((groups, 50)), scratch(5, 5), scratch(6)
        while steps < max_steps:
            steps += 1
            n = local_coordinates(family, axis_field, point.pose, problem.free, model.directions)
            linearise(problem, point, grads, parts, n, model, h)
            if stalled >= 2 or residual(point.gaps, duals, model.rates, n, mu) <= 10.0 * mu:
                if problem.ease[0] > 0.0:
                    ease_requirements(problem, point, t, _EASE * smallest_of(point.gaps[:first]))
                elif mu <= _MU_END or stalled >= 6:
                    break
                else:
                    mu = max(_MU_END, min(0.1 * mu, mu**1.5))
                    t = best_level(f, mu)
                    fill_gaps(problem, point, t)
            slope = newton_step(point.gaps, duals, model.rates, h, n, mu, model.factor, step)
            if math.isnan(slope):
                break
            dual_scale, largest = longest_scale(problem, point.gaps, model.rates, step, n)
            scale, t = line_search(problem, point, t, trial, model, n, mu, step, slope, dual_scale, logs)
            if not scale > 0.0:
                stalled += 3
                continue
            stalled = stalled + 1 if scale * largest < 1e-13 else 0
            update_duals(point.gaps, trial.gaps, model.rates, step, n + 1, dual_scale, mu, duals)
            copy_into(trial.pose, point.pose)
            copy_into(trial.values, point.values)
            copy_into(trial.gaps, point.gaps)
            value = smallest_of(f)
            if value > best:
                best = value
                copy_into(point.pose, best_pose)
        best = put_on_faces(problem, point, trial, model, logs, best, best_pose)
    else:
        duals[:] = 1.0
    fill_multipliers(problem, duals, multipliers)
    copy_into(best_pose[:3], p)
    copy_into(best_pose[3:], u)
    return best, steps
