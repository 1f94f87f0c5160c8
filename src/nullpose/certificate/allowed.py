"""Constraints on the allowed positions of a box, each with a multiplier."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.interval import Interval, dot
from nullpose.family import Family

__all__ = ["Constraint", "Weighted", "negative_where_allowed"]


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A quadratic of the position for each box, ``g(c + x) = value + slopes.x + sum_i bend_i x_i^2``.

    Args:
        value: (b,) at the boxes' centres.
        slopes: (b, 3) its gradient there.
        bend: (b, 3) not negative.
    """

    value: Interval
    slopes: Interval
    bend: FloatArray


Weighted: TypeAlias = list[tuple[FloatArray, Constraint]]
"""Constraints with a multiplier, not negative, for each box."""


def ball_constraint(family: Family, ball: IntArray, boxes: Boxes) -> Constraint:
    """Return ``|p - q|^2 - R^2``, which is not negative outside a keep-out ball.

    Args:
        family: with its keep-out balls.
        ball: (b,) which of them.
        boxes: b of them.
    """
    away = Interval(boxes.centre) - family.keep_out_points_m[ball]
    value = dot(away, away) - Interval(family.keep_out_m).squared()
    return Constraint(value, away * 2.0, np.ones((len(boxes), 3)))


def negative_where_allowed(
    family: Family,
    leaves: Leaves,
    boxes: Boxes,
    test: Callable[[IntArray, Weighted], np.ndarray],
) -> np.ndarray:
    """Return which boxes a test excludes at every position that is allowed.

    Args:
        family: with its keep-out balls.
        leaves: with the ball that counts in each, and its multiplier.
        boxes: to be tested.
        test: returns whether a sum, with these multiples of constraints added, is negative all over the boxes
            of these indices.
    """
    balls = len(family.keep_out_points_m)
    ball = leaves.ball[boxes.leaf]
    rows = np.arange(len(boxes))
    weight = np.where((ball >= 0) & (ball < balls), leaves.ball_multiplier[boxes.leaf], 0.0)
    if not np.any(weight > 0.0):
        return test(rows, [])
    return test(rows, [(weight, ball_constraint(family, np.clip(ball, 0, balls - 1), boxes))])
