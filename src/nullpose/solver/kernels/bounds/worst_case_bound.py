"""A lower bound on one ratio over all errors: branch and bound on the axis and the offset, by lemma 4.

The axis is ``y = x0 f0 + x1 f1 + x2 f2`` with ``x0 = 1``, of any length, on a face of a cube about the drone.
The ratio is at least t over a cell if ``F = (a - t) |y|^2 + c |y x v|^2 - t sum_j b_j |y|^2 L_j`` is not
negative there, with ``|y x v|^2 + l (y.v)^2`` in place of ``|y x v|^2`` if the antenna leaks. F less half of
a bound on its second derivatives times the squared distance from the cell's centre is concave, whatever the
places of the jammers, and so smallest at a corner of the cell. The cone and the ball of offsets enter with
multipliers. Proofs: docs/robust.md.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.channel.model import BY_DISTANCE
from nullpose.solver.kernels.bounds.constants import VECTOR_BEND, VECTOR_SLOPE
from nullpose.solver.kernels.bounds.link_field import Reach, distance_amplitude, times_amplitude
from nullpose.solver.kernels.bounds.node import split_across
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.linear_algebra.channel import excess_in_sight
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    combination,
    corner_of,
    cross,
    dot,
    minus,
    norm,
    row,
    scaled,
    signs,
    store,
)
from nullpose.solver.kernels.search.worst_case import (
    FloatArray,
    Vector,
    descend,
    into_ball,
    into_cone,
    ratio_at,
    worst_found,
)
from nullpose.solver.kernels.search.worst_case_links import ROUND, clearance, has_dipole, strongest_link

_SLACK = 1e-12  # relative: more than rounding takes from a sum
_BETTER = 1e-9  # relative: less is no reason to descend anew
_SIDES = 5  # of a cell: two of the axis, three of the offset
_CENTRE, _HALF = 1, 1 + _SIDES  # columns of a cell's row, after its face
_COLUMNS = _HALF + _SIDES
_DEPTH = 512
_SHARE = 0.8  # of what is to spare that a jammer's bound may take


class Cell(NamedTuple):
    """A rectangle of axes on a face, times a box of offsets: centres and half sides."""

    face: int
    x: Vector
    x_half: Vector
    d: Vector
    d_half: Vector


class Corners(NamedTuple):
    """What holds at the corners of a cell: ``m`` of the axis, ``e`` of the offset."""

    values: FloatArray  # (m, e) F, from below
    sizes: FloatArray  # (m, e) the sizes of its terms
    cone: FloatArray  # (m,) G, negative outside the cone
    ball: FloatArray  # (e,) H, negative outside the ball of offsets
    across: FloatArray  # (n,) W_j, the largest |y x v_j|


@inner_kernel
def cell_of(cells, i):
    """Return a row as a cell."""
    r = cells[i]
    return Cell(int(r[0]), (1.0, r[1], r[2]), (0.0, r[6], r[7]), (r[3], r[4], r[5]), (r[8], r[9], r[10]))


@inner_kernel
def ahead(face):
    """Return the one of a face's three coordinates that lies along the nominal axis."""
    return (3 - face) % 3


@inner_kernel
def axis_at(errors, face, x):
    """Return the axis of a point of a face."""
    frame = errors.frame
    return combination((frame[face], frame[(face + 1) % 3], frame[(face + 2) % 3]), x)


@inner_kernel
def nearest(centre, half):
    """Return the least size of each coordinate."""
    return (
        max(0.0, abs(centre[0]) - half[0]),
        max(0.0, abs(centre[1]) - half[1]),
        max(0.0, abs(centre[2]) - half[2]),
    )


@inner_kernel
def farthest(centre, half):
    """Return the largest size of each coordinate."""
    return abs(centre[0]) + half[0], abs(centre[1]) + half[1], abs(centre[2]) + half[2]


@inner_kernel
def empty_of_errors(errors, cell):
    """Check whether a cell lies outside the cone or outside the ball of offsets."""
    d = nearest(cell.d, cell.d_half)
    if dot(d, d) > errors.reach**2 * (1.0 + _SLACK):
        return True
    low, high = nearest(cell.x, cell.x_half), farthest(cell.x, cell.x_half)
    rest = 0.0
    for i in range(3):
        if i != ahead(cell.face):
            rest += low[i] ** 2
    along_cone = (high[ahead(cell.face)] * errors.sine) ** 2
    return along_cone * (1.0 + _SLACK) < rest * errors.cosine**2


@inner_kernel
def least_dipole_link(ratio, y, q):
    """Return the link of a node with a dipole for an axis y of any length, rounding taken off."""
    square, length, other = dot(q, q), norm(y), cross(ratio.dipole, q)
    both = max(0.0, abs(dot(cross(y, q), other)) - 4.0 * ROUND * length * square)
    leaking = max(0.0, norm(other) - ROUND * norm(q))
    link = (1.0 - ratio.leak) * both * both / square + ratio.leak * (length * leaking) ** 2
    return link / (square * square)


@inner_kernel
def link_reach(channels, j, q, near, far, is_dipole):
    """Return the reach of a link vector times the amplitude of its channel, between two distances.

    Args:
        channels: the rows, or None.
        j: which.
        q: of the point, or of the centre of its set.
        near: the least distance; in a channel by elevation the position is known.
        far: the largest.
        is_dipole: whether the vector is that of a dipole.
    """
    slope, bend = (VECTOR_SLOPE, VECTOR_BEND) if is_dipole else (1.0, 2.0)
    reach = Reach(1.0 / near, slope / near**2, bend / near**3)
    if channels is not None:
        if channels[j, 0] == BY_DISTANCE:
            return times_amplitude(distance_amplitude(channels[j], q, near * near, far * far), reach)
        if near == far:
            return Reach(reach.length * math.sqrt(excess_in_sight(channels[j], q)), reach.slope, reach.bend)
    return reach


@inner_kernel
def node_gain(channels, n, q):
    """Return the excess gain of the node's channel, the last of n + 1."""
    if channels is not None:
        return excess_in_sight(channels[n], q)
    return 1.0


@inner_kernel
def evaluate_corners(ratio, weight, errors, level, cell, tolerance, corners):
    """Fill what holds at the corners; return False near a jammer. The node's weight is 0 if left out.

    With an infinite tolerance F is what is attained, not what it is at least.
    """
    n_axes, n_offsets = corners.values.shape
    for e in range(n_offsets):
        offset = corner_of(cell.d, cell.d_half, e)
        node = minus(ratio.node, offset)
        strength = weight * node_gain(ratio.sets.channels, ratio.shares.shape[0], node)
        corners.ball[e] = errors.reach**2 - dot(offset, offset)
        for m in range(n_axes):
            x = corner_of(cell.x, cell.x_half, 2 * m)
            y, square, length = axis_at(errors, cell.face, x), dot(x, x), norm(x)
            corners.cone[m] = x[ahead(cell.face)] ** 2 - errors.cosine**2 * square
            signal, noise = ratio.isotropic * square, square
            if weight > 0.0 and has_dipole(ratio.dipole):
                signal += strength * least_dipole_link(ratio, y, node)
            elif weight > 0.0:
                rounding = ROUND * length * norm(node)
                across = max(0.0, norm(cross(y, node)) - rounding) / dot(node, node)
                leaking = max(0.0, abs(dot(y, node)) - rounding) / dot(node, node)
                signal += strength * (across * across + ratio.leak * leaking * leaking)
            for j in range(ratio.shares.shape[0]):
                q = minus(row(ratio.centres, j), offset)
                found, root, _ = strongest_link(
                    ratio.sets, j, scaled(1.0 / length, y), q, ratio.leak, tolerance
                )
                root = root if tolerance < math.inf else found
                if not root < math.inf:
                    return False
                noise += ratio.shares[j] * (length * root) ** 2
                before = corners.across[j] if e + m > 0 else 0.0
                corners.across[j] = max(before, length * root)
            corners.values[m, e] = signal - level * noise
            corners.sizes[m, e] = signal + level * noise
    return True


@inner_kernel
def curvatures(ratio, channels, weight, level, cell, across):
    """Return lemma 4's A, B and C; infinite unless the cell keeps clear of all sets."""
    lean, swing, length = norm(cell.x_half), norm(cell.d_half), norm(farthest(cell.x, cell.x_half))
    n, q = ratio.shares.shape[0], minus(ratio.node, cell.d)
    near, far = norm(q) - swing if weight > 0.0 else math.inf, norm(q) + swing
    node = link_reach(channels, n, q, near, far, has_dipole(ratio.dipole))
    a = 2.0 * max(0.0, ratio.isotropic - level + weight * node.length**2)
    b = 4.0 * weight * length * node.length * node.slope
    c = 2.0 * weight * length**2 * (node.slope**2 + node.length * node.bend)
    for j in range(n):
        q = minus(row(ratio.centres, j), cell.d)
        near = clearance(ratio.sets, j, q) - swing
        if not near > 0.0:
            return math.inf, math.inf, math.inf
        far = norm(q) + ratio.sets.extents[j] + swing
        reach = link_reach(channels, j, q, near, far, has_dipole(row(ratio.sets.dipoles, j)))
        most = across[j] + lean * reach.length + swing * length * reach.slope  # no corner is farther off
        part = 2.0 * level * ratio.shares[j] * most
        b += part * reach.slope
        c += part * length * reach.bend
    return a, b, c


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
def least_corner(corners, nu, mu):
    """Return the least of ``F - nu G - mu H`` at the corners, rounding taken off."""
    least = math.inf
    for m in range(corners.values.shape[0]):
        for e in range(corners.values.shape[1]):
            cone, ball = corners.cone[m], corners.ball[e]
            rounding = _SLACK * (corners.sizes[m, e] + nu * (1.0 + abs(cone)) + mu * abs(ball))
            least = min(least, corners.values[m, e] - nu * cone - mu * ball - rounding)
    return least


@inner_kernel
def margin(errors, cell, corners, nu, mu, rest):
    """Bound F from below in a cell, with the best of the multipliers or none."""
    lean, swing, most = norm(cell.x_half), norm(cell.d_half), -math.inf
    for trial in range(4):
        of_cone, of_ball = nu if trial & 1 else 0.0, mu if trial & 2 else 0.0
        more = rest + of_cone * (errors.cosine * lean) ** 2 + of_ball * swing**2
        most = max(most, least_corner(corners, of_cone, of_ball) - more * (1.0 + _SLACK))
    return most


@inner_kernel
def side_to_split(cell, by_axis, by_offset):
    """Return the side whose halving takes most off a remainder of such curvatures."""
    side, most = 0, -1.0
    for i in range(_SIDES):
        weight = by_axis * cell.x_half[1 + i] ** 2 if i < 2 else by_offset * cell.d_half[i - 2] ** 2
        if weight > most:
            side, most = i, weight
    return side


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


@inner_kernel
def first_cells(errors, cells):
    """Fill the cells that cover the cone and the ball of offsets; return how many."""
    faces = 3 if errors.sine > 0.999 * errors.cosine else 1
    for face in range(faces):
        half = 1.0
        if face == 0 and errors.cosine > 0.0:
            half = min(1.0, 1.001 * errors.sine / errors.cosine)
        cells[face, 0] = face
        for i in range(_SIDES):
            cells[face, _CENTRE + i] = 0.0
            cells[face, _HALF + i] = half if i < 2 else errors.reach * (1.0 + _SLACK)
    return faces


@inner_kernel
def split(cells, i, side):
    """Put the halves of cell i in its place and behind it, a hair wider than half."""
    split_across(cells[i], _CENTRE + side, _HALF + side, cells[i], cells[i + 1])
    for k in range(i, i + 2):
        cells[k, _HALF + side] *= 1.0 + 1e-15


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
    cells = np.empty((_DEPTH, _COLUMNS))
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
        if examined % most == 0 or top + 2 > _DEPTH or not cells[top, _HALF + side] > 0.0:
            level -= min(1.0, short) * level  # which all cells before it are above, and soon the next
            short *= 2.0
            top += 1
            continue
        split(cells, top, side)
        top += 2
    store(at_y, y)
    store(at_offset, offset)
    return max(0.0, level), min(worst, ratio_at(ratio, at_y, at_offset, places)[0]), examined
