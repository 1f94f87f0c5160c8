"""Leaves that distances alone exclude."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, Leaves
from nullpose.certificate.interval import Interval
from nullpose.certificate.zones import forbidden
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family


def far_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes keep their node so far that it cannot reach the level, whatever the axis.

    ``N <= n + w / a^2`` and ``D >= d``, a being the least distance that box and keep-out ball allow.

    Args:
        family: the ratios.
        field: of no effect.
        leaves: of the boxes, with level and ratio.
        boxes: to be tested.
    """
    k = leaves.point
    nearest2 = boxes.nearest2(family.points_m[family.numerator_point[k]])
    a2 = np.maximum(nearest2, Interval(family.keep_out_m).squared().low)
    below = Interval(leaves.level) * family.denominator_isotropic[family.denominator_of[k]]
    lack = Interval(family.numerator_isotropic[k]) - below
    return np.asarray((lack.high < 0.0) & ((lack * a2 + family.numerator_weight[k]).high < 0.0))


def kept_out_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes lie inside their keep-out ball or zone, where no position is allowed.

    Args:
        family: with its keep-out balls and zones.
        field: of no effect.
        leaves: of the boxes, with the ball, or, counted on from the balls, the zone.
        boxes: to be tested.
    """
    balls = len(family.keep_out_points_m)
    which = leaves.point
    holds, in_ball = np.zeros(len(boxes), dtype=bool), which < balls
    farthest2 = boxes.chosen(in_ball).farthest2(family.keep_out_points_m[which[in_ball]])
    holds[in_ball] = farthest2 < Interval(family.keep_out_m).squared().low
    in_zone = ~in_ball & (which < balls + len(family.zone_kind))
    if np.any(in_zone):
        holds[in_zone] = forbidden(family, which[in_zone] - balls, boxes.chosen(in_zone))
    return holds


def root_holds(family: Family, root_m: FloatArray, upper_bound: float) -> str:
    """Return what a root box leaves out that could beat the bound, or an empty string.

    Beyond each of its faces lies nothing of the domain, or nothing within a node's reach: there
    ``n + w / a^2 <= t d``.

    Args:
        family: the ratios and their domain.
        root_m: (2, 3) the root's corners.
        upper_bound: t.
    """
    points = family.points_m[family.numerator_point]
    below = family.denominator_isotropic[family.denominator_of]
    lack = Interval(upper_bound) * below - family.numerator_isotropic
    for face_m, end_m, inwards in zip(root_m, (family.low_m, family.high_m), (1.0, -1.0), strict=True):
        reach = Interval(((Interval(points) - face_m) * inwards).low.T)
        out = (reach.low > 0.0) & ((reach.squared() * lack - family.numerator_weight).low >= 0.0)
        fine = (face_m * inwards <= end_m * inwards) | np.any(out, axis=1)
        if not np.all(fine):
            i = int(np.argmin(fine))
            end = f"{'xyz'[i]} = {face_m[i]:g} m"
            return f"the root box ends at {end}, beyond which poses could exceed the bound"
    return ""
