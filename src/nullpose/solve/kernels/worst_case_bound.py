"""A lower bound on one ratio over all errors: branch and bound on the axis and the offset.

The axis is ``y = f0 + x1 f1 + x2 f2``, of any length, on a face of a cube about the drone. The ratio is at
least t over a cell if ``F = (a - t) |y|^2 + c |y x v|^2 - t sum_j b_j |y|^2 L_j`` is not negative there. F
less half of a bound on its second derivatives times the squared distance from the cell's centre is concave,
whatever the places of the jammers, and so smallest at a corner of the cell. The cone and the ball of offsets
enter with multipliers. Proofs: docs/robust.md.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.worst_case import descend, into_ball, into_cone, ratio_at, worst_found
from nullpose.solve.kernels.worst_case_links import ROUND, across, clearance, loudest

__all__ = ["worst_case"]

_SLACK = 1e-12
_COLUMNS = 11  # face, centre and half sides on the face, centre and half sides of the offset
_DEPTH = 512


@inner_kernel
def axis_at(errors, face, x1, x2, y):
    """Fill the axis of a point of a face."""
    frame = errors[0]
    first, second = (face + 1) % 3, (face + 2) % 3
    for i in range(3):
        y[i] = frame[face, i] + x1 * frame[first, i] + x2 * frame[second, i]


@inner_heap_kernel
def curvatures(ratio, c, level, cell, most_across, out):
    """Fill bounds A, B, C: the second derivative of F along (x, d) is at most A|x|^2 + 2B|x||d| + C|d|^2.

    Returns whether the cell keeps clear of all jammers. The weight c of the node is 0 where it is not clear.
    """
    a, _, node, b, centres, radii, axes, semi = ratio
    lean = math.sqrt(cell[3] * cell[3] + cell[4] * cell[4])
    swing = math.sqrt(cell[8] * cell[8] + cell[9] * cell[9] + cell[10] * cell[10])
    length = 1.0
    for i in range(2):
        length += (abs(cell[1 + i]) + cell[3 + i]) * (abs(cell[1 + i]) + cell[3 + i])
    length = math.sqrt(length)
    inverse = 1.0 / (distance_from(node, cell) - swing) if c > 0.0 else 0.0
    square = inverse * inverse
    out[0] = 2.0 * max(0.0, a - level + c * square)
    out[1] = 4.0 * c * length * square * inverse
    out[2] = 6.0 * c * length * length * square * square
    q = np.empty(3)
    for j in range(b.shape[0]):
        for i in range(3):
            q[i] = centres[j, i] - cell[5 + i]
        near = clearance(radii[j], axes, semi, j, q) - swing
        if not near > 0.0:
            return False
        inverse = 1.0 / near
        w = most_across[j] + lean * inverse + swing * length * inverse * inverse  # no corner is farther off
        w *= 2.0 * level * b[j] * inverse * inverse
        out[1] += w
        out[2] += 2.0 * w * length * inverse
    return True


@inner_kernel
def distance_from(point, cell):
    """Return the distance from the centre of a cell's offsets to a point."""
    total = 0.0
    for i in range(3):
        total += (point[i] - cell[5 + i]) ** 2
    return math.sqrt(total)


@inner_kernel
def empty_of_errors(errors, cell):
    """Return whether a cell lies outside the cone or outside the ball of offsets."""
    cosine, sine, reach = errors[1:]
    least = 0.0
    for i in range(3):
        low = max(0.0, abs(cell[5 + i]) - cell[8 + i])
        least += low * low
    if least > reach * reach * (1.0 + _SLACK):
        return True
    face = np.int64(cell[0])
    ahead = rest = 0.0
    for m in range(3):
        low = high = 1.0
        if m > 0:
            low = max(0.0, abs(cell[m]) - cell[2 + m])
            high = abs(cell[m]) + cell[2 + m]
        if (face + m) % 3 == 0:
            ahead = high * high
        else:
            rest += low * low
    return ahead * sine * sine * (1.0 + _SLACK) < rest * cosine * cosine


@inner_heap_kernel
def evaluate_corners(ratio, c, errors, level, cell, tolerance, values, sizes, cone, ball, most_across):
    """Fill F from below, the sizes of its terms, and both constraints, at the corners; False near a jammer.

    Fills also a bound on ``|y x v|`` over the cell for each jammer.
    """
    a, _, node, b, centres, radii, axes, semi = ratio
    cosine, reach = errors[1], errors[3]
    n_links = b.shape[0]
    n_y, n_d = values.shape
    face = np.int64(cell[0])
    ys, lengths = np.empty((n_y, 3)), np.empty(n_y)
    unit, offset, q, point = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for m in range(n_y):
        s1 = 0.0 if n_y == 1 else (1.0 if m & 1 else -1.0)
        s2 = 0.0 if n_y == 1 else (1.0 if m & 2 else -1.0)
        x1, x2 = cell[1] + s1 * cell[3], cell[2] + s2 * cell[4]
        axis_at(errors, face, x1, x2, ys[m])
        lengths[m] = math.sqrt(1.0 + x1 * x1 + x2 * x2)
        ahead = 1.0 if face == 0 else (x2 if face == 1 else x1)
        cone[m] = ahead * ahead - cosine * cosine * lengths[m] ** 2
    for j in range(n_links):
        most_across[j] = 0.0
    for e in range(n_d):
        square = 0.0
        for i in range(3):
            sign = 0.0 if n_d == 1 else (1.0 if (e >> i) & 1 else -1.0)
            offset[i] = cell[5 + i] + sign * cell[8 + i]
            square += offset[i] * offset[i]
            q[i] = node[i] - offset[i]
        ball[e] = reach * reach - square
        square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
        for m in range(n_y):
            w = 0.0
            if c > 0.0:
                w = max(0.0, across(ys[m], q) - ROUND * lengths[m] * math.sqrt(square)) / square
            sizes[m, e] = lengths[m] * lengths[m]
            values[m, e] = a * sizes[m, e] + c * w * w
        for j in range(n_links):
            for i in range(3):
                q[i] = centres[j, i] - offset[i]
            for m in range(n_y):
                for i in range(3):
                    unit[i] = ys[m, i] / lengths[m]
                _, w = loudest(radii[j], axes, semi, j, unit, q, tolerance, point)
                if not w < math.inf:
                    return False
                if radii[j] >= 0.0:
                    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
                    w += ROUND * math.sqrt(square) / (square - radii[j] * radii[j])
                w *= lengths[m]
                most_across[j] = max(most_across[j], w)
                sizes[m, e] += b[j] * w * w
    for m in range(n_y):
        for e in range(n_d):
            signal, noise = values[m, e], level * sizes[m, e]
            values[m, e] = signal - noise
            sizes[m, e] = signal + noise
    return True


@inner_kernel
def slopes(values, cell, gradient):
    """Fill the gradient by the two coordinates of the axis and the three of the offset, from the corners."""
    n_y, n_d = values.shape
    for i in range(5):
        gradient[i] = 0.0
    for m in range(n_y):
        for e in range(n_d):
            for i in range(2):
                if n_y > 1:
                    gradient[i] += values[m, e] * (1.0 if (m >> i) & 1 else -1.0)
            for i in range(3):
                if n_d > 1:
                    gradient[2 + i] += values[m, e] * (1.0 if (e >> i) & 1 else -1.0)
    for i in range(5):
        half = cell[3 + i] if i < 2 else cell[6 + i]
        gradient[i] = gradient[i] / (n_y * n_d * half) if half > 0.0 else 0.0


@inner_kernel
def multipliers(errors, cell, gradient):
    """Return the multipliers of the cone and of the ball that flatten F at the cell's centre, if positive."""
    cosine = errors[1]
    face = np.int64(cell[0])
    ahead = 0 if face == 0 else 3 - face  # coordinate of the face that lies along the nominal axis
    dot = square = 0.0
    for i in range(1, 3):
        slope = -2.0 * cosine * cosine * cell[i]
        if i == ahead:
            slope += 2.0 * cell[i]
        dot += gradient[i - 1] * slope
        square += slope * slope
    cone = max(0.0, dot / square) if square > 0.0 else 0.0
    dot = square = 0.0
    for i in range(3):
        dot -= 2.0 * gradient[2 + i] * cell[5 + i]
        square += 4.0 * cell[5 + i] * cell[5 + i]
    return cone, (max(0.0, dot / square) if square > 0.0 else 0.0)


@inner_kernel
def least_corner(values, sizes, cone, ball, nu, mu):
    """Return the least of F less the weighted constraints at the corners, rounding taken off."""
    least = math.inf
    for m in range(values.shape[0]):
        for e in range(values.shape[1]):
            rounding = _SLACK * (sizes[m, e] + nu * (1.0 + abs(cone[m])) + mu * abs(ball[e]))
            least = min(least, values[m, e] - nu * cone[m] - mu * ball[e] - rounding)
    return least


@inner_kernel
def side_to_split(cell, bends, nu, mu):
    """Return the side whose halving takes most off the remainder."""
    lean = math.sqrt(cell[3] ** 2 + cell[4] ** 2)
    swing = math.sqrt(cell[8] ** 2 + cell[9] ** 2 + cell[10] ** 2)
    by_axis = bends[0] + 2.0 * nu + (bends[1] * swing / lean if lean > 0.0 else 0.0)
    by_offset = bends[2] + 2.0 * mu + (bends[1] * lean / swing if swing > 0.0 else 0.0)
    side, most = np.int64(0), -1.0
    for i in range(5):
        at = 3 + i if i < 2 else 6 + i
        weight = (by_axis if i < 2 else by_offset) * cell[at] * cell[at]
        if weight > most:
            most, side = weight, at
    return side


@inner_heap_kernel
def holds(ratio, errors, level, cell, tolerance, values, sizes, cone, ball, most_across):
    """Return (whether the ratio is at least the level all over a cell, the side to split otherwise)."""
    bends, gradient = np.zeros(3), np.empty(5)
    cosine, c = errors[1], ratio[1]
    swing = math.sqrt(cell[8] * cell[8] + cell[9] * cell[9] + cell[10] * cell[10])
    distance = distance_from(ratio[2], cell)
    if not distance > swing:
        c = 0.0  # the signal, which has no bound there, is left out
    clear = evaluate_corners(
        ratio, c, errors, level, cell, tolerance, values, sizes, cone, ball, most_across
    ) and curvatures(ratio, c, level, cell, most_across, bends)
    if not clear:
        bends[0] = distance * distance
        bends[2] = 1.0
        return False, side_to_split(cell, bends, 0.0, 0.0)
    slopes(values, cell, gradient)
    nu, mu = multipliers(errors, cell, gradient)
    lean = cell[3] ** 2 + cell[4] ** 2
    swing = cell[8] ** 2 + cell[9] ** 2 + cell[10] ** 2
    rest = 0.5 * (bends[0] * lean + 2.0 * bends[1] * math.sqrt(lean * swing) + bends[2] * swing)
    rest *= 1.0 + _SLACK
    for trial in range(4):
        one = nu if trial & 1 else 0.0
        two = mu if trial & 2 else 0.0
        bound = least_corner(values, sizes, cone, ball, one, two)
        if bound - rest - (one * cosine * cosine * lean + two * swing) * (1.0 + _SLACK) >= 0.0:
            return True, np.int64(0)
    return False, side_to_split(cell, bends, nu, mu)


@inner_kernel
def first_cells(errors, stack):
    """Fill the cells that cover the cone and the ball of offsets; return how many."""
    cosine, sine, reach = errors[1:]
    faces = np.int64(3 if sine > 0.999 * cosine else 1)
    for face in range(faces):
        half = min(1.0, 1.001 * sine / cosine) if face == 0 and cosine > 0.0 else 1.0
        for i in range(_COLUMNS):
            stack[face, i] = 0.0
        stack[face, 0] = face
        for i in range(2):
            stack[face, 3 + i] = half
        for i in range(3):
            stack[face, 8 + i] = reach * (1.0 + _SLACK)
    return faces


@inner_heap_kernel
def bound_below(ratio, errors, worst, accuracy, most, y, offset):
    """Return (lower bound on the ratio over all errors, least ratio found, cells examined).

    Args:
        ratio: the ratio, see ``worst_case``.
        errors: what may be wrong.
        worst: the least ratio found so far, positive.
        accuracy: the bound aimed at is ``worst (1 - accuracy)``.
        most: cells after which the level is halved, so that it ends.
        y: in and out, (3,): the actual axis that gives the least ratio found.
        offset: in and out, (3,): its offset.
    """
    sine, reach = errors[2:]
    n_links = ratio[3].shape[0]
    values = np.empty((np.int64(4 if sine > 0.0 else 1), np.int64(8 if reach > 0.0 else 1)))
    sizes = np.empty(values.shape)
    cone, ball, most_across = np.empty(values.shape[0]), np.empty(values.shape[1]), np.empty(n_links)
    stack, cell = np.empty((_DEPTH, _COLUMNS)), np.empty(_COLUMNS)
    places, trial, shift = np.empty((n_links, 3)), np.empty(3), np.empty(3)
    level, scale, short = worst * (1.0 - accuracy), 1.0, accuracy
    top, cells = first_cells(errors, stack), np.int64(0)
    while top > 0 and level > 0.0:
        top -= 1
        for i in range(_COLUMNS):
            cell[i] = stack[top, i]
        if empty_of_errors(errors, cell):
            continue
        cells += 1
        proved, side = holds(
            ratio, errors, level, cell, 0.2 * accuracy, values, sizes, cone, ball, most_across
        )
        if proved:
            continue
        axis_at(errors, np.int64(cell[0]), cell[1], cell[2], trial)
        for i in range(3):
            shift[i] = cell[5 + i]
        into_cone(errors, trial)
        into_ball(reach, shift)
        if better(ratio, errors, worst, trial, shift, places):
            worst = descend(ratio, errors, trial, shift, places)
            level = min(level, scale * worst * (1.0 - accuracy))
            for i in range(3):
                y[i], offset[i] = trial[i], shift[i]
        if not cell[side] > 0.0:  # nothing left to split: what is missing is precision
            level -= short * level
            short *= 2.0
            top += 1
            continue
        if cells % most == 0 or top + 2 > _DEPTH:
            scale *= 0.5
            level *= 0.5
        if top + 2 > _DEPTH:
            level = 0.0
            break
        for i in range(_COLUMNS):
            stack[top, i] = stack[top + 1, i] = cell[i]
        half = 0.5 * cell[side]
        middle = side - 2 if side < 5 else side - 3
        stack[top, side] = stack[top + 1, side] = half * (1.0 + 1e-15)
        stack[top, middle] -= half
        stack[top + 1, middle] += half
        top += 2
    return max(0.0, level), worst, cells


@inner_heap_kernel
def better(ratio, errors, worst, y, offset, places):
    """Return whether the ratio at an error is below the worst found."""
    slope_y, slope_d = np.empty(3), np.empty(3)
    return ratio_at(ratio, y, offset, places, slope_y, slope_d) < worst * (1.0 - 1e-9)


@heap_kernel
def worst_case(ratio, errors, accuracy, most, y, offset, places):
    """Return (lower bound on the ratio over all errors, least ratio found, cells examined).

    Args:
        ratio: the ratio, see the module ``worst_case``.
        errors: what may be wrong.
        accuracy: the bound aimed at is ``least found (1 - accuracy)``; 1 or more asks for no bound.
        most: cells after which the level is halved, so that it ends.
        y: output, (3,): the actual axis of the least ratio found, of unit length.
        offset: output, (3,): its offset of the position.
        places: output, (K, 3): the jammers' places from the actual position.
    """
    worst = worst_found(ratio, errors, y, offset)
    lower, cells = 0.0, np.int64(0)
    if worst > 0.0 and accuracy < 1.0:
        lower, worst, cells = bound_below(ratio, errors, worst, accuracy, most, y, offset)
    slope_y, slope_d = np.empty(3), np.empty(3)
    value = ratio_at(ratio, y, offset, places, slope_y, slope_d)
    return lower, min(worst, value), cells
