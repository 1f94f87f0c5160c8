"""Buildings over a box of positions: each link counts as clear or as blocked, whichever is the better."""

from __future__ import annotations

from nullpose.channel.model import BLOCKED
from nullpose.objectives.ratios import Ratios
from nullpose.solver.kernels.bounds.expansion import min_square
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.compiler.jit import inner_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import most_excess
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import dot, norm

_SMALL_M = 2.0  # half diagonal of boxes in which shadows are compared
_TOUCHES = 1e-9  # m, as in :mod:`nullpose.channel.buildings`
_PARALLEL = 1e-9  # the least square of the sine between two sides


@inner_kernel
def blocked_end(points, sides, start, row, is_above, centre, half):
    """Return what buildings leave of a link all over a box: the most, or the least, as ``is_above`` says.

    A shadow is convex: beyond one of its sides the box is clear of it, inside of all it is in it.
    """
    for shadow in range(points[0], points[1]):
        clear, inside = False, True
        for s in range(start[shadow], start[shadow + 1]):
            beyond = reach_beyond(sides[s], centre, half)
            if beyond >= 2.0 * norm_along(sides[s], half):
                clear = True
                break
            inside = inside and beyond < 0.0
        if not clear and (inside or not is_above):
            return row[BLOCKED]
    return 1.0


@inner_kernel
def reach_beyond(side, centre, half):
    """Return the largest distance of a box beyond a side."""
    return dot(side, centre) - side[3] + norm_along(side, half)


@inner_kernel
def is_implied(side, sides, first, last, centre, half):
    """Check whether what is in a shadow and in a box is inside a side, as one or two of the shadow's show."""
    rest = scratch(4)
    if reach_beyond(side, centre, half) <= _TOUCHES:
        return True
    for a in range(first, last):
        for b in range(a, last):
            across = dot(sides[a], sides[b]) if b > a else 0.0
            with_a, with_b = dot(side, sides[a]), (dot(side, sides[b]) if b > a else 0.0)
            det = 1.0 - across * across
            if det < _PARALLEL:
                continue
            x, y = (with_a - across * with_b) / det, (with_b - across * with_a) / det
            if x >= 0.0 and y >= 0.0:
                for m in range(4):
                    rest[m] = side[m] - x * sides[a, m] - y * sides[b, m]
                if reach_beyond(rest, centre, half) <= _TOUCHES:
                    return True
    return False


@inner_kernel
def is_covered(sides, start, shadow, other, centre, half):
    """Check whether one shadow holds all that another does in a box."""
    for s in range(start[other], start[other + 1]):
        if not is_implied(sides[s], sides, start[shadow], start[shadow + 1], centre, half):
            return False
    return True


@inner_kernel
def must_be_seen(family, row, k):
    """Check whether a ratio is too weak all over a box where its point's link is blocked."""
    j = family.numerator_point[k]
    square = min_square(family.points_m, j, row[CENTRE:HALF], row[HALF:LEVEL])
    most = family.numerator_weight[k] * most_excess(family.channels, j, square) * family.channels[j, BLOCKED]
    least = row[LEVEL] * family.denominator_isotropic[family.denominator_of[k]]
    return (family.numerator_isotropic[k] - least) * square + most < 0.0


@inner_kernel
def is_seen_with_nodes(family, j, row):
    """Check whether point j is in sight wherever all nodes are that must be: theirs hold its shadows.

    At a building's edge shadows meet, and no smaller box tells them apart.
    """
    sides, start, of_point = family.shadow_sides, family.shadow_start, family.shadows_of_point
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    for shadow in range(of_point[j], of_point[j + 1]):
        covered = False
        for s in range(start[shadow], start[shadow + 1]):
            covered = covered or reach_beyond(sides[s], centre, half) >= 2.0 * norm_along(sides[s], half)
        for k in range(family.numerator_point.shape[0]):
            if not covered and must_be_seen(family, row, k):
                node = family.numerator_point[k]
                for other in range(of_point[node], of_point[node + 1]):
                    covered = covered or is_covered(sides, start, shadow, other, centre, half)
        if not covered:
            return False
    return True


@inner_kernel
def norm_along(side, half):
    """Return how far a box reaches along the normal of a side."""
    return abs(side[0]) * half[0] + abs(side[1]) * half[1] + abs(side[2]) * half[2]


@small_kernel
def multiply_by_sight(family, channels, points, is_above, row, weights):
    """Multiply weights by what buildings leave of their points' links, at best, all over a row's box."""
    if channels is not None and family.shadow_sides.shape[0] > 0:
        sides, start = family.shadow_sides, family.shadow_start
        for k in range(weights.shape[0]):
            j = points[k]
            shadows = family.shadows_of_point[j : j + 2]
            centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
            left = blocked_end(shadows, sides, start, channels[j], is_above, centre, half)
            if left < 1.0 and not is_above and norm(half) < _SMALL_M and is_seen_with_nodes(family, j, row):
                left = 1.0
            weights[k] *= left


@small_kernel
def in_sight(family, row, workspace):
    """Return the ratios as a row's box has them, without buildings: their shadows are in the weights."""
    copy_into(family.numerator_weight, workspace.numerator_weight)
    copy_into(family.denominator_weight, workspace.denominator_weight)
    points, channels = family.numerator_point, family.channels
    multiply_by_sight(family, channels, points, True, row, workspace.numerator_weight)
    multiply_by_sight(family, channels, family.denominator_point, False, row, workspace.denominator_weight)
    return Ratios(
        family.points_m, family.numerator_isotropic, workspace.numerator_weight, family.numerator_point,
        family.denominator_of, family.denominator_isotropic, family.denominator_start,
        family.denominator_point, workspace.denominator_weight, family.turn, family.leak,
        family.ground_axes, family.ground_leaks, family.channels, family.shadows_of_point,
        family.shadow_start, workspace.no_sides,
    )  # fmt: skip
