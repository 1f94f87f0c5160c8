"""The family of ratios ``(u^T N_k(p) u) / (u^T D_k(p) u)`` and the positions it is asked about."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, fields
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from nullpose.family.records import Domain, Ratios

__all__ = ["Family"]

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Family:
    """Ratios over the link forms of points, as plain arrays.

    With ``T(r) = (|r|^2 I - r r^T) / |r|^4`` and ``r_j = points[j] - p``, ratio k is
    ``N_k = n_k I + w_k T(r_a(k))`` over ``D_g(k) = d_g I + sum_e b_e T(r_j(e))``, the sum being over the
    entries e
    from ``denominator_start[g]`` to ``denominator_start[g + 1]``. Ratios may share a denominator. Everything
    is dimensionless but the positions.

    Args:
        points_m: (m, 3) ground points, metres.
        numerator_isotropic: (r,) ``n_k``.
        numerator_weight: (r,) ``w_k``, m^2.
        numerator_point: (r,) index ``a(k)`` into the points.
        denominator_of: (r,) index ``g(k)`` of each ratio's denominator.
        denominator_isotropic: (g,) ``d_g``, positive.
        denominator_start: (g + 1,) bounds of each denominator's entries.
        denominator_point: (e,) index of each entry's point.
        denominator_weight: (e,) ``b_e``, m^2.
        low_m: (3,) lowest position, minus infinity where unbounded.
        high_m: (3,) highest position.
        keep_out_points_m: (q, 3) centres of the balls that positions must stay out of and could reach.
        keep_out_m: their radius.
        turn: (m, 3, 3) rotations: point j sees the axis ``turn[j] u``; or (0, 3, 3), where all see u itself.
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

    points_m: FloatArray
    numerator_isotropic: FloatArray
    numerator_weight: FloatArray
    numerator_point: IntArray
    denominator_of: IntArray
    denominator_isotropic: FloatArray
    denominator_start: IntArray
    denominator_point: IntArray
    denominator_weight: FloatArray
    low_m: FloatArray
    high_m: FloatArray
    keep_out_points_m: FloatArray
    keep_out_m: float
    turn: FloatArray = field(default_factory=lambda: np.zeros((0, 3, 3)))
    piece_start: IntArray = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    piece_sides: FloatArray = field(default_factory=lambda: np.zeros((0, 5)))
    zone_kind: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    zone_start: IntArray = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    zone_edges: FloatArray = field(default_factory=lambda: np.zeros((0, 4)))
    zone_range_m: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if isinstance(value, np.ndarray):
                array = np.ascontiguousarray(value).copy()
                array.flags.writeable = False
                object.__setattr__(self, one.name, array)

    @property
    def arrays(self) -> Ratios:
        """The ratios as the kernels take them."""
        return Ratios(*(getattr(self, name) for name in Ratios._fields))

    @property
    def domain(self) -> Domain:
        """The positions as the kernels take them."""
        return Domain(*(getattr(self, name) for name in Domain._fields))

    @property
    def digest(self) -> str:
        """SHA-256 of every number in the family: two families with the same digest are the same problem."""
        sha = hashlib.sha256()
        for one in fields(self):
            value = np.ascontiguousarray(getattr(self, one.name))
            sha.update(f"{one.name}:{value.dtype.str}:{value.shape};".encode())
            sha.update(value.tobytes())
        return sha.hexdigest()
