"""Denominators over a box: ``-t D`` to first order, with a bound on the rest that is sharp beside a null."""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.constants import ROUNDING
from nullpose.solver.kernels.bounds.expansion import expand_point
from nullpose.solver.kernels.bounds.node import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import bilinear
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_identity,
    add_scaled as add_multiple,
    top_eigenvector,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot

_LARGEST_SHARE = 0.5


@small_kernel
def add_scaled(weight, form, slopes, matrix, matrix_slopes):
    """Add a weighted form and its slopes to a matrix and its slopes."""
    add_multiple(weight, form, matrix)
    for i in range(3):
        add_multiple(weight, slopes[i], matrix_slopes[i])


@inner_kernel
def expand_denominator(family, g, level, frame, centre, half, out, out_slopes):
    """Add ``-t D_g`` and its slopes; return its remainders, isotropic and on the first two axes besides."""
    form, slopes = scratch(6), scratch(3, 6)
    size = family.denominator_isotropic[g]
    add_identity(-level * size, out)
    everywhere = across = 0.0
    radius = 0.5 * dot(half, half)
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        j, weight = family.denominator_point[e], family.denominator_weight[e]
        fall, _ = expand_point(family, j, False, frame, centre, half, form, slopes)
        add_scaled(-level * weight, form, slopes, out, out_slopes)
        if frame.kind == TOWARDS_POINT and j == frame.anchor:
            rest = level * weight * (ROUNDING * (form[0] + form[1]) + radius * fall)
            across += (1.0 - family.leak) * rest
            everywhere += family.leak * rest
        else:
            size += weight * (form[0] + form[1] + form[2])
            everywhere += level * weight * radius * fall
    return everywhere + ROUNDING * level * size, across


@small_kernel
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


@rare_kernel
def add_mixed_denominators(family, frame, row, matrix, slopes):
    """Add ``-t sum_k lambda_k D_k`` of the row's multipliers and its slopes; return its remainders."""
    everywhere = across = 0.0
    for s in range(int(row[COUNT])):
        weight = group_weight(family, row, s) * row[LEVEL]
        if weight > 0.0:
            g = family.denominator_of[int(row[INDEX + s])]
            rest, rest_across = expand_denominator(
                family, g, weight, frame, row[CENTRE:HALF], row[HALF:LEVEL], matrix, slopes
            )
            everywhere += rest
            across += rest_across
    return everywhere, across


@inner_kernel
def sharpen(family, frame, row, matrix, slopes):
    """Replace the denominators' remainders by smaller ones where they are smaller.

    With ``w = h r / |r|^2``, r seen in the frame, a link is ``|u x w|^2 + leak (u.w)^2``, a sum of squares
    of numbers that are linear in w and together no longer than it; and the rest of w beyond first order is
    at most ``W |x|^2 / 2`` at a step x from the centre. Since ``2 p q <= eta p^2 + q^2 / eta``, its
    form is at least ``(1 - eta) (M + M'.x) - (W |x|^2 / 2)^2 / eta I`` for any eta in (0, 1): beside the
    null, where M is small, far better than a remainder of the second order. The point that the frame turns
    towards keeps its own.
    """
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    form, form_slopes, v = scratch(6), scratch(3, 6), scratch(3)
    top_eigenvector(matrix, v)
    square = dot(half, half)
    change = 0.0
    for s in range(int(row[COUNT])):
        weight = group_weight(family, row, s) * row[LEVEL]
        if not weight > 0.0:
            continue
        g = family.denominator_of[int(row[INDEX + s])]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            j, scale = family.denominator_point[e], weight * family.denominator_weight[e]
            if frame.kind == TOWARDS_POINT and j == frame.anchor:
                continue
            fall, bend = expand_point(family, j, False, frame, centre, half, form, form_slopes)
            value, trace = bilinear(form, v, v), form[0] + form[1] + form[2]
            rest, plain = 0.5 * square * bend, 0.5 * square * fall
            eta = rest / math.sqrt(max(value, 1e-12 * trace))
            if eta < _LARGEST_SHARE and eta * value + rest * rest / eta < plain:
                add_scaled(scale * eta, form, form_slopes, matrix, slopes)
                change += scale * (rest * rest / eta - plain + ROUNDING * (trace + rest * rest / eta))
    add_identity(change, matrix)
