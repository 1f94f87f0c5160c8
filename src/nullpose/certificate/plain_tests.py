"""Leaves that need no multipliers: nodes out of reach, positions kept out, axes out of the band."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.channels import most_excess
from nullpose.certificate.elementary import log
from nullpose.certificate.forms import cell_ends
from nullpose.certificate.interval import Interval
from nullpose.certificate.zones import forbidden
from nullpose.objectives.ratios import Ratios
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family


def out_of_reach(ratios: Ratios, level: FloatArray | float, square: FloatArray) -> np.ndarray:
    """Check where no axis reaches a level, from the distances of the nodes alone.

    ``N_k <= n_k + w_k g_k / a_k^2`` and ``D >= d``, g being the largest excess gain of the channel beyond the
    distance a: one ratio is not above the level, or their mean is not, or one pair's quotient.

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
    near = np.stack(
        [boxes.nearest2(family.ratios.points_m[j]) for j in family.ratios.numerator_point], axis=-1
    )
    return out_of_reach(
        family.ratios, leaves.level, np.maximum(near, Interval(family.domain.keep_out_m).squared().low)
    )


def kept_out_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes lie inside their keep-out ball or zone, where no position is allowed.

    Args:
        family: with its keep-out balls and zones.
        field: of no effect.
        leaves: of the boxes, with the ball, or, counted on from the balls, the zone.
        boxes: to be tested.
    """
    balls = len(family.domain.keep_out_points_m)
    which = leaves.point
    holds, in_ball = np.zeros(len(boxes), dtype=bool), which < balls
    farthest2 = boxes.chosen(in_ball).farthest2(family.domain.keep_out_points_m[which[in_ball]])
    holds[in_ball] = farthest2 < Interval(family.domain.keep_out_m).squared().low
    if np.any(in_zone := ~in_ball & (which < balls + len(family.domain.zone_kind))):
        holds[in_zone] = forbidden(family.domain, which[in_zone] - balls, boxes.chosen(in_zone))
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
    points = family.ratios.points_m[family.ratios.numerator_point]
    gaps = np.maximum(
        (family.domain.low_m - Interval(points)).low, (Interval(points) - family.domain.high_m).low
    )
    gap2 = Interval(np.maximum(gaps, 0.0)).squared()  # from all of the domain, along each axis
    for face_m, end_m, inwards in zip(
        root_m, (family.domain.low_m, family.domain.high_m), (1.0, -1.0), strict=True
    ):
        beyond = Interval(np.maximum(((Interval(points) - face_m) * inwards).low, 0.0)).squared()
        square = (beyond + gap2[:, [1, 2, 0]] + gap2[:, [2, 0, 1]]).low.T
        out = out_of_reach(family.ratios, upper_bound, square)
        fine = (face_m * inwards <= end_m * inwards) | out
        if not np.all(fine):
            i = int(np.argmin(fine))
            end = f"{'xyz'[i]} = {face_m[i]:g} m"
            return f"the root box ends at {end}, beyond which poses could exceed the bound"
    return ""


def off_band_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which leaves hold no axis of the band, wherever their boxes are.

    With one coordinate at 1 and the squares of the two others in intervals, ``u_z^2 / |u|^2`` is largest
    where z is and x and y are not, and the other way round.

    Args:
        family: of no effect.
        field: a free axis within a band.
        leaves: with cells.
        boxes: of no effect.
    """
    cell = leaves.cell
    row, on_face = np.arange(len(cell)), cell[:, 0] >= 0
    face = np.maximum(cell[:, 0], 0)
    least, most = np.ones((3, len(cell))), np.ones((3, len(cell)))
    for side in range(2):
        square = Interval(*cell_ends(cell, side)).squared()
        v = (face + 1 + side) % 3
        least[v, row], most[v, row] = square.low, square.high
    lower, upper = field.band
    # c (x^2 + y^2 + z^2) - z^2 for the greatest z^2 and the least x^2 and y^2, and the other way round
    below = (Interval(least[0]) + least[1] + most[2]) * lower - most[2]
    above = (Interval(most[0]) + most[1] + least[2]) * upper - least[2]
    return np.asarray(on_face & ((below.low > 0.0) | (above.high < 0.0)))
