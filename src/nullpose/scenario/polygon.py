"""Simple polygons in the plane: what may be one, and how far points are from its border."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import rejection
from nullpose.scenario.units import PlanePoint
from nullpose.scenario.wording import described, plain

__all__ = ["Polygon", "area_m2", "depth_m"]

Array = NDArray[np.float64]

_MOST = 1000  # vertices: each edge is compared with every other
_APART_M = 1e-6
"""Vertices and edges closer than this meet [m]."""


def area_m2(vertices_m: Array) -> float:
    """Returns the area [m²] inside a closed chain of vertices, positive when they run counter-clockwise.

    The shoelace formula, about the first vertex so that a distant origin costs no digits.

    Args:
        vertices_m: vertices [m], (n, 2).
    """
    x, y = (vertices_m - vertices_m[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def depth_m(points_m: Array, vertices_m: Array) -> Array:
    """Returns how deep each point lies in the polygon [m]: its distance from the border, negative outside.

    Args:
        points_m: points [m], (..., 2).
        vertices_m: vertices of a simple polygon [m], (n, 2), in either sense of rotation.

    Returns:
        Array of shape ``(...)``.
    """
    start, end = vertices_m, np.roll(vertices_m, -1, axis=0)
    points = points_m[..., None, :]
    distance = _distance_m(points, start, end).min(axis=-1)
    # Even-odd rule: edges that cross the ray from the point towards +x.
    spans = (start[:, 1] > points[..., 1]) != (end[:, 1] > points[..., 1])
    above, rise = points[..., 1] - start[:, 1], end[:, 1] - start[:, 1]
    share = np.divide(above, rise, out=np.zeros_like(above), where=spans)
    crossing = start[:, 0] + share * (end[:, 0] - start[:, 0])
    inside = np.count_nonzero(spans & (points[..., 0] < crossing), axis=-1) % 2 == 1
    return np.asarray(np.where(inside, distance, -distance))


def _distance_m(points: Array, start: Array, end: Array) -> Array:
    """Returns the distances from points to segments, broadcast [m]."""
    along = end - start
    length_squared = np.sum(along**2, axis=-1)
    share = np.sum((points - start) * along, axis=-1) / np.where(length_squared > 0.0, length_squared, 1.0)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * along
    return np.asarray(np.linalg.norm(points - nearest, axis=-1))


def _fault(vertices_m: Array) -> str:
    """Returns what keeps a chain of vertices from bounding one area, or an empty text."""
    count = len(vertices_m)
    for later in range(1, count):
        same = np.linalg.norm(vertices_m[:later] - vertices_m[later], axis=-1) < _APART_M
        if same.any():
            closes = (same.argmax(), later) == (0, count - 1)
            remedy = (
                "remove it, the last vertex is joined to the first" if closes else "give every vertex once"
            )
            return f"vertex [{later}] repeats vertex [{same.argmax()}]; {remedy}"
    met = _first_meeting(vertices_m)
    if met:
        one, other = met
        return (
            f"the edge from vertex [{one}] to [{(one + 1) % count}] meets the one from [{other}] to "
            f"[{(other + 1) % count}], so the border crosses or touches itself; list the vertices in order "
            "around the area"
        )
    if abs(area_m2(vertices_m)) < _APART_M**2:
        return "its vertices lie on one line, so it holds no area; move one off the line"
    return ""


def _first_meeting(vertices: Array) -> tuple[int, int] | None:
    """Returns the first two edges that have more in common than the vertex between neighbours."""
    count = len(vertices)
    if count == 3:
        return None
    ends = np.roll(vertices, -1, axis=0)
    for one in range(count - 1):
        others = np.arange(one + 1, count)
        start, end = vertices[others], ends[others]
        crossing = _crosses(vertices[one], ends[one], start, end)
        touching = np.minimum(
            np.minimum(_distance_m(vertices[one], start, end), _distance_m(ends[one], start, end)),
            np.minimum(
                _distance_m(start, vertices[one], ends[one]), _distance_m(end, vertices[one], ends[one])
            ),
        )
        met = crossing | (touching < _APART_M)
        met[0] = _folds(vertices[one], ends[one], ends[one + 1])
        if one == 0:
            met[-1] = _folds(vertices[-1], vertices[0], vertices[1])
        if met.any():
            return one, int(others[met.argmax()])
    return None


def _crosses(p: Array, q: Array, start: Array, end: Array) -> NDArray[np.bool_]:
    """Returns which segments run from one side of segment pq to the other, and it of theirs."""

    def side(a: Array, b: Array, c: Array) -> Array:
        ab, ac = b - a, c - a
        return np.sign(ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0])

    return np.asarray(
        (side(p, q, start) * side(p, q, end) < 0) & (side(start, end, p) * side(start, end, q) < 0)
    )


def _folds(before: Array, corner: Array, after: Array) -> bool:
    """Returns whether the edge after a corner runs back along the edge before it."""
    return bool(min(_distance_m(after, before, corner), _distance_m(before, corner, after)) < _APART_M)


@dataclass(frozen=True, slots=True)
class _Outline:
    """The vertices of a simple polygon, as metadata of an annotated tuple."""

    def read(self, value: object) -> list[object]:
        value = plain(value)
        if not isinstance(value, list | tuple):
            raise rejection(f"got {described(value)}, must be a list of at least three vertices [x, y] in m")
        if not 3 <= len(value) <= _MOST:
            raise rejection(
                f"got {described(value)}, must be at least three vertices [x, y] in m, at most {_MOST}"
            )
        return list(value)

    def judge(self, vertices: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        fault = _fault(np.asarray(vertices))
        if fault:
            raise rejection(fault)
        return vertices

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        members = core_schema.no_info_before_validator_function(self.read, handler(source))
        return core_schema.no_info_after_validator_function(self.judge, members)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"type": "array", "items": handler(schema)["items"], "minItems": 3, "maxItems": _MOST}


Polygon = Annotated[tuple[PlanePoint, ...], _Outline()]
"""The vertices [x, y] of a polygon in order, in m; the last is joined to the first."""
