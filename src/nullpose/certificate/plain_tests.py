"""Leaves that need no multipliers: nodes out of reach, positions kept out, axes out of the band."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import most_excess
from nullpose.certificate.elementary import log
from nullpose.certificate.forms import cell_axes
from nullpose.certificate.interval import Interval
from nullpose.certificate.zones import forbidden
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family


def out_of_reach(ratios: Ratios, level: FloatArray | float, square: FloatArray) -> np.ndarray:
    """Check where no axis reaches a level, from the distances of the nodes alone.

    ``N_k <= n_k + w_k g_k / a_k^2`` and ``D >= d``, where ``g / a^2`` bounds the excess gain over the squared
    distance beyond a: one ratio is not above the level, or their mean is not, or one pair's quotient.

    Args:
        ratios: over the points.
        level: (...) t.
        square: (..., ratios) lower bounds on the squared distances.
    """
    point, below = ratios.numerator_point, ratios.denominator_isotropic[ratios.denominator_of]
    heard = most_excess(ratios, point, square) * Interval(ratios.numerator_weight)
    if len(ratios.shares):
        each = (heard / square + ratios.numerator_isotropic) / below + ratios.offset
        total = sum((log(each[..., k]) * share for k, share in enumerate(ratios.shares)), Interval(0.0))
        return np.asarray(total.high <= log(Interval(level)).low)
    if len(ratios.pairs):  # the node not jammed, the eavesdropper jammed as much as can be
        node, eavesdropper = ratios.pairs.T
        most = Interval((heard / square + below).high[..., eavesdropper])
        overheard = most + (Interval(ratios.numerator_isotropic) - below)[eavesdropper]
        lack = Interval(level)[..., None] * overheard * below[node] - most * ratios.numerator_isotropic[node]
        return np.asarray(np.any((square[..., eavesdropper] > 0.0) & (lack.low >= 0.0), axis=-1))
    lack = Interval(level)[..., None] * below - ratios.numerator_isotropic
    return np.asarray(np.any((square > 0.0) & ((square * lack - heard).low >= 0.0), axis=-1))


def far_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes are too far from the nodes to reach the level, whatever the axis.

    Args:
        family: the ratios.
        field: of no effect.
        leaves: of the boxes, with level.
        boxes: to be tested.
    """
    points_m = family.ratios.points_m[family.ratios.numerator_point]
    square = np.stack([boxes.distance2(point_m[None]).low for point_m in points_m], axis=-1)
    return out_of_reach(
        family.ratios, leaves.level, np.maximum(square, Interval(family.domain.keep_out_m).squared().low)
    )


def borders(family: Family) -> int:
    """Count the keep-out balls and, after them, the zones."""
    return len(family.domain.keep_out_points_m) + len(family.domain.zone_kind)


def kept_out(family: Family, border: IntArray, boxes: Boxes) -> np.ndarray:
    """Check which boxes lie inside a keep-out ball or zone, where no position is allowed.

    Args:
        family: with its keep-out balls and zones.
        border: (b,) the ball, or, counted on from the balls, the zone; no box lies in one that there is not.
        boxes: b of them.
    """
    balls = len(family.domain.keep_out_points_m)
    holds, in_ball = np.zeros(len(boxes), dtype=bool), border < balls
    distance2 = boxes.chosen(in_ball).distance2(family.domain.keep_out_points_m[border[in_ball]])
    holds[in_ball] = distance2.high < Interval(family.domain.keep_out_m).squared().low
    if np.any(in_zone := ~in_ball & (border < borders(family))):
        holds[in_zone] = forbidden(family.domain, border[in_zone] - balls, boxes.chosen(in_zone))
    return holds


def root_holds(family: Family, root_m: FloatArray, upper_bound: float) -> str:
    """Find a face of a root box that leaves out what could beat the bound; an empty string if there is none.

    Beyond each of its faces lies nothing of the domain, or nothing within a node's reach: there
    ``n + w / a^2 <= t d``, a being at least as long as the distances beyond the face and, along the other two
    axes, to the domain.

    Args:
        family: the ratios and their domain.
        root_m: (2, 3) the root's corners.
        upper_bound: t.
    """
    domain, axis = family.domain, np.arange(3)
    low, high = (np.tile(end_m[:, None], 6) for end_m in (domain.low_m, domain.high_m))
    # what is beyond the three lower faces and then the three upper ones: a half space, within the domain
    low[axis, axis], high[axis, axis] = -np.inf, root_m[0]
    low[axis, axis + 3], high[axis, axis + 3] = root_m[1], np.inf
    points_m = family.ratios.points_m[family.ratios.numerator_point]
    square = (Interval(points_m[..., None]) - Interval(low, high)).T.squared().total().low.T
    fine = out_of_reach(family.ratios, upper_bound, square)
    fine |= np.append(root_m[0] <= domain.low_m, root_m[1] >= domain.high_m)
    if np.all(fine):
        return ""
    i = int(np.argmin(fine))
    end = f"{'xyz'[i % 3]} = {root_m.flat[i]:g} m"
    return f"the root box ends at {end}, beyond which poses could exceed the bound"


def off_band_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which leaves hold no axis of the band, wherever their boxes are.

    ``c (u_x^2 + u_y^2) - (1 - c) u_z^2`` is positive where ``u_z^2`` is below c for a unit vector, and has
    that sign for a vector of any length.

    Args:
        family: of no effect.
        field: a free axis within a band.
        leaves: with cells.
        boxes: of no effect.
    """
    u2 = cell_axes(leaves.cell).squared()
    least, most = (Interval(c) * (u2[0] + u2[1]) - (1.0 - Interval(c)) * u2[2] for c in field.band)
    return np.asarray((leaves.face >= 0) & ((least.low > 0.0) | (most.high < 0.0)))
