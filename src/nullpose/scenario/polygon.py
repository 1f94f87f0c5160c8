"""Simple polygons in the plane: what may be one, its border's distance from points, and its margin."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import AfterValidator

from nullpose.scenario.faults import require_value
from nullpose.scenario.rules import ListOf
from nullpose.scenario.section import Floats, read_only
from nullpose.scenario.units import LatLon, PlanePoint

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

# shapely is imported where there is a polygon: most scenarios have none.

MOST_CORNERS = 5000
"""Vertices of a polygon, and of all that an airspace has: more take too long to cut."""
_Vertices = tuple[tuple[float, float], ...]
_SAME_VERTEX = 1e-9  # metres or degrees: vertices closer than this are one


def area_m2(vertices_m: Floats) -> float:
    """Return the area [m²] inside a closed chain of vertices, positive when they run counter-clockwise.

    The shoelace formula, about the first vertex so that a distant origin costs no digits.

    Args:
        vertices_m: vertices [m], (n, 2).
    """
    x, y = (vertices_m - vertices_m[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def counter_clockwise_m(polygon: Sequence[tuple[float, float]] | None) -> Floats:
    """Return the vertices of a polygon [m], (n, 2), counter-clockwise and read-only; none without one."""
    vertices_m = np.asarray(polygon or (), dtype=np.float64).reshape(-1, 2)
    clockwise = len(vertices_m) > 0 and area_m2(vertices_m) < 0.0
    return read_only(vertices_m[::-1] if clockwise else vertices_m, (-1, 2))


def depth_m(points_m: Floats, vertices_m: Floats) -> Floats:
    """Measure how deep points lie in a polygon [m]: their distance from the border, negative outside.

    Args:
        points_m: points [m], (..., 2).
        vertices_m: vertices of a simple polygon [m], (n, 2), in either sense of rotation.

    Returns:
        Array of shape ``(...)``.
    """
    import shapely

    polygon, border = _prepared(vertices_m.tobytes())
    distance = shapely.distance(border, shapely.points(points_m))
    return np.asarray(
        np.where(shapely.contains_xy(polygon, *np.moveaxis(points_m, -1, 0)), distance, -distance)
    )


@lru_cache(maxsize=64)
def _prepared(vertices_m: bytes) -> tuple[BaseGeometry, BaseGeometry]:
    """Return a polygon and its border, indexed for many points."""
    import shapely

    polygon = shapely.Polygon(np.frombuffer(vertices_m).reshape(-1, 2))
    found = polygon, polygon.exterior
    shapely.prepare(found)
    return found


@lru_cache(maxsize=64)  # a scenario reads its polygons more than once
def _judged(corners: _Vertices) -> tuple[str, _Vertices]:
    """Find the fault of corners that bound no area, in shapely's words, and drop doubled ones."""
    import shapely

    try:
        polygon = shapely.remove_repeated_points(shapely.Polygon(corners), _SAME_VERTEX)
    except shapely.GEOSException:
        return "all vertices are one", ()
    if polygon.is_valid and polygon.area:
        return "", tuple(polygon.exterior.coords)[:-1]
    return "it has no area" if polygon.is_valid else shapely.is_valid_reason(polygon), ()


def _outline(value: _Vertices) -> _Vertices:
    """Return the vertices without doubled ones, or raise the fault that keeps them from one area."""
    fault, corners = _judged(value)
    require_value(
        not fault,
        f"the border crosses or touches itself, or has no area ({fault}); list every vertex once, in "
        "order around the area (the last is joined to the first)",
    )
    return value if len(corners) == len(value) else corners


def _earthly_outline(value: _Vertices) -> _Vertices:
    """Do the same in degrees; longitudes go on across the antimeridian."""
    first = value[0][1]
    near = tuple((lat, lon - 360.0 * round((lon - first) / 360.0)) for lat, lon in value)
    corners = _outline(near)
    return value if corners is near else tuple((lat, (lon + 180.0) % 360.0 - 180.0) for lat, lon in corners)


Polygon = Annotated[
    tuple[PlanePoint, ...],
    ListOf(f"a list of at least three and at most {MOST_CORNERS} vertices [x, y] in m", 3, MOST_CORNERS),
    AfterValidator(_outline),
]
"""The vertices [x, y] of a polygon in order, in m; the last is joined to the first."""
EarthlyPolygon = Annotated[
    tuple[LatLon, ...],
    ListOf(
        f"a list of at least three and at most {MOST_CORNERS} vertices [latitude, longitude] in degrees",
        3,
        MOST_CORNERS,
    ),
    AfterValidator(_earthly_outline),
]
"""The vertices [latitude, longitude] of a polygon in order, in degrees; the last is joined to the first."""


_MITRE_LIMIT = 1.5  # a right angle's mitre, 1.42 times the distance, stays whole
_SLACK = 1e-5  # GEOS rounds its offsets by 2e-6 of the distance
_SIMPLER = 1e-6


def offset_outlines_m(outline_m: Floats, by_m: float) -> list[tuple[tuple[float, float], ...]]:
    """Return a polygon's outline further out, or further in: one for each part that it falls into.

    No point of the new border is nearer to the old one than the distance. At a corner it is up to 1.81 times
    as far away: edges are joined by mitres, which are cut off at 1.5 times the distance. A pocket whose mouth
    closes counts as inside.

    Args:
        outline_m: vertices of a simple polygon [m], (n, 2).
        by_m: how far each edge is moved outwards [m]; inwards if negative.
    """
    from shapely import Polygon  # imported here: most scenarios have no margin

    moved = Polygon(outline_m).buffer(by_m * (1.0 + _SLACK), join_style="mitre", mitre_limit=_MITRE_LIMIT)
    moved = moved.simplify(_SIMPLER * abs(by_m))  # edges of no length have no direction
    return [
        tuple(part.exterior.coords[:-1]) for part in getattr(moved, "geoms", [moved]) if not part.is_empty
    ]


def largest_margin_m(outline_m: Floats, below_m: float) -> float:
    """Return the largest margin, to a hundredth, that leaves one part inside an outline [m]; 0 if none does.

    Args:
        outline_m: vertices of a simple polygon [m], (n, 2).
        below_m: what it is smaller than [m].
    """
    most_m = min(below_m, 0.5 * float(np.ptp(outline_m, axis=0).min()))
    tried_m = (float(f"{most_m * percent / 100:.3g}") for percent in range(99, 0, -1))
    return next((each_m for each_m in tried_m if len(offset_outlines_m(outline_m, -each_m)) == 1), 0.0)
