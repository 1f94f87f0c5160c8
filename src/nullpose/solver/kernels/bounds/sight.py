"""Buildings over a box of positions: each link counts as clear or as blocked, whichever is the better."""

from __future__ import annotations

from nullpose.channel.model import BLOCKED
from nullpose.objectives.ratios import Ratios
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.compiler.jit import inner_kernel, small_kernel
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into


@inner_kernel
def blocked_end(points, sides, start, row, is_above, centre, half):
    """Return what buildings leave of a link all over a box: the most, or the least, as ``is_above`` says.

    A shadow is convex: beyond one of its sides the box is clear of it, inside of all it is in it.
    """
    for shadow in range(points[0], points[1]):
        clear, inside = False, True
        for s in range(start[shadow], start[shadow + 1]):
            away = sides[s, 0] * centre[0] + sides[s, 1] * centre[1] + sides[s, 2] * centre[2] - sides[s, 3]
            reach = abs(sides[s, 0]) * half[0] + abs(sides[s, 1]) * half[1] + abs(sides[s, 2]) * half[2]
            if away >= reach:
                clear = True
                break
            inside = inside and away < -reach
        if not clear and (inside or not is_above):
            return row[BLOCKED]
    return 1.0


@small_kernel
def multiply_by_sight(family, channels, points, is_above, row, weights):
    """Multiply weights by what buildings leave of their points' links, at best, all over a row's box."""
    if channels is not None and family.shadow_sides.shape[0] > 0:
        sides, start = family.shadow_sides, family.shadow_start
        for k in range(weights.shape[0]):
            j = points[k]
            shadows = family.shadows_of_point[j : j + 2]
            weights[k] *= blocked_end(
                shadows, sides, start, channels[j], is_above, row[CENTRE:HALF], row[HALF:LEVEL]
            )


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
