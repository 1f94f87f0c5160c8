"""Leaves that distances alone exclude."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, Leaves
from nullpose.certificate.interval import Interval
from nullpose.certificate.zones import forbidden
from nullpose.family import Family

__all__ = ["far_holds", "kept_out_holds", "root_holds"]


def far_holds(family: Family, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes keep their node so far that it cannot reach the level, whatever the axis.

    ``N <= n + w / a^2`` and ``D >= d``, a being the least distance that box and keep-out ball allow.

    Args:
        family: the ratios.
        leaves: with level and ratio.
        boxes: to be tested.
    """
    k = leaves.point[boxes.leaf]
    below = family.denominator_isotropic[family.denominator_of[k]]
    level = leaves.level[boxes.leaf]
    nearest2 = boxes.nearest2(family.points_m[family.numerator_point[k]])
    a2 = np.maximum(nearest2, Interval(family.keep_out_m).squared().low)
    lack = Interval(family.numerator_isotropic[k]) - Interval(level) * below
    return np.asarray((lack.high < 0.0) & ((lack * a2 + family.numerator_weight[k]).high < 0.0))


def kept_out_holds(family: Family, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes lie inside their keep-out ball or zone, where no position is allowed.

    Args:
        family: with its keep-out balls and zones.
        leaves: with the ball, or, counted on from the balls, the zone.
        boxes: to be tested.
    """
    balls = len(family.keep_out_points_m)
    which = leaves.point[boxes.leaf]
    holds, in_ball = np.zeros(len(boxes), dtype=bool), which < balls
    if np.any(in_ball):
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
    for i, name in enumerate("xyz"):
        for side, domain_end in ((0, family.low_m[i]), (1, family.high_m[i])):
            face = root_m[side, i]
            if (face <= domain_end) if side == 0 else (face >= domain_end):
                continue
            beyond = Interval(points[:, i]) - face if side == 0 else Interval(face) - points[:, i]
            reach = beyond.low
            out = (reach > 0.0) & ((Interval(reach).squared() * lack - family.numerator_weight).low >= 0.0)
            if not np.any(out):
                return f"the root box ends at {name} = {face:g} m, beyond which poses could exceed the bound"
    return ""
