"""Tests that need not exclude what is not allowed: balls and zones with their multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.constraint import Constraint
from nullpose.certificate.interval import Interval, dot
from nullpose.certificate.zones import zone_alternatives
from nullpose.family import Family

__all__ = ["Weighted", "negative_where_allowed"]

Weighted: TypeAlias = list[tuple[FloatArray, Constraint]]
"""Constraints with a multiplier, not negative, for each box."""


def negative_where_allowed(
    family: Family,
    leaves: Leaves,
    boxes: Boxes,
    test: Callable[[IntArray, Weighted], np.ndarray],
    gradient: Callable[[], FloatArray],
) -> np.ndarray:
    """Return which boxes a test excludes at every position that is allowed.

    A ball's multiplier is the leaf's. Those of a zone are guessed here, for each of its alternatives: any
    that are not negative are sound.

    Args:
        family: with its keep-out balls and zones.
        leaves: with the ball or zone that counts in each.
        boxes: to be tested.
        test: returns whether a sum, with these multiples of constraints added, is negative all over the boxes
            of these indices.
        gradient: returns that of the sum at the centres, (b, 3), which is to be cancelled.
    """
    balls = len(family.keep_out_points_m)
    ball = leaves.ball[boxes.leaf]
    rows = np.arange(len(boxes))
    weight = np.where((ball >= 0) & (ball < balls), leaves.ball_multiplier[boxes.leaf], 0.0)
    weighted: Weighted = []
    if np.any(weight > 0.0):
        weighted = [(weight, _outside_ball(family, np.clip(ball, 0, balls - 1), boxes))]
    holds = test(rows, weighted)
    left = rows[(ball >= balls) & ~holds]
    if not len(left):
        return holds
    steep = gradient()
    holds[left] = True
    for one in zone_alternatives(family, ball[left] - balls, boxes.chosen(left)):
        here = left[one.rows]
        held = np.zeros(len(here), dtype=bool)
        for multipliers in _guesses(one.constraints, steep[here]):
            held |= test(here, list(zip(multipliers, one.constraints, strict=True)))
        holds[here[~held]] = False  # a box may be named twice
    return holds


def _outside_ball(family: Family, ball: IntArray, boxes: Boxes) -> Constraint:
    """Return ``|p - q|^2 - R^2``."""
    away = Interval(boxes.centre) - family.keep_out_points_m[ball]
    value = dot(away, away) - Interval(family.keep_out_m).squared()
    return Constraint(value, away * 2.0, np.ones((len(boxes), 3)))


def _guesses(constraints: tuple[Constraint, ...], gradient: FloatArray) -> Iterator[list[FloatArray]]:
    """Yield multipliers with which the constraints' gradients cancel one, as far as they can."""
    slopes = [bound.slopes.middle() for bound in constraints]
    zero = np.zeros(len(gradient))
    alone = [_usable(-_inner(slope, gradient) / _inner(slope, slope)) for slope in slopes]
    for i, multiplier in enumerate(alone):
        yield [multiplier if i == c else zero for c in range(len(slopes))]
    if len(slopes) == 2:
        a, b, c = _inner(slopes[0], slopes[0]), _inner(slopes[0], slopes[1]), _inner(slopes[1], slopes[1])
        d, e = -_inner(slopes[0], gradient), -_inner(slopes[1], gradient)
        det = a * c - b * b
        yield [_usable((d * c - e * b) / det), _usable((e * a - d * b) / det)]


def _inner(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.sum(a * b, axis=1))


def _usable(multiplier: FloatArray) -> FloatArray:
    """Return multipliers with zero in place of what is negative or undefined."""
    return np.where(np.isfinite(multiplier), np.maximum(multiplier, 0.0), 0.0)
