"""Forms at a box's centre, whitened: in coordinates in which the denominators' mean is the identity."""

from __future__ import annotations

import numpy as np

from nullpose.problem.records import BAND_AXIS
from nullpose.solver.kernels.bounds.exclusion import has_horizontal_axes
from nullpose.solver.kernels.bounds.node import (
    BAND,
    CELL,
    CENTRE,
    FACE,
    HALF,
    LEVEL,
    SIDE,
    cell_side,
    elevations,
)
from nullpose.solver.kernels.compiler.jit import inner_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import (
    add_denominator,
    add_point,
    congruence,
    in_frame,
    inverse_factor,
)
from nullpose.solver.kernels.linear_algebra.links import denominator_at, numerator_at
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, smallest_of
from nullpose.solver.kernels.linear_algebra.vectors import dot, store

_THIN = 1e-6  # by how much the ends of a band are moved, in u_z^2, so that its dual has an inside, at least
_COARSE = 0.005  # and in units of a box's size
_SHARE = 0.1  # of the square of what a cell spans, less some of the band's widths: for cones and narrow bands
_WIDTHS = 3.0  # how many
_MIDDLE = 0.2  # share of it where the band crosses the middle of the cell
_TIP = 0.1  # share of what a cell spans that a band holds then, by no more than that share of its width
_STEEP = 0.1  # share of the distance from level or upright by which ends are moved at most


@inner_kernel
def wider_band(axis_field, row, coarseness):
    """Return a band's ends, in u_z^2, moved apart for the search of multipliers."""
    least, greatest = elevations(row)
    low, high = axis_field.offset[0], axis_field.offset[1]
    width, span = high - low, 0.0 if row[FACE] < 0.0 else greatest - least
    narrow = _SHARE * span * span - _WIDTHS * width
    both, most = max(_THIN, _COARSE * coarseness, _MIDDLE * narrow), max(_TIP * width, narrow)
    down = max(both, min(most, low - greatest + _TIP * span))
    up = max(both, min(most, least - high + _TIP * span))
    return low - min(down, _STEEP * low), high + min(up, _STEEP * (1.0 - high))


@small_kernel
def whiten(family, basis, row, denominators, mean, back):
    """Fill every denominator at the centre, in the frame, their mean W, and what whitens it.

    A ratio's form is then that of ``N_k + t (W - D_k)``, which exceeds the level t exactly where the ratio
    does.
    """
    groups = denominators.shape[0]
    denominators[:, :], mean[:] = 0.0, 0.0
    for g in range(groups):
        add_denominator(family, g, 1.0, row[CENTRE:HALF], basis, denominators[g])
        add_scaled(1.0 / groups, denominators[g], mean)
    inverse_factor(mean, back)


@small_kernel
def ratio_form(family, is_horizontal, basis, row, whitening, k, out):
    """Fill the whitened form of one ratio at the centre."""
    denominators, mean, back = whitening
    den, level, raw = family.denominator_of, row[LEVEL], scratch(6)
    for m in range(6):
        raw[m] = level * (mean[m] - denominators[den[k], m])
    weight, isotropic = family.numerator_weight[k], family.numerator_isotropic[k]
    add_point(family, family.numerator_point[k], row[CENTRE:HALF], basis, weight, isotropic, raw)
    congruence(raw, back, out)
    if is_horizontal:  # no weight on the vertical: whitening leaves its direction alone
        out[2] = -(abs(out[0]) + abs(out[1]) + 2.0 * abs(out[3])) - level
        out[4] = out[5] = 0.0


@inner_kernel
def constraint_forms(axis_field, basis, row, coarseness, back, forms, places):
    """Fill the whitened forms of the cell's sides and of the band's ends; return how many there are.

    And the column of a row in which each one's multiplier stands, negative where it stands negated.
    """
    raw, turned = scratch(6), scratch(6)
    sides = np.int64(0)
    is_horizontal = has_horizontal_axes(axis_field)
    if row[FACE] >= 0.0:
        for side in range(2):
            if is_horizontal and side != (0 if row[FACE] == 0.0 else 1):
                continue
            cell_side(int(row[FACE]), row[CELL:SIDE], side, raw)
            congruence(raw, basis, turned)
            congruence(turned, back, forms[sides])
            if is_horizontal:
                forms[sides, 2] = forms[sides, 4] = forms[sides, 5] = 0.0
            places[sides] = SIDE + side
            sides += 1
    if axis_field.kind >= BAND_AXIS and not is_horizontal:
        ends = wider_band(axis_field, row, coarseness)
        for end in range(2):
            c = ends[end]
            if 0.0 < c < 1.0:
                for m in range(6):
                    raw[m] = (-c if end == 0 else c) if m < 3 else 0.0
                raw[2] += 1.0 if end == 0 else -1.0
                congruence(raw, basis, turned)
                congruence(turned, back, forms[sides])
                places[sides] = BAND if end == 1 else -BAND
                sides += 1
    return sides


@small_kernel
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
    return smallest_of(values[:ratios])


@inner_kernel
def whiten_axis(basis, back, u, w):
    """Fill an axis of the world in whitened coordinates."""
    v0, v1, v2 = in_frame(basis, u)
    # back is upper triangular: w solves back w = v
    w[2] = v2 / back[2, 2]
    w[1] = (v1 - back[1, 2] * w[2]) / back[1, 1]
    w[0] = (v0 - back[0, 1] * w[1] - back[0, 2] * w[2]) / back[0, 0]


@inner_kernel
def axis_of(basis, back, w, axis):
    """Fill the axis of the world, of any length, that whitened coordinates stand for."""
    v = dot(back[0], w), dot(back[1], w), dot(back[2], w)
    store((dot(basis[0], v), dot(basis[1], v), dot(basis[2], v)), axis)
