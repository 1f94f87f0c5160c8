"""The test that excludes a node of a free axis: a weighted sum of forms that is negative all over its box.

Multipliers ``lambda`` (one per ratio, summing to one) and ``mu`` (one per side of the cell of axes, one for
the band of elevations) exclude a box at the ratio t if ``sum_k lambda_k (N_k(p) - t D_k(p)) + sum mu_q Q_q``
is negative definite for every position p in it: then no pose there has all its ratios at t or above. ``Q_q``
are the forms that no axis of the cell or the band makes negative. The matrix is expanded to the first order
at the box's centre; with a bound on the remainder, and a margin for rounding, it is tested at the eight
corners. Where all axes are horizontal, it only needs to be negative definite in the horizontal plane.

A form is six numbers: xx, yy, zz, xy, xz, yz. Forms stand in a frame that turns with the direction to one
ground point, the anchor, whose null stands still in it (docs/proofs.md, lemma 2).
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.problem.records import BAND_AXIS, CONE_AXIS
from nullpose.solver.kernels.bounds.borders import borders, choose_border, weigh_borders
from nullpose.solver.kernels.bounds.constants import CONSTANT_FORM_BEND, ROUNDING
from nullpose.solver.kernels.bounds.dipoles import add_constant, add_links, centre_form
from nullpose.solver.kernels.bounds.expansion import expand_once, min_square
from nullpose.solver.kernels.bounds.link_vectors import Shear, shear_at
from nullpose.solver.kernels.bounds.node import (
    ANCHOR,
    BALL,
    BAND,
    CELL,
    CENTRE,
    COUNT,
    FACE,
    FAR,
    HALF,
    KEPT_OUT,
    LEVEL,
    NU,
    SIDE,
    cell_side,
)
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD
from nullpose.solver.kernels.bounds.signed_sum import fill_sum, log_most_mean, unreachable_pair
from nullpose.solver.kernels.bounds.tilt import tilt_sum
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int, zeroed
from nullpose.solver.kernels.linear_algebra.forms import bilinear, congruence, form_value
from nullpose.solver.kernels.linear_algebra.links import most_heard
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_identity,
    add_scaled,
    copy_into,
    copy_table,
    form_product,
    top_eigenvector,
)
from nullpose.solver.kernels.linear_algebra.vectors import corner_of, dot, minus
from nullpose.solver.kernels.search.domain import forbidding
from nullpose.solver.kernels.search.zones import MOST_ALTERNATIVES

_FORESEEN_SHARE = 0.7  # of a remainder: a half with multipliers of its own does better than is foreseen
_CENTRE = (0.0, 0.0, 0.0)  # as a step from it
_LARGEST_SHARE = 0.5  # of a form that is given up for a smaller remainder
_DEFINITE = 1e-13  # least minor over the products that it consists of: many times its rounding


@inner_kernel
def has_horizontal_axes(axis_field):
    """Check whether an axis field holds the level axes only."""
    return axis_field.kind == CONE_AXIS and axis_field.offset[1] == 0.0


@inner_kernel
def negative_at(matrix, slopes, step, is_horizontal):
    """Check whether the linear matrix is negative definite at a step from the centre."""
    x, y, z = step
    a0 = matrix[0] + x * slopes[0, 0] + y * slopes[1, 0] + z * slopes[2, 0]
    a1 = matrix[1] + x * slopes[0, 1] + y * slopes[1, 1] + z * slopes[2, 1]
    a3 = matrix[3] + x * slopes[0, 3] + y * slopes[1, 3] + z * slopes[2, 3]
    # leading minors, not eigenvalues: this runs eight times for every box
    minor = a0 * a1 - a3 * a3
    if not (a0 < 0.0 and minor > _DEFINITE * a0 * a1):
        return False
    if is_horizontal:
        return True
    a2 = matrix[2] + x * slopes[0, 2] + y * slopes[1, 2] + z * slopes[2, 2]
    a4 = matrix[4] + x * slopes[0, 4] + y * slopes[1, 4] + z * slopes[2, 4]
    a5 = matrix[5] + x * slopes[0, 5] + y * slopes[1, 5] + z * slopes[2, 5]
    negated_determinant = -a2 * minor + a0 * a5 * a5 + a1 * a4 * a4 - 2.0 * a3 * a4 * a5
    return negated_determinant > -_DEFINITE * a0 * a1 * a2


@inner_kernel
def failing_corner(matrix, slopes, middle, half, is_horizontal):
    """Return the first corner of a box at which the linear matrix is not negative definite, or -1."""
    for corner in range(8):
        if not negative_at(matrix, slopes, corner_of(middle, half, corner), is_horizontal):
            return corner
    return -1


@inner_kernel
def passes_without(matrix, slopes, half, corner, remainder, is_horizontal):
    """Check whether a failing corner passes without a part of the remainder."""
    rest = scratch(6)
    copy_into(matrix, rest)
    add_identity(-remainder, rest)
    return negative_at(rest, slopes, corner_of(_CENTRE, half, corner), is_horizontal)


@inner_kernel
def will_fail(forecast, row, part, is_horizontal):
    """Foresee whether a part of a box fails the test, from the matrix of the whole box."""
    half, whole, matrix = part[HALF:LEVEL], row[HALF:LEVEL], scratch(6)
    if forecast.rest[0] == math.inf:  # no multipliers exclude even the centre
        return True
    middle = minus(part[CENTRE:HALF], row[CENTRE:HALF])
    share = _FORESEEN_SHARE * dot(half, half) / dot(whole, whole)  # remainders are of the second order
    copy_into(forecast.matrix, matrix)
    add_scaled(share, forecast.rest, matrix)
    return failing_corner(matrix, forecast.slopes, middle, half, is_horizontal) >= 0


@inner_kernel
def add_side(form, weight, frame, matrix, matrix_slopes):
    """Add a weighted side of a cell, turned into the frame, and its slopes; return its remainder."""
    q, basis = scratch(6), frame.basis
    congruence(form, basis, q)
    add_scaled(weight, q, matrix)
    if frame.kind == WORLD:
        return 0.0
    for i in range(3):
        x, y = basis[i, 0] / frame.radius_m, basis[i, 1] / frame.radius_m
        matrix_slopes[i, 0] += weight * 2.0 * x * q[4]
        matrix_slopes[i, 1] += weight * 2.0 * y * q[5]
        matrix_slopes[i, 2] -= weight * 2.0 * (x * q[4] + y * q[5])
        matrix_slopes[i, 3] += weight * (y * q[4] + x * q[5])
        matrix_slopes[i, 4] += weight * (x * (q[2] - q[0]) - y * q[3])
        matrix_slopes[i, 5] += weight * (y * (q[2] - q[1]) - x * q[3])
    size = math.sqrt(2.0 * form_product(q, q))
    return weight * CONSTANT_FORM_BEND * size / (frame.least_radius_m * frame.least_radius_m)


@small_kernel
def add_linear(weight, form, slopes, matrix, matrix_slopes):
    """Add a weighted form and its slopes to a matrix and its slopes."""
    add_scaled(weight, form, matrix)
    for i in range(3):
        add_scaled(weight, slopes[i], matrix_slopes[i])


@small_kernel
def add_sum(family, axis_field, frame, row, workspace, matrix):
    """Fill the row's sum, its slopes and its rest; return the rest of what is subtracted in it."""
    centre, half, slopes, rest = row[CENTRE:HALF], row[HALF:LEVEL], workspace.slopes, workspace.rest
    half_square = 0.5 * dot(half, half)  # a remainder is this times a second derivative
    matrix[:], slopes[:, :] = 0.0, 0.0
    identity, size = fill_sum(family, row, workspace.sums)
    add_identity(identity, matrix)
    everywhere, across, subtracted, added = ROUNDING * size, 0.0, 0.0, 0.0
    for j in range(workspace.sums.shape[0]):
        weight = workspace.sums[j]
        if weight != 0.0:
            expand_once(family, j, weight > 0.0, frame, centre, half, workspace)
            form, bend = workspace.forms[j], workspace.bends[j, 0]
            add_linear(weight, form, workspace.form_slopes[j], matrix, slopes)
            left = abs(weight) * (half_square * bend + ROUNDING * (form[0] + form[1] + form[2]))
            if frame.kind == TOWARDS_POINT and j == frame.anchor:  # it lies across its own null only
                across += (1.0 - family.leak) * left
                left *= family.leak
            everywhere += left
            subtracted += left if weight < 0.0 else 0.0
            added += left if weight > 0.0 else 0.0
    rest[:] = 0.0
    if workspace.tilt[3] > 0.0:
        everywhere += tilt_sum(workspace, half, slopes, rest, added)
    side = scratch(6)
    for number in range(3):
        weight, level = constraint_of(axis_field, row, number, side)
        if weight > 0.0:
            add_identity(weight * level, matrix)  # which no frame turns
            everywhere += half_square * add_side(side, weight, frame, matrix, slopes)
            everywhere += 4.0 * ROUNDING * weight  # a form's entries are at most 1
    add_identity(everywhere, rest)
    rest[0], rest[1] = rest[0] + across, rest[1] + across
    return subtracted


@inner_kernel
def sharpen(family, frame, row, workspace, matrix, slopes):
    """Replace the remainders of what is subtracted by smaller ones where they are smaller.

    With ``w = h r / |r|^2``, r seen in the frame, a link is ``|u x w|^2 + leak (u.w)^2``, a sum of squares
    of numbers that are linear in w and together no longer than it; and the rest of w beyond first order is
    at most ``W |x|^2 / 2`` at a step x from the centre. Since ``2 p q <= eta p^2 + q^2 / eta``, its
    form is at least ``(1 - eta) (M + M'.x) - (W |x|^2 / 2)^2 / eta I`` for any eta in (0, 1): beside the
    null, where M is small, far better than a remainder of the second order. The point that the frame turns
    towards keeps its own.
    """
    centre, half, v, change = row[CENTRE:HALF], row[HALF:LEVEL], scratch(3), 0.0
    top_eigenvector(matrix, v)
    square = dot(half, half)
    for j in range(workspace.sums.shape[0]):
        scale = -workspace.sums[j]
        if not scale > 0.0 or (frame.kind == TOWARDS_POINT and j == frame.anchor):
            continue
        expand_once(family, j, False, frame, centre, half, workspace)
        form, fall, bend = workspace.forms[j], workspace.bends[j, 0], workspace.bends[j, 1]
        value, trace = bilinear(form, v, v), form[0] + form[1] + form[2]
        rest, plain = 0.5 * square * bend, 0.5 * square * fall
        eta = rest / math.sqrt(max(value, 1e-12 * trace))
        if eta < _LARGEST_SHARE and eta * value + rest * rest / eta < plain:
            add_linear(scale * eta, form, workspace.form_slopes[j], matrix, slopes)
            change += scale * (rest * rest / eta - plain + ROUNDING * (trace + rest * rest / eta))
    add_identity(change, matrix)


@rare_kernel
def add_dipole_sum(family, axis_field, frame, row, workspace, matrix):
    """Fill the row's sum and its slopes and rest where points have dipoles."""
    v, weights, turned, half = scratch(3), scratch(3), scratch(3, 6), row[HALF:LEVEL]
    slopes, rest, sums = workspace.slopes, workspace.rest, workspace.sums
    shear = shear_at(
        family, frame, row[CENTRE:HALF], half,
        Shear(np.int64(WORLD), False, 0.0, scratch(3, 3), scratch(6, 3), zeroed(4)),
    )  # fmt: skip
    matrix[:], slopes[:, :], rest[:] = 0.0, 0.0, 0.0
    identity, size = fill_sum(family, row, sums)
    centre_form(family, frame, row, identity, sums, matrix)
    q = scratch(6)
    for number in range(3):
        weights[number], level = constraint_of(axis_field, row, number, q)
        add_identity(level, q)
        congruence(q, frame.basis, turned[number])
        add_scaled(weights[number], turned[number], matrix)
    top_eigenvector(matrix, v)
    matrix[:] = 0.0
    for number in range(3):
        if weights[number] > 0.0:
            add_constant(shear, half, weights[number], turned[number], matrix, slopes, rest)
    add_identity(ROUNDING * size, rest)
    add_links(family, shear, frame, row, identity, sums, v, matrix, slopes, rest)


@small_kernel
def constraint_of(axis_field, row, number, form):
    """Fill the form of a cell's side (0 or 1) or of the band (2), but for a multiple of the identity.

    Return its multiplier, zero where it is not in force, and that multiple.
    """
    form[:] = 0.0
    if number < 2:
        if row[FACE] < 0.0 or not row[SIDE + number] > 0.0:
            return 0.0, 0.0
        cell_side(int(row[FACE]), row[CELL:SIDE], number, form)
        return row[SIDE + number], 0.0
    if axis_field.kind < BAND_AXIS or has_horizontal_axes(axis_field):
        return 0.0, 0.0
    upper = row[BAND] > 0.0  # its sign tells the end of the band that is in force
    form[2] = -1.0 if upper else 1.0
    return abs(row[BAND]), axis_field.offset[1] if upper else -axis_field.offset[0]


@inner_kernel
def excludes(family, domain, axis_field, frame, row, workspace):
    """Check whether the row's multipliers exclude its box and cell; fill its border's, and the forecast."""
    if not (row[COUNT] > 0.0 or family.shares.shape[0] > 0):
        return False
    matrix, slopes = scratch(6), workspace.slopes
    dipoles = family.ground_axes.shape[0] > 0
    row[NU] = subtracted = 0.0
    half, is_horizontal = row[HALF:LEVEL], has_horizontal_axes(axis_field)
    if dipoles:
        add_dipole_sum(family, axis_field, frame, row, workspace, matrix)
    else:
        subtracted = add_sum(family, axis_field, frame, row, workspace, matrix)
    # without a remainder, at the centre: what fails there fails in every box about it, however small
    if row[BALL] < 0.0 and not negative_at(matrix, slopes, _CENTRE, is_horizontal):
        workspace.rest[0] = math.inf
        return False
    copy_into(matrix, workspace.matrix)
    add_scaled(1.0, workspace.rest, matrix)
    corner = failing_corner(matrix, slopes, _CENTRE, half, is_horizontal)
    if corner < 0:
        return True
    # sharper remainders cost as much as the test so far: only where none at all would let the corner pass
    if not dipoles and passes_without(matrix, slopes, half, corner, subtracted, is_horizontal):
        if is_horizontal:  # what is off the level plane does not count
            matrix[2] = -2.0 * (abs(matrix[0]) + abs(matrix[1]) + abs(matrix[3]))
            matrix[4] = matrix[5] = 0.0
        slopes = scratch(3, 6)
        copy_table(workspace.slopes, slopes)
        sharpen(family, frame, row, workspace, matrix, slopes)
        if failing_corner(matrix, slopes, _CENTRE, half, is_horizontal) < 0:
            return True
    return row[BALL] >= 0.0 and excludes_within_borders(domain, row, matrix, slopes, is_horizontal)


@rare_kernel
def excludes_within_borders(domain, row, matrix, slopes, is_horizontal):
    """Check whether the matrix is negative wherever a border allows positions; fill its multiplier."""
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    alternatives = borders(domain, row, sides, counts)
    if alternatives == 0:
        return False
    v, gradient, border = scratch(3), scratch(3), scratch(7)
    half = row[HALF:LEVEL]
    if is_horizontal:
        matrix[2], matrix[4], matrix[5] = min(matrix[0], matrix[1]) - abs(matrix[3]), 0.0, 0.0
    # the border is to cancel the slope along the axis that fails worst
    top_eigenvector(matrix, v)
    for i in range(3):
        gradient[i] = form_value(slopes, i, v)
    bordered, bordered_slopes = scratch(6), scratch(3, 6)
    for a in range(alternatives):
        row[NU] = weigh_borders(sides[a], counts[a], row, gradient, border)
        if row[NU] < 0.0:
            return False
        copy_into(matrix, bordered)
        copy_table(slopes, bordered_slopes)
        rest = border[0]
        for i in range(3):
            rest += 0.5 * border[4 + i] * half[i] ** 2
            add_identity(border[1 + i], bordered_slopes[i])
        add_identity(rest, bordered)
        if failing_corner(bordered, bordered_slopes, _CENTRE, half, is_horizontal) >= 0:
            return False
    if int(row[BALL]) >= domain.keep_out_points_m.shape[0]:
        row[NU] = 1.0  # any positive number: the verifier finds a zone's multipliers itself
    return True


@small_kernel
def out_of_reach(family, domain, row):
    """Return the kind of a box that needs no multipliers, too far or forbidden, or -1; fill its border."""
    centre, half, row[NU] = row[CENTRE:HALF], row[HALF:LEVEL], 0.0
    is_mean = family.shares.shape[0] > 0
    if is_mean and log_most_mean(family, centre, half) < math.log(row[LEVEL]):
        row[ANCHOR] = 0.0
        return FAR
    has_pairs = family.pairs.shape[0] > 0
    pair = unreachable_pair(family, row[LEVEL], centre, half) if has_pairs else -1
    if pair >= 0:
        row[ANCHOR] = pair
        return FAR
    for k in range(0 if is_mean or has_pairs else family.numerator_weight.shape[0]):
        least = row[LEVEL] * family.denominator_isotropic[family.denominator_of[k]]
        square = min_square(family.points_m, family.numerator_point[k], centre, half)
        if most_heard(family, k, square) < least:
            row[ANCHOR] = k  # not where the multipliers are: a later stage begins with them
            return FAR
    border = forbidding(domain, centre, half)
    if border >= 0:
        row[ANCHOR] = border
        return KEPT_OUT
    choose_border(domain, row)
    return -1
