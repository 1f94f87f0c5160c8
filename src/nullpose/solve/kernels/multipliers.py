"""New multipliers for a node: from the dual at its centre, or by line searches if the axis is fixed."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.dual import dual_multipliers, top_eigenvector
from nullpose.solve.kernels.expansion import ABOUT_LINE, expand_point, min_distance
from nullpose.solve.kernels.forms import congruence, form_value, inverse_factor
from nullpose.solve.kernels.jit import kernel
from nullpose.solve.kernels.node import (
    CELL,
    CENTRE,
    FACE,
    HALF,
    LEVEL,
    SIDE,
    cell_side,
    keep_largest,
)

__all__ = ["fixed_multipliers", "free_multipliers"]


@kernel
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


@kernel
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


@kernel
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


@kernel
def two_multipliers(first, second, v):
    """Return the weight of the first of two forms that makes their mix's largest eigenvalue least."""
    low, high = 0.0, 1.0
    mix = np.empty(6)
    for _ in range(16):
        weight = 0.5 * (low + high)
        for m in range(6):
            mix[m] = weight * first[m] + (1.0 - weight) * second[m]
        top_eigenvector(mix, v)
        slope = 0.0
        for m in range(6):
            i = m if m < 3 else (0 if m < 5 else 1)
            j = m if m < 3 else (1 if m == 3 else 2)
            slope += (1.0 if m < 3 else 2.0) * (first[m] - second[m]) * v[i] * v[j]
        if slope > 0.0:
            high = weight
        else:
            low = weight
    return 0.5 * (low + high)


@kernel
def smallest_form(forms, count, v):
    """Return the smallest of the first ``count`` forms at a vector."""
    smallest = math.inf
    for k in range(count):
        smallest = min(smallest, form_value(forms, k, v))
    return smallest


@kernel
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
        primal = dual_multipliers(forms, ratios, sides, level, level, 1e-5, start, weights, matrix)
        top_eigenvector(matrix, v)
        if primal > level and primal - smallest_form(forms, ratios, v) > coarseness * level:
            # stopped early, so the axis is a poor one: finish, to see whether there is a duality gap at all
            primal = dual_multipliers(forms, ratios, sides, level, math.inf, 1e-4, start, weights, matrix)
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


@kernel
def mixed_value(value, slopes, half):
    """Return the largest value of a linear function over the box."""
    return value + half[0] * abs(slopes[0]) + half[1] * abs(slopes[1]) + half[2] * abs(slopes[2])


@kernel
def fixed_multipliers(family, view, row, below, weights):
    """Fill new multipliers for a fixed axis: the least upper bound of a mix of linear functions.

    Starts from the best single ratio and mixes in one ratio at a time by an exact line search; returns the
    smallest value at the centre relative to the level.
    """
    points, n0, nw, npt = family[:4]
    kind, anchor, basis, rho, rho_min = view
    denominator, denominator_slopes, rests = below
    ratios = nw.shape[0]
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    radius = 0.5 * (half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    form, slopes = np.empty(6), np.empty((3, 6))
    values, gradients = np.empty(ratios), np.empty((ratios, 3))
    smallest = math.inf
    base = denominator[2] + radius * rests[0]
    for k in range(ratios):
        up, _ = expand_point(points, npt[k], kind, anchor, basis, rho, rho_min, centre, half, form, slopes)
        if kind == ABOUT_LINE:
            up = 6.0 / min_distance(points, npt[k], centre, half) ** 4
        smallest = min(smallest, (n0[k] + nw[k] * form[2]) / (row[LEVEL] * rests[2]))
        values[k] = base + n0[k] + nw[k] * (form[2] + radius * up)
        for i in range(3):
            gradients[k, i] = denominator_slopes[i, 2] + nw[k] * slopes[i, 2]
    lead = 0
    for k in range(ratios):
        weights[k] = 0.0
        if mixed_value(values[k], gradients[k], half) < mixed_value(values[lead], gradients[lead], half):
            lead = k
    weights[lead] = 1.0
    value = values[lead]
    gradient = gradients[lead].copy()
    bound = mixed_value(value, gradient, half)
    trial = np.empty(3)
    for _ in range(3):
        before = bound
        for k in range(ratios):
            best_share = 0.0
            for i in range(4):  # the bound is piecewise linear in the share: its kinks, and the end
                if i < 3:
                    change = gradients[k, i] - gradient[i]
                    share = -gradient[i] / change if change != 0.0 else -1.0
                else:
                    share = 1.0
                if not 0.0 < share <= 1.0:
                    continue
                for m in range(3):
                    trial[m] = gradient[m] + share * (gradients[k, m] - gradient[m])
                candidate = mixed_value(value + share * (values[k] - value), trial, half)
                if candidate < bound:
                    bound, best_share = candidate, share
            if best_share > 0.0:
                for m in range(ratios):
                    weights[m] *= 1.0 - best_share
                weights[k] += best_share
                value += best_share * (values[k] - value)
                for m in range(3):
                    gradient[m] += best_share * (gradients[k, m] - gradient[m])
        if bound < 0.0 or bound >= before:
            break
    keep_largest(weights, ratios, row)
    return smallest
