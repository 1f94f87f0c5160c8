"""No-fly zones and the geofence as arrays: as they are for proofs, cut into convex pieces for searches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.family.convex import convex_parts, hull_and_pockets
from nullpose.family.ratios import FloatArray, IntArray
from nullpose.scenario import Airspace

__all__ = ["Zones", "airspace_zones"]

FORBIDDEN_POLYGON, FORBIDDEN_CYLINDER, FENCE = 0, 1, 2


@dataclass(frozen=True, slots=True, eq=False)
class Zones:
    """The arrays of a family that say where in its box positions are forbidden (see ``Family``)."""

    piece_start: IntArray
    piece_sides: FloatArray
    zone_kind: IntArray
    zone_start: IntArray
    zone_edges: FloatArray
    zone_range_m: FloatArray


class _Gathered:
    """Zones and pieces as they are put together."""

    def __init__(self) -> None:
        self.pieces: list[FloatArray] = []
        self.kinds: list[int] = []
        self.edges: list[FloatArray] = []
        self.ranges: list[tuple[float, float]] = []

    def zone(self, kind: int, edges: FloatArray, low: float, high: float) -> None:
        """Add a zone."""
        self.kinds.append(kind)
        self.edges.append(edges)
        self.ranges.append((low, high))

    def piece(self, sides: FloatArray, low: float = -np.inf, high: float = np.inf) -> None:
        """Add a convex piece, with its floor and ceiling if it has them."""
        ends = [(0.0, 0.0, 0.0, sign, sign * z) for sign, z in ((1.0, high), (-1.0, low)) if np.isfinite(z)]
        self.pieces.append(np.vstack([sides, np.reshape(ends, (-1, 5))]))

    def arrays(self) -> Zones:
        """Return what was gathered."""
        return Zones(
            piece_start=_starts(self.pieces),
            piece_sides=np.vstack([np.zeros((0, 5)), *self.pieces]),
            zone_kind=np.array(self.kinds, dtype=np.int64),
            zone_start=_starts(self.edges),
            zone_edges=np.vstack([np.zeros((0, 4)), *self.edges]),
            zone_range_m=np.reshape(self.ranges, (-1, 2)).astype(float),
        )


def airspace_zones(airspace: Airspace) -> Zones:
    """Return an airspace's no-fly zones and geofence, those left out that its altitudes do not reach.

    Args:
        airspace: box, zones and fence.
    """
    gathered = _Gathered()
    lowest, highest = airspace.altitude_m
    for zone in airspace.no_fly:
        if zone.floor_m >= highest or zone.ceiling_m <= lowest:
            continue
        low, high = zone.forbidden_range_m(airspace.altitude_m)
        if zone.centre_m is not None and zone.radius_m is not None:
            x, y = zone.centre_m
            gathered.zone(FORBIDDEN_CYLINDER, np.array([[x, y, zone.radius_m, 0.0]]), low, high)
            gathered.piece(np.array([[1.0, x, y, 0.0, zone.radius_m]]), low, high)
            continue
        gathered.zone(FORBIDDEN_POLYGON, _edges(zone.outline_m), low, high)
        for part in convex_parts(zone.outline_m):
            gathered.piece(_outer_sides(part), low, high)
    outline = airspace.geofence_outline_m
    if len(outline):
        gathered.zone(FENCE, _edges(outline), -np.inf, np.inf)
        hull, pockets = hull_and_pockets(outline)
        for side in _outer_sides(hull):
            gathered.piece(np.concatenate([side[:1], -side[1:]])[None])
        for pocket in pockets:
            for part in convex_parts(pocket):
                gathered.piece(_outer_sides(part))
    return gathered.arrays()


def _starts(blocks: list[FloatArray]) -> IntArray:
    return np.cumsum([0, *(len(block) for block in blocks)]).astype(np.int64)


def _edges(outline_m: FloatArray) -> FloatArray:
    return np.hstack([outline_m, np.roll(outline_m, -1, axis=0)])


def _outer_sides(part_m: FloatArray) -> FloatArray:
    """Return the half-planes outside each edge of a convex polygon, counter-clockwise."""
    along = np.roll(part_m, -1, axis=0) - part_m
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    offset = np.sum(normal * part_m, axis=1)
    zero = np.zeros(len(part_m))
    return np.column_stack([zero, normal, zero, offset])
