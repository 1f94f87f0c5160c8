"""Forms at a box's centre, whitened: in coordinates in which the denominators' mean is the identity."""

from __future__ import annotations

import numpy as np

from nullpose.solve.kernels.box import CENTRE, HALF, LEVEL
from nullpose.solve.kernels.cells import CONSTRAINTS, constraint, is_level
from nullpose.solve.kernels.forms import add_form, congruence, inverse_factor, seen_from
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.links import denominator_at, numerator_at
from nullpose.solve.kernels.scratch import scratch

__all__ = ["axis_of", "constraint_forms", "fill_values", "ratio_form", "whiten", "whiten_axis"]


@inner_kernel
def fill_denominators(family, basis, centre, denominators, mean):
    """Fill every denominator at the centre, in the frame, and their mean."""
    groups = denominators.shape[0]
    denominators[:, :] = 0.0
    mean[:] = 0.0
    for g in range(groups):
        for m in range(3):
            denominators[g, m] = family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            x, y, z = seen_from(family.points_m, family.turn, family.denominator_point[e], centre, basis)
            add_form(x, y, z, family.leak, family.denominator_weight[e], 0.0, denominators[g])
        for m in range(6):
            mean[m] += denominators[g, m] / groups


@inner_kernel
def whiten(family, basis, row, denominator, denominators, mean, back):
    """Fill what whitens, and with several denominators each of them and their mean W, in the frame.

    A ratio's form is then that of ``N_k + t (W - D_k)``, which exceeds the level t exactly where the ratio
    does.
    """
    if family.denominator_isotropic.shape[0] == 1:
        for m in range(6):
            mean[m] = -denominator[m] / row[LEVEL]
    else:
        fill_denominators(family, basis, row[CENTRE:HALF], denominators, mean)
    inverse_factor(mean, back)


@inner_kernel
def ratio_form(family, level_axes, basis, row, whitening, k, out):
    """Fill the whitened form of one ratio at the centre."""
    denominators, mean, back = whitening
    den, level, raw = family.denominator_of, row[LEVEL], scratch(6)
    several = family.denominator_isotropic.shape[0] > 1
    for m in range(6):
        raw[m] = level * (mean[m] - denominators[den[k], m]) if several else 0.0
    x, y, z = seen_from(family.points_m, family.turn, family.numerator_point[k], row[CENTRE:HALF], basis)
    add_form(x, y, z, family.leak, family.numerator_weight[k], family.numerator_isotropic[k], raw)
    congruence(raw, back, out)
    if level_axes:  # no weight on the vertical: whitening leaves its direction alone
        out[2] = -(abs(out[0]) + abs(out[1]) + 2.0 * abs(out[3])) - level
        out[4] = out[5] = 0.0


@inner_kernel
def constraint_forms(axis_field, basis, row, back, forms, numbers, scales):
    """Fill forms of the constraints of the row's cell and band, their numbers and scales; return how many.

    A constraint ``Q >= 0`` at a level t is the form ``t I + s Q``: it is at least t where Q is not negative,
    and there are multipliers with it that bring the largest eigenvalue below t whatever the scale s > 0 is
    if there are any. The scale makes the entries of s Q up to t.
    """
    raw, turned = scratch(6), scratch(6)
    sides, level = np.int64(0), row[LEVEL]
    for q in range(CONSTRAINTS):
        there, isotropic = constraint(axis_field, row, q, raw)
        if not there:
            continue
        for m in range(3):
            raw[m] += isotropic
        form = forms[sides]
        congruence(raw, basis, turned)
        congruence(turned, back, form)
        if is_level(axis_field):
            form[2] = form[4] = form[5] = 0.0
        largest = 0.0
        for m in range(6):
            largest = max(largest, abs(form[m]))
        for m in range(6):
            form[m] = level * (form[m] / largest + (1.0 if m < 3 else 0.0))
        numbers[sides], scales[sides] = q, level / largest
        sides += 1
    return sides


@inner_kernel
def fill_values(family, centre, level, axis, size, values):
    """Fill every ratio's form at an axis of the world, whose squared length when whitened is ``size``.

    Returns the smallest.
    """
    ratios, groups = family.numerator_weight.shape[0], family.denominator_isotropic.shape[0]
    for k in range(ratios):
        values[k] = numerator_at(family, k, centre, axis)
    for g in range(groups if groups > 1 else 0):
        excess = level * (size - denominator_at(family, g, centre, axis))
        for k in range(ratios):
            values[k] += excess if family.denominator_of[k] == g else 0.0
    smallest = values[0]
    for k in range(1, ratios):
        smallest = min(smallest, values[k])
    return smallest


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
def axis_of(basis, back, w, axis):
    """Fill the axis of the world, of any length, that whitened coordinates stand for."""
    v = scratch(3)
    for i in range(3):
        v[i] = back[i, 0] * w[0] + back[i, 1] * w[1] + back[i, 2] * w[2]
    for i in range(3):
        axis[i] = basis[i, 0] * v[0] + basis[i, 1] * v[1] + basis[i, 2] * v[2]
