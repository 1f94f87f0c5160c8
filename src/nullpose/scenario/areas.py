"""Areas on the ground from the features of a geographic file: for no-fly zones and fences."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.altitude_limits import Ground, altitude_limits
from nullpose.scenario.arrays import Floats
from nullpose.scenario.faults import EXCHANGED, RawTable, refusal
from nullpose.scenario.geo_file import NAMES, Feature

if TYPE_CHECKING:
    from shapely import LinearRing, Polygon
    from shapely.geometry.base import BaseGeometry

# shapely is imported where there is an area: most scenarios have none. Coordinates are longitudes, which go
# on across the antimeridian, and latitudes.

_SAME_CORNER_DEG = 9e-8  # a centimetre
_STRAIGHT_DEG = 0.02  # an edge of this length, straight in degrees, is within 0.2 m of straight in metres
_CUT_DEG = 0.05  # the same within a metre, for edges that bound nothing
_LOOPS = 0.01  # of the area inside a ring: larger loops may mean that its corners are out of order
_LONGEST_NAME = 80
_LIKE_RADII = re.compile("radi|buffer|diameter", re.IGNORECASE)
_PASSED_OVER = ("point", "line", "wall", "feature without a place")


@dataclass(slots=True)
class Area:
    """What a feature covers.

    Args:
        place: the feature in its file.
        name: as stated, and unique; empty without one.
        polygons: of the ground, holes and all.
        cylinders: longitude, latitude and radius in metres, each.
        limits: altitudes by the key of a zone.
        remarks: on what of it is not read.
    """

    place: str
    name: str
    polygons: list[Polygon]
    cylinders: list[tuple[float, float, Any]]
    limits: RawTable = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)

    def zones(self) -> Iterator[RawTable]:
        """Yield raw no-fly zones, holes filled."""
        shapes: list[RawTable] = [
            *({"polygon_lat_lon_deg": corners_of(polygon.exterior)} for polygon in self.polygons),
            *({"centre_lat_lon_deg": [lat, lon], "radius_m": size} for lon, lat, size in self.cylinders),
        ]
        for index, shape in enumerate(shapes, 1):
            name = f"{self.name} ({index})" if len(shapes) > 1 else self.name
            yield ({"name": name} if self.name else {}) | shape | self.limits

    def cut(self, box: Polygon) -> bool:
        """Leave out what lies outside a box of degrees; return whether anything is left."""
        self.polygons = [part for polygon in self.polygons for part in _cut(polygon, box)]
        self.cylinders = [cylinder for cylinder in self.cylinders if _box_about(*cylinder).intersects(box)]
        return bool(self.polygons or self.cylinders)


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
    def polygons(self) -> list[Polygon]:
        """The polygons of all areas."""
        return [polygon for area in self.areas for polygon in area.polygons]

    @property
    def corners(self) -> int:
        """How many corners the polygons have, holes filled."""
        return sum(len(polygon.exterior.coords) - 1 for polygon in self.polygons)

    def cut(self, box: Polygon) -> None:
        """Leave out what lies outside a box of degrees."""
        self.areas = [area for area in self.areas if area.cut(box)]

    def account(self, is_fence: bool = False) -> list[str]:
        """Say in a line what became of all features, then in a line each kind of remark.

        Args:
            is_fence: whether they are a fence, whose holes are zones; no line where there is nothing to say.
        """
        counts, areas, polygons = self.counts, self.areas, self.polygons
        shapes = {"polygon": len(polygons), "cylinder": sum(len(area.cylinders) for area in areas)}
        in_brackets = f" ({counted(shapes)})" if areas else ""
        passed = counted({kind: counts[kind] for kind in _PASSED_OVER})
        holes = sum(len(polygon.interiors) for polygon in polygons)
        limits = areas[0].limits if is_fence else {}
        parts = {
            "fence: 1 polygon": is_fence,
            f"zones: {len(areas)} of {counts['area']} in reach{in_brackets}": not is_fence,
            EXCHANGED: counts["area"] and not areas,
            f"passed over: {passed}": passed,
            f"holes {'that are zones' if is_fence else 'filled'}: {holes}": holes,
            f"borders that cross, all inside counts: {counts['crossing']}": counts["crossing"],
            ", ".join(f"{key} = {ends}" for key, ends in limits.items()): limits,
        }
        words = [part for part, is_so in parts.items() if is_so]
        lines = ["; ".join(words)] if len(words) > 1 or not is_fence else []
        names: dict[str, list[str]] = {}
        for area in areas:
            for remark in area.remarks:
                names.setdefault(remark, []).append(area.name or area.place)
        more = {remark: f" (and so {len(others) - 1} more)" for remark, others in names.items() if others[1:]}
        return [
            *lines,
            *self.remarks,
            *(f'"{first}"{more.get(remark, "")} {remark}' for remark, (first, *_) in names.items()),
        ]


def counted(numbers: Mapping[str, int]) -> str:
    """Put counts by their nouns into words: ``5 points, 1 line``; without those that are 0."""
    plurals = {noun: noun.replace("feature", "features") if " " in noun else f"{noun}s" for noun in numbers}
    return ", ".join(
        f"{number} {plurals[noun] if number > 1 else noun}" for noun, number in numbers.items() if number
    )


def areas_of(
    features: Sequence[Feature],
    reach: Polygon,
    ground_m: Ground,
    names: set[str] | None = None,
    *,
    is_fence: bool = False,
) -> Areas:
    """Find the areas of features: polygons, closed lines, and points with a radius.

    The parts of a feature are united; walls, which cover no ground, are left out. An area out of reach is
    counted and left out.

    Args:
        features: of a file.
        reach: the box of degrees in which areas count.
        ground_m: the origin's ground.
        names: that are taken.
        is_fence: whether every crossing of a border is a fault; a zone may have small ones.

    Raises:
        ScenarioError: with the faults of all features.
    """
    found, taken, faults = Areas(), set(names or ()), list[Fault]()
    for feature in features:
        try:
            area = _area(feature, reach, found.counts, is_fence)
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
    if keys:
        found.remarks.append(f"of points {', '.join(sorted(keys))} is not read; a radius is radius_m")
    return found


def _area(feature: Feature, reach: Polygon, counts: Counter[str], is_fence: bool) -> Area | None:
    """Find what a feature covers within reach; count what it is."""
    import shapely

    west, _, east, _ = reach.bounds
    middle_deg = 0.5 * (west + east)
    polygons, cylinders = [], []
    parts = list(parts_of(shapely.force_2d(feature.geometry)))
    counts["feature without a place"] += not parts
    for part in parts:
        radius_m = _radius_m(feature)
        if part.geom_type == "Point" and radius_m is not None:
            cylinders.append((part.x - 360.0 * round((part.x - middle_deg) / 360.0), part.y, radius_m))
        elif part.geom_type == "Point":
            counts["point"] += 1
        elif part.geom_type == "LineString" and not (part.is_closed and len(part.coords) > 3):
            counts["line"] += 1
        else:
            ring = part if part.geom_type == "Polygon" else shapely.Polygon(part.coords)
            polygons.append(_near(ring, middle_deg))
    if not (polygons or cylinders):
        return None
    polygons = [polygon for polygon in polygons if polygon.envelope.intersects(reach)]
    ground = [polygon for each in polygons if (polygon := _sound(each, feature, counts, is_fence)).area]
    if polygons and not ground and not cylinders:
        counts["wall"] += 1
        return None
    counts["area"] += 1
    united = list(parts_of(shapely.union_all(ground) if len(ground) > 1 else ground))
    area = Area(feature.place, name_of(feature), united, cylinders)
    return area if area.cut(reach) else None


def _radius_m(feature: Feature) -> Any:
    """Return the radius of a circle as stated, by ED-318 in its extent; None without one."""
    extent = feature.properties.get("extent")
    return feature.properties.get("radius_m", extent.get("radius") if isinstance(extent, dict) else None)


def _sound(polygon: Polygon, feature: Feature, counts: Counter[str], is_fence: bool) -> Polygon:
    """Mend doubled corners and spikes, and make long edges straight in degrees; empty for a wall.

    Raises:
        ScenarioError: its border crosses itself.
    """
    import shapely

    with suppress(shapely.GEOSException):  # a ring within a centimetre stays as it is
        polygon = shapely.remove_repeated_points(polygon, _SAME_CORNER_DEG)
    if not polygon.is_valid:
        # GEOS has the area inside the rings, which spikes do not change and crossings do
        valid = _valid(polygon)
        if abs(valid.area - polygon.area) > _SAME_CORNER_DEG * polygon.length:
            valid = None if is_fence else _enclosed(polygon)
            counts["crossing"] += 1
        if valid is None:
            raise refusal(
                feature.place,
                f"its border crosses itself ({shapely.is_valid_reason(polygon)}, longitude and latitude); "
                "list every corner once, in order around the area",
            )
        polygon = valid
    is_wall = polygon.area <= _SAME_CORNER_DEG * polygon.length
    return shapely.Polygon() if is_wall else shapely.segmentize(polygon, _STRAIGHT_DEG)


def _valid(polygon: Polygon) -> Any:
    import shapely

    return shapely.make_valid(polygon, method="structure", keep_collapsed=False)


def _enclosed(polygon: Polygon) -> Any:
    """Return all that the rings of a polygon enclose; None where the crossings of a ring are not small."""
    import shapely

    rings = [shapely.Polygon(ring) for ring in (polygon.exterior, *polygon.interiors)]
    sound = [_valid(ring) for ring in rings]
    is_small = all(ring.area >= (1 - _LOOPS) * whole.area for ring, whole in zip(rings, sound, strict=True))
    return shapely.union_all(sound) if is_small else None


def _near(polygon: Polygon, middle_deg: float) -> Polygon:
    """Move a polygon's longitudes near a middle, going on across the antimeridian."""
    import shapely

    def moved(corners: Floats) -> Floats:
        first = corners[0, 0] - 360.0 * round((corners[0, 0] - middle_deg) / 360.0)
        corners[:, 0] -= 360.0 * np.round((corners[:, 0] - first) / 360.0)
        return corners

    west, _, east, _ = polygon.bounds
    is_near = east - west < 180.0 and abs(west - middle_deg) <= 180.0
    return polygon if is_near else shapely.transform(polygon, moved)


def _box_about(lon_deg: float, lat_deg: float, radius_m: Any) -> Polygon:
    """Return a box of degrees that a cylinder lies in; one about all where its radius is at fault."""
    import shapely

    is_number = isinstance(radius_m, int | float) and not isinstance(radius_m, bool)
    is_length = is_number and 0.0 <= radius_m < 4e7
    half = radius_m / 1.1e5 if is_length else 360.0  # a degree of latitude has 110.57 km at least
    wide = half / max(np.cos(np.radians(min(abs(lat_deg) + half, 89.0))), 0.01)
    return shapely.box(lon_deg - wide, lat_deg - half, lon_deg + wide, lat_deg + half)


def _cut(polygon: Polygon, box: Polygon) -> list[Polygon]:
    """Return the parts of a polygon that lie in a box; one that lies in it as it is."""
    import shapely

    if box.covers(polygon.envelope):
        return [polygon]
    # In metres a long edge of the box would leave the parallel, and might cross other edges
    inside = polygon & shapely.segmentize(box, _CUT_DEG)
    return [part for part in parts_of(inside) if part.geom_type == "Polygon"]


def parts_of(geometry: BaseGeometry | Sequence[BaseGeometry] | None) -> Iterator[Any]:
    """Yield the single geometries of one that may hold several, without the empty ones."""
    import shapely

    for part in shapely.get_parts(geometry):
        if hasattr(part, "geoms"):
            yield from parts_of(part)
        elif not part.is_empty:
            yield part


def corners_of(ring: LinearRing) -> list[list[float]]:
    """Return the corners of a ring as latitudes and longitudes, these from -180 to 180 degrees."""
    import shapely

    corners = shapely.get_coordinates(ring)[:-1, ::-1]
    beyond = np.abs(corners[:, 1]) > 180.0
    corners[beyond, 1] = (corners[beyond, 1] + 180.0) % 360.0 - 180.0
    return corners.tolist()  # type: ignore[no-any-return]


def name_of(feature: Feature) -> str:
    """Return a feature's name on one line, however it is stated; empty without one."""
    value = next((feature.properties[key] for key in NAMES if key in feature.properties), "")
    if isinstance(value, list) and value and isinstance(value[0], dict):
        value = value[0].get("text", "")  # ED-318 has one for each language
    words = " ".join(str(value).split())
    return "".join(letter for letter in words if letter.isprintable())[:_LONGEST_NAME].strip()


def unique(name: str, taken: set[str]) -> str:
    """Number a name that is taken, and take it; an empty one stays."""
    if not name:
        return ""
    numbered = (f"{name} {n}" if n > 1 else name for n in count(1))
    name = next(each for each in numbered if each not in taken)
    taken.add(name)
    return name
