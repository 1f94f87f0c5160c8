"""Simple polygons in the plane: what may be one, and how far points are from its border."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Annotated, Any

import numpy as np

from nullpose.scenario.arrays import Floats, read_only
from nullpose.scenario.faults import rejection
from nullpose.scenario.rules import ListOf
from nullpose.scenario.units import LatLon, PlanePoint

# shapely is imported where there is a polygon: most scenarios have none.

MOST_CORNERS = 5000
"""Vertices of a polygon, and of all that an airspace has: more take too long to cut."""
_SAME = 1e-9  # metres or degrees: vertices closer than this are one


def area_m2(vertices_m: Floats) -> float:
    """Returns the area [m²] inside a closed chain of vertices, positive when they run counter-clockwise.

    The shoelace formula, about the first vertex so that a distant origin costs no digits.

    Args:
        vertices_m: vertices [m], (n, 2).
    """
    x, y = (vertices_m - vertices_m[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def counter_clockwise_m(polygon: Sequence[tuple[float, float]] | None) -> Floats:
    """Returns the vertices of a polygon [m], (n, 2), counter-clockwise and read-only; none without one."""
    vertices_m = np.asarray(polygon or (), dtype=np.float64).reshape(-1, 2)
    clockwise = len(vertices_m) > 0 and area_m2(vertices_m) < 0.0
    return read_only(vertices_m[::-1] if clockwise else vertices_m, (-1, 2))


def depth_m(points_m: Floats, vertices_m: Floats) -> Floats:
    """Returns how deep each point lies in the polygon [m]: its distance from the border, negative outside.

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
def _prepared(vertices_m: bytes) -> tuple[Any, Any]:
    """Returns a polygon and its border, indexed for many points."""
    import shapely

    polygon = shapely.Polygon(np.frombuffer(vertices_m).reshape(-1, 2))
    found = polygon, polygon.exterior
    shapely.prepare(found)
    return found


@lru_cache(maxsize=64)  # a scenario reads its polygons more than once
def _judged(corners: tuple[tuple[float, float], ...]) -> tuple[str, tuple[tuple[float, float], ...]]:
    """Returns what keeps corners from bounding one area, in shapely's words, or those not doubled."""
    import shapely

    try:
        polygon = shapely.remove_repeated_points(shapely.Polygon(corners), _SAME)
    except shapely.GEOSException:
        return "all vertices are one", ()
    if polygon.is_valid and polygon.area:
        return "", tuple(polygon.exterior.coords)[:-1]
    return "it has no area" if polygon.is_valid else shapely.is_valid_reason(polygon), ()


class _Outline(ListOf):
    """The vertices of a simple polygon, as the metadata of an annotated tuple."""

    def judge(self, value: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """Returns the vertices without doubled ones, or raises the fault that keeps them from one area."""
        fault, corners = _judged(value)
        if fault:
            raise rejection(
                f"the border crosses or touches itself, or has no area ({fault}); list every vertex once, in "
                "order around the area (the last is joined to the first)"
            )
        return value if len(corners) == len(value) else corners


class _EarthlyOutline(_Outline):
    """The same in degrees; longitudes go on across the antimeridian."""

    def judge(self, value: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """Returns the vertices without doubled ones, or raises the fault that keeps them from one area."""
        first = value[0][1]
        near = tuple((lat, lon - 360.0 * round((lon - first) / 360.0)) for lat, lon in value)
        corners = super().judge(near)
        return (
            value if corners is near else tuple((lat, (lon + 180.0) % 360.0 - 180.0) for lat, lon in corners)
        )


Polygon = Annotated[
    tuple[PlanePoint, ...],
    _Outline(f"a list of at least three and at most {MOST_CORNERS} vertices [x, y] in m", 3, MOST_CORNERS),
]
"""The vertices [x, y] of a polygon in order, in m; the last is joined to the first."""
EarthlyPolygon = Annotated[
    tuple[LatLon, ...],
    _EarthlyOutline(
        f"a list of at least three and at most {MOST_CORNERS} vertices [latitude, longitude] in degrees",
        3,
        MOST_CORNERS,
    ),
]
"""The vertices [latitude, longitude] of a polygon in order, in degrees; the last is joined to the first."""
