"""New multipliers for a node of a free axis: from the dual at its centre."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.dual import dual_multipliers, top_eigenvector
from nullpose.solve.kernels.forms import congruence, form_value, inverse_factor
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.node import (
    CELL,
    CENTRE,
    COUNT,
    FACE,
    HALF,
    INDEX,
    LEVEL,
    SIDE,
    cell_side,
    keep_largest,
)

__all__ = ["free_multipliers"]

_MIXES = 6
_MANY = 16  # more ratios than this are not all taken at once
_FEW = 6
_ROUNDS = 5
_SLIGHT = 1e-3


@inner_kernel
def plain_form(points, j, basis, centre, weight, isotropic, out):
    """Fill ``isotropic I + weight T`` for point j seen from the centre, in the frame."""
    r0, r1, r2 = points[j, 0] - centre[0], points[j, 1] - centre[1], points[j, 2] - centre[2]
    x = basis[0, 0] * r0 + basis[1, 0] * r1 + basis[2, 0] * r2
    y = basis[0, 1] * r0 + basis[1, 1] * r1 + basis[2, 1] * r2
    z = basis[0, 2] * r0 + basis[1, 2] * r1 + basis[2, 2] * r2
    s = x * x + y * y + z * z
    f = weight / (s * s)
    out[0] = isotropic + f * (y * y + z * z)
    out[1] = isotropic + f * (x * x + z * z)
    out[2] = isotropic + f * (x * x + y * y)
    out[3], out[4], out[5] = -f * x * y, -f * x * z, -f * y * z


@inner_kernel
def centre_forms(family, basis, row, level, denominator, forms, back):
    """Fill the ratios' forms at the centre, whitened by the denominator; return the number of sides."""
    points, n0, nw, npt = family[:4]
    raw = np.empty(6)
    for m in range(6):
        raw[m] = -denominator[m] / level
    inverse_factor(raw, back)
    ratios = nw.shape[0]
    for k in range(ratios):
        plain_form(points, npt[k], basis, row[CENTRE:HALF], nw[k], n0[k], raw)
        congruence(raw, back, forms[k])
    if row[FACE] < 0.0:
        return 0
    turned = np.empty(6)
    for side in range(2):
        cell_side(int(row[FACE]), row[CELL:SIDE], side, raw)
        congruence(raw, basis, turned)
        congruence(turned, back, forms[ratios + side])
    return 2


@inner_kernel
def cell_start(basis, back, row, start):
    """Fill a positive definite matrix of unit trace inside the row's cell, in whitened coordinates."""
    for m in range(6):
        start[m] = 1.0 / 3.0 if m < 3 else 0.0
    if row[FACE] < 0.0:
        return
    for m in range(6):
        start[m] = 0.0
    face = int(row[FACE])
    u, v, w = np.empty(3), np.empty(3), np.empty(3)
    for corner in range(5):
        fraction_y = 0.5 if corner == 4 else (0.02 if corner & 1 else 0.98)
        fraction_z = 0.5 if corner == 4 else (0.02 if corner & 2 else 0.98)
        u[face] = 1.0
        u[(face + 1) % 3] = row[CELL] + fraction_y * (row[CELL + 1] - row[CELL])
        u[(face + 2) % 3] = row[CELL + 2] + fraction_z * (row[CELL + 3] - row[CELL + 2])
        for i in range(3):
            v[i] = basis[0, i] * u[0] + basis[1, i] * u[1] + basis[2, i] * u[2]
        # back is upper triangular: w solves back w = v
        w[2] = v[2] / back[2, 2]
        w[1] = (v[1] - back[1, 2] * w[2]) / back[1, 1]
        w[0] = (v[0] - back[0, 1] * w[1] - back[0, 2] * w[2]) / back[0, 0]
        norm = w[0] ** 2 + w[1] ** 2 + w[2] ** 2
        for m in range(6):
            i = m if m < 3 else (0 if m < 5 else 1)
            j = m if m < 3 else (1 if m == 3 else 2)
            start[m] += 0.2 * w[i] * w[j] / norm


@inner_kernel
def two_multipliers(first, second, v):
    """Return the weight of the first of two forms that makes their mix's largest eigenvalue least."""
    low, high = 0.0, 1.0
    slope_low = slope_high = 0.0
    mix = np.empty(6)
    for turn in range(_MIXES):  # the slope rises with the weight: its ends, then the Illinois rule
        weight = 0.0 if turn == 0 else 1.0
        if turn > 1:
            weight = low - (high - low) * slope_low / (slope_high - slope_low)
        for m in range(6):
            mix[m] = weight * first[m] + (1.0 - weight) * second[m]
        top_eigenvector(mix, v)
        slope = 0.0
        for m in range(6):
            i = m if m < 3 else (0 if m < 5 else 1)
            j = m if m < 3 else (1 if m == 3 else 2)
            slope += (1.0 if m < 3 else 2.0) * (first[m] - second[m]) * v[i] * v[j]
        if turn == 0 and slope >= 0.0:
            return 0.0
        if turn == 1 and slope <= 0.0:
            return 1.0
        if slope > 0.0:
            high, slope_high = weight, slope
            slope_low *= 0.5 if turn > 2 else 1.0
        else:
            low, slope_low = weight, slope
            slope_high *= 0.5 if turn > 2 else 1.0
    return low - (high - low) * slope_low / (slope_high - slope_low)


@inner_kernel
def smallest_form(forms, count, v):
    """Return the smallest of the first ``count`` forms at a vector."""
    smallest = math.inf
    for k in range(count):
        smallest = min(smallest, form_value(forms, k, v))
    return smallest


@inner_kernel
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


@inner_kernel
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
    few, few_weights = np.empty((2 * _MANY + 2, 6)), np.empty(2 * _MANY + 2)
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
def free_multipliers(family, basis, row, denominator, coarseness, weights, axis):
    """Fill new multipliers for a free axis into the row; return (primal value, rank-one value) at the centre.

    Both are relative to the level: the first is what multipliers cannot beat, the second is what one axis
    reaches, which is filled in world coordinates.
    """
    level = row[LEVEL]
    ratios = family[1].shape[0]
    forms = np.empty((ratios + 2, 6))
    back = np.empty((3, 3))
    matrix, start = np.empty(6), np.empty(6)
    v = np.empty(3)
    sides = centre_forms(family, basis, row, level, denominator, forms, back)
    if ratios == 2 and sides == 0:
        weights[0] = two_multipliers(forms[0], forms[1], v)
        weights[1] = 1.0 - weights[0]
        primal = 0.0
        for m in range(6):
            matrix[m] = weights[0] * forms[0, m] + weights[1] * forms[1, m]
        primal = top_eigenvector(matrix, v)
    else:
        cell_start(basis, back, row, start)
        primal = sparse_dual(forms, ratios, sides, row, level, 1e-5, start, weights, matrix)
        top_eigenvector(matrix, v)
        if primal > level and primal - smallest_form(forms, ratios, v) > coarseness * level:
            # stopped early, so the axis is a poor one: finish, to see whether there is a duality gap at all
            primal = sparse_dual(forms, ratios, sides, row, math.inf, 1e-4, start, weights, matrix)
            top_eigenvector(matrix, v)
    for side in range(2):
        row[SIDE + side] = weights[ratios + side] if sides else 0.0
    keep_largest(weights, ratios, row)
    reached = smallest_form(forms, ratios, v)
    for i in range(3):
        matrix[i] = back[i, 0] * v[0] + back[i, 1] * v[1] + back[i, 2] * v[2]
    for i in range(3):
        axis[i] = basis[i, 0] * matrix[0] + basis[i, 1] * matrix[1] + basis[i, 2] * matrix[2]
    return primal / level, reached / level
