"""Quadratics of the position that are not negative where a position is allowed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.certificate import FloatArray
from nullpose.certificate.interval import Interval, dot


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A quadratic of the position for each box, ``g(c + x) = value + slopes.x + sum_i bend_i x_i^2``.

    Args:
        value: (b,) at the boxes' centres.
        slopes: (3, b) its gradient there.
        bend: (3, b) not negative.
    """

    value: Interval
    slopes: Interval
    bend: FloatArray

    @classmethod
    def beyond(cls, away: Interval, normal: Interval) -> Constraint:
        """Return ``n.(p - q)``.

        Args:
            away: (3, b) from a point q of the plane to the boxes' centres.
            normal: (3, b) n, of any length.
        """
        return cls(dot(away, normal), normal, np.zeros(normal.low.shape))

    @classmethod
    def outside(cls, away: Interval, radius: FloatArray | float, counted: FloatArray) -> Constraint:
        """Return ``|p - q|^2 - R^2`` over the coordinates that count.

        Args:
            away: (3, b) from q to the boxes' centres, zero along the others.
            radius: (b,) or one R.
            counted: (3,) one for each coordinate that counts, zero for the others.
        """
        value = away.squared().total() - Interval(radius).squared()
        return cls(value, away * 2.0, np.outer(counted, np.ones(value.low.shape)))
