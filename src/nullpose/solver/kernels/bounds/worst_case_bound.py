"""A lower bound on one ratio over all errors: branch and bound on the axis and the offset, by lemma 4.

The ratio is at least t over a cell if ``F = (a - t) |y|^2 + c |y x v|^2 - t sum_j b_j |y|^2 L_j`` is not
negative there, with ``|y x v|^2 + l (y.v)^2`` in place of ``|y x v|^2`` if the antenna leaks. F less half of
a bound on its second derivatives times the squared distance from the cell's centre is concave, whatever the
places of the jammers, and so smallest at a corner of the cell. The cone and the ball of offsets enter with
multipliers. Proofs: docs/robust.md.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.bounds.error_cells import (
    COLUMNS,
    HALF,
    SLACK,
    ahead,
    axis_at,
    cell_of,
    empty_of_errors,
    first_cells,
    side_to_split,
    split,
)
from nullpose.solver.kernels.bounds.error_corners import Corners, curvatures, evaluate_corners, least_corner
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.linear_algebra.vectors import along, dot, minus, norm, scaled, signs, store
from nullpose.solver.kernels.search.worst_case import descend, into_ball, into_cone, ratio_at, worst_found

_BETTER = 1e-9  # relative: less is no reason to descend anew
_DEPTH = 512
_SHARE = 0.8  # of what is to spare that a jammer's bound may take


@inner_kernel
def multiplier(slope, of_constraint):
    """Return the multiplier of a constraint that cancels a slope along its own, if positive."""
    square = dot(of_constraint, of_constraint)
    return max(0.0, dot(slope, of_constraint) / square) if square > 0.0 else 0.0


@inner_kernel
def slope_of(total, half, count):
    """Return the slope by three coordinates from the sum of the values, with their signs, at the corners."""
    return (
        total[0] / (count * half[0]) if half[0] > 0.0 else 0.0,
        total[1] / (count * half[1]) if half[1] > 0.0 else 0.0,
        total[2] / (count * half[2]) if half[2] > 0.0 else 0.0,
    )


@inner_kernel
def multipliers(errors, cell, values):
    """Return the multipliers of the cone and of the ball that flatten F at the cell's centre, if positive."""
    by_x, by_d = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for m in range(values.shape[0]):
        for e in range(values.shape[1]):
            by_x, by_d = along(by_x, values[m, e], signs(2 * m)), along(by_d, values[m, e], signs(e))
    share = errors.cosine**2
    first = (1.0 if ahead(cell.face) == 1 else 0.0) - share
    second = (1.0 if ahead(cell.face) == 2 else 0.0) - share
    of_cone = (0.0, 2.0 * first * cell.x[1], 2.0 * second * cell.x[2])
    nu = multiplier(slope_of(by_x, cell.x_half, values.size), of_cone)
    return nu, multiplier(slope_of(by_d, cell.d_half, values.size), scaled(-2.0, cell.d))


@inner_kernel
def margin(errors, cell, corners, nu, mu, rest):
    """Bound F from below in a cell, with the best of the multipliers or none."""
    lean, swing, most = norm(cell.x_half), norm(cell.d_half), -math.inf
    for trial in range(4):
        of_cone, of_ball = nu if trial & 1 else 0.0, mu if trial & 2 else 0.0
        more = rest + of_cone * (errors.cosine * lean) ** 2 + of_ball * swing**2
        most = max(most, least_corner(corners, of_cone, of_ball) - more * (1.0 + SLACK))
    return most


@inner_kernel
def holds(ratio, errors, level, cell, tolerance, corners):
    """Return (whether the ratio is at least the level all over a cell, the side to split otherwise)."""
    lean, swing = norm(cell.x_half), norm(cell.d_half)
    distance = norm(minus(ratio.node, cell.d))
    # the signal, which has no bound where the drone may be at the node, is left out there
    weight = ratio.weight if distance > swing else 0.0
    a = math.inf
    if evaluate_corners(ratio, weight, errors, level, cell, math.inf, corners):
        a, b, c = curvatures(ratio, ratio.sets.channels, weight, level, cell, corners.across)
    if not a < math.inf:
        return False, side_to_split(cell, distance**2, 1.0)
    nu, mu = multipliers(errors, cell, corners.values)
    rest = 0.5 * (a * lean**2 + 2.0 * b * lean * swing + c * swing**2)
    spare = margin(errors, cell, corners, nu, mu, rest)
    size = corners.sizes[0, 0]
    if spare > tolerance * size:  # bounds need be no closer than what is to spare
        tolerance = _SHARE * spare / size
        if evaluate_corners(ratio, weight, errors, level, cell, tolerance, corners):
            a, b, c = curvatures(ratio, ratio.sets.channels, weight, level, cell, corners.across)
            rest = 0.5 * (a * lean**2 + 2.0 * b * lean * swing + c * swing**2)
            if margin(errors, cell, corners, nu, mu, rest) >= 0.0:
                return True, 0
    by_axis = a + 2.0 * nu + (b * swing / lean if lean > 0.0 else 0.0)
    return False, side_to_split(cell, by_axis, c + 2.0 * mu + (b * lean / swing if swing > 0.0 else 0.0))


@heap_kernel
def worst_case(ratio, errors, accuracy, most, y, offset, places):
    """Return (lower bound on the ratio over all errors, least ratio found, cells examined).

    Args:
        ratio: the ratio.
        errors: what may be wrong.
        accuracy: the bound aimed at is ``least found (1 - accuracy)``; 1 or more asks for no bound.
        most: cells after which the level is lowered, every time by twice as much, so that it ends.
        y: output, (3,): the actual axis of the least ratio found, of unit length.
        offset: output, (3,): its offset of the position.
        places: output, (n, 3): the jammers' places from the actual position.
    """
    worst, at_y, at_offset = worst_found(ratio, errors, places)
    n_axes, n_offsets = 4 if errors.sine > 0.0 else 1, 8 if errors.reach > 0.0 else 1
    table = np.empty((2, n_axes, n_offsets))
    across = np.empty(ratio.shares.shape[0])
    corners = Corners(table[0], table[1], np.empty(n_axes), np.empty(n_offsets), across)
    cells = np.empty((_DEPTH, COLUMNS))
    level, short, examined = worst * max(0.0, 1.0 - accuracy), accuracy, 0
    top = first_cells(errors, cells)
    while top > 0 and level > 0.0:
        top -= 1
        cell = cell_of(cells, top)
        if empty_of_errors(errors, cell):
            continue
        examined += 1
        proved, side = holds(ratio, errors, level, cell, 0.2 * short, corners)
        if proved:
            continue
        centre = into_cone(errors, axis_at(errors, cell.face, cell.x)), into_ball(errors.reach, cell.d)
        if ratio_at(ratio, centre[0], centre[1], places)[0] < worst * (1.0 - _BETTER):
            worst, at_y, at_offset = descend(ratio, errors, centre[0], centre[1], places)
            level = min(level, worst * (1.0 - accuracy))
        if examined % most == 0 or top + 2 > _DEPTH or not cells[top, HALF + side] > 0.0:
            level -= min(1.0, short) * level  # which all cells before it are above, and soon the next
            short *= 2.0
            top += 1
            continue
        split(cells, top, side)
        top += 2
    store(at_y, y)
    store(at_offset, offset)
    return max(0.0, level), min(worst, ratio_at(ratio, at_y, at_offset, places)[0]), examined
