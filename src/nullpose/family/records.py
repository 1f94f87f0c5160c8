"""The arrays of a family, of its domain and of an axis field, by name, as the kernels take them."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["ArrayProblem", "Axes", "Domain", "Ratios"]

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]


class Ratios(NamedTuple):
    """The ratios of a family; :class:`nullpose.family.ratios.Family` says what each array is."""

    points_m: FloatArray
    numerator_isotropic: FloatArray
    numerator_weight: FloatArray
    numerator_point: IntArray
    denominator_of: IntArray
    denominator_isotropic: FloatArray
    denominator_start: IntArray
    denominator_point: IntArray
    denominator_weight: FloatArray
    turn: FloatArray


class Domain(NamedTuple):
    """The positions of a family: box, keep-out balls, convex forbidden pieces, zones."""

    low_m: FloatArray
    high_m: FloatArray
    keep_out_points_m: FloatArray
    keep_out_m: float
    piece_start: IntArray
    piece_sides: FloatArray
    zone_kind: IntArray
    zone_start: IntArray
    zone_edges: FloatArray
    zone_range_m: FloatArray


class Axes(NamedTuple):
    """An axis field: 0 any axis, 1 affine in the position, 2 a band, 3 a cone.

    The ends of a band or a cone stand in the first two places of the offset.
    """

    kind: int
    offset: FloatArray
    matrix: FloatArray


class ArrayProblem(NamedTuple):
    """What an array on a level vehicle hears; m points, the nodes first, and k elements."""

    points_m: FloatArray  # (m, 3)
    strengths_m2: FloatArray  # (m,) power times path gain over noise, a node's divided by what it requires
    nodes: int
    base: FloatArray  # (k, 2) elements in body axes, wavelengths
    shared: bool  # whether one beam serves all nodes; otherwise each has its own weights
