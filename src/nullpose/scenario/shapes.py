"""Shapes in degrees, x being longitudes, which go on across the antimeridian, and y latitudes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import shapely
from shapely import LinearRing, Polygon
from shapely.geometry.base import BaseGeometry

from nullpose.scenario.faults import require
from nullpose.scenario.geodesy import geodetic_from_enu, wrapped

_SAME_CORNER_DEG = 9e-8  # a centimetre
_STRAIGHT_DEG = 0.02  # an edge of this length, straight in degrees, is within 0.2 m of straight in metres
_CUT_DEG = 0.05  # the same within a metre, for edges that bound nothing
DISC_SIDES = 180
"""How many sides the polygon has that stands for a round fence."""
_LOOPS = 0.01  # of the area inside a ring: larger loops may mean that its corners are out of order


def parts_of(geometry: BaseGeometry | Sequence[BaseGeometry] | None) -> Iterator[BaseGeometry]:
    """Yield the single geometries of one that may hold several, without the empty ones."""
    for part in shapely.get_parts(geometry):
        if hasattr(part, "geoms"):
            yield from parts_of(part)
        elif not part.is_empty:
            yield part


def corners_of(ring: LinearRing) -> list[list[float]]:
    """Return the corners of a ring as latitudes and longitudes, these from -180 to 180 degrees."""
    lon_deg, lat_deg = shapely.get_coordinates(ring)[:-1].T
    return list(np.stack([lat_deg, wrapped(lon_deg)], axis=1).tolist())


def sound(polygon: Polygon, place: str, is_fence: bool) -> tuple[Polygon, bool]:
    """Mend doubled corners and spikes, and make long edges straight in degrees; empty for a wall.

    Where a ring has small loops, all inside the rings counts.

    Args:
        polygon: any.
        place: of its feature, for messages.
        is_fence: whether every crossing of a border is a fault.

    Returns:
        The polygon, or several, and whether its border crossed itself.

    Raises:
        ScenarioError: it does, and may mean that corners are out of order.
    """
    with suppress(shapely.GEOSException):  # a ring within a centimetre stays as it is
        polygon = shapely.remove_repeated_points(polygon, _SAME_CORNER_DEG)
    valid = polygon if polygon.is_valid else _valid(polygon)
    # GEOS has the area inside the rings, which spikes do not change and crossings do
    if is_crossing := abs(valid.area - polygon.area) > _SAME_CORNER_DEG * polygon.length:
        rings = [shapely.Polygon(ring) for ring in (polygon.exterior, *polygon.interiors)]
        wholes = [_valid(ring) for ring in rings]
        has_loops = np.any(shapely.area(rings) < (1.0 - _LOOPS) * shapely.area(wholes))
        require(
            not (is_fence or has_loops),
            place,
            f"its border crosses itself ({shapely.is_valid_reason(polygon)}, longitude and latitude); list "
            "every corner once, in order around the area",
        )
        valid = shapely.union_all(wholes)
    is_wall = valid.area <= _SAME_CORNER_DEG * valid.length
    return shapely.Polygon() if is_wall else shapely.segmentize(valid, _STRAIGHT_DEG), is_crossing


def _valid(polygon: Polygon) -> BaseGeometry:
    return shapely.make_valid(polygon, method="structure", keep_collapsed=False)


def is_solid(faces: BaseGeometry | None) -> bool:
    """Check if polygons have a wall among them, or lie one above the other, as a roof and a floor do."""
    polygons = [shapely.make_valid(part) for part in parts_of(shapely.force_2d(faces))]
    areas = shapely.area(polygons)
    is_doubled = areas.sum() > (2.0 - _LOOPS) * shapely.union_all(polygons).area
    return bool(is_doubled or np.any(areas <= _SAME_CORNER_DEG * shapely.length(polygons)))


def connected(geometry: BaseGeometry | None) -> list[BaseGeometry]:
    """Return the parts of a geometry together that touch each other, seen from above."""
    parts = list(parts_of(geometry))
    seen = [shapely.buffer(shapely.make_valid(shapely.force_2d(part)), _SAME_CORNER_DEG) for part in parts]
    return [
        shapely.GeometryCollection(
            [part for part, each in zip(parts, seen, strict=True) if each.intersects(region)]
        )
        for region in parts_of(shapely.union_all(seen))
    ]


def disc(lon_deg: float, lat_deg: float, radius_m: float, alt_m: float) -> Polygon:
    """Return a polygon with its corners on a circle [m]; its sides are up to 0.015 % of the radius inside."""
    angles = np.linspace(0.0, 2.0 * np.pi, DISC_SIDES, endpoint=False)
    places_m = radius_m * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=-1)
    return shapely.Polygon(geodetic_from_enu(places_m, [lat_deg, lon_deg, alt_m])[:, 1::-1])


def near(polygon: Polygon, middle_deg: float) -> Polygon:
    """Move a polygon's longitudes near a middle, going on across the antimeridian."""
    return shapely.transform(
        polygon,
        lambda corners: np.insert(
            corners[:, 1:], 0, wrapped(corners[:, 0], wrapped(corners[0, 0], middle_deg)), axis=1
        ),
    )


def box_about(lon_deg: float, lat_deg: float, radius_m: object) -> Polygon:
    """Return a box of degrees that a cylinder lies in; one about all where its radius is at fault."""
    half = 360.0
    if isinstance(radius_m, int | float) and not isinstance(radius_m, bool) and 0.0 <= radius_m < 4e7:
        half = radius_m / 1.1e5  # a degree of latitude has 110.57 km at least
    wide = half / max(np.cos(np.radians(min(abs(lat_deg) + half, 89.0))), 0.01)
    return shapely.box(lon_deg - wide, lat_deg - half, lon_deg + wide, lat_deg + half)


def cut(polygon: Polygon, box: Polygon) -> list[Polygon]:
    """Return the parts of a polygon that lie in a box; one that lies in it as it is."""
    if box.covers(polygon.envelope):
        return [polygon]
    # In metres a long edge of the box would leave the parallel, and might cross other edges
    return [
        part for part in parts_of(polygon & shapely.segmentize(box, _CUT_DEG)) if part.geom_type == "Polygon"
    ]
