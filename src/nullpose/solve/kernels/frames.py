"""The frame in which a box is tested: one that stands still, or one that turns towards a point."""

from __future__ import annotations

from nullpose.solve.kernels.box import CENTRE, COUNT, HALF, INDEX, LEVEL, WEIGHT
from nullpose.solve.kernels.cells import is_level
from nullpose.solve.kernels.expansion import min_distance
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.records import TOWARDS_POINT, WORLD

__all__ = ["best_frame"]


@inner_kernel
def strongest_point(family, centre):
    """Return the denominators' point that is received most strongly at the centre, or -1."""
    strongest = 0.0
    anchor = -1
    for e in range(family.denominator_weight.shape[0]):
        j, weight = family.denominator_point[e], family.denominator_weight[e]
        d = 0.0
        for i in range(3):
            d += (family.points_m[j, i] - centre[i]) ** 2
        if weight > strongest * d:
            strongest, anchor = weight / d, j
    return anchor


@inner_kernel
def best_frame(family, axis_field, row):
    """Return the frame in which a box's remainders are smallest, and the point that it turns towards.

    A frame that turns spares us the remainder of the point that it turns towards, and makes all others
    larger: worth it where one interferer outweighs the rest.
    """
    points, centre, half = family.points_m, row[CENTRE:HALF], row[HALF:LEVEL]
    anchor = strongest_point(family, centre)
    if anchor < 0 or family.turn.shape[0] > 0 or is_level(axis_field):
        return WORLD, anchor
    rho = min_distance(points, anchor, centre, half)
    still = turning = 0.0
    for s in range(int(row[COUNT])):
        k = int(row[INDEX + s])
        a = min_distance(points, family.numerator_point[k], centre, half)
        scale = row[WEIGHT + s] * family.numerator_weight[k] / (a * a * a * a)
        still += 6.0 * scale
        turning += scale * (6.0 + a / rho * (16.0 + 8.31 * a / rho))
    for e in range(family.denominator_weight.shape[0]):
        a = min_distance(points, family.denominator_point[e], centre, half)
        scale = row[LEVEL] * family.denominator_weight[e] / (a * a * a * a)
        still += 4.0 * scale
        if family.denominator_point[e] != anchor:
            turning += scale * (4.0 + a / rho * (12.0 + 6.31 * a / rho))
    return (TOWARDS_POINT if turning < still else WORLD), anchor
