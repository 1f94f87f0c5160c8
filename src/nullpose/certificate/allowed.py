"""Tests that need not exclude what is not allowed: balls and zones with their multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import reduce
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.interval import Interval
from nullpose.certificate.zones import Constraint, zone_alternatives
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.records import Domain

# Constraints with a multiplier, not negative, for each box.
Weighted: TypeAlias = list[tuple[FloatArray, Constraint]]


def negative_where_allowed(
    domain: Domain,
    leaves: Leaves,
    boxes: Boxes,
    test: Callable[[IntArray, Weighted], np.ndarray],
    gradient: Callable[[], FloatArray],
) -> np.ndarray:
    """Check which boxes a test excludes at every position that is allowed.

    A ball's multiplier is the leaf's. Those of a zone are guessed here, for each of its alternatives: any
    that are not negative are sound.

    Args:
        domain: with its keep-out balls and zones.
        leaves: of the boxes, with the ball or zone that counts in each.
        boxes: to be tested.
        test: returns whether a sum, with these multiples of constraints added, is negative all over the boxes
            of these indices.
        gradient: returns that of the sum at the centres, (3, b), which is to be cancelled.
    """
    balls = len(domain.keep_out_points_m)
    rows = np.arange(len(boxes))
    of_ball = (leaves.ball >= 0) & (leaves.ball < balls)
    weight = np.where(of_ball, leaves.ball_multiplier, 0.0)
    weighted: Weighted = []
    if np.any(weight > 0.0):
        away = Interval(boxes.centre) - domain.keep_out_points_m[np.where(of_ball, leaves.ball, 0)]
        weighted = [(weight, Constraint.outside(away.T, domain.keep_out_m, np.ones(3)))]
    holds = test(rows, weighted)
    if not len(left := rows[(leaves.ball >= balls) & ~holds]):
        return holds
    steep = gradient()
    holds[left] = True
    for rows, constraints in zone_alternatives(domain, leaves.ball[left] - balls, boxes.chosen(left)):
        named = left[rows]
        guesses = _guesses(constraints, steep[:, named])
        tests = (test(named, list(zip(guess, constraints, strict=True))) for guess in guesses)
        excluded = reduce(np.logical_or, tests, np.zeros(len(named), dtype=bool))
        holds[named[~excluded]] = False  # a box may be named twice
    return holds


def _guesses(constraints: tuple[Constraint, ...], gradient: FloatArray) -> Iterator[FloatArray]:
    """Yield multipliers, (c, b), with which the constraints' gradients cancel one, as far as they can."""
    if not constraints:
        return
    normals = np.stack([bound.slopes.middle() for bound in constraints])
    gram = np.einsum("ikb,jkb->ijb", normals, normals)
    pull = -np.einsum("ikb,kb->ib", normals, gradient)
    alone = _usable(pull / np.einsum("iib->ib", gram))
    yield from (alone * chosen[:, None] for chosen in np.eye(len(alone)))
    if len(alone) == 2:
        det = gram[0, 0] * gram[1, 1] - gram[0, 1] ** 2
        yield _usable((pull * gram[[1, 0], [1, 0]] - pull[::-1] * gram[0, 1]) / det)


def _usable(multiplier: FloatArray) -> FloatArray:
    """Return multipliers with zero in place of what is negative or undefined."""
    return np.where(np.isfinite(multiplier), np.maximum(multiplier, 0.0), 0.0)
