"""Buildings: they shadow links, and the vehicle may not enter them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, TypeAdapter

from nullpose.files import PlainTable
from nullpose.scenario.faults import Place, key_faults, path_of
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.no_fly import NoFlyZone, unplaced
from nullpose.scenario.polygon import EarthlyPolygon, Polygon, counter_clockwise_m, depth_m
from nullpose.scenario.rules import Choice, Limits, ListOf, NumberOr, ascending
from nullpose.scenario.section import Floats, Section, optional
from nullpose.scenario.units import Label, MarginMetres
from nullpose.scenario.ways import Ways

MOST_BUILDINGS = 2000
"""The most buildings of a scenario: more take a search too long."""
DEEP_M = -1e4
"""Where a building on the ground ends, for the ground may lie below that at the origin [m]."""

_ABOVE_GROUND = Limits(
    "a height in m above the ground", 0.0, 1000.0, "heights count upwards from z = 0, in metres"
)
HIGHEST_M = _ABOVE_GROUND.high
"""The highest roof [m]."""
_STOREY = Limits("a height of a storey in m", 1.0, 20.0, "3 m is common")
_COURTYARDS = ListOf("a list of at most 1000 polygons, each a list of vertices", 0, 1000)
_Height = Annotated[float, _ABOVE_GROUND]
_BOTH_ENDS = Annotated[
    tuple[_Height, _Height],
    ListOf("one height in m, or two, the lowest first", 2, 2),
    AfterValidator(ascending),
]
Height = Annotated[float | tuple[float, float], NumberOr(_ABOVE_GROUND, TypeAdapter(_BOTH_ENDS))]
"""A height above the ground, or the lowest and the highest that it may be [m]."""

_OF_ONE = ("name", "courtyards_m", "courtyards_lat_lon_deg", "base_m")
_OF_FILES = ("storey_height_m", "missing_height_m", "height_unit", "roof_property", "ground_property")


class Building(
    Section,
    header="a building, in a table of its own headed [[buildings]]",
    letter="B",
    ways=(
        Ways((("polygon_m", "height_m"), ("buildings_from",)), twins=(("polygon_lat_lon_deg", "polygon_m"),)),
        Ways((("polygon_m",), ("polygon_lat_lon_deg",)), fewest=0, most=2),
        Ways((("courtyards_m",), ("courtyards_lat_lon_deg",)), fewest=0, most=2),
    ),
    unstated=("base_m", "clearance_m"),
):
    """An upright prism that shadows links and that the vehicle may not enter; or a file of such.

    A scenario with an origin fills in the metres of what is stated on the Earth.

    Args:
        name: how results and overrides refer to it; a scenario names it by its place when left out.
        polygon_m: vertices [east, north] of the outline [m], in order; the last is joined to the first.
        polygon_lat_lon_deg: the same as latitudes and longitudes [degrees].
        courtyards_m: the outlines [m] of what is open inside it.
        courtyards_lat_lon_deg: the same in degrees.
        height_m: altitude of the roof above the origin [m], or the lowest and the highest that it may have.
        base_m: altitude below which it is open [m]; 0 stands on the ground, wherever that is.
        clearance_m: how far the vehicle stays away [m], beside the airspace's margin.
        buildings_from: only in files: the file that holds several; None once it has been read, like
        storey_height_m, missing_height_m: heights [m] of a storey, and of buildings that state none;
        height_unit: what bare numbers of the file are in;
        roof_property, ground_property: the names under which it states both over one datum.
    """

    name: Label = Field(
        default="",
        description="Name, unique among the buildings. Left out: B1, B2, ... by their place in the file.",
    )
    polygon_m: Polygon | None = optional(
        "Vertices of the outline, in metres, in order around it: [[east, north], ...]. With height_m.",
        [[20.0, 0.0], [40.0, 0.0], [40.0, 15.0], [20.0, 15.0]],
    )
    polygon_lat_lon_deg: EarthlyPolygon | None = optional(
        "The same in degrees: [[latitude, longitude], ...]. In place of polygon_m, in a scenario "
        "with an [origin].",
        [[50.0, 14.5], [50.0, 14.5003], [50.0002, 14.5001]],
    )
    courtyards_m: Annotated[tuple[Polygon, ...], _COURTYARDS] | None = optional(
        "Outlines of what is open inside it, in metres: a list of polygons. The vehicle may not enter them.",
        [[[25.0, 5.0], [35.0, 5.0], [35.0, 10.0], [25.0, 10.0]]],
    )
    courtyards_lat_lon_deg: Annotated[tuple[EarthlyPolygon, ...], _COURTYARDS] | None = optional(
        "The same in degrees, in place of courtyards_m.",
        [[[50.00001, 14.50005], [50.00001, 14.50015], [50.00005, 14.5001]]],
    )
    height_m: Height | None = optional(
        "Altitude of the roof above the origin, in metres, or the lowest and the highest that it may be: "
        "[low, high]. The worse end counts for each link.",
        22.0,
        [18.0, 25.0],
    )
    base_m: _Height = Field(
        default=0.0,
        description="Altitude in metres below which it is open, as a passage is. 0: it stands on the ground.",
        examples=[4.0],
    )
    clearance_m: MarginMetres = Field(
        default=0.0,
        description="How far in metres the vehicle stays away from it, beside the margin_m of [airspace].",
        examples=[5.0],
    )
    buildings_from: Label | None = optional(
        "Name of a geographic file (GeoJSON, KML, GeoPackage and others) with buildings, relative to this "
        "file's folder, in place of polygon_m and height_m.",
        "town.geojson",
    )
    storey_height_m: Annotated[float, _STOREY] | None = optional(
        "With buildings_from: height of a storey in metres, for buildings that state only levels.", 3.0
    )
    missing_height_m: Height | None = optional(
        "With buildings_from: height in metres of buildings that state none, or [low, high].",
        9.0,
        [4.0, 12.0],
    )
    height_unit: Annotated[str, Choice("a unit", ("m", "ft"))] | None = optional(
        "With buildings_from: what its heights without a unit are in. Left out: metres.", "ft"
    )
    roof_property: Label | None = optional(
        "With buildings_from: name of the property that states the roof's altitude. With ground_property.",
        "roof_msl",
    )
    ground_property: Label | None = optional(
        "With buildings_from: name of the property that states the ground's altitude over the same datum.",
        "ground_msl",
    )

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return the faults of keys that do not go together, of its height and of its courtyards."""
        yield from unplaced(self, raw)
        is_file = raw.get("buildings_from") is not None
        other = "without buildings_from, for one building" if is_file else "with buildings_from"
        yield from key_faults(
            raw, _OF_ONE if is_file else _OF_FILES, f"has a meaning only {other}; remove it"
        )
        properties = [key for key in ("roof_property", "ground_property") if raw.get(key) is not None]
        if is_file and len(properties) == 1:
            yield (properties[0],), "given without the other of roof_property and ground_property; add it"
        if self.height_m is not None and self.base_m is not None and self.heights_m[0] < self.base_m:
            yield (
                ("height_m",),
                f"got {self.heights_m[0]:g}, must be base_m = {self.base_m:g} or more: a roof is above "
                "what it covers; raise it or lower base_m",
            )
        if self.polygon_m and self.courtyards_m:
            import shapely

            if not (shape := shapely.Polygon(self.polygon_m, self.courtyards_m)).is_valid:
                yield (
                    ("courtyards_m" if raw.get("courtyards_m") is not None else "courtyards_lat_lon_deg",),
                    "they must lie inside the outline, apart from each other, but do not "
                    f"({shapely.is_valid_reason(shape)}); correct or remove them",
                )

    @cached_property
    def outline_m(self) -> NDArray[np.float64]:
        """Vertices of its outline seen from above [m], (n, 2), counter-clockwise; none of a file."""
        return counter_clockwise_m(self.polygon_m)

    @property
    def courtyard_outlines_m(self) -> tuple[NDArray[np.float64], ...]:
        """Vertices of its courtyards [m], (n, 2) each, counter-clockwise."""
        return tuple(map(counter_clockwise_m, self.courtyards_m or ()))

    @property
    def heights_m(self) -> tuple[float, float]:
        """Lowest and highest altitude that its roof may have [m]."""
        height_m = self.height_m or 0.0
        return height_m if isinstance(height_m, tuple) else (height_m, height_m)

    @property
    def floor_m(self) -> float:
        """Altitude of its lower end [m]: ``base_m``, or far below a building that stands on the ground."""
        return self.base_m or (DEEP_M if self.heights_m[1] > 0.0 else 0.0)

    @property
    def zone(self) -> NoFlyZone:
        """What the vehicle may not enter: the building at its highest, courtyards and clearance with it."""
        return NoFlyZone.model_construct(
            name=f"of the building {self.name}",
            polygon_m=tuple(map(tuple, self.outline_m.tolist())),
            altitude_m=(self.floor_m, self.heights_m[1]),
        ).grown(self.clearance_m or 0.0)

    def holds(self, position_m: Floats) -> bool:
        """Check if a position is inside it, not in a courtyard; below a floor on the ground too.

        Args:
            position_m: (3,) [m].
        """
        outline_m, at_m = self.outline_m, position_m[:2]
        if not np.all((outline_m.min(axis=0) < at_m) & (at_m < outline_m.max(axis=0))):
            return False
        is_within = self.floor_m < position_m[2] < self.heights_m[1] and depth_m(at_m, outline_m) > 0.0
        return bool(is_within) and all(depth_m(at_m, yard_m) < 0.0 for yard_m in self.courtyard_outlines_m)


def buried_points(
    buildings: Mapping[Place, Building], points: Mapping[Place, GroundPoint]
) -> Iterator[tuple[Place, str]]:
    """Yield the buildings that a ground point stands in, each with its place.

    Args:
        buildings: sound ones.
        points: with a position.
    """
    for place, building in buildings.items():
        for of_point, point in points.items():
            if building.holds(np.asarray(point.position_m)):
                low_m, high_m = building.heights_m
                roof = f"{low_m:g}" if low_m == high_m else f"{low_m:g} to {high_m:g}"
                yield (
                    place,
                    f"{path_of(of_point)} at {[float(f'{x:.6g}') for x in point.position_m]} stands in it, "
                    f"below its roof at {roof} m; must be outside or on the roof; move the point, correct "
                    "the height, or leave the building out",
                )
