"""Multistart: coarse positions judged by a likely axis, the promising ones polished.

A pose at least as good as one already known lies within a known distance of every node, since a ratio falls
with the square of it; the starts fill that box, which shrinks as the incumbent improves, so that an unbounded
horizontal domain needs no box of its own.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.problem.records import AFFINE_AXIS
from nullpose.solver.kernels.compiler.jit import (
    heap_kernel,
    inner_heap_kernel,
    inner_kernel,
    kernel,
    rare_kernel,
)
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.channel import reach_of
from nullpose.solver.kernels.linear_algebra.dual import dual_multipliers
from nullpose.solver.kernels.linear_algebra.forms import congruence, fill_forms, inverse_factor
from nullpose.solver.kernels.linear_algebra.links import log_most_share, log_objective, row_count
from nullpose.solver.kernels.linear_algebra.pair_dual import touch_pairs
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_scaled,
    add_square,
    copy_into,
    fill_identity,
    normalise,
    top_eigenvector,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot
from nullpose.solver.kernels.search.domain import push_out
from nullpose.solver.kernels.search.local_coordinates import axis_at, clamp_axis
from nullpose.solver.kernels.search.polish import polish

_MU_START = 0.1
_MAX_STEPS = 100
_LEAST_GAIN = 1e-9
_LEAST_CLIMB = 1e-12
_ROUGH = 1e-2
_FARTHEST_M, _BISECTIONS = 1e9, 30  # of the faces beyond which a mean is too small
_GOLDEN = 1.2207440846057596  # the root of x^4 = x + 1: the golden ratio of three dimensions


@inner_kernel
def log_mean_beyond(family, low, high, side, face, sign):
    """Bound the logarithm of a mean beyond a face of a box, as distances alone show."""
    total = 0.0
    for k in range(family.shares.shape[0]):
        square = 0.0
        for i in range(3):
            x = family.points_m[family.numerator_point[k], i]
            gap = sign * (face - x) if i == side else max(low[i] - x, x - high[i])
            square += max(0.0, gap) ** 2
        total += log_most_share(family, k, square)
    return total


@rare_kernel
def cut_box_of_mean(family, low, high, level, box_low, box_high):
    """Cut a box around the nodes where beyond each face a mean stays below a level."""
    for side in range(3):
        for sign in (-1.0, 1.0):
            start = -math.inf
            for j in family.numerator_point:
                start = max(start, sign * family.points_m[j, side])
            inside, outside = 0.0, 1.0
            while (
                outside < _FARTHEST_M
                and log_mean_beyond(family, low, high, side, sign * (start + outside), sign) > level
            ):
                inside, outside = outside, 2.0 * outside
            if outside >= _FARTHEST_M:
                continue
            for _ in range(_BISECTIONS):
                middle = 0.5 * (inside + outside)
                if log_mean_beyond(family, low, high, side, sign * (start + middle), sign) > level:
                    inside = middle
                else:
                    outside = middle
            if sign > 0.0:
                box_high[side] = min(box_high[side], start + outside)
            else:
                box_low[side] = max(box_low[side], -(start + outside))


@kernel
def cut_box(family, low, high, level, box_low, box_high):
    """Fill the smallest box that holds every position whose smallest log ratio can reach ``level``."""
    points, n0, nw = family.points_m, family.numerator_isotropic, family.numerator_weight
    npt, den, d0 = family.numerator_point, family.denominator_of, family.denominator_isotropic
    copy_into(low, box_low)
    copy_into(high, box_high)
    if family.pairs.shape[0] > 0:  # far away nobody is jammed, which may be best
        return
    if family.shares.shape[0] > 0:
        cut_box_of_mean(family, low, high, level, box_low, box_high)
        return
    for k in range(nw.shape[0]):
        least, square = d0[den[k]] * math.exp(level) - n0[k], 0.0
        if least > 0.0:
            reach, point = reach_of(family.channels, npt[k], nw[k] / least), points[npt[k]]
            for i in range(3):
                square += max(0.0, low[i] - point[i], point[i] - high[i]) ** 2
            for i in range(3):  # what is left of the reach beside the gaps along the other axes
                gap = max(0.0, low[i] - point[i], point[i] - high[i])
                left = math.sqrt(max(0.0, reach * reach - (square - gap * gap)))
                box_low[i] = max(box_low[i], point[i] - left)
                box_high[i] = min(box_high[i], point[i] + left)


@heap_kernel
def likely_axis(family, p, axis):
    """Fill the axis that the relaxation of the best axis suggests at a position; return its log value.

    The top eigenvector of the dual's matrix: exact unless there is a duality gap, and then a good place to
    start. With several denominators, that of the ratios' excess over a level, taken three times more; with
    pairs that of their tangents at the last axis.
    """
    ratios, groups = family.numerator_isotropic.shape[0], family.denominator_isotropic.shape[0]
    has_pairs, forms = family.pairs.shape[0] > 0, np.empty((row_count(family), 6))
    numerators, denominators = np.empty((ratios, 6)), np.empty((groups, 6))
    fill_forms(family, p, numerators, denominators)
    logs, f = np.empty(groups), np.empty(ratios)
    back, mean, plain, trial = scratch(3, 3), zeroed(6), scratch(6), scratch(3)
    level, size, best = 0.0, math.inf, -math.inf
    if has_pairs:
        fill_identity(back)
        mean[:3], size = 1.0 / 3.0, 1.0
    else:
        for g in range(groups):
            add_scaled(1.0 / groups, denominators[g], mean)
        inverse_factor(mean, back)
    for attempt in range(4 if groups > 1 else 1):
        if has_pairs:
            touch_pairs(family, max(1.0, level), denominators, mean, forms)
        for k in range(0 if has_pairs else ratios):
            below = denominators[family.denominator_of[k]]
            for m in range(6):
                plain[m] = numerators[k, m] + level * (mean[m] - below[m])
            congruence(plain, back, forms[k])
            if attempt == 0:
                size = min(size, (forms[k, 0] + forms[k, 1] + forms[k, 2]) / 3.0)
        axis_of_forms(forms, back, size, family.shares, family.offset, trial)
        value = log_objective(family, p, trial, logs, f)
        if attempt > 0 and not value > best + 1e-3:
            break
        best = value
        copy_into(trial, axis)
        size = level = math.exp(best) if best > -20.0 else size
        if has_pairs:
            mean[:] = 0.0
            add_square(1.0, trial, mean)
    return best


@inner_heap_kernel
def axis_of_forms(forms, back, level, shares, offset, axis):
    """Fill the axis that the dual of the smallest of several whitened forms, or of their mean, suggests."""
    start, matrix, v, multipliers = zeroed(6), scratch(6), scratch(3), np.empty(forms.shape[0])
    start[:3] = 1.0 / 3.0
    dual_multipliers(
        forms,
        np.int64(0),
        forms.shape[0],
        level,
        math.inf,
        _ROUGH,
        start,
        multipliers,
        matrix,
        shares,
        offset,
    )
    top_eigenvector(matrix, v)
    for i in range(3):
        axis[i] = dot(back[i], v)
    normalise(axis)


@inner_kernel
def start_axis(family, axis_field, p, u, logs, f):
    """Return the smallest log ratio at the axis to start with: a likely one, or the field's."""
    if axis_field.kind == AFFINE_AXIS:
        axis_at(axis_field, p, u)
    else:
        likely_axis(family, p, u)
        clamp_axis(axis_field, u)
    return log_objective(family, p, u, logs, f)


@inner_kernel
def surround(points, margin, box_low, box_high):
    """Replace the infinite faces of a box by those of a box around the points: where to look first."""
    for i in range(3):
        least, most = points[0, i], points[0, i]
        for j in range(points.shape[0]):
            least, most = min(least, points[j, i]), max(most, points[j, i])
        if not math.isfinite(box_low[i]):
            box_low[i] = least - margin - (most - least)
        if not math.isfinite(box_high[i]):
            box_high[i] = most + margin + (most - least)


@kernel
def draw(shift, number, box_low, box_high, p):
    """Fill the position of one number of the golden-ratio sequence, every other one on the box's floor."""
    for i in range(3):
        s = shift[i] + number / _GOLDEN ** (i + 1)
        s -= math.floor(s)
        if i == 2 and number % 2 == 0:
            s = 0.0  # the optimum is often on the floor
        p[i] = box_low[i] + s * (box_high[i] - box_low[i])


@heap_kernel
def search(family, domain, axis_field, landmarks, shift, settings, best_p, best_u, best_z):
    """Fill the best pose found; return its smallest log ratio, the polished starts and the evaluations made.

    Args:
        family: arrays of the family.
        domain: box, keep-out balls and forbidden pieces; the altitude is bounded.
        axis_field: kind, offset and matrix, as ``AxisField.arrays`` has them.
        landmarks: (m, 3) positions polished first, each after being moved into the domain.
        shift: (3,) offset in [0, 1) of the low-discrepancy sequence: the seed.
        settings: how hard to try, a ``SearchSettings``.
        best_p: output, (3,).
        best_u: output, (3,).
        best_z: output, (ratios,) or (pairs,): their multipliers at that pose.
    """
    f, logs = np.empty(family.numerator_isotropic.shape[0]), np.empty(family.denominator_isotropic.shape[0])
    z, p, u, box_low, box_high = np.empty(best_z.shape[0]), scratch(3), scratch(3), scratch(3), scratch(3)
    size = max(settings.coarse, landmarks.shape[0])
    poses, values = np.empty((size, 6)), np.empty(size)
    best = -math.inf
    starts = evaluations = idle = 0
    for lap in range(settings.rounds + 1):  # the first is the landmarks'
        judged = landmarks.shape[0] if lap == 0 else settings.coarse
        cut_box(family, domain.low_m, domain.high_m, best - 1e-12, box_low, box_high)
        margin = domain.high_m[2] - domain.low_m[2] + 10.0 * domain.keep_out_m
        surround(family.points_m, margin, box_low, box_high)
        for c in range(judged):
            if lap == 0:
                copy_into(landmarks[c], p)
            else:
                draw(shift, (lap - 1) * judged + c + 1, box_low, box_high, p)
            values[c] = -math.inf
            if push_out(p, domain):
                values[c] = start_axis(family, axis_field, p, u, logs, f)
                copy_into(p, poses[c])
                copy_into(u, poses[c, 3:])
                evaluations += 1
        before = best
        for _ in range(min(settings.landmarks if lap == 0 else settings.polished, judged)):
            c = np.argmax(values[:judged])
            if not values[c] > -math.inf:
                break
            values[c] = -math.inf
            copy_into(poses[c, :3], p)
            copy_into(poses[c, 3:], u)
            value, steps = polish(family, domain, axis_field, p, u, _MU_START, np.int64(_MAX_STEPS), z)
            if value > best:
                best = value
                copy_into(p, best_p)
                copy_into(u, best_u)
                copy_into(z, best_z)
            starts += 1
            evaluations += steps
        if lap > 0 and best > -math.inf:
            idle = 0 if best > before + _LEAST_GAIN else idle + 1
            if idle >= settings.patience:
                break
    return best, starts, evaluations


@heap_kernel
def search_and_climb(
    family, domain, axis_field, landmarks, shift, settings, climbs, most_steps, best_p, best_u, best_z
):
    """Fill the best pose of a search and of climbs from it; return its value, the starts and the evaluations.

    Along a flat, curved ridge the search's own steps may not suffice.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        landmarks: (m, 3) positions polished first, each after being moved into the domain.
        shift: (3,) offset in [0, 1) of the low-discrepancy sequence: the seed.
        settings: how hard the search tries; with fewer than no rounds it is left out, and the pose that is
            given is climbed from.
        climbs: first barrier weights of the climbs, in units of the log ratio.
        most_steps: of each climb.
        best_p: (3,) in and out.
        best_u: (3,) in and out.
        best_z: output, (ratios,) or (pairs,): their multipliers at that pose.
    """
    value, starts, evaluations = search(
        family, domain, axis_field, landmarks, shift, settings, best_p, best_u, best_z
    )
    if settings.rounds >= 0 and not math.isfinite(value):
        return value, starts, evaluations
    for mu in climbs:
        before = value
        value, steps = polish(family, domain, axis_field, best_p, best_u, mu, most_steps, best_z)
        evaluations += steps
        if steps < most_steps and value <= before + _LEAST_CLIMB:
            break
    return value, starts, evaluations
