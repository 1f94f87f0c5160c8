"""Whether no pose of a cell reaches a level, for an antenna with any pattern.

The ratios ``N_k / D_k`` are all below t wherever ``F = sum_k l_k (N_k - t D_k)`` is negative for
multipliers l of sum one. F is a weighted sum of ``g(b_j) / |r_j|^2`` over the ground points: expanded
to second order about the cell's middle with a bound on the third, and maximised over the cell coordinate
by coordinate. A channel multiplies it by an end of its excess gain over the cell: the largest for a node and
the least for an interferer.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.attitude import (
    ANCHOR,
    CHART,
    FACE,
    HALF,
    WARM,
    cyclic,
    direction_rate,
    fill_frame,
    in_body,
    move,
    rates,
    third,
)
from nullpose.solver.kernels.bounds.sight import excess_range
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.harmonics import cap_bounds, gain_at, gain_jet
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import (
    dot,
    norm,
    over,
    row as row_of,
    scaled,
    square_range,
    unit,
)
from nullpose.solver.kernels.search.pattern_search import quotient

_WIDEST = 1.0  # radians: directions in wider caps are not expanded
_ZENITH_M = 1e30  # metres to an anchor that no position changes the direction to
_HALVINGS = 14
_PACE = 2.0
_STEPS = 40

LEAST, MOST, REST = 0, 1, 2  # rows of a point's bounds over a cell
CONSTANT, NU, SIDE, BOUND, BY_NU = 0, 1, 2, 3, 4
"""Of the reach's term (:mod:`.tilt_reach`): its constant from above, its multiplier, and 1 or -1 for the
largest or the least angle; of the last sum that was bounded: the bound, and its slope by that multiplier."""


@inner_kernel
def vector_to(points, j, row):
    """Return the way from a cell's middle to a point, in the chart's order."""
    first = int(row[CHART])
    point, middle = cyclic(points[j], first), cyclic(row, first)
    return point[0] - middle[0], point[1] - middle[1], point[2] - middle[2]


@inner_kernel
def anchor_of(points, row):
    """Return the way from a cell's middle to its anchor, in the chart's order, and the least in the cell."""
    anchor = int(row[ANCHOR])
    if anchor < 0:
        return (0.0, 0.0, _ZENITH_M), _ZENITH_M
    near, _ = square_range(points[anchor], row, row[HALF:], 3)
    return vector_to(points, anchor, row), math.sqrt(near)


@inner_kernel
def fill_points(family, pattern, spins, row, space):
    """Fill every point's bounds over the cell.

    Of ``g / r^2``: least and largest over the cell, and a bound on the remainder of the second
    order, with a margin for rounding. Returns by how much any frame may turn in the cell, radians, and a
    bound on the remainder of a direction of the world.
    """
    points, caps = family.points_m, scratch(5)
    anchor_m, anchor_near_m = anchor_of(points, row)
    fill_frame(row, anchor_m, space.frame)
    reach = norm(row[HALF : HALF + 3])
    held, whole = rates(row, spins, reach, anchor_m, anchor_near_m)
    for j in range(points.shape[0]):
        a = in_body(space.frame, vector_to(points, j, row))
        near, far = square_range(points[j], row, row[HALF:], 3)
        e = reach / math.sqrt(near) if near > 0.0 else math.inf
        is_anchor = j == int(row[ANCHOR])
        width = held[0] if is_anchor else direction_rate(row, spins, space.frame, a, whole, e)
        cap_bounds(pattern, unit(a), min(width, math.pi), caps)
        least, most = -caps[0], caps[1]
        low, high = excess_range(family, j, row[:3], row[HALF : HALF + 3])
        end = space.excess[j] = high if space.is_numerator[j] > 0.0 else low
        space.wide[LEAST, j] = low * least / far if least >= 0.0 else high * least / near
        space.wide[MOST, j] = high * most / near if most >= 0.0 else low * most / far
        space.wide[REST, j] = math.inf
        is_sided = space.one_sided[j] > 0.0 or low == high  # one end of the excess bounds it
        # in wider cells the third derivative's bound is of no use
        if is_sided and width < _WIDEST and e < 0.5:
            turning = held if is_anchor else whole
            g0 = max(abs(least), abs(most))
            away = 0.0 if is_anchor else e
            rest = third(turning, width, e, away, g0, caps[2], caps[3], caps[4])
            below = (high - low) * max(0.0, -least)  # where a gain is negative the other end counts
            space.wide[REST, j] = (end * (rest + pattern.rounding) + below) / near
    return whole[0], (whole[2] + 3.0 * whole[1] * whole[0] + whole[0] ** 3) / 6.0


@inner_kernel
def weak_ratio(family, level, space):
    """Return a ratio that stays below a level by the bounds of its points over the cell, or -1."""
    for k in range(family.numerator_point.shape[0]):
        above, below = quotient(family, k, space.wide[MOST], space.wide[LEAST])
        if above < level * below * (1.0 - 1e-12):
            return k
    return -1


@inner_kernel
def middle(family, pattern, level, row, space):
    """Return the smallest ratio at a cell's middle, and whether it is to be expanded there.

    It is if some ratio with its remainders is below the level: no multipliers would do otherwise. Fills the
    points' values.
    """
    for j in range(family.points_m.shape[0]):
        a = in_body(space.frame, vector_to(family.points_m, j, row))
        square = dot(a, a)
        x, y, z = over(a, math.sqrt(square))
        value, rest = space.excess[j] * gain_at(pattern, x, y, z) / square, space.wide[REST, j]
        space.value[j] = value
        space.parts[j] = min(space.wide[MOST, j], value + rest)
        space.factor[j] = max(space.wide[LEAST, j], value - rest)
    least, promising = math.inf, False  # an expansion costs ten times as much as this look
    for k in range(family.numerator_point.shape[0]):
        above, below = quotient(family, k, space.parts, space.factor)
        promising = promising or above < level * below
        above, below = quotient(family, k, space.value, space.value)
        least = min(least, above / below)
    return least, promising


@inner_kernel
def expand(family, pattern, row, space):
    """Fill value, gradient and Hessian of every point's ``g / r^2`` at a cell's middle."""
    points, first = family.points_m, int(row[CHART])
    firsts, seconds, slopes, stiff = scratch(6, 3), scratch(6, 6, 3), scratch(3), scratch(3, 3)
    for j in range(points.shape[0]):
        a = in_body(space.frame, vector_to(points, j, row))
        square = dot(a, a)
        length, excess = math.sqrt(square), space.excess[j]
        move(space.frame, a, 1.0, firsts, seconds)
        space.value[j] = excess * gain_jet(pattern, over(a, length), slopes, stiff) / square
        p1, p2 = excess / (square * length), excess / (square * square)
        pull = scaled(p1, slopes)
        for m in range(6):
            i, f = (first + m) % 3 if m < 3 else m, row_of(firsts, m)
            space.slope[j, i] = dot(pull, f)
            pushed = scaled(p2, (dot(stiff[0], f), dot(stiff[1], f), dot(stiff[2], f)))
            for n in range(m, 6):
                k = (first + n) % 3 if n < 3 else n
                bend = dot(pushed, row_of(firsts, n)) + dot(pull, row_of(seconds[m], n))
                space.bend[j, i, k] = bend
                space.bend[j, k, i] = bend


@inner_kernel
def add_point(space, k, j, weight):
    """Add the constant of a point's ``g / r^2`` times a weight to that of ``N_k - t D_k``, from above.

    Where the bound over the cell alone is nearer than the expansion's remainder, it takes the place of both.
    """
    value, limit = space.value[j], space.wide[MOST, j] if weight > 0.0 else space.wide[LEAST, j]
    rest = space.wide[REST, j]
    if space.one_sided[j] and abs(limit - value) < rest:
        rest = abs(limit - value)
        for i in range(6):
            space.slope[j, i] = 0.0
            space.bend[j, i] = 0.0
    space.f[k] += weight * value + abs(weight) * rest
    space.rest[k] += abs(weight) * rest


@inner_kernel
def fill_constants(family, level, space):
    """Fill the constants of ``N_k - t D_k`` from above, and how much of them is remainder."""
    for k in range(family.numerator_point.shape[0]):
        g = family.denominator_of[k]
        space.f[k] = family.numerator_isotropic[k] - level * family.denominator_isotropic[g]
        space.rest[k] = 0.0
        add_point(space, k, family.numerator_point[k], family.numerator_weight[k])
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            add_point(space, k, family.denominator_point[e], -level * family.denominator_weight[e])


@inner_kernel
def weigh(family, level, multipliers, space):
    """Fill the factors of points and reach in ``sum_k l_k (N_k - t D_k) + nu h``; return its constant."""
    space.factor[:] = 0.0
    space.factor[-1] = space.reach[NU]
    total = space.reach[NU] * space.reach[CONSTANT]
    for k in range(multipliers.shape[0]):
        total += multipliers[k] * space.f[k]
        g = family.denominator_of[k]
        space.factor[family.numerator_point[k]] += multipliers[k] * family.numerator_weight[k]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            space.factor[family.denominator_point[e]] -= level * multipliers[k] * family.denominator_weight[e]
    return total


@inner_kernel
def upper(family, level, half, multipliers, space):
    """Return an upper bound of the sum over the cell, convex in l and nu; fill its slopes by both.

    With ``|x_i| <= h_i`` the Hessian's mixed terms are
    ``|x_i x_j| <= (x_i^2 h_j / h_i + x_j^2 h_i / h_j) / 2``: what is left is one parabola for each
    coordinate.
    """
    total = weigh(family, level, multipliers, space)
    slope, bend, parts, points = zeroed(6), zeroed(6, 6), space.parts, space.factor.shape[0]
    for j in range(points):
        c = space.factor[j]
        if c != 0.0:
            for i in range(6):
                slope[i] += c * space.slope[j, i]
                for n in range(i, 6):
                    bend[i, n] += c * space.bend[j, i, n]
    for i in range(6):
        h, mixed = half[i], 0.0
        if h == 0.0:
            space.at[i] = space.score[i] = 0.0
            continue
        for n in range(6):
            if n != i:
                mixed += abs(bend[min(i, n), max(i, n)]) * half[n] / h
        curve, x = bend[i, i] + mixed, h
        if curve < 0.0 and abs(slope[i]) < -curve * h:
            x = -abs(slope[i]) / curve
        total += abs(slope[i]) * x + 0.5 * curve * x * x
        space.score[i] = abs(slope[i]) * h + (abs(bend[i, i]) + mixed) * h * h
        space.at[i] = math.copysign(x, slope[i])
    # by Danskin's theorem the slopes by l are those at the maximum
    for i in range(6):
        for n in range(i + 1, 6):
            share = 0.0
            if half[i] > 0.0 and half[n] > 0.0:
                share = 0.5 * (space.at[i] ** 2 * half[n] / half[i] + space.at[n] ** 2 * half[i] / half[n])
            bend[n, i] = math.copysign(share, bend[i, n])
    for j in range(points):
        part = 0.0
        for i in range(6):
            part += space.slope[j, i] * space.at[i] + 0.5 * space.at[i] ** 2 * space.bend[j, i, i]
            for n in range(i + 1, 6):
                part += bend[n, i] * space.bend[j, i, n]
        parts[j] = part
    for k in range(multipliers.shape[0]):
        g = family.denominator_of[k]
        by = space.f[k] + family.numerator_weight[k] * parts[family.numerator_point[k]]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            by -= level * family.denominator_weight[e] * parts[family.denominator_point[e]]
        space.by_l[k] = by
    space.reach[BOUND] = total
    space.reach[BY_NU] = space.reach[CONSTANT] + parts[points - 1]
    return total


@inner_kernel
def excluded_by_sum(family, level, row, space):
    """Check whether some multipliers keep the sum negative over the cell; leave the last tried in its row."""
    multipliers, half = row[WARM:], row[HALF:FACE]
    if multipliers.shape[0] == 2:  # one number: bisection with tangents ends in a few steps, descent does not
        return two_multipliers(family, level, half, multipliers, space)
    return descended(family, level, half, multipliers, space)


@inner_kernel
def two_multipliers(family, level, half, multipliers, space):
    """Check whether two multipliers keep the sum negative: tried where both sides' tangents meet."""
    left, left_value, left_slope, right, right_value, right_slope = 0.0, 0.0, 0.0, 1.0, 0.0, 0.0
    for _ in range(_HALVINGS):
        x = multipliers[0]
        value = upper(family, level, half, multipliers, space)
        if value < 0.0:
            return True
        slope = space.by_l[0] - space.by_l[1]  # of a convex function of the first multiplier
        if slope < 0.0:
            left, left_value, left_slope = x, value, slope
        else:
            right, right_value, right_slope = x, value, slope
        if value + slope * ((1.0 if right_slope == 0.0 else right) - x) > 0.0 and slope < 0.0:
            return False
        if value + slope * ((0.0 if left_slope == 0.0 else left) - x) > 0.0 and slope >= 0.0:
            return False
        x = 0.5 * (left + right)
        if left_slope < 0.0 and right_slope > 0.0:
            step = (right_value - left_value + left_slope * left - right_slope * right) / (
                left_slope - right_slope
            )
            if left_value + left_slope * (step - left) > 0.0:
                return False  # convex: no less than where the tangents meet
            x = min(max(step, left + 0.1 * (right - left)), right - 0.1 * (right - left))
        elif left_slope < 0.0:
            x = min(1.0, left - 2.0 * left_value / left_slope)
        elif right_slope > 0.0:
            x = max(0.0, right - 2.0 * right_value / right_slope)
        multipliers[0], multipliers[1] = x, 1.0 - x
    return False


@inner_kernel
def descended(family, level, half, multipliers, space):
    """Check whether several multipliers keep the sum negative: mirror descent, the best of which is left."""
    n = multipliers.shape[0]
    least = math.inf
    for step in range(_STEPS):
        value = upper(family, level, half, multipliers, space)
        if value < 0.0:
            return True
        # the slopes by the multipliers tell how far any others could lower a convex function
        low, high, mean = math.inf, -math.inf, 0.0
        for k in range(n):
            low, high = min(low, space.by_l[k]), max(high, space.by_l[k])
            mean += multipliers[k] * space.by_l[k]
        if value < least:
            least = value
            copy_into(multipliers, space.best)
        if value + low - mean > 0.0:
            break  # convex: no multipliers do better than this
        size, total = _PACE / ((high - low) * math.sqrt(1.0 + step)), 0.0
        for k in range(n):
            # none may stay at zero, which a product never leaves
            multipliers[k] = max(1e-9, multipliers[k]) * math.exp(-size * (space.by_l[k] - low))
            total += multipliers[k]
        for k in range(n):
            multipliers[k] /= total
    copy_into(space.best, multipliers)
    return False
