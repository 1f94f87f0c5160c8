"""Search and proof of many families in one call: the same steps as for one, without a return to Python.

What a run in Python does in stages, with a clock and with threads, is left to it: a family whose proof takes
more nodes than are given is handed back.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.family.records import Domain, Ratios
from nullpose.solve.kernels.branch import BETTER, DONE, EARLY, FULL, LATE, branch, may_have_gaps
from nullpose.solve.kernels.expansion import min_distance
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.links import min_log_ratio
from nullpose.solve.kernels.node import CENTRE, COLUMNS, FACE, HALF, keep_largest
from nullpose.solve.kernels.polish import polish
from nullpose.solve.kernels.scratch import scratch, zeroed
from nullpose.solve.kernels.search import cut_box, search
from nullpose.solve.kernels.symmetric import copy_into

__all__ = ["OPEN", "PROVED", "UNPLACED", "solve_and_prove_many"]

OPEN = 0
PROVED = 1
UNPLACED = 2

_CLIMB_STEPS = 300
_SAME = 1e-12
_HAIR = 1e-9


@inner_kernel
def find(family, domain, axis_field, landmarks, shift, effort, climbs, p, u, z):
    """Fill the best pose of a search and of a last climb; return its smallest log ratio."""
    value, _, _ = search(family, domain, axis_field, landmarks, shift, effort, p, u, z)
    if not math.isfinite(value):
        return value
    for mu in climbs:
        before = value
        value, steps = polish(family, domain, axis_field, p, u, mu, np.int64(_CLIMB_STEPS), z)
        if steps < _CLIMB_STEPS and value <= before + _SAME:
            break
    return value


@inner_kernel
def reach(family, low, high, keep_out_m):
    """Return what no ratio can exceed at all: the bound of the most distant point."""
    points, n0, nw = family.points_m, family.numerator_isotropic, family.numerator_weight
    npt, den, d0 = family.numerator_point, family.denominator_of, family.denominator_isotropic
    zero, here = zeroed(3), scratch(3)
    least = math.inf
    for k in range(nw.shape[0]):
        for i in range(3):
            here[i] = min(max(points[npt[k], i], low[i]), high[i])
        a = max(min_distance(points, npt[k], here, zero), keep_out_m)
        least = min(least, (n0[k] + nw[k] / (a * a)) / d0[den[k]])
    return least * (1.0 + _HAIR)


@inner_heap_kernel
def fill_root(family, domain, log_value, target, favourite, row):
    """Fill the box outside which no pose reaches the incumbent."""
    low, high = scratch(3), scratch(3)
    level = log_value
    if np.any(family.numerator_isotropic != 0.0):  # ratios tend to one far away, however little that is
        level += math.log1p(target)
    level -= _HAIR if level > 1e-6 or level < 0.0 else 1e-3 * level
    cut_box(family, domain.low_m, domain.high_m, level, low, high)
    copy_into(favourite, row)
    for i in range(3):
        row[CENTRE + i] = 0.5 * (low[i] + high[i])
        row[HALF + i] = 0.5 * (high[i] - low[i]) * (1.0 + 1e-12)
    row[FACE] = -1.0


@inner_heap_kernel
def fill_favourite(z, favourite):
    """Fill a row with the multipliers at the incumbent."""
    weights = z.copy()
    favourite[:] = 0.0
    keep_largest(weights, weights.shape[0], favourite)


@inner_heap_kernel
def prove(family, domain, axis_field, log_value, target, axes_above, most, p, u, z, stack, leaves):
    """Return (whether all above the target is excluded, the incumbent's log value, the nodes worked off)."""
    favourite = scratch(COLUMNS)
    fill_favourite(z, favourite)
    fill_root(family, domain, log_value, target, favourite, stack[0])
    logs, f = np.empty(family.denominator_isotropic.shape[0]), np.empty(z.shape[0])
    better_p, better_u, trial = scratch(3), scratch(3), np.empty(z.shape[0])
    top, nodes = np.int64(1), np.int64(0)
    doubt = 0.0
    while nodes < most:
        value = math.exp(log_value)
        code, top, _, done, _ = branch(
            family, domain, axis_field, value * (1.0 + target), value * (1.0 + doubt), favourite, axes_above,
            stack, top, leaves, np.int64(0), most - nodes, better_p, better_u,
        )  # fmt: skip
        nodes += done
        if code == DONE:
            return True, log_value, nodes
        if code == FULL and top + 3 > stack.shape[0]:
            break
        if code == BETTER:
            start = min_log_ratio(family, better_p, better_u, logs, f)
            q, v = better_p.copy(), better_u.copy()
            found, _ = polish(family, domain, axis_field, q, v, 0.01, np.int64(100), trial)
            if found < start:
                found = start
                copy_into(better_p, q)
                copy_into(better_u, v)
            if found > log_value:
                log_value = found
                copy_into(q, p)
                copy_into(v, u)
                copy_into(trial, z)
                fill_favourite(z, favourite)
            else:  # the two evaluations differ in their rounding: do not ask again
                doubt = max(1e-9, 10.0 * doubt)
    return False, log_value, nodes


@inner_heap_kernel
def prove_directly(family, domain, axis_field, log_value, target, budget, p, u, z, stack, leaves):
    """Return what ``prove`` does, with axes split late first where that may help, then early."""
    late, early, most = budget
    shown, nodes = False, np.int64(0)
    if may_have_gaps(family, axis_field):
        shown, log_value, nodes = prove(
            family, domain, axis_field, log_value, target, LATE, min(late, most), p, u, z, stack, leaves
        )
    if not shown:
        more = min(early, most - nodes)
        shown, log_value, done = prove(
            family, domain, axis_field, log_value, target, EARLY, more, p, u, z, stack, leaves
        )
        nodes += done
    return shown, log_value, nodes


@heap_kernel
def solve_and_prove_many(
    shape, varied, domain, keep_points, axis_field, landmarks, shift, effort, climbs, target, budget,
    positions, axes, multipliers, log_values, bounds, nodes, codes,
):  # fmt: skip
    """Fill the best pose of every family that is not solved yet, and the bound that was proved.

    Args:
        shape: what the families share: numerator point, denominator of each ratio, start and point of its
            entries, turn.
        varied: what they do not, (s, ...) each: points, isotropic and weight of the numerators, isotropic and
            weight of the denominators.
        domain: box, no keep-out points, their radius, forbidden pieces and zones.
        keep_points: (s, q, 3).
        axis_field: kind, offset and matrix.
        landmarks: (s, m, 3) positions polished first.
        shift: (3,) offset of the low-discrepancy sequence.
        effort: coarse, polished, rounds and patience of the search.
        climbs: barrier weights of the last climb.
        target: relative gap to be proved; negative: nothing is.
        budget: nodes of a try in which axes are split late, of one in which they are split early, and of all;
            a family that needs more stays open.
        positions: (s, 3) in and out.
        axes: (s, 3) in and out.
        multipliers: (s, r) in and out.
        log_values: (s,) in and out: minus infinity where a search is to be run.
        bounds: (s,) in and out: a bound known before, or infinity.
        nodes: (s,) output.
        codes: (s,) in and out: OPEN, PROVED or UNPLACED, where no position was found.
    """
    npt, den, dstart, dpt, turn = shape
    points, n0, nw, d0, dw = varied
    stack, leaves = np.empty((4096, COLUMNS)), np.empty((256, COLUMNS))
    for s in range(points.shape[0]):
        if codes[s] != OPEN:
            continue
        family = Ratios(points[s], n0[s], nw[s], npt, den, d0[s], dstart, dpt, dw[s], turn)
        here = Domain(
            domain.low_m, domain.high_m, keep_points[s], domain.keep_out_m, domain.piece_start,
            domain.piece_sides, domain.zone_kind, domain.zone_start, domain.zone_edges, domain.zone_range_m,
        )  # fmt: skip
        p, u, z = positions[s].copy(), axes[s].copy(), multipliers[s].copy()
        value = log_values[s]
        if value == -math.inf:
            value = find(family, here, axis_field, landmarks[s], shift, effort, climbs, p, u, z)
        if not math.isfinite(value):
            codes[s] = UNPLACED
            continue
        if target >= 0.0:
            bound = min(bounds[s], reach(family, here.low_m, here.high_m, here.keep_out_m))
            if bound <= math.exp(value) * (1.0 + target):
                codes[s] = PROVED
            else:
                shown, value, nodes[s] = prove_directly(
                    family, here, axis_field, value, target, budget, p, u, z, stack, leaves
                )
                if shown:
                    codes[s] = PROVED
                    bound = min(bound, math.exp(value) * (1.0 + target))
            bounds[s] = bound
        log_values[s] = value
        positions[s], axes[s], multipliers[s] = p, u, z
