"""New multipliers for a box of a free axis: from the dual at its centre."""

from __future__ import annotations

import math

import numpy as np

from nullpose.problem.records import BAND_AXIS
from nullpose.solver.kernels.bounds.ascent import POOL, Pool, ascend, lowest_missing, put_weights
from nullpose.solver.kernels.bounds.exclusion import has_horizontal_axes
from nullpose.solver.kernels.bounds.node import (
    BALL,
    BAND,
    CELL,
    CENTRE,
    COUNT,
    FACE,
    HALF,
    LEVEL,
    SIDE,
    TOUCH,
    keep_largest,
)
from nullpose.solver.kernels.bounds.whitened import (
    axis_of,
    constraint_forms,
    fill_values,
    ratio_form,
    whiten,
    whiten_axis,
    wider_band,
)
from nullpose.solver.kernels.compiler.jit import inner_heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int
from nullpose.solver.kernels.linear_algebra.dual import dual_multipliers, positive_definite
from nullpose.solver.kernels.linear_algebra.forms import congruence, smallest_form
from nullpose.solver.kernels.linear_algebra.links import log_objective, log_quotient, row_count
from nullpose.solver.kernels.linear_algebra.pair_dual import pair_multipliers
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_square,
    copy_into,
    fill_identity,
    form_product,
    top_eigenvector,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot
from nullpose.solver.kernels.search.local_coordinates import clamp_axis

_MANY = 16  # ratios that are taken at first, if there are more
_FEW = 6  # and in each later round at most
_ROUNDS = 5
_SLIGHT = 1e-3
_FINE = 1e-5  # accuracy of the multipliers
_FINEST = 1e-10  # and at one position
_LOOSE = 0.03  # and in units of a box's size
_INTERIOR = 0.01  # and of an interior point's, likewise
_BARELY = 1e-9
_NEARLY = 1e-2  # short of requirements beyond which these need no help from the mean to exclude a box
_EASED = 0.2  # of a box's size: by how much requirements that no form meets are eased beyond what one meets
_STRICTER = 1e-4  # than required, so that an axis near the form's is likely to meet what is required
_MET = 1.001  # times a requirement, from where on a form leaves room enough inside it
_GRID = 9  # of lines across a cell


@inner_kernel
def add_axis(basis, back, u, start):
    """Add the whitened square of an axis to a matrix."""
    w = scratch(3)
    whiten_axis(basis, back, u, w)
    add_square(1.0 / dot(w, w), w, start)


@inner_kernel
def add_band_axes(basis, back, row, least, greatest, along, start):
    """Add the whitened squares of axes inside both a cell and a band.

    On lines across the cell, of which the band leaves an interval or two of the side ``along``.
    """
    face, other = int(row[FACE]), 1 - along
    u = scratch(3)
    for line in range(_GRID):
        low, high = row[CELL + 2 * other], row[CELL + 2 * other + 1]
        x = low + (high - low) * (0.02 + 0.96 * line / (_GRID - 1))
        if face == 2:  # u_z = 1: the squares of the others sum to 1 / u_z^2 - 1
            bottom = 1.0 / greatest - 1.0 - x * x
            top = (1.0 / least - 1.0 if least > 0.0 else 2.0) - x * x
        else:
            bottom = least / (1.0 - least) * (1.0 + x * x)
            top = (greatest / (1.0 - greatest) if greatest < 0.5 else 2.0) * (1.0 + x * x)
        far, near = math.sqrt(max(0.0, top)), math.sqrt(max(0.0, bottom))
        for sign in range(2):
            a = max(near if sign else -far, row[CELL + 2 * along])
            b = min(far if sign else -near, row[CELL + 2 * along + 1])
            for part in range(2 if b > a else 0):
                u[face] = 1.0
                u[(face + 1 + other) % 3] = x
                u[(face + 1 + along) % 3] = a + (0.25 if part else 0.75) * (b - a)
                add_axis(basis, back, u, start)


@inner_kernel
def cell_start(axis_field, basis, back, row, coarseness, start):
    """Fill a positive definite matrix of unit trace inside the row's cell and band; return whether there is.

    In whitened coordinates: the mean of the squares of axes inside. None may have been met in a thin cell.
    """
    face, has_band, is_horizontal = (
        int(row[FACE]),
        axis_field.kind >= BAND_AXIS,
        has_horizontal_axes(axis_field),
    )
    start[:] = 0.0
    if face < 0 and (is_horizontal or not has_band):
        start[:3] = 1.0 / 3.0
        return True
    least, greatest = wider_band(axis_field, row, coarseness)
    u = scratch(3)
    if face < 0:
        for turn in range(12):
            share = least + (greatest - least) * (0.25 if turn & 1 else 0.75)
            across, azimuth = math.sqrt(1.0 - share), turn * math.pi / 3.0
            u[0], u[1] = across * math.cos(azimuth), across * math.sin(azimuth)
            u[2] = math.sqrt(share) if turn < 6 else -math.sqrt(share)
            add_axis(basis, back, u, start)
    elif has_band and not is_horizontal:
        if face != 1:
            add_band_axes(basis, back, row, least, greatest, 1 if face == 0 else 0, start)
        if face != 0:
            add_band_axes(basis, back, row, least, greatest, 1 if face == 2 else 0, start)
    else:
        for corner in range(5):
            u[face] = 1.0
            for side in range(2):
                low, wide = row[CELL + 2 * side], row[CELL + 2 * side + 1] - row[CELL + 2 * side]
                fraction = 0.5 if corner == 4 else (0.02 if (corner >> side) & 1 else 0.98)
                u[(face + 1 + side) % 3] = low + fraction * wide
            if is_horizontal:
                u[2] = 0.0
            add_axis(basis, back, u, start)
    if is_horizontal:
        start[2] += 0.1
    trace = start[0] + start[1] + start[2]
    for m in range(6):
        start[m] /= trace
    return positive_definite(start)


@inner_kernel
def take_smallest(forms, every, below, most, pool, sides, total):
    """Add the ratios lowest at a matrix, if below a value, to the pool; return how many forms there are."""
    for _ in range(min(most, POOL - total)):
        ratio = lowest_missing(every, below, pool, sides, total)
        if ratio < 0:
            break
        copy_into(forms[ratio], pool.forms[total])
        pool.members[total] = ratio
        total += 1
    return total


@inner_kernel
def sparse_dual(forms, every, sides, total, level, stop, gap, start, pool, matrix, shares):
    """Return the dual's primal value and how many forms it took: few at a time if there are many.

    Begins with the pool and the ratios smallest at the start, and adds what turns out to be smaller. Of no
    mean: the shares are (0,).
    """
    copy_into(start, matrix)
    below, found, counted = math.inf, math.inf, np.int64(0)
    for _ in range(_ROUNDS):
        for k in range(every.shape[0]):
            every[k] = form_product(forms[k], matrix)
        total = take_smallest(forms, every, below, max(_FEW, _MANY + sides - total), pool, sides, total)
        if total == counted:
            break
        found = dual_multipliers(
            pool.forms, sides, total, level, stop, gap, start, pool.shares, matrix, shares, 0.0
        )
        below, counted = found - _SLIGHT * level, total
    return found, total


@inner_kernel
def multiplier_accuracy(coarseness):
    """Choose the accuracy of an interior point's multipliers: less where a box is large.

    Multipliers as inaccurate as the box is large exclude a box so small no sooner than its halves, for ever.
    """
    return max(_INTERIOR * coarseness, min(_FINE, max(_FINEST, coarseness)))


@inner_heap_kernel
def interior_multipliers(
    family, axis_field, basis, row, whitening, pool, sides, total, coarseness, every, weights, v
):
    """Fill the dual's multipliers and the axis that its matrix suggests; return the primal value."""
    ratios, level = every.shape[0], row[LEVEL]
    matrix, start, forms = scratch(6), scratch(6), np.empty((ratios, 6))
    if not cell_start(axis_field, basis, whitening[2], row, coarseness, start):
        return math.inf
    for k in range(ratios):
        ratio_form(family, has_horizontal_axes(axis_field), basis, row, whitening, k, forms[k])
    accuracy, shares = multiplier_accuracy(coarseness), family.shares
    primal, total = sparse_dual(
        forms, every, sides, total, level, level, accuracy, start, pool, matrix, shares
    )
    top_eigenvector(matrix, v)
    _, reached = smallest_form(forms, v)
    if primal > level and primal - reached > coarseness * level:
        # stopped early, so the axis is a poor one: finish, to see whether there is a duality gap at all
        met, total = sparse_dual(
            forms, every, sides, total, level, math.inf, 1e-4, start, pool, matrix, shares
        )
        primal = max(primal, met)  # which may be less accurate
        top_eigenvector(matrix, v)
    put_weights(pool, sides, total, ratios, weights)
    return primal


@inner_kernel
def fill_constraints(shares, sides, places, row):
    """Fill the multipliers of the cell's sides and of the band into a row."""
    row[SIDE] = row[SIDE + 1] = row[BAND] = 0.0
    for c in range(sides):
        row[abs(places[c])] += math.copysign(shares[c], places[c])


@inner_heap_kernel
def touching_form(family, axis_field, basis, row, whitening, pool, sides, coarseness, v):
    """Fill the form at which a mean's tangent is best, and multipliers; return their value and if it is met.

    The value is minus infinity if no axis was met inside the row's cell and band. Where no form meets the
    requirements, these are eased until one does; or their multipliers stand alone, where that bounds more.
    """
    ratios, start, matrix = family.shares.shape[0], scratch(6), scratch(6)
    row[COUNT], row[TOUCH:BALL] = 0.0, 0.0
    if not cell_start(axis_field, basis, whitening[2], row, coarseness, start):
        return -math.inf, False
    is_horizontal, accuracy = has_horizontal_axes(axis_field), multiplier_accuracy(coarseness)
    required, share, is_met, alone = np.flatnonzero(family.requirements), 1.0, True, math.inf
    first = sides + required.shape[0]
    forms, multipliers, weights = np.empty((first + ratios, 6)), np.empty(first + ratios), np.zeros(ratios)
    for k in range(first + ratios):
        if k < sides:
            copy_into(pool.forms[k], forms[k])
        else:
            of = required[k - sides] if k < first else np.int64(k - first)
            ratio_form(family, is_horizontal, basis, row, whitening, of, forms[k])
            forms[k, 2] = 0.0 if is_horizontal else forms[k, 2]
    if first > sides:
        for k in range(sides, first):
            for m in range(6):
                forms[k, m] /= family.requirements[required[k - sides]]
        met = dual_multipliers(
            forms, sides, first, 1.0, _MET, accuracy, start, multipliers, matrix, family.shares[:0], 0.0
        )
        is_met, alone = met > 1.0 + _BARELY, math.log(max(met, 1e-290) * row[LEVEL])
        keep_required(family, required, sides, multipliers, pool, weights, row)
        if met < 1.0 - max(_NEARLY, coarseness):
            return alone, False
        share = met * (1.0 - max(_STRICTER, _EASED * coarseness))
        if is_met:
            share = 1.0 + min(_STRICTER, 0.5 * (met - 1.0))
        copy_into(matrix, start)
        for k in range(sides, first):
            for m in range(3):
                forms[k, m] -= 0.0 if is_horizontal and m == 2 else share
    found = dual_multipliers(
        forms, first, first + ratios, 1.0, math.inf, accuracy, start, multipliers, matrix, family.shares,
        family.offset,
    )  # fmt: skip
    for k in range(sides, first):  # the value at what is required, for which the multipliers hold as well
        found += multipliers[k] * (share - 1.0)
    if not (is_met or found < alone):
        return alone, False
    keep_required(family, required, sides, multipliers, pool, weights, row)
    keep_form(matrix, basis, whitening[2], row, v)
    return found, is_met


@inner_kernel
def keep_form(matrix, basis, back, row, v):
    """Keep a form, out of whitened coordinates and out of the frame, in a row; fill its top eigenvector."""
    turn = scratch(3, 3)
    top_eigenvector(matrix, v)
    for i in range(3):
        for m in range(3):
            turn[m, i] = dot(basis[i], back[:, m])
    congruence(matrix, turn, row[TOUCH:BALL])


@inner_kernel
def keep_required(family, required, sides, multipliers, pool, weights, row):
    """Keep the multipliers of constraints: of the cell's sides, and of requirements, over these."""
    weights[:] = 0.0
    copy_into(multipliers[:sides], pool.shares)
    for i in range(required.shape[0]):
        weights[required[i]] = multipliers[sides + i] / family.requirements[required[i]]
    keep_largest(weights, weights.shape[0], row, True)


@inner_heap_kernel
def pair_form(family, axis_field, basis, row, whitening, pool, sides, places, coarseness, v):
    """Fill the form at which pairs' tangents are best, and multipliers; return the smallest quotient there.

    Over the level. It is infinite if no axis was met inside the row's cell and band.
    """
    groups, start, matrix, total = whitening[0], scratch(6), scratch(6), sides + row_count(family)
    forms, multipliers = np.empty((total, 6)), np.empty(total)
    row[COUNT], row[TOUCH:BALL] = 0.0, 0.0
    if not cell_start(axis_field, basis, whitening[2], row, coarseness, start):
        return math.inf
    forms[:sides] = pool.forms[:sides]
    for q in range(
        family.pairs.shape[0] if has_horizontal_axes(axis_field) else 0
    ):  # no weight on the vertical
        heard = groups[family.denominator_of[family.pairs[q, 0]]]
        jammed = groups[family.denominator_of[family.pairs[q, 1]]]
        jammed[2] = jammed[4] = jammed[5] = heard[4] = heard[5] = 0.0
        heard[2] = heard[0] + heard[1] + 2.0 * abs(heard[3])
    accuracy = multiplier_accuracy(coarseness)
    pair_multipliers(family, row[LEVEL], groups, forms, sides, accuracy, start, multipliers, matrix)
    fill_constraints(multipliers[:sides], sides, places, row)
    keep_largest(multipliers[sides:], total - sides, row, False)
    keep_form(matrix, basis, whitening[2], row, v)
    least = math.inf
    for q in range(family.pairs.shape[0]):
        heard = groups[family.denominator_of[family.pairs[q, 0]]]
        jammed = groups[family.denominator_of[family.pairs[q, 1]]]
        least = min(least, log_quotient(family, q, form_product(heard, matrix), form_product(jammed, matrix)))
    return math.exp(least) / row[LEVEL]


@inner_kernel
def tangent_form(family, axis_field, basis, row, whitening, pool, sides, places, coarseness, v):
    """Fill the form at which tangents of a mean, or of pairs, are best; return its value, and if it is met.

    Over the level. It is infinite if no axis was met inside the row's cell and band.
    """
    if family.pairs.shape[0] > 0:
        primal = pair_form(family, axis_field, basis, row, whitening, pool, sides, places, coarseness, v)
        return primal, primal < math.inf
    found, is_met = touching_form(family, axis_field, basis, row, whitening, pool, sides, coarseness, v)
    if found == -math.inf:
        return math.inf, False
    fill_constraints(pool.shares, sides, places, row)
    return math.exp(found) / row[LEVEL], is_met


@inner_kernel
def free_multipliers(family, axis_field, basis, row, coarseness, workspace, axis):
    """Fill new multipliers for a free axis into the row; return (primal, rank-one value, whether known).

    Both values are at the centre and relative to the level: the first is what multipliers cannot beat, the
    second is what one axis reaches, which is filled in world coordinates. A first value of infinity: no
    multipliers were found. Where the last is false, the first is only what the multipliers found come to,
    well below the level, and there is no axis.
    """
    level, ratios = row[LEVEL], family.numerator_isotropic.shape[0]
    weights, every = workspace.weights, workspace.values
    pool = Pool(
        scratch(POOL, 6), scratch_int(POOL), scratch(POOL), scratch(POOL), scratch(POOL, 2), scratch(3),
        scratch_int(3),
    )  # fmt: skip
    mean, back, v, places = scratch(6), scratch(3, 3), scratch(3), scratch_int(4)
    whitening = (workspace.denominators, mean, back)
    whiten(family, basis, row, workspace.denominators, mean, back)
    if family.pairs.shape[0] > 0:  # their sums are of unit axes
        fill_identity(back)
    sides = constraint_forms(axis_field, basis, row, coarseness, back, pool.forms, places)
    for c in range(sides):
        pool.shares[c] = max(0.0, math.copysign(1.0, places[c]) * row[abs(places[c])])
    tolerance = max(_FINE, _LOOSE * coarseness)
    if family.shares.shape[0] + family.pairs.shape[0] > 0:
        primal, followed = tangent_form(
            family, axis_field, basis, row, whitening, pool, sides, places, coarseness, v
        )
        if not followed:
            return primal, 0.0, False
        axis_of(basis, back, v, axis)
        if axis_field.kind >= BAND_AXIS:
            clamp_axis(axis_field, axis)
        reached = log_objective(family, row[CENTRE:HALF], axis, workspace.log_denominators, every)
        return primal, math.exp(reached) / level, True
    primal, followed, total = ascend(
        family,
        has_horizontal_axes(axis_field),
        basis,
        row,
        whitening,
        pool,
        sides,
        tolerance,
        every,
        weights,
        v,
    )
    if primal == math.inf:
        primal = interior_multipliers(
            family, axis_field, basis, row, whitening, pool, sides, total, coarseness, every, weights, v
        )
        followed = True
        if primal == math.inf:
            return math.inf, 0.0, False
    fill_constraints(weights[ratios:], sides, places, row)
    keep_largest(weights, ratios, row, False)
    if not followed:
        return primal / level, 0.0, False
    axis_of(basis, back, v, axis)
    square = 1.0
    if axis_field.kind >= BAND_AXIS:
        clamp_axis(axis_field, axis)
        whiten_axis(basis, back, axis, v)
        square = dot(v, v)
    reached = fill_values(family, row[CENTRE:HALF], level, axis, square, every)
    return primal / level, reached / (square * level), True
