"""New multipliers for a box of a free axis: from the dual at its centre."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.ascent import POOL, Pool, ascend, lowest_missing, put_weights, take_in
from nullpose.solve.kernels.box import BAND, CENTRE, HALF, LEVEL, SIDE, keep_largest
from nullpose.solve.kernels.cells import constraint_multiplier, is_level
from nullpose.solve.kernels.dual import dual_multipliers
from nullpose.solve.kernels.jit import inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.local_coordinates import BAND as ELEVATION_BAND
from nullpose.solve.kernels.local_coordinates import clamp_axis
from nullpose.solve.kernels.scratch import scratch, scratch_int
from nullpose.solve.kernels.symmetric import form_product, top_eigenvector
from nullpose.solve.kernels.vectors import dot
from nullpose.solve.kernels.whitened import (
    axis_of,
    constraint_forms,
    fill_values,
    ratio_form,
    whiten,
    whiten_axis,
)

__all__ = ["free_multipliers"]

_MANY = 16  # ratios that an interior point takes at first, if there are more
_FEW = 6  # and in each later round at most
_ROUNDS = 5
_SLIGHT = 1e-3
_FINE = 1e-5  # accuracy of the multipliers
_LOOSE = 0.03  # and in units of a box's size
_INTERIOR = 0.01  # of an interior point's, likewise
_AT_ONE_POSITION = 1e-10  # where nothing else closes a gap
_NO_RATIO = 1e-9  # the multiplier of a ratio where constraints alone exclude every axis


@inner_heap_kernel
def interior_multipliers(
    family, level_axes, basis, row, whitening, pool, total, accuracy, every, weights, v
):  # fmt: skip
    """Fill the dual's multipliers and the axis that its matrix suggests; return its value.

    Few ratios are taken at a time if there are many: those smallest at the matrix, then what turns out to be
    smaller.
    """
    matrix, form = scratch(6), scratch(6)
    matrix[:], matrix[:3] = 0.0, 1.0 / 3.0
    below, found, known = math.inf, math.inf, np.int64(0)
    for _ in range(_ROUNDS):
        for k in range(every.shape[0]):
            ratio_form(family, level_axes, basis, row, whitening, k, form)
            every[k] = form_product(form, matrix)
        for _ in range(_FEW if known > 0 else _MANY):
            ratio = lowest_missing(every, below, pool, total)
            if ratio < 0 or total == POOL:
                break
            total = take_in(family, level_axes, basis, row, whitening, ratio, 0.0, pool, total)
        if total == known:
            break
        found = dual_multipliers(pool.forms, total, row[LEVEL], accuracy, pool.shares, matrix)
        below, known = found - _SLIGHT * row[LEVEL], total
    put_weights(pool, total, weights)
    top_eigenvector(matrix, v)
    return found


@inner_kernel
def free_multipliers(family, axis_field, basis, row, denominator, coarseness, workspace, axis):
    """Fill new multipliers for a free axis into the row; return (dual value, rank-one value, if known).

    Both values are at the centre and relative to the level: the first is what multipliers cannot beat, the
    second is what one axis reaches, which is filled in world coordinates. Where the last is false, the first
    is only what the multipliers found come to, well below the level, and there is no axis.
    """
    level, ratios, level_axes = row[LEVEL], family.numerator_isotropic.shape[0], is_level(axis_field)
    weights, every = workspace.weights, workspace.values
    pool = Pool(
        scratch(POOL, 6), scratch_int(POOL), scratch(POOL), scratch(POOL), scratch(POOL, 2), scratch(3),
        scratch_int(3),
    )  # fmt: skip
    mean, back, v, numbers, scales = scratch(6), scratch(3, 3), scratch(3), scratch_int(4), scratch(4)
    whitening = (workspace.denominators, mean, back)
    whiten(family, basis, row, denominator, workspace.denominators, mean, back)
    sides = constraint_forms(axis_field, basis, row, back, pool.forms, numbers, scales)
    for c in range(sides):
        pool.members[c], pool.shares[c] = ratios + c, constraint_multiplier(row, numbers[c]) / scales[c]
    tolerance = max(_FINE, _LOOSE * coarseness)
    primal, followed, total = ascend(
        family, level_axes, basis, row, whitening, pool, sides, tolerance, every, weights, v
    )
    if primal == math.inf:
        accuracy = max(_FINE, _INTERIOR * coarseness) if coarseness > 0.0 else _AT_ONE_POSITION
        primal = interior_multipliers(
            family, level_axes, basis, row, whitening, pool, total, accuracy, every, weights, v
        )
        followed = True
    weights[0] = max(_NO_RATIO, weights[0])
    row[SIDE] = row[SIDE + 1] = row[BAND] = 0.0
    for c in range(sides):
        multiplier = scales[c] * weights[ratios + c]
        row[SIDE + min(numbers[c], 2)] += -multiplier if numbers[c] == 2 else multiplier
    keep_largest(weights, ratios, row)
    if not followed:
        return primal / level, 0.0, False
    axis_of(basis, back, v, axis)
    square = 1.0
    if axis_field.kind >= ELEVATION_BAND:
        clamp_axis(axis_field, axis)
        whiten_axis(basis, back, axis, v)
        square = dot(v, v)
    reached = fill_values(family, row[CENTRE:HALF], level, axis, square, every)
    return primal / level, reached / (square * level), True
