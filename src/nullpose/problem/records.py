"""The arrays of a family's domain and of an axis field, by name, as the kernels take them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray, IntArray, Ratios


class Domain(NamedTuple):
    """The positions of a family: box, keep-out balls, convex forbidden pieces, zones.

    Args:
        low_m: (3,) lowest position, minus infinity where unbounded.
        high_m: (3,) highest position.
        keep_out_points_m: (q, 3) centres of the balls that positions must stay out of and could reach.
        keep_out_m: their radius.
        piece_start: (c + 1,) bounds of each convex forbidden piece's sides. A position is outside a piece if
            it is on the outer side of one of them.
        piece_sides: (s, 5) sides: (0, a, b) with ``a.p >= b`` outside, a of unit length, or (1, x, y, 0, r)
            outside the upright cylinder of radius r.
        zone_kind: (z,) 0 a forbidden polygon, 1 a forbidden cylinder, 2 a polygon to stay in; the pieces are
            these zones cut into convex parts.
        zone_start: (z + 1,) bounds of each zone's edges.
        zone_edges: (e, 4) an edge's ends (x1, y1, x2, y2), the polygons counter-clockwise; or (x, y, r, 0).
        zone_range_m: (z, 2) lowest and highest altitude of each zone.
    """

    low_m: FloatArray
    high_m: FloatArray
    keep_out_points_m: FloatArray
    keep_out_m: float
    piece_start: IntArray = np.zeros(1, dtype=np.int64)
    piece_sides: FloatArray = np.zeros((0, 5))
    zone_kind: IntArray = np.zeros(0, dtype=np.int64)
    zone_start: IntArray = np.zeros(1, dtype=np.int64)
    zone_edges: FloatArray = np.zeros((0, 4))
    zone_range_m: FloatArray = np.zeros((0, 2))


FREE_AXIS, AFFINE_AXIS, BAND_AXIS, NARROW_AXIS, CONE_AXIS = 0, 1, 2, 3, 4
"""Kinds of axis field: any axis, affine in the position, a band of elevations, a narrow one, a cone."""


class Axes(NamedTuple):
    """An axis field of one of the kinds.

    The ends of a band or of a cone about the vertical stand in the first two places of the offset.
    """

    kind: int
    offset: FloatArray
    matrix: FloatArray


class AttitudeReach(NamedTuple):
    """Which attitudes of an antenna with a pattern the airframe reaches.

    Args:
        tilt_max_rad: largest angle between the body's vertical and the world's.
        mount_rad: angle between the antenna's axis and the body's vertical.
        up: (3,) the body's vertical in the antenna's axes.
        spins: whether the antenna is the same all round its axis, so that any spin about it does.
        even: whether it is the same upside down, too.
    """

    tilt_max_rad: float
    mount_rad: float
    up: FloatArray
    spins: bool
    even: bool


class ArrayProblem(NamedTuple):
    """What an array on a level vehicle receives; m points, the nodes first, and k elements."""

    ratios: Ratios  # with the points, (m, 3), and their channels
    strengths_m2: FloatArray  # (m,) power times path gain over noise, a node's divided by what it requires
    nodes: int
    base: FloatArray  # (k, 2) elements in body axes, wavelengths
