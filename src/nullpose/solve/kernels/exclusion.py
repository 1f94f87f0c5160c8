"""The test that excludes a node: a weighted sum of forms that is negative all over its box and cell.

Multipliers ``lambda`` (one per ratio, summing to one) and ``mu`` (one per side of the cell) exclude a box at
a level t if
``sum_k lambda_k (N_k(p) - t D_k(p)) + sum_q mu_q Q_q`` is negative definite for every position p in it: then
no pose there
has all its ratios at t or above. The matrix is bounded by its first-order expansion at the eight corners
plus a second-order remainder.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.expansion import ABOUT_LINE, TOWARDS_POINT, WORLD, expand_point, min_distance
from nullpose.solve.kernels.forms import congruence
from nullpose.solve.kernels.jit import kernel
from nullpose.solve.kernels.node import (
    CELL,
    CENTRE,
    COUNT,
    FACE,
    FAR,
    HALF,
    INDEX,
    KEPT_OUT,
    LEVEL,
    SIDE,
    WEIGHT,
    cell_side,
)

__all__ = ["excludes", "expand_denominator", "out_of_reach"]


@kernel
def negative_definite(a0, a1, a2, a3, a4, a5):
    """Return whether a form is negative definite, by the leading minors of its negative."""
    minor = a0 * a1 - a3 * a3
    det = -a2 * minor + a0 * a5 * a5 + a1 * a4 * a4 - 2.0 * a3 * a4 * a5
    return a0 < 0.0 and minor > 0.0 and det > 0.0


@kernel
def negative_at_corners(matrix, slopes, half, fixed):
    """Return whether the linear matrix, or its last entry, is negative at all eight corners."""
    if fixed:
        swing = 0.0
        for i in range(3):
            swing += half[i] * abs(slopes[i, 2])
        return matrix[2] + swing < 0.0
    for corner in range(8):
        x = half[0] if corner & 1 else -half[0]
        y = half[1] if corner & 2 else -half[1]
        z = half[2] if corner & 4 else -half[2]
        if not negative_definite(
            matrix[0] + x * slopes[0, 0] + y * slopes[1, 0] + z * slopes[2, 0],
            matrix[1] + x * slopes[0, 1] + y * slopes[1, 1] + z * slopes[2, 1],
            matrix[2] + x * slopes[0, 2] + y * slopes[1, 2] + z * slopes[2, 2],
            matrix[3] + x * slopes[0, 3] + y * slopes[1, 3] + z * slopes[2, 3],
            matrix[4] + x * slopes[0, 4] + y * slopes[1, 4] + z * slopes[2, 4],
            matrix[5] + x * slopes[0, 5] + y * slopes[1, 5] + z * slopes[2, 5],
        ):
            return False
    return True


@kernel
def add_scaled(weight, form, slopes, matrix, matrix_slopes):
    """Add a weighted form and its slopes to a matrix and its slopes."""
    for m in range(6):
        matrix[m] += weight * form[m]
        for i in range(3):
            matrix_slopes[i, m] += weight * slopes[i, m]


@kernel
def across_axis(points, j, view, centre, half):
    """Return bounds on the form of point j along the third axis that are sharp at a null.

    The part of ``r`` across the axis has two components, each linear in the position up to a remainder (none
    in the
    world frame). Squares lie above their tangents, so that close to a null, where the components are small,
    so is
    the remainder of their sum. The first bound is the form's least value in the box; the second bounds its
    second derivative from below, for use with its value and slopes at the centre.
    """
    kind, _, basis, rho, rho_min = view
    size2 = half[0] ** 2 + half[1] ** 2 + half[2] ** 2
    far2 = here2 = 0.0
    along = np.zeros(3)
    for i in range(3):
        r = points[j, i] - centre[i]
        here2 += r * r
        far2 += (abs(r) + half[i]) ** 2
        for m in range(3):
            along[m] += basis[i, m] * r
    turning = 0.0  # second derivative of the second component, which turns with the frame about the line
    steepest = 1.0
    if kind == ABOUT_LINE:
        turning = 1.1548 * math.hypot(along[1] + rho, along[2]) / (rho_min * rho_min) + 1.0 / rho_min
        steepest = math.hypot(1.0, along[2] / rho)
    least = 0.0
    for m in range(2):
        swing = 0.5 * size2 * turning if m == 1 else 0.0
        for i in range(3):
            slope = -basis[i, m]
            if kind == ABOUT_LINE and m == 1:
                slope += along[2] * basis[i, 2] / rho
            swing += half[i] * abs(slope)
        least += max(0.0, abs(along[m]) - swing) ** 2
    near = min_distance(points, j, centre, half)
    s = math.hypot(along[0], along[1])
    widest = (s + steepest * math.sqrt(size2)) ** 2 + abs(along[1]) * turning * size2
    curvature = 8.0 * s * steepest / here2**2.5 + 2.0 * widest / near**6 + abs(along[1]) * turning / near**4
    # the tangent of 1/|r|^4 must not fall below zero in the box
    if 4.0 * math.sqrt(size2) / here2**2.5 + 2.0 * size2 / near**6 > 1.0 / here2**2:
        curvature = math.inf
    return least / (far2 * far2), -2.0 * curvature


@kernel
def expand_denominator(family, fixed, level, view, centre, half, out, out_slopes):
    """Fill ``-t D`` and its slopes, or less where that is a sharper bound.

    Returns its remainders, isotropic and on the first two axes, and the denominator along the third at the
    centre.
    """
    points, _, _, _, _, d0, dstart, dpt, dw = family
    kind, anchor, basis, rho, rho_min = view
    form, slopes = np.empty(6), np.empty((3, 6))
    for m in range(6):
        out[m] = -level * d0[0] if m < 3 else 0.0
        for i in range(3):
            out_slopes[i, m] = 0.0
    everywhere = across = 0.0
    plain = d0[0]
    radius = 0.5 * (half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    for e in range(dstart[0], dstart[1]):
        j = dpt[e]
        _, down = expand_point(points, j, kind, anchor, basis, rho, rho_min, centre, half, form, slopes)
        plain += dw[e] * form[2]
        if fixed and kind != TOWARDS_POINT:
            least, sharper = across_axis(points, j, view, centre, half)
            down = max(down, sharper)
            linear = form[2] + radius * down
            for i in range(3):
                linear -= half[i] * abs(slopes[i, 2])
            if least > linear:
                out[2] -= level * dw[e] * least
                continue
        add_scaled(-level * dw[e], form, slopes, out, out_slopes)
        if kind == TOWARDS_POINT and j == anchor:
            across -= level * dw[e] * down
        else:
            everywhere -= level * dw[e] * down
    return everywhere, across, plain


@kernel
def add_side(form, weight, view, matrix, matrix_slopes):
    """Add a weighted side of a cell, turned into the frame, and its slopes; return its remainder."""
    kind, _, basis, rho, rho_min = view
    q = np.empty(6)
    congruence(form, basis, q)
    for m in range(6):
        matrix[m] += weight * q[m]
    if kind == WORLD:
        return 0.0
    for i in range(3):
        x, y = basis[i, 0] / rho, basis[i, 1] / rho
        matrix_slopes[i, 0] += weight * 2.0 * x * q[4]
        matrix_slopes[i, 1] += weight * 2.0 * y * q[5]
        matrix_slopes[i, 2] -= weight * 2.0 * (x * q[4] + y * q[5])
        matrix_slopes[i, 3] += weight * (y * q[4] + x * q[5])
        matrix_slopes[i, 4] += weight * (x * (q[2] - q[0]) - y * q[3])
        matrix_slopes[i, 5] += weight * (y * (q[2] - q[1]) - x * q[3])
    size = q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + 2.0 * (q[3] ** 2 + q[4] ** 2 + q[5] ** 2)
    return weight * 2.4143 * math.sqrt(2.0 * size) / (rho_min * rho_min)


@kernel
def excludes(family, fixed, view, row, below):
    """Return whether the row's multipliers exclude its box and cell.

    Args:
        family: arrays of the family.
        fixed: whether the axis is the frame's third.
        view: the frame at the box's centre, from ``set_frame``.
        row: the node.
        below: ``-t D``, its slopes and its remainders, from ``expand_denominator``.
    """
    points, n0, nw, npt = family[:4]
    kind, anchor, basis, rho, rho_min = view
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    if not row[COUNT] > 0.0:
        return False
    form, form_slopes = np.empty(6), np.empty((3, 6))
    matrix, slopes = np.empty(6), np.empty((3, 6))
    for m in range(6):
        matrix[m] = below[0][m]
        for i in range(3):
            slopes[i, m] = below[1][i, m]
    everywhere, across, _ = below[2]
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        weight = row[WEIGHT + s]
        up, _ = expand_point(
            points, npt[k], kind, anchor, basis, rho, rho_min, centre, half, form, form_slopes
        )
        if fixed and kind == ABOUT_LINE:  # the nodes stay broadside: their form is 1/|a|^2 exactly
            up = 6.0 / min_distance(points, npt[k], centre, half) ** 4
        add_scaled(weight * nw[k], form, form_slopes, matrix, slopes)
        for m in range(3):
            matrix[m] += weight * n0[k]
        everywhere += weight * nw[k] * up
    if row[FACE] >= 0.0:
        for side in range(2):
            if row[SIDE + side] > 0.0:
                cell_side(int(row[FACE]), row[CELL:SIDE], side, form)
                everywhere += add_side(form, row[SIDE + side], view, matrix, slopes)
    radius = 0.5 * (half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    matrix[0] += radius * (everywhere + across)
    matrix[1] += radius * (everywhere + across)
    matrix[2] += radius * everywhere
    return negative_at_corners(matrix, slopes, half, fixed)


@kernel
def out_of_reach(family, keep_points, keep_radius, row):
    """Return the kind of a box that needs no multipliers, too far or inside a keep-out ball, or -1."""
    points, n0, nw, npt, den, d0 = family[:6]
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    for k in range(nw.shape[0]):
        a = min_distance(points, npt[k], centre, half)
        if (n0[k] - row[LEVEL] * d0[den[k]]) * a * a + nw[k] < 0.0:
            row[INDEX] = k
            return FAR
    for q in range(keep_points.shape[0]):
        d = 0.0
        for i in range(3):
            d += (abs(keep_points[q, i] - centre[i]) + half[i]) ** 2
        if d < keep_radius * keep_radius:
            row[INDEX] = q
            return KEPT_OUT
    return -1
