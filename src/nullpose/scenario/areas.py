"""Areas on the ground from the features of a geographic file: for no-fly zones and fences."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.altitude_limits import Ground, altitude_limits
from nullpose.scenario.faults import refusal
from nullpose.scenario.geo_file import NAMES, Feature

_SAME_DEG = 9e-8  # corners closer than this are one: a centimetre
_STRAIGHT_DEG = (
    0.02  # an edge of this length that is straight in degrees is within 0.2 m of straight in metres
)
_LOOPS = 0.01  # of the area inside a ring: larger loops may mean that its corners are out of order
_CUT_DEG = 0.05  # the same within a metre, for edges that bound nothing
_LONGEST_NAME = 80
_MOST_REMARKS = 5
_LIKE_RADII = re.compile("radi|buffer|diameter", re.IGNORECASE)
_PASSED_OVER = ("point", "line", "wall", "feature without a place")


Rectangle = Sequence[float]
"""West, south, east and north, degrees; longitudes go on across the antimeridian."""


@dataclass(slots=True)
class Area:
    """What a feature covers.

    Args:
        place: the feature in its file.
        name: as stated, and unique; empty without one.
        polygons: shapely's, of longitudes and latitudes.
        cylinders: longitude, latitude and radius in metres, each.
        limits: altitudes by the key of a zone.
        remarks: on what of it is not read.
    """

    place: str
    name: str
    polygons: list[Any]
    cylinders: list[tuple[float, float, Any]]
    limits: dict[str, Any]
    remarks: list[str]

    def zones(self) -> Iterator[dict[str, Any]]:
        """Yield raw no-fly zones, holes filled."""
        shapes: list[dict[str, Any]] = [
            {"polygon_lat_lon_deg": corners_of(polygon.exterior)} for polygon in self.polygons
        ]
        shapes += [
            {"centre_lat_lon_deg": [lat, lon], "radius_m": radius} for lon, lat, radius in self.cylinders
        ]
        for index, shape in enumerate(shapes):
            name = f"{self.name} ({index + 1})" if len(shapes) > 1 else self.name
            yield ({"name": name} if self.name else {}) | shape | self.limits


@dataclass(slots=True)
class Areas:
    """The areas of a file and an account of all that it holds.

    Args:
        areas: within reach.
        counts: of features by what became of them.
        remarks: on all of them.
    """

    areas: list[Area] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    remarks: list[str] = field(default_factory=list)

    @property
    def corners(self) -> int:
        """How many corners all polygons have."""
        return sum(len(polygon.exterior.coords) - 1 for area in self.areas for polygon in area.polygons)

    def cut(self, box_deg: Rectangle) -> None:
        """Leave out what lies outside a rectangle.

        Args:
            box_deg: the rectangle.
        """
        for area in self.areas:
            area.polygons = _cut(area.polygons, box_deg)
            area.cylinders = [each for each in area.cylinders if _meets(_bounds_of(*each), box_deg)]
        self.areas = [area for area in self.areas if area.polygons or area.cylinders]

    def account(self, is_fence: bool = False) -> Iterator[str]:
        """Yield a line that says what became of all features, then a line for each remark, of some at most.

        Args:
            is_fence: whether they are a fence, whose holes are zones; no line where there is nothing to say.
        """
        counts, areas = self.counts, self.areas
        polygons = [polygon for area in areas for polygon in area.polygons]
        shapes = {"polygon": len(polygons), "cylinder": sum(len(area.cylinders) for area in areas)}
        holes = sum(len(polygon.interiors) for polygon in polygons)
        words = f"zones: {len(areas)} of {counts['area']} in reach" + (
            f" ({listed_numbers(shapes)})" if areas else ""
        )
        parts = ["fence: 1 polygon"] if is_fence else [words]
        passed = {kind: counts[kind] for kind in _PASSED_OVER}
        parts += ["are latitude and longitude exchanged?"] if not areas and counts["area"] else []
        parts += [f"passed over: {listed_numbers(passed)}"] if any(passed.values()) else []
        parts += [f"holes {'that are zones' if is_fence else 'filled'}: {holes}"] if holes else []
        parts += (
            [f"borders that cross, all inside counts: {counts['crossing']}"] if counts["crossing"] else []
        )
        if is_fence and areas[0].limits:
            parts.append(", ".join(f"{key} = {limits}" for key, limits in areas[0].limits.items()))
        if len(parts) > 1 or not is_fence:
            yield "; ".join(parts)
        remarks = [f'"{area.name or area.place}" {remark}' for area in areas for remark in area.remarks]
        yield from [*self.remarks, *remarks[:_MOST_REMARKS]]
        if len(remarks) > _MOST_REMARKS:
            yield f"{len(remarks) - _MOST_REMARKS} more remarks of this kind"


def listed_numbers(numbers: Mapping[str, int]) -> str:
    """Return counts by their nouns in words: ``5 points, 1 line``; without those that are 0."""
    return ", ".join(
        f"{number} {_plural(noun) if number > 1 else noun}" for noun, number in numbers.items() if number
    )


def _plural(noun: str) -> str:
    return noun.replace("feature", "features") if " " in noun else f"{noun}s"


def areas_of(
    features: Sequence[Feature],
    reach_deg: Rectangle | None,
    ground_m: Ground,
    names: set[str] | None = None,
    *,
    is_fence: bool = False,
) -> Areas:
    """Return the areas of features: polygons, closed lines, and points with a radius.

    The parts of a feature are united; walls, which cover no ground, are left out. An area out of reach is
    counted and left out.

    Args:
        features: of a file.
        reach_deg: where areas count; None where that is not known.
        ground_m: the origin's ground.
        names: that are taken.
        is_fence: whether every crossing of a border is a fault; a zone may have small ones.

    Raises:
        ScenarioError: with the faults of all features.
    """
    found, taken, faults = Areas(), set(names or ()), list[Fault]()
    for feature in features:
        try:
            area = _area(feature, reach_deg, found.counts, is_fence)
            if area is not None:
                area.limits, area.remarks = altitude_limits(feature, ground_m)
                area.name = unique(area.name, taken)
                found.areas.append(area)
        except ScenarioError as error:
            faults += error.faults
    if faults:
        raise ScenarioError(faults)
    points = [each for each in features if getattr(each.geometry, "geom_type", "") in ("Point", "MultiPoint")]
    keys = {key for point in points for key in point.properties if _LIKE_RADII.search(key)} - {"radius_m"}
    found.remarks += (
        [f"of points {', '.join(sorted(keys))} is not read; a radius is radius_m"] if keys else []
    )
    return found


def corners_of(ring: Any) -> list[list[float]]:
    """Return the corners of a shapely ring as latitudes and longitudes, these from -180 to 180 degrees."""
    import shapely

    corners = shapely.get_coordinates(ring)[:-1, ::-1]
    beyond = np.abs(corners[:, 1]) > 180.0
    corners[beyond, 1] = (corners[beyond, 1] + 180.0) % 360.0 - 180.0
    return corners.tolist()  # type: ignore[no-any-return]


def _area(feature: Feature, reach_deg: Rectangle | None, counts: Counter[str], is_fence: bool) -> Area | None:
    """Return what a feature covers within reach; count what it is."""
    import shapely

    if feature.geometry is None or feature.geometry.is_empty:
        counts["feature without a place"] += 1
        return None
    middle_deg = 0.0 if reach_deg is None else 0.5 * (reach_deg[0] + reach_deg[2])
    polygons, cylinders, passed = [], [], Counter[str]()
    for part in parts_of(shapely.force_2d(feature.geometry)):
        kind = part.geom_type
        radius = feature.properties.get("radius_m", _extent_m(feature.properties.get("extent")))
        if kind == "Point" and radius is not None:
            cylinders.append((part.x - 360.0 * round((part.x - middle_deg) / 360.0), part.y, radius))
        elif kind == "Point":
            passed["point"] += 1
        elif kind == "LineString" and not (part.is_closed and len(part.coords) > 3):
            passed["line"] += 1
        else:
            polygons.append(_near(part if kind == "Polygon" else shapely.Polygon(part.coords), middle_deg))
    counts.update(passed)
    counts["area"] += bool(polygons or cylinders)
    if reach_deg is not None:
        polygons = [each for each in polygons if _meets(each.bounds, reach_deg)]
        cylinders = [each for each in cylinders if _meets(_bounds_of(*each), reach_deg)]
    sound = [_sound(polygon, feature, counts, is_fence) for polygon in polygons]
    ground = [polygon for polygon in sound if polygon is not None]
    whole = list(parts_of(shapely.union_all(ground) if len(ground) > 1 else ground))
    if polygons and not whole and not cylinders:
        counts.update({"wall": 1, "area": -1})
    if reach_deg is not None:
        whole = _cut(whole, reach_deg)
    return Area(feature.place, name_of(feature), whole, cylinders, {}, []) if whole or cylinders else None


def parts_of(geometry: Any) -> Iterator[Any]:
    """Yield the single geometries of one that may hold several."""
    import shapely

    for part in shapely.get_parts(geometry):
        if hasattr(part, "geoms"):
            yield from parts_of(part)
        elif not part.is_empty:
            yield part


def _extent_m(extent: Any) -> Any:
    """Return the radius of a circle as ED-318 states it, or None."""
    return extent.get("radius") if isinstance(extent, dict) else None


def _sound(polygon: Any, feature: Feature, counts: Counter[str], is_fence: bool) -> Any:
    """Return a polygon without doubled corners and spikes, long edges straight in degrees; None for a wall.

    Raises:
        ScenarioError: its border crosses itself.
    """
    import shapely

    with suppress(shapely.GEOSException):  # a ring within a centimetre stays as it is
        polygon = shapely.remove_repeated_points(polygon, _SAME_DEG)
    if not polygon.is_valid:
        # GEOS has the area inside the rings, which spikes do not change and crossings do
        valid = shapely.make_valid(polygon, method="structure", keep_collapsed=False)
        if abs(valid.area - polygon.area) > _SAME_DEG * polygon.length:
            valid = None if is_fence else _enclosed(polygon)
            counts["crossing"] += 1
        if valid is None:
            raise refusal(
                feature.place,
                f"its border crosses itself ({shapely.is_valid_reason(polygon)}, longitude and latitude); "
                "list every corner once, in order around the area",
            )
        polygon = valid
    return None if polygon.area <= _SAME_DEG * polygon.length else shapely.segmentize(polygon, _STRAIGHT_DEG)


def _enclosed(polygon: Any) -> Any:
    """Return all that the rings of a polygon enclose; None where the crossings of a ring are not small."""
    import shapely

    rings = [shapely.Polygon(ring) for ring in (polygon.exterior, *polygon.interiors)]
    sound = [shapely.make_valid(ring, method="structure", keep_collapsed=False) for ring in rings]
    is_small = all(ring.area >= (1 - _LOOPS) * whole.area for ring, whole in zip(rings, sound, strict=True))
    return shapely.union_all(sound) if is_small else None


def _near(polygon: Any, middle_deg: float) -> Any:
    """Return a polygon with its longitudes near a given one, going on across the antimeridian."""
    import shapely

    def moved(corners: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        first = corners[0, 0] - 360.0 * round((corners[0, 0] - middle_deg) / 360.0)
        corners[:, 0] -= 360.0 * np.round((corners[:, 0] - first) / 360.0)
        return corners

    west, _, east, _ = polygon.bounds
    is_near = east - west < 180.0 and abs(west - middle_deg) <= 180.0
    return polygon if is_near else shapely.transform(polygon, moved)


def _meets(one_deg: Rectangle, other_deg: Rectangle) -> bool:
    return all(one_deg[k] <= other_deg[k + 2] and other_deg[k] <= one_deg[k + 2] for k in (0, 1))


def _bounds_of(lon_deg: float, lat_deg: float, radius_m: Any) -> list[float]:
    """Return a rectangle of degrees that a cylinder lies in; one about all where its radius is at fault."""
    is_number = isinstance(radius_m, int | float) and not isinstance(radius_m, bool)
    half = radius_m / 1.1e5 if is_number else 360.0  # a degree of latitude has 110.57 km at least
    wide = half / max(np.cos(np.radians(min(abs(lat_deg) + half, 89.0))), 0.01)
    return [lon_deg - wide, lat_deg - half, lon_deg + wide, lat_deg + half]


def _cut(polygons: list[Any], box_deg: Rectangle) -> list[Any]:
    """Return what of polygons lies in a rectangle; those that lie in it as they are."""
    import shapely

    west, south, east, north = box_deg
    kept, box = [], None
    for polygon in polygons:
        low_x, low_y, high_x, high_y = polygon.bounds
        if west <= low_x and south <= low_y and high_x <= east and high_y <= north:
            kept.append(polygon)
            continue
        # In metres a long edge of the box would leave the parallel, and might cross other edges
        box = box or shapely.segmentize(shapely.box(*box_deg), _CUT_DEG)
        kept += [part for part in parts_of(polygon & box) if part.geom_type == "Polygon"]
    return kept


def name_of(feature: Feature) -> str:
    """Return a feature's name on one line, however it is stated; empty without one."""
    value = next((feature.properties[key] for key in NAMES if key in feature.properties), "")
    if isinstance(value, list) and value and isinstance(value[0], dict):
        value = value[0].get("text", "")  # ED-318 has one for each language
    words = " ".join(str(value).split())
    return "".join(letter for letter in words if letter.isprintable())[:_LONGEST_NAME].strip()


def unique(name: str, taken: set[str]) -> str:
    """Return a name that is not taken yet, numbered where it is, and take it."""
    if name:
        name = next(each for n in count(1) if (each := f"{name} {n}" if n > 1 else name) not in taken)
        taken.add(name)
    return name
