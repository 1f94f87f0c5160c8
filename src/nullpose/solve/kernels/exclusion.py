"""The test that excludes a box of a free axis: a weighted sum of forms that is negative all over its box.

Multipliers ``lambda`` (one per ratio, summing to one) and ``mu`` (one per side of the cell, one for the band)
exclude a box at a level t if ``sum_k lambda_k (N_k(p) - t D_k(p)) + sum_q mu_q Q_q`` is negative definite for
every position p in it: then no pose there has all its ratios at t or above. The matrix is bounded by its
first-order expansion at the eight corners plus a second-order remainder, with a margin for rounding. Where
all axes are level, it only needs to be negative definite in the level plane.
"""

from __future__ import annotations

import math

from nullpose.solve.kernels.borders import border_sum, borders, choose_border
from nullpose.solve.kernels.box import (
    ANCHOR,
    BALL,
    CENTRE,
    COUNT,
    FAR,
    HALF,
    INDEX,
    KEPT_OUT,
    LEVEL,
    NU,
    WEIGHT,
)
from nullpose.solve.kernels.cells import CONSTRAINTS, constraint, constraint_multiplier, is_level
from nullpose.solve.kernels.denominators import (
    ROUNDING,
    add_mixed_denominators,
    add_scaled,
    sharpen,
)
from nullpose.solve.kernels.expansion import expand_point, min_distance
from nullpose.solve.kernels.forms import congruence, form_value
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.records import WORLD
from nullpose.solve.kernels.scratch import scratch, scratch_int, zeroed
from nullpose.solve.kernels.symmetric import copy_table, top_eigenvector
from nullpose.solve.kernels.zones import MOST_ALTERNATIVES

__all__ = ["excludes", "out_of_reach", "will_fail"]

_HOPED = 0.7  # of a remainder: a part with multipliers of its own does better than is foreseen
_DEFINITE = 1e-13  # minors, relative to the products that they are made of


@inner_kernel
def negative_over(linear, everywhere, across, middle, half, level_axes):
    """Return whether a linear matrix and its remainder are negative definite at all corners of a box.

    Args:
        linear: (4, 6) a form at a point, and its slopes.
        everywhere: isotropic remainder.
        across: remainder on the first two axes besides.
        middle: (3,) the box's centre, from that point.
        half: (3,) its half sides.
        level_axes: whether only horizontal axes count.
    """
    for corner in range(8):
        x = middle[0] + (half[0] if corner & 1 else -half[0])
        y = middle[1] + (half[1] if corner & 2 else -half[1])
        z = middle[2] + (half[2] if corner & 4 else -half[2])
        a0 = everywhere + across + linear[0, 0] + x * linear[1, 0] + y * linear[2, 0] + z * linear[3, 0]
        a1 = everywhere + across + linear[0, 1] + x * linear[1, 1] + y * linear[2, 1] + z * linear[3, 1]
        a3 = linear[0, 3] + x * linear[1, 3] + y * linear[2, 3] + z * linear[3, 3]
        minor = a0 * a1 - a3 * a3
        if not (a0 < 0.0 and minor > _DEFINITE * a0 * a1):
            return False
        if not level_axes:
            a2 = everywhere + linear[0, 2] + x * linear[1, 2] + y * linear[2, 2] + z * linear[3, 2]
            a4 = linear[0, 4] + x * linear[1, 4] + y * linear[2, 4] + z * linear[3, 4]
            a5 = linear[0, 5] + x * linear[1, 5] + y * linear[2, 5] + z * linear[3, 5]
            det = -a2 * minor + a0 * a5 * a5 + a1 * a4 * a4 - 2.0 * a3 * a4 * a5
            if not det > -_DEFINITE * a0 * a1 * a2:
                return False
    return True


@inner_kernel
def will_fail(forecast, row, part, level_axes):
    """Return whether a part of a row's box will fail, by what the row's multipliers come to there."""
    middle, half = scratch(3), part[HALF:LEVEL]
    whole = square = 0.0
    for i in range(3):
        middle[i] = part[CENTRE + i] - row[CENTRE + i]
        whole += row[HALF + i] ** 2
        square += half[i] ** 2
    share, rests = _HOPED * square / whole, forecast.rests
    return not negative_over(forecast.linear, share * rests[0], share * rests[1], middle, half, level_axes)


@inner_kernel
def add_turned(form, weight, frame, matrix, matrix_slopes):
    """Add a weighted form of the world, turned into the frame, and its slopes; return its remainder."""
    q, basis = scratch(6), frame.basis
    congruence(form, basis, q)
    for m in range(6):
        matrix[m] += weight * q[m]
    if frame.kind == WORLD:
        return 0.0
    for i in range(3):
        x, y = basis[i, 0] / frame.radius_m, basis[i, 1] / frame.radius_m
        matrix_slopes[i, 0] += weight * 2.0 * x * q[4]
        matrix_slopes[i, 1] += weight * 2.0 * y * q[5]
        matrix_slopes[i, 2] -= weight * 2.0 * (x * q[4] + y * q[5])
        matrix_slopes[i, 3] += weight * (y * q[4] + x * q[5])
        matrix_slopes[i, 4] += weight * (x * (q[2] - q[0]) - y * q[3])
        matrix_slopes[i, 5] += weight * (y * (q[2] - q[1]) - x * q[3])
    size = q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + 2.0 * (q[3] ** 2 + q[4] ** 2 + q[5] ** 2)
    return weight * 2.4143 * math.sqrt(2.0 * size) / (frame.least_radius_m * frame.least_radius_m)


@inner_kernel
def add_numerators(family, axis_field, frame, row, matrix, slopes):
    """Add the numerators, the cell's sides and the band with the row's multipliers; return the remainder."""
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    form, form_slopes = scratch(6), scratch(3, 6)
    radius = 0.5 * (half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    everywhere = 0.0
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        weight = row[WEIGHT + s]
        isotropic, strength = family.numerator_isotropic[k], family.numerator_weight[k]
        j = family.numerator_point[k]
        up, _ = expand_point(family, j, frame, centre, half, form, form_slopes)
        add_scaled(weight * strength, form, form_slopes, matrix, slopes)
        for m in range(3):
            matrix[m] += weight * isotropic
        size = isotropic + strength * (form[0] + form[1] + form[2])
        everywhere += weight * (radius * strength * up + ROUNDING * size)
    for q in range(CONSTRAINTS):
        weight = constraint_multiplier(row, q)
        if weight > 0.0:
            _, isotropic = constraint(axis_field, row, q, form)
            for m in range(3):
                matrix[m] += weight * isotropic
            everywhere += radius * add_turned(form, weight, frame, matrix, slopes)
            everywhere += 4.0 * ROUNDING * weight  # entries are at most 1
    return everywhere


@inner_kernel
def excludes(family, domain, axis_field, frame, row, below, forecast):
    """Return whether the row's multipliers exclude its box and cell.

    Args:
        family: arrays of the family.
        domain: box, keep-out balls, forbidden pieces and zones.
        axis_field: kind, offset and matrix; a free axis, perhaps within a band.
        frame: at the box's centre.
        row: the box; if a keep-out ball reaches into its box, that constraint's multiplier is filled.
        below: ``-t D`` with its slopes, (4, 6), and its remainders, from ``expand_denominator``, if there is
            one denominator for all.
        forecast: output: ``linear`` and ``rests`` of the sum, for ``will_fail``.
    """
    if not row[COUNT] > 0.0:
        return False
    linear, middle, half, level_axes = forecast.linear, zeroed(3), row[HALF:LEVEL], is_level(axis_field)
    copy_table(below[0], linear)
    less, across = below[1]
    if family.denominator_isotropic.shape[0] > 1:  # then what is below is zero
        less, across = add_mixed_denominators(family, frame, row, linear[0], linear[1:])
    everywhere = less + add_numerators(family, axis_field, frame, row, linear[0], linear[1:])
    forecast.rests[0], forecast.rests[1], row[NU] = everywhere, across, 0.0
    if negative_over(linear, everywhere, across, middle, half, level_axes):
        return True
    sharp = scratch(4, 6)
    copy_table(linear, sharp)
    for m in range(3):
        sharp[0, m] += everywhere + (across if m < 2 else 0.0)
    # sharpening takes the denominators' remainder away at best
    if negative_over(linear, everywhere - less, across, middle, half, level_axes):
        if level_axes:  # what is off the level plane does not count
            sharp[0, 2] = -2.0 * (abs(sharp[0, 0]) + abs(sharp[0, 1]) + abs(sharp[0, 3]))
            sharp[0, 4] = sharp[0, 5] = 0.0
        sharpen(family, frame, row, sharp[0], sharp[1:])
        if negative_over(sharp, 0.0, 0.0, middle, half, level_axes):
            return True
    return row[BALL] >= 0.0 and excludes_allowed(domain, row, sharp, level_axes)


@inner_kernel
def excludes_allowed(domain, row, linear, level_axes):
    """Return whether a linear matrix is negative wherever a border allows positions; fill its multiplier."""
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    alternatives = borders(domain, row, sides, counts)
    v, gradient, border, bent, half = scratch(3), scratch(3), scratch(7), scratch(4, 6), row[HALF:LEVEL]
    if level_axes:
        linear[0, 2], linear[0, 4] = min(linear[0, 0], linear[0, 1]) - abs(linear[0, 3]), 0.0
        linear[0, 5] = 0.0
    top_eigenvector(linear[0], v)
    for i in range(3):
        gradient[i] = form_value(linear, 1 + i, v)
    for a in range(alternatives):
        if not border_sum(domain, row, sides[a], counts[a], gradient, border):
            return False
        copy_table(linear, bent)
        for m in range(3):
            bent[0, m] += border[0]
            for i in range(3):
                bent[0, m] += 0.5 * border[4 + i] * half[i] ** 2
                bent[1 + i, m] += border[1 + i]
        if not negative_over(bent, 0.0, 0.0, zeroed(3), half, level_axes):
            return False
    return alternatives > 0


@inner_kernel
def out_of_reach(family, domain, row):
    """Return the kind of a box that needs no multipliers, too far or forbidden, or -1; fill its border."""
    keep_points, keep_radius = domain.keep_out_points_m, domain.keep_out_m
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    for k in range(family.numerator_weight.shape[0]):
        a = min_distance(family.points_m, family.numerator_point[k], centre, half)
        least = row[LEVEL] * family.denominator_isotropic[family.denominator_of[k]]
        if (family.numerator_isotropic[k] - least) * a * a + family.numerator_weight[k] < 0.0:
            row[ANCHOR] = k  # not where the multipliers are: a later stage begins with them
            return FAR
    for q in range(keep_points.shape[0]):
        d = 0.0
        for i in range(3):
            d += (abs(keep_points[q, i] - centre[i]) + half[i]) ** 2
        if d < keep_radius * keep_radius:
            row[ANCHOR] = q
            return KEPT_OUT
    zone = choose_border(domain, row)
    if zone >= 0:
        row[ANCHOR] = zone
        return KEPT_OUT
    return -1
