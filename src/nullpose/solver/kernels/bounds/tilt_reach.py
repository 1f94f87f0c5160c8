"""The airframe's reach in the test of a cell for an antenna with a pattern.

Attitudes within reach have ``h = s n_z - cos b >= 0`` with the vertical component n_z of an axis, the largest
angle b from the vertical and s = 1; or ``cos b - s n_z >= 0`` with the least. A cell is also excluded where
``sum_k l_k (N_k - t D_k) + nu h`` is negative for some nu >= 0. Like a point, h is expanded to second order.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.attitude import BAND, CHART, FACE, HALF, WARM, move
from nullpose.solver.kernels.bounds.pattern_bound import (
    BOUND,
    BY_NU,
    CONSTANT,
    NU,
    SIDE,
    excluded_by_sum,
    upper,
)
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import dot, row as row_of

ROUNDING_RAD = 1e-9  # radians: attitudes within reach miss it by less
_ROUNDING = 1e-12
_STEPS = 8


@inner_kernel
def end_in_force(reach, vertical, turning):
    """Return the body's direction and the angle that no attitude of a cell within reach is farther from.

    As the vertical at the middle is seen; an angle of pi where all of the cell is within reach. And 1, or -1
    for the angle that none is nearer than, which is one from the opposite direction.
    """
    x, y, z = reach.up[0], reach.up[1], reach.up[2]
    end, side = reach.tilt_max_rad, 1.0
    if reach.spins:
        x, y, z = 0.0, 0.0, -1.0 if reach.even and vertical[2] < 0.0 else 1.0
        if reach.even and abs(vertical[2]) <= turning:
            return (x, y, z), math.pi, side
        end = reach.mount_rad + reach.tilt_max_rad
        if dot((x, y, z), vertical) > math.cos(reach.mount_rad):
            z, end, side = -z, math.pi - (reach.mount_rad - reach.tilt_max_rad), -1.0
    end += ROUNDING_RAD
    angle = math.acos(min(1.0, max(-1.0, dot((x, y, z), vertical))))
    return (x, y, z), end if end < angle + turning else math.pi, side


@inner_kernel
def fill_reach(row, reach, turning, rest, space):
    """Fill the constant, the gradient and the Hessian of h from above, zero where no end is in force.

    Args:
        row: of the cell.
        reach: which attitudes there are.
        turning: by how much any frame may turn in the cell, radians.
        rest: a bound on the remainder of a direction of the world.
        space: output.
    """
    m, first = space.slope.shape[0] - 1, int(row[CHART])
    vertical = row_of(space.frame, (2 - first) % 3)
    axis, end, space.reach[SIDE] = end_in_force(reach, vertical, turning)
    space.reach[CONSTANT], space.slope[m], space.bend[m] = 0.0, 0.0, 0.0
    if not end < math.pi or not turning < 1.0:
        return
    space.reach[CONSTANT] = dot(axis, vertical) - math.cos(end) + rest + _ROUNDING
    firsts, seconds = scratch(6, 3), scratch(6, 6, 3)
    move(space.frame, vertical, 0.0, firsts, seconds)
    for a in range(6):
        i = (first + a) % 3 if a < 3 else a
        space.slope[m, i] = dot(axis, row_of(firsts, a))
        for b in range(a, 6):
            k = (first + b) % 3 if b < 3 else b
            space.bend[m, i, k] = space.bend[m, k, i] = dot(axis, row_of(seconds[a], b))


@inner_kernel
def excluded_within_reach(family, level, row, space):
    """Check whether some multipliers keep the sum negative over the cell; leave the best in its row.

    The bound is convex in nu: its tangents tell between which two a zero can be.
    """
    multipliers, low, high, least = row[WARM:], 0.0, math.inf, math.inf
    space.reach[NU] = best = 0.0
    for _ in range(_STEPS):
        if excluded_by_sum(family, level, row, space):
            row[BAND] = space.reach[SIDE] * space.reach[NU]
            return True
        nu, bound, slope = space.reach[NU], space.reach[BOUND], space.reach[BY_NU]
        if bound < least:
            least, best = bound, nu
            copy_into(multipliers, space.kept)
        if slope < 0.0:
            low = nu - bound / slope
        elif slope > 0.0:
            high = nu - bound / slope
        if slope == 0.0 or not low < high:
            break
        space.reach[NU] = 0.5 * (low + high) if high < math.inf else max(abs(row[BAND]), 1.1 * low)
    if space.reach[NU] != best:
        copy_into(space.kept, multipliers)
        space.reach[NU] = best
        upper(family, level, row[HALF:FACE], multipliers, space)  # by which the side to split is chosen
    row[BAND] = best
    return False
