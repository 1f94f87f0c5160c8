"""Tests that need not exclude what is not allowed: balls and zones with their multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import reduce
from typing import TypeAlias

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import Leaves
from nullpose.certificate.taylor import Taylor
from nullpose.certificate.zones import beyond, zone_alternatives
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.records import Domain

Weighted: TypeAlias = list[tuple[FloatArray, Taylor]]
"""Functions that are not negative where a position is allowed, with a multiplier, likewise, for each box."""


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
        centre_m = domain.keep_out_points_m[np.where(of_ball, leaves.ball, 0)].T
        weighted = [(weight, beyond(boxes.position, centre_m, domain.keep_out_m))]
    holds = test(rows, weighted)
    if not len(left := rows[(leaves.ball >= balls) & ~holds]):
        return holds
    steep = gradient()
    # an allowed position meets some alternative that names its box: the test must exclude each of these
    holds[left] = True
    for rows, constraints in zone_alternatives(domain, leaves.ball[left] - balls, boxes.chosen(left)):
        named = left[rows]
        guesses = _guesses(constraints, steep[:, named])
        tests = (test(named, list(zip(guess, constraints, strict=True))) for guess in guesses)
        excluded = reduce(np.logical_or, tests, np.zeros(len(named), dtype=bool))
        holds[named[~excluded]] = False
    return holds


def _guesses(constraints: tuple[Taylor, ...], gradient: FloatArray) -> Iterator[FloatArray]:
    """Yield multipliers, (c, b), with which the constraints' gradients cancel one, as far as they can.

    By least squares, each constraint alone and then all together; none where there are no constraints, which
    the test has been tried without.
    """
    subsets = np.unique([*np.eye(len(constraints)), np.ones(len(constraints))], axis=0)
    for used in subsets if constraints else ():
        normals = np.stack([np.broadcast_to(g.at.slopes.middle(), gradient.shape) for g in constraints])
        inverse = np.linalg.pinv(np.moveaxis(normals * used[:, None, None], -1, 0))
        pull = -np.einsum("bkc,kb->cb", inverse, gradient)
        yield np.nan_to_num(np.maximum(pull, 0.0), nan=0.0, posinf=0.0)
