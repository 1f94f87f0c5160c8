"""New multipliers for a node of a free axis: from the dual at its centre."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.ascent import ascend
from nullpose.solve.kernels.chart import clamp_axis
from nullpose.solve.kernels.dual import dual_multipliers, positive_definite, top_eigenvector
from nullpose.solve.kernels.exclusion import is_level
from nullpose.solve.kernels.forms import form_value
from nullpose.solve.kernels.jit import inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.node import (
    BAND,
    CELL,
    CENTRE,
    COUNT,
    FACE,
    HALF,
    INDEX,
    LEVEL,
    SIDE,
    keep_largest,
)
from nullpose.solve.kernels.scratch import scratch, scratch_int
from nullpose.solve.kernels.symmetric import copy_into
from nullpose.solve.kernels.whitened import (
    axis_of,
    constraint_forms,
    fill_values,
    half_width,
    ratio_form,
    whiten,
    whiten_axis,
)

__all__ = ["free_multipliers"]

_MANY = 16  # more ratios than this are not all taken at once
_FEW = 6
_FORMS = 2 * _MANY + 4
_ROUNDS = 5
_SLIGHT = 1e-3
_FINE = 1e-5  # accuracy of the multipliers
_LOOSE = 1e-3  # and in units of a box's size
_GRID = 9  # of axes looked at for one inside both a cell and a band


@inner_kernel
def add_start(basis, back, u, start):
    """Add the whitened square of an axis to a matrix."""
    w = scratch(3)
    whiten_axis(basis, back, u, w)
    norm = w[0] ** 2 + w[1] ** 2 + w[2] ** 2
    for m in range(6):
        i = m if m < 3 else (0 if m < 5 else 1)
        j = m if m < 3 else (1 if m == 3 else 2)
        start[m] += w[i] * w[j] / norm


@inner_kernel
def cell_start(axis_field, basis, back, row, start):
    """Fill a positive definite matrix of unit trace inside the row's cell and band; return whether there is.

    In whitened coordinates. The mean of the squares of axes inside; none may have been met in a thin cell.
    """
    for m in range(6):
        start[m] = 1.0 / 3.0 if m < 3 else 0.0
    face = int(row[FACE])
    level_axes = is_level(axis_field)
    if face < 0 and (axis_field.kind < 2 or level_axes):
        return True
    for m in range(6):
        start[m] = 0.0
    u = scratch(3)
    least, greatest = axis_field.offset[0], axis_field.offset[1]
    least, greatest = least - half_width(axis_field), greatest + half_width(axis_field)
    least, greatest = max(0.0, least), min(1.0, greatest)
    count = 0
    if face < 0:
        for turn in range(6):
            share = least + (greatest - least) * (0.25 if turn & 1 else 0.75)
            across = math.sqrt(1.0 - share)
            u[0], u[1] = across * math.cos(turn * math.pi / 3.0), across * math.sin(turn * math.pi / 3.0)
            u[2] = math.sqrt(share)
            add_start(basis, back, u, start)
            u[2] = -u[2]
            add_start(basis, back, u, start)
            count += 2
    elif level_axes:
        side = 0 if face == 0 else 1
        for turn in range(2):
            u[:] = 0.0
            u[face] = 1.0
            low, high = row[CELL + 2 * side], row[CELL + 2 * side + 1]
            u[(face + 1 + side) % 3] = low + (0.1 if turn else 0.9) * (high - low)
            add_start(basis, back, u, start)
        start[2] += 0.1
        count = 3
    elif axis_field.kind >= 2:
        for swap in range(2 if face == 2 else 1):
            count += add_band_axes(basis, back, row, least, greatest, swap, start)
    else:
        for corner in range(5):
            u[face] = 1.0
            for side in range(2):
                low, wide = row[CELL + 2 * side], row[CELL + 2 * side + 1] - row[CELL + 2 * side]
                fraction = 0.5 if corner == 4 else (0.02 if (corner >> side) & 1 else 0.98)
                u[(face + 1 + side) % 3] = low + fraction * wide
            add_start(basis, back, u, start)
        count = 5
    if count < 3:
        return False
    trace = start[0] + start[1] + start[2]
    for m in range(6):
        start[m] /= trace
    return axis_field.kind < 2 or positive_definite(start)


@inner_kernel
def add_band_axes(basis, back, row, least, greatest, swap, start):
    """Add the whitened squares of axes inside both a cell and a band; return how many.

    Along lines across the cell, on which the band leaves an interval or two.
    """
    face = int(row[FACE])
    along = swap if face == 2 else (1 if face == 0 else 0)  # the side that is solved for: z where it is one
    other = 1 - along
    u = scratch(3)
    count = 0
    for line in range(_GRID):
        low, wide = row[CELL + 2 * other], row[CELL + 2 * other + 1] - row[CELL + 2 * other]
        x = low + wide * (0.02 + 0.96 * line / (_GRID - 1))
        if face == 2:  # u_z = 1: the squares of the others sum to 1 / u_z^2 - 1
            bottom = 1.0 / greatest - 1.0 - x * x
            top = (1.0 / least - 1.0 if least > 0.0 else 2.0) - x * x
        else:
            bottom = least / (1.0 - least) * (1.0 + x * x)
            top = (greatest / (1.0 - greatest) if greatest < 0.5 else 2.0) * (1.0 + x * x)
        if not top > 0.0:
            continue
        far, near = math.sqrt(top), math.sqrt(max(0.0, bottom))
        for sign in range(2):
            a = max(near if sign else -far, row[CELL + 2 * along])
            b = min(far if sign else -near, row[CELL + 2 * along + 1])
            if not b > a:
                continue
            for part in range(2):
                u[face] = 1.0
                u[(face + 1 + other) % 3] = x
                u[(face + 1 + along) % 3] = a + (0.25 if part else 0.75) * (b - a)
                add_start(basis, back, u, start)
                count += 1
    return count


@inner_kernel
def smallest_form(forms, count, v):
    """Return the smallest of the first ``count`` forms at a vector."""
    smallest = math.inf
    for k in range(count):
        smallest = min(smallest, form_value(forms, k, v))
    return smallest


@inner_heap_kernel
def add_smallest(forms, ratios, matrix, below, most, chosen, count, taken):
    """Add the forms of smallest ``<A_k, U>`` below a value to those chosen; return how many there are now."""
    values = np.empty(ratios)
    for k in range(ratios):
        a = forms[k]
        values[k] = a[0] * matrix[0] + a[1] * matrix[1] + a[2] * matrix[2]
        values[k] += 2.0 * (a[3] * matrix[3] + a[4] * matrix[4] + a[5] * matrix[5])
    smallest = math.inf
    for k in range(ratios):
        smallest = min(smallest, values[k])
    for _ in range(most):
        lead = -1
        for k in range(ratios):
            if not taken[k] and values[k] < below and (lead < 0 or values[k] < values[lead]):
                lead = k
        if lead < 0 or count >= chosen.shape[0]:
            break
        chosen[count], taken[lead] = lead, True
        count += 1
    return smallest, count


@inner_heap_kernel
def sparse_dual(forms, ratios, sides, row, stop, gap, start, weights, matrix):
    """Return the dual's primal value as ``dual_multipliers`` does, from few forms at a time if many.

    Begins with the row's own ratios and those smallest at the start, and adds what turns out to be smaller.
    """
    level = row[LEVEL]
    if ratios <= _MANY:
        return dual_multipliers(forms, ratios, sides, level, stop, gap, start, weights, matrix)
    chosen, taken = np.empty(2 * _MANY, np.int64), np.zeros(ratios, np.bool_)
    count = np.int64(0)
    for s in range(int(row[COUNT])):
        chosen[count] = int(row[INDEX + s])
        taken[chosen[count]] = True
        count += 1
    _, count = add_smallest(forms, ratios, start, math.inf, _FEW, chosen, count, taken)
    few, few_weights = scratch(_FORMS, 6), scratch(_FORMS)
    smallest = -math.inf
    for _ in range(_ROUNDS):
        for c in range(count + sides):
            k = chosen[c] if c < count else ratios + c - count
            for m in range(6):
                few[c, m] = forms[k, m]
        found = dual_multipliers(few, count, sides, level, stop, gap, start, few_weights, matrix)
        before = count
        smallest, count = add_smallest(
            forms, ratios, matrix, found - _SLIGHT * level, _FEW, chosen, count, taken
        )
        if count == before:
            break
    for k in range(ratios):
        weights[k] = 0.0
    for c in range(before):
        weights[chosen[c]] = few_weights[c]
    for side in range(sides):
        weights[ratios + side] = few_weights[before + side]
    return smallest


@inner_kernel
def keep_sides(row, places, sides, weights, ratios):
    """Put the multipliers of the cell's sides and of the band into the row."""
    row[SIDE] = row[SIDE + 1] = row[BAND] = 0.0
    for c in range(sides):
        row[abs(places[c])] += weights[ratios + c] if places[c] > 0 else -weights[ratios + c]


@inner_kernel
def kept_sides(row, places, sides, weights):
    """Fill the multipliers of the cell's sides and of the band that a row has."""
    for c in range(sides):
        weights[c] = max(0.0, row[places[c]] if places[c] > 0 else -row[-places[c]])


@inner_heap_kernel
def interior_multipliers(
    family, axis_field, basis, row, whitening, constraints, sides, coarseness, weights, v
):
    """Fill the dual's multipliers and the axis that its matrix suggests; return the primal value."""
    ratios, level = family.numerator_isotropic.shape[0], row[LEVEL]
    matrix, start = scratch(6), scratch(6)
    if not cell_start(axis_field, basis, whitening[2], row, start):
        return math.inf
    forms = np.empty((ratios + sides, 6))
    for k in range(ratios):
        ratio_form(family, is_level(axis_field), basis, row, whitening, k, forms[k])
    for c in range(sides):
        copy_into(constraints[c], forms[ratios + c])
    accuracy = 1e-5 if coarseness > 0.0 else 1e-10  # at one position nothing else closes a gap
    primal = sparse_dual(forms, ratios, sides, row, level, accuracy, start, weights, matrix)
    top_eigenvector(matrix, v)
    if primal > level and primal - smallest_form(forms, ratios, v) > coarseness * level:
        # stopped early, so the axis is a poor one: finish, to see whether there is a duality gap at all
        primal = sparse_dual(forms, ratios, sides, row, math.inf, 1e-4, start, weights, matrix)
        top_eigenvector(matrix, v)
    return primal


@inner_kernel
def free_multipliers(family, axis_field, basis, row, denominator, coarseness, workspace, axis):
    """Fill new multipliers for a free axis into the row; return (primal, rank-one value, whether known).

    Both values are at the centre and relative to the level: the first is what multipliers cannot beat, the
    second is what one axis reaches, which is filled in world coordinates. A first value of infinity: no
    multipliers were found. Where the last is false, the first is only what the multipliers found come to,
    well below the level, and there is no axis.
    """
    level, ratios = row[LEVEL], family.numerator_isotropic.shape[0]
    weights, every = workspace.weights, workspace.values
    mean, back, v = scratch(6), scratch(3, 3), scratch(3)
    constraints, places, start = scratch(4, 6), scratch_int(4), scratch(4)
    denominators = workspace.denominators
    whiten(family, basis, row, denominator, denominators, mean, back)
    whitening = (denominators, mean, back)
    sides = constraint_forms(axis_field, basis, row, back, constraints, places)
    kept_sides(row, places, sides, start)
    tolerance = max(_FINE, _LOOSE * coarseness)
    primal, followed = ascend(
        family, is_level(axis_field), basis, row, whitening, constraints, sides, start, tolerance, every,
        weights, v,
    )  # fmt: skip
    if primal == math.inf:
        primal = interior_multipliers(
            family, axis_field, basis, row, whitening, constraints, sides, coarseness, weights, v
        )
        followed = True
        if primal == math.inf:
            return math.inf, 0.0, False
    keep_sides(row, places, sides, weights, ratios)
    keep_largest(weights, ratios, row)
    if not followed:
        return primal / level, 0.0, False
    axis_of(basis, back, v, axis)
    square = 1.0
    if axis_field.kind >= 2:
        clamp_axis(axis_field, axis)
        whiten_axis(basis, back, axis, v)
        square = v[0] ** 2 + v[1] ** 2 + v[2] ** 2
    reached = fill_values(family, row[CENTRE:HALF], level, axis, square, every)
    return primal / level, reached / (square * level), True
