"""Denominators over a box: ``-t D`` to first order, with a bound on the rest that is sharp beside a null."""

from __future__ import annotations

import math

from nullpose.solve.kernels.expansion import TOWARDS_POINT, expand_point, min_distance
from nullpose.solve.kernels.forms import bilinear
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import top_eigenvector

__all__ = ["ROUNDING", "add_mixed_denominators", "add_scaled", "expand_denominator", "sharpen"]

ROUNDING = 2e-14
"""Relative to the terms summed: a hundred units in the last place."""

_LARGEST_SHARE = 0.5


@inner_kernel
def add_scaled(weight, form, slopes, matrix, matrix_slopes):
    """Add a weighted form and its slopes to a matrix and its slopes."""
    for m in range(6):
        matrix[m] += weight * form[m]
        for i in range(3):
            matrix_slopes[i, m] += weight * slopes[i, m]


@inner_kernel
def expand_denominator(family, g, level, view, centre, half, out, out_slopes):
    """Add ``-t D_g`` and its slopes; return its remainders, isotropic and on the first two axes."""
    points, d0, dstart = family.points_m, family.denominator_isotropic, family.denominator_start
    dpt, dw, turn = family.denominator_point, family.denominator_weight, family.turn
    kind, anchor, basis, rho, rho_min = view
    form, slopes = scratch(6), scratch(3, 6)
    for m in range(3):
        out[m] -= level * d0[g]
    everywhere = across = 0.0
    radius = 0.5 * (half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    size = d0[g]
    for e in range(dstart[g], dstart[g + 1]):
        j = dpt[e]
        _, down = expand_point(points, turn, j, kind, anchor, basis, rho, rho_min, centre, half, form, slopes)
        add_scaled(-level * dw[e], form, slopes, out, out_slopes)
        if kind == TOWARDS_POINT and j == anchor:
            across += level * dw[e] * (ROUNDING * (form[0] + form[1]) - radius * down)
        else:
            size += dw[e] * (form[0] + form[1] + form[2])
            everywhere -= level * dw[e] * radius * down
    return everywhere + ROUNDING * level * size, across


@inner_kernel
def group_weight(family, row, s):
    """Return the weight of a slot's denominator over all slots, or zero if an earlier slot has it."""
    den = family.denominator_of
    g = den[int(row[INDEX + s])]
    total = 0.0
    for r in range(int(row[COUNT])):
        if den[int(row[INDEX + r])] == g:
            if r < s:
                return 0.0
            total += row[WEIGHT + r]
    return total


@inner_kernel
def add_mixed_denominators(family, view, row, matrix, slopes):
    """Add ``-t sum_k lambda_k D_k`` of the row's multipliers and its slopes; return its remainders."""
    den = family.denominator_of
    everywhere = across = 0.0
    for s in range(int(row[COUNT])):
        weight = group_weight(family, row, s) * row[LEVEL]
        if weight > 0.0:
            g = den[int(row[INDEX + s])]
            one, two = expand_denominator(
                family, g, weight, view, row[CENTRE:HALF], row[HALF:LEVEL], matrix, slopes
            )
            everywhere += one
            across += two
    return everywhere, across


@inner_kernel
def null_rest(a, rho):
    """Return a bound on the second derivative of a link's vector w, in a frame that turns or stands still."""
    rest = 2.0 / (a * a * a)
    if rho < math.inf:
        rest += 6.0 / (a * a * rho) + 3.155 / (a * rho * rho)  # 2 + 2 / sqrt(3), rounded up
    return rest


@inner_kernel
def sharpen(family, view, row, matrix, slopes):
    """Replace the denominators' remainders by smaller ones where they are smaller.

    With ``w = r / |r|^2``, r seen in the frame, a link is ``|u x w|^2``, and the rest of w beyond first
    order is at most ``W |x|^2 / 2`` at a step x from the centre. Since ``2 p q <= eta p^2 + q^2 / eta``, its
    form is at least ``(1 - eta) (T + T'.x) - (W |x|^2 / 2)^2 / eta I`` for any eta in (0, 1): beside the
    null, where T is small, far better than a remainder of the second order. The point that the frame turns
    towards keeps its own.
    """
    points, den, dstart = family.points_m, family.denominator_of, family.denominator_start
    dpt, dw, turn = family.denominator_point, family.denominator_weight, family.turn
    kind, anchor, basis, rho, rho_min = view
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    form, form_slopes, v = scratch(6), scratch(3, 6), scratch(3)
    top_eigenvector(matrix, v)
    square = half[0] ** 2 + half[1] ** 2 + half[2] ** 2
    change = 0.0
    for s in range(int(row[COUNT])):
        weight = group_weight(family, row, s) * row[LEVEL]
        if not weight > 0.0:
            continue
        g = den[int(row[INDEX + s])]
        for e in range(dstart[g], dstart[g + 1]):
            if kind == TOWARDS_POINT and dpt[e] == anchor:
                continue
            scale = weight * dw[e]
            _, down = expand_point(
                points, turn, dpt[e], kind, anchor, basis, rho, rho_min, centre, half, form, form_slopes
            )
            here, trace = bilinear(form, v, v), form[0] + form[1] + form[2]
            rest = 0.5 * square * null_rest(min_distance(points, dpt[e], centre, half), rho_min)
            plain = -0.5 * square * down
            eta = rest / math.sqrt(max(here, 1e-12 * trace))
            if eta < _LARGEST_SHARE and eta * here + rest * rest / eta < plain:
                add_scaled(scale * eta, form, form_slopes, matrix, slopes)
                change += scale * (rest * rest / eta - plain + ROUNDING * (trace + rest * rest / eta))
    for m in range(3):
        matrix[m] += change
