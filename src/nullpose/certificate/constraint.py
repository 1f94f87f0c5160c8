"""Quadratics of the position that are not negative where a position is allowed."""

from __future__ import annotations

from dataclasses import dataclass

from nullpose.certificate.certificate import FloatArray
from nullpose.certificate.interval import Interval

__all__ = ["Constraint"]


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
