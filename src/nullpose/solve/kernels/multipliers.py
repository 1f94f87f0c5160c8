"""New multipliers for a node of a free axis: from the dual at its centre."""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.chart import clamp_axis
from nullpose.solve.kernels.dual import dual_multipliers, positive_definite, top_eigenvector
from nullpose.solve.kernels.exclusion import is_level
from nullpose.solve.kernels.forms import congruence, form_value, inverse_factor
from nullpose.solve.kernels.jit import inner_kernel
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
    cell_side,
    keep_largest,
)

__all__ = ["free_multipliers"]

_MIXES = 6
_MANY = 16  # more ratios than this are not all taken at once
_FEW = 6
_ROUNDS = 5
_SLIGHT = 1e-3
_THIN = 1e-6  # half the width, in u_z^2, that a cone is given so that its dual has an inside
_STEEP = 1e-3  # and as a share of its distance from level and upright, if that is less
_GRID = 9  # of axes looked at for one inside both a cell and a band


@inner_kernel
def half_width(axis_field):
    """Return half the width that a cone is given; zero for a band."""
    if axis_field[0] != 3:
        return 0.0
    c = axis_field[1][0]
    return min(_THIN, _STEEP * min(c, 1.0 - c))


@inner_kernel
def add_plain_form(points, turn, j, basis, centre, weight, isotropic, out):
    """Add ``isotropic I + weight T`` for point j seen from the centre, in the frame."""
    r0, r1, r2 = points[j, 0] - centre[0], points[j, 1] - centre[1], points[j, 2] - centre[2]
    if turn.shape[0] > 0:
        basis = turn[j]
    x = basis[0, 0] * r0 + basis[1, 0] * r1 + basis[2, 0] * r2
    y = basis[0, 1] * r0 + basis[1, 1] * r1 + basis[2, 1] * r2
    z = basis[0, 2] * r0 + basis[1, 2] * r1 + basis[2, 2] * r2
    s = x * x + y * y + z * z
    f = weight / (s * s)
    out[0] += isotropic + f * (y * y + z * z)
    out[1] += isotropic + f * (x * x + z * z)
    out[2] += isotropic + f * (x * x + y * y)
    out[3] -= f * x * y
    out[4] -= f * x * z
    out[5] -= f * y * z


@inner_kernel
def fill_denominators(family, basis, centre, denominators, mean):
    """Fill every denominator at the centre, in the frame, and their mean."""
    points, d0, dstart, dpt, dw, turn = family[0], family[5], family[6], family[7], family[8], family[9]
    groups = d0.shape[0]
    denominators[:, :] = 0.0
    mean[:] = 0.0
    for g in range(groups):
        for m in range(3):
            denominators[g, m] = d0[g]
        for e in range(dstart[g], dstart[g + 1]):
            add_plain_form(points, turn, dpt[e], basis, centre, dw[e], 0.0, denominators[g])
        for m in range(6):
            mean[m] += denominators[g, m] / groups


@inner_kernel
def centre_forms(family, axis_field, basis, row, denominator, forms, back):
    """Fill the whitened forms at the centre, those of the constraints last; return how many those are.

    Whitened by the denominator; where there are several, by their mean W: then a ratio's form is that of
    ``N_k + t (W - D_k)``, which exceeds the level t exactly where the ratio does.
    """
    points, n0, nw, npt, den, turn = family[0], family[1], family[2], family[3], family[4], family[9]
    level, groups, ratios = row[LEVEL], family[5].shape[0], family[2].shape[0]
    raw, mean, turned = np.empty(6), np.empty(6), np.empty(6)
    denominators = np.empty((groups, 6))
    if groups == 1:
        for m in range(6):
            mean[m] = -denominator[m] / level
    else:
        fill_denominators(family, basis, row[CENTRE:HALF], denominators, mean)
    inverse_factor(mean, back)
    for k in range(ratios):
        for m in range(6):
            raw[m] = 0.0 if groups == 1 else level * (mean[m] - denominators[den[k], m])
        add_plain_form(points, turn, npt[k], basis, row[CENTRE:HALF], nw[k], n0[k], raw)
        congruence(raw, back, forms[k])
    sides = np.int64(0)
    level_axes = is_level(axis_field)
    if row[FACE] >= 0.0:
        for side in range(2):
            if level_axes and side != (0 if row[FACE] == 0.0 else 1):
                continue
            cell_side(int(row[FACE]), row[CELL:SIDE], side, raw)
            congruence(raw, basis, turned)
            congruence(turned, back, forms[ratios + sides])
            sides += 1
    if level_axes:  # no weight on the vertical: whitening leaves its direction alone
        for k in range(ratios + sides):
            f = forms[k]
            f[2] = -(abs(f[0]) + abs(f[1]) + 2.0 * abs(f[3])) - level if k < ratios else 0.0
            f[4] = f[5] = 0.0
    elif axis_field[0] >= 2:
        thin = half_width(axis_field)
        for end in range(2):
            c = axis_field[1][end] + (thin if end == 1 else -thin)
            if 0.0 < c < 1.0:
                for m in range(6):
                    raw[m] = (-c if end == 0 else c) if m < 3 else 0.0
                raw[2] += 1.0 if end == 0 else -1.0
                congruence(raw, basis, turned)
                congruence(turned, back, forms[ratios + sides])
                sides += 1
    return sides


@inner_kernel
def whiten_axis(basis, back, u, w):
    """Fill an axis of the world in whitened coordinates."""
    v0 = basis[0, 0] * u[0] + basis[1, 0] * u[1] + basis[2, 0] * u[2]
    v1 = basis[0, 1] * u[0] + basis[1, 1] * u[1] + basis[2, 1] * u[2]
    v2 = basis[0, 2] * u[0] + basis[1, 2] * u[1] + basis[2, 2] * u[2]
    # back is upper triangular: w solves back w = v
    w[2] = v2 / back[2, 2]
    w[1] = (v1 - back[1, 2] * w[2]) / back[1, 1]
    w[0] = (v0 - back[0, 1] * w[1] - back[0, 2] * w[2]) / back[0, 0]


@inner_kernel
def add_start(basis, back, u, start):
    """Add the whitened square of an axis to a matrix."""
    w = np.empty(3)
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
    if face < 0 and (axis_field[0] < 2 or level_axes):
        return True
    for m in range(6):
        start[m] = 0.0
    u = np.empty(3)
    least, greatest = axis_field[1][0], axis_field[1][1]
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
    elif axis_field[0] >= 2:
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
    return axis_field[0] < 2 or positive_definite(start)


@inner_kernel
def add_band_axes(basis, back, row, least, greatest, swap, start):
    """Add the whitened squares of axes inside both a cell and a band; return how many.

    Along lines across the cell, on which the band leaves an interval or two.
    """
    face = int(row[FACE])
    along = swap if face == 2 else (1 if face == 0 else 0)  # the side that is solved for: z where it is one
    other = 1 - along
    u = np.empty(3)
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
def axis_of(basis, back, w, axis):
    """Fill the axis of the world, of any length, that whitened coordinates stand for."""
    v = np.empty(3)
    for i in range(3):
        v[i] = back[i, 0] * w[0] + back[i, 1] * w[1] + back[i, 2] * w[2]
    for i in range(3):
        axis[i] = basis[i, 0] * v[0] + basis[i, 1] * v[1] + basis[i, 2] * v[2]


@inner_kernel
def pair_multipliers(axis_field, basis, back, forms, sides, weights, v):
    """Fill the multipliers of two ratios and the axis that they leave; return the primal value.

    Infinity if that axis is outside of the band, which has no multiplier then but should have one. Two forms
    have no duality gap; nor do they on the level plane, where their values lie on an ellipse, of which a
    largest minimum is a point wherever it may lie inside.
    """
    weights[0] = two_multipliers(forms[0], forms[1], v)
    weights[1] = 1.0 - weights[0]
    mix = np.empty(6)
    for m in range(6):
        mix[m] = weights[0] * forms[0, m] + weights[1] * forms[1, m]
    primal = top_eigenvector(mix, v)
    if axis_field[0] >= 2 and not is_level(axis_field):
        axis_of(basis, back, v, mix)
        upright = mix[2] ** 2
        square = mix[0] ** 2 + mix[1] ** 2 + upright
        if not axis_field[1][0] * square <= upright <= axis_field[1][1] * square:
            return math.inf
    for side in range(sides):
        weights[2 + side] = 0.0
    return primal


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
    few, few_weights = np.empty((2 * _MANY + 4, 6)), np.empty(2 * _MANY + 4)
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
def keep_sides(axis_field, row, weights, ratios):
    """Put the multipliers of the cell's sides and of the band into the row."""
    row[SIDE] = row[SIDE + 1] = row[BAND] = 0.0
    level_axes = is_level(axis_field)
    c = ratios
    if row[FACE] >= 0.0:
        for side in range(2):
            if level_axes and side != (0 if row[FACE] == 0.0 else 1):
                continue
            row[SIDE + side] = weights[c]
            c += 1
    if axis_field[0] >= 2 and not level_axes:
        thin = half_width(axis_field)
        for end in range(2):
            if 0.0 < axis_field[1][end] + (thin if end == 1 else -thin) < 1.0:
                row[BAND] += -weights[c] if end == 0 else weights[c]
                c += 1


@inner_kernel
def free_multipliers(family, axis_field, basis, row, denominator, coarseness, weights, axis):
    """Fill new multipliers for a free axis into the row; return (primal value, rank-one value) at the centre.

    Both are relative to the level: the first is what multipliers cannot beat, the second is what one axis
    reaches, which is filled in world coordinates. A first value of infinity: no multipliers were found.
    """
    level = row[LEVEL]
    ratios = family[1].shape[0]
    forms = np.empty((ratios + 4, 6))
    back = np.empty((3, 3))
    matrix, start = np.empty(6), np.empty(6)
    v = np.empty(3)
    sides = centre_forms(family, axis_field, basis, row, denominator, forms, back)
    primal = math.inf
    if ratios == 2 and row[FACE] < 0.0:
        primal = pair_multipliers(axis_field, basis, back, forms, sides, weights, v)
    if primal == math.inf:
        if not cell_start(axis_field, basis, back, row, start):
            return math.inf, 0.0
        accuracy = 1e-5 if coarseness > 0.0 else 1e-10  # at one position nothing else closes a gap
        primal = sparse_dual(forms, ratios, sides, row, level, accuracy, start, weights, matrix)
        top_eigenvector(matrix, v)
        if primal > level and primal - smallest_form(forms, ratios, v) > coarseness * level:
            # stopped early, so the axis is a poor one: finish, to see whether there is a duality gap at all
            primal = sparse_dual(forms, ratios, sides, row, math.inf, 1e-4, start, weights, matrix)
            top_eigenvector(matrix, v)
    keep_sides(axis_field, row, weights, ratios)
    keep_largest(weights, ratios, row)
    axis_of(basis, back, v, axis)
    if axis_field[0] >= 2:
        clamp_axis(axis_field, axis)
        whiten_axis(basis, back, axis, v)
        norm = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
        for i in range(3):
            v[i] /= norm
    reached = smallest_form(forms, ratios, v)
    return primal / level, reached / level
