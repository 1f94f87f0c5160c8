"""Straight segments past what is forbidden: a half space for each obstacle that both ends are in."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.problem.records import Domain

_NO_LENGTH_M = 1e-9


class HalfSpaces(NamedTuple):
    """Half spaces ``n . p >= c``, one for each segment and obstacle; there is none where the normal is zero.

    Args:
        normals: (n, k, 3) unit normals.
        starts: (n, k) c at the segment's start.
        ends: (n, k) c at its end: what moves is elsewhere then.
        slacks_m: (n, k) the lesser distance of both ends.
    """

    normals: FloatArray
    starts: FloatArray
    ends: FloatArray
    slacks_m: FloatArray


def half_spaces(
    domain: Domain, p: FloatArray, q: FloatArray, centres: FloatArray, moved: FloatArray, radius_m: float
) -> HalfSpaces:
    """Find, for each segment, the side of each forbidden piece, and of each ball, that it is farthest on.

    A segment of which both ends are in the half space does not meet the convex obstacle.

    Args:
        domain: with its forbidden pieces, which stand.
        p: (n, 3) starts of the segments, metres.
        q: (n, 3) their ends.
        centres: (n, m, 3) of the balls when the vehicle is at p.
        moved: (n, m, 3) likewise at q; in between both are on straight lines.
        radius_m: of the balls.
    """
    parts = [_of_pieces(domain, p, q), _of_balls(p, q, centres, moved, radius_m)]
    return HalfSpaces(*(np.concatenate(each, axis=1) for each in zip(*parts, strict=True)))


def _of_pieces(domain: Domain, p: FloatArray, q: FloatArray) -> HalfSpaces:
    sides, start = domain.piece_sides, domain.piece_start
    normals = np.broadcast_to(sides[:, 1:4], (len(p), len(sides), 3)).copy()
    offsets = np.broadcast_to(sides[:, 4], normals.shape[:2]).copy()
    for s in np.flatnonzero(sides[:, 0] == 1.0):  # an upright cylinder: the plane before it
        outward = _towards_nearest(p[:, :2] - sides[s, 1:3], q[:, :2] - sides[s, 1:3])
        normals[:, s, :2], normals[:, s, 2] = outward, 0.0
        offsets[:, s] = outward @ sides[s, 1:3] + sides[s, 4]
    slacks = np.minimum(*(np.einsum("nsi,ni->ns", normals, end) - offsets for end in (p, q)))
    chosen = [first + np.argmax(slacks[:, first:last], axis=1) for first, last in pairwise(start)]
    rows = np.arange(len(p))[:, None], np.array(chosen, dtype=np.int64).reshape(-1, len(p)).T
    return HalfSpaces(normals[rows], offsets[rows], offsets[rows], slacks[rows])


def _of_balls(
    p: FloatArray, q: FloatArray, centres: FloatArray, moved: FloatArray, radius_m: float
) -> HalfSpaces:
    outward = _towards_nearest(p[:, None] - centres, q[:, None] - moved)
    starts, ends = (np.einsum("nki,nki->nk", outward, each) + radius_m for each in (centres, moved))
    slacks = np.minimum(
        np.einsum("nki,ni->nk", outward, p) - starts, np.einsum("nki,ni->nk", outward, q) - ends
    )
    return HalfSpaces(outward, starts, ends, slacks)


def _towards_nearest(first: FloatArray, last: FloatArray) -> FloatArray:
    """Return the unit vectors from the origin to the nearest points of segments, (..., i)."""
    along = last - first
    square = np.maximum(np.sum(along**2, axis=-1, keepdims=True), _NO_LENGTH_M**2)
    share = np.clip(-np.sum(first * along, axis=-1, keepdims=True) / square, 0.0, 1.0)
    nearest = first + share * along
    return np.asarray(nearest / np.maximum(np.linalg.norm(nearest, axis=-1, keepdims=True), _NO_LENGTH_M))
