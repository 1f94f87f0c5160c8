"""No-fly zones and the geofence as arrays: as they are for proofs, cut into convex pieces for searches."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from nullpose.channel.convex import convex_parts, outlines_of, sides_of
from nullpose.objectives import FloatArray, IntArray
from nullpose.problem.family import DEFAULTS, Family
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
from nullpose.scenario.polygon import area_m2

_Zone: TypeAlias = tuple[int, FloatArray, float, float]  # kind, edges, lowest and highest altitude

FORBIDDEN_POLYGON, FORBIDDEN_CYLINDER, FENCE = 0, 1, 2


def airspace_zones(airspace: Airspace) -> dict[str, FloatArray | IntArray]:
    """Build the fields of a domain for no-fly zones and fence, without those that change nothing."""
    zones: list[_Zone] = []
    for zone in airspace.no_fly:
        if (zone.shape == "box" and not area_m2(zone.outline_m) > 0.0) or not airspace.reached(zone):
            continue
        kind, edges = FORBIDDEN_POLYGON, _edges(zone.outline_m)
        if zone.centre_m is not None and zone.radius_m is not None:
            kind, edges = FORBIDDEN_CYLINDER, np.array([[*zone.centre_m, zone.radius_m, 0.0]])
        zones.append((kind, edges, *zone.forbidden_range_m(airspace.altitude_m)))
    if len(airspace.geofence_outline_m):
        zones.append((FENCE, _edges(airspace.geofence_outline_m), -np.inf, np.inf))
    return _arrays(zones) if zones else {name: DEFAULTS[name] for name in Domain._field_defaults}


def loosened(family: Family, by_m: float) -> Family:
    """Build a family with its keep-out balls and zones smaller and its fence larger: walls get a width.

    Args:
        family: ratios and domain.
        by_m: how far each border is moved, metres; much less than anything in the airspace is wide.
    """
    zones: list[_Zone] = []
    domain = family.domain
    for z, (kind, (low, high)) in enumerate(zip(domain.zone_kind, domain.zone_range_m, strict=True)):
        edges = domain.zone_edges[domain.zone_start[z] : domain.zone_start[z + 1]]
        if kind == FORBIDDEN_CYLINDER:
            edges = edges - [0.0, 0.0, by_m, 0.0]
        else:
            edges = _edges(_inset(edges[:, :2], -by_m if kind == FENCE else by_m))
        zones.append((kind, edges, low + by_m, high - by_m))
    return family.changed(keep_out_m=family.domain.keep_out_m - by_m, **_arrays(zones))


def _arrays(zones: list[_Zone]) -> dict[str, FloatArray | IntArray]:
    pieces = [piece for zone in zones for piece in _pieces(*zone)]
    edges = [edges for _, edges, _, _ in zones]
    return {
        "piece_start": _starts(pieces),
        "piece_sides": np.vstack([np.zeros((0, 5)), *pieces]),
        "zone_kind": np.array([zone[0] for zone in zones], dtype=np.int64),
        "zone_start": _starts(edges),
        "zone_edges": np.vstack([np.zeros((0, 4)), *edges]),
        "zone_range_m": np.reshape([zone[2:] for zone in zones], (-1, 2)).astype(float),
    }


def _pieces(kind: int, edges: FloatArray, low: float, high: float) -> list[FloatArray]:
    """List the sides of a zone's convex pieces, with its floor and ceiling if it has them."""
    ends = [(0.0, 0.0, 0.0, sign, sign * z) for sign, z in ((1.0, high), (-1.0, low)) if np.isfinite(z)]
    parts = [np.array([[1.0, *edges[0, :2], 0.0, edges[0, 2]]])]
    if kind == FORBIDDEN_POLYGON:
        parts = [_outer_sides(part) for part in convex_parts(edges[:, :2])]
    elif kind == FENCE:
        hull, pockets = hull_and_pockets(edges[:, :2])
        parts = [_outer_sides(part) for pocket in pockets for part in convex_parts(pocket)]
        parts = [*(_outer_sides(hull) * [1.0, -1.0, -1.0, -1.0, -1.0])[:, None], *parts]
    return [np.vstack([part, np.reshape(ends, (-1, 5))]) for part in parts]


def _inset(outline_m: FloatArray, by_m: float) -> FloatArray:
    """Move the edges of a counter-clockwise polygon inwards; less at the sharpest corners."""
    normal = sides_of(outline_m)[:, :2]
    before = np.roll(normal, 1, axis=0)
    bend = np.maximum(1.0 + np.sum(normal * before, axis=1, keepdims=True), 0.05)
    return np.asarray(outline_m - by_m * (normal + before) / bend)


def _starts(blocks: list[FloatArray]) -> IntArray:
    return np.cumsum([0, *(len(block) for block in blocks)]).astype(np.int64)


def _edges(outline_m: FloatArray) -> FloatArray:
    return np.hstack([outline_m, np.roll(outline_m, -1, axis=0)])


def _outer_sides(part_m: FloatArray) -> FloatArray:
    """List the half-planes outside each edge of a convex polygon, counter-clockwise."""
    return np.insert(sides_of(part_m), [0, 2], 0.0, axis=1)


def hull_and_pockets(outline_m: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
    """Find the convex hull of a simple polygon and the parts of the hull outside the polygon.

    Args:
        outline_m: vertices, (n, 2), metres; like those returned, counter-clockwise.
    """
    import shapely

    polygon = shapely.Polygon(outline_m)
    return outlines_of(polygon.convex_hull)[0], outlines_of(polygon.convex_hull - polygon)
