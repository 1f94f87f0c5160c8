"""Where the vehicle may not be: boxes, cylinders and prisms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from nullpose.files import PlainTable
from nullpose.scenario.faults import Place
from nullpose.scenario.polygon import EarthlyPolygon, Polygon, counter_clockwise_m, depth_m, offset_outlines_m
from nullpose.scenario.section import Section, optional, read_only
from nullpose.scenario.units import EARTHLY, Label, LatLon, PlanePoint, RadiusMetres, Range
from nullpose.scenario.ways import Ways

ALTITUDES = Ways((("altitude_m",), ("altitude_msl_m",), ("altitude_ellipsoid_m",)), fewest=0, most=3)
"""The ways to state a range of altitudes."""

_SAME_M = 1e-9  # an offset smaller than this is lost in the coordinates


def unplaced(table: Section, raw: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    """Yield the keys of an airspace or a zone that mean nothing without the origin of a scenario."""
    return (
        (
            (key,),
            f"needs the [origin] of a scenario; state {metric} here, or give the scenario as a "
            "file or as plain data (Scenario.from_dict)",
        )
        for key, metric in EARTHLY.items()
        if getattr(table, key, None) is not None and raw.get(metric) is None
    )


class NoFlyZone(
    Section,
    header="a no-fly zone, in a table of its own headed [[airspace.no_fly]]",
    letter="Z",
    ways=(
        Ways(
            (("x_m", "y_m"), ("centre_m", "radius_m"), ("polygon_m",)),
            twins=(("centre_lat_lon_deg", "centre_m"), ("polygon_lat_lon_deg", "polygon_m")),
        ),
        Ways((("centre_m",), ("centre_lat_lon_deg",)), fewest=0, most=2),
        Ways((("polygon_m",), ("polygon_lat_lon_deg",)), fewest=0, most=2),
        ALTITUDES,
    ),
):
    """An upright solid that the vehicle may not enter; its border is allowed.

    Exactly one shape is given: ``x_m`` and ``y_m``, or ``centre_m`` and ``radius_m``, or ``polygon_m``. A
    scenario with an origin fills in the metres of what is stated on the Earth.

    Args:
        name: how results and overrides refer to it; an airspace names it by its place when left out.
        x_m: westmost and eastmost position of a box [m].
        y_m: southmost and northmost position of a box [m].
        centre_m: east and north of the axis of a cylinder [m], (2,).
        radius_m: radius of the cylinder [m].
        polygon_m: vertices [east, north] of a polygon [m], in order around it; the last is joined to the
            first.
        centre_lat_lon_deg: latitude and longitude of the cylinder's axis [degrees], (2,).
        polygon_lat_lon_deg: latitudes and longitudes of the polygon's vertices [degrees].
        altitude_m: lowest and highest altitude of the zone above the origin [m]; None for all altitudes.
        altitude_msl_m, altitude_ellipsoid_m: the same over the sea or over the ellipsoid.
    """

    name: Label = Field(
        default="",
        description="Name, unique among the no-fly zones. Left out: Z1, Z2, ... by their place in the file.",
    )
    x_m: Range | None = optional(
        "Range of a box towards the east, in metres: [west end, east end]. With y_m.", [-20.0, 5.0]
    )
    y_m: Range | None = optional(
        "Range of a box towards the north, in metres: [south end, north end]. With x_m.", [10.0, 40.0]
    )
    centre_m: PlanePoint | None = optional(
        "Centre of a cylinder, in metres: [east, north]. With radius_m.", [17.0, 15.0]
    )
    radius_m: RadiusMetres | None = optional("Radius of a cylinder, in metres. With centre_m.", 12.0)
    polygon_m: Polygon | None = optional(
        "Vertices of a polygon, in metres, in order around it: [[east, north], ...].",
        [[0.0, 0.0], [20.0, 0.0], [10.0, 15.0]],
    )
    centre_lat_lon_deg: LatLon | None = optional(
        "Centre of a cylinder in degrees: [latitude, longitude]. In place of centre_m, in a "
        "scenario with an [origin].",
        [50.0005, 14.5028],
    )
    polygon_lat_lon_deg: EarthlyPolygon | None = optional(
        "Vertices of a polygon in degrees, in order around it: [[latitude, longitude], ...]. In "
        "place of polygon_m, in a scenario with an [origin].",
        [[50.0, 14.5], [50.0, 14.5003], [50.0002, 14.5001]],
    )
    altitude_m: Range | None = optional(
        "Lowest and highest altitude of the zone above the origin, in metres: [low, high]. Left "
        "out: all altitudes.",
        [0.0, 20.0],
    )
    altitude_msl_m: Range | None = optional(
        "The same over the sea (the geoid), in metres, in place of altitude_m.", [185.0, 205.0]
    )
    altitude_ellipsoid_m: Range | None = optional(
        "The same over the WGS-84 ellipsoid, in metres, in place of altitude_m.", [230.0, 250.0]
    )

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return the fault of a zone on the Earth that no scenario has placed."""
        return unplaced(self, raw)

    @property
    def shape(self) -> Literal["box", "cylinder", "polygon"]:
        """Which of the three shapes it has."""
        return "polygon" if self.polygon_m is not None else "box" if self.centre_m is None else "cylinder"

    @cached_property
    def outline_m(self) -> NDArray[np.float64]:
        """Vertices of a box or polygon seen from above [m], (n, 2), counter-clockwise; none of a cylinder."""
        if self.x_m is not None and self.y_m is not None:
            (west, east), (south, north) = self.x_m, self.y_m
            return read_only([(west, south), (east, south), (east, north), (west, north)], (4, 2))
        return counter_clockwise_m(self.polygon_m)

    @property
    def box_m(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper corner of the smallest box about the zone [m], (3,) each."""
        outline_m = self.outline_m
        if self.centre_m is not None and self.radius_m is not None:
            outline_m = np.add([[-self.radius_m], [self.radius_m]], self.centre_m)
        low, high = outline_m.min(axis=0), outline_m.max(axis=0)
        return np.append(low, self.floor_m), np.append(high, self.ceiling_m)

    @property
    def floor_m(self) -> float:
        """Lowest altitude of the zone [m]; minus infinity for all altitudes."""
        return -math.inf if self.altitude_m is None else self.altitude_m[0]

    @property
    def ceiling_m(self) -> float:
        """Highest altitude of the zone [m]; infinity for all altitudes."""
        return math.inf if self.altitude_m is None else self.altitude_m[1]

    def grown(self, by_m: float) -> NoFlyZone:
        """Return a larger zone of the same shape: walls further out, floor lower, ceiling higher.

        Args:
            by_m: how much [m]; a polygon's corners as ``offset_outlines_m`` moves them.
        """
        if abs(by_m) < _SAME_M:
            return self
        x_m, y_m, altitude_m = (
            ends_m and (ends_m[0] - by_m, ends_m[1] + by_m)
            for ends_m in (self.x_m, self.y_m, self.altitude_m)
        )
        return NoFlyZone.model_construct(
            name=self.name,
            x_m=x_m,
            y_m=y_m,
            centre_m=self.centre_m,
            radius_m=self.radius_m and self.radius_m + by_m,
            polygon_m=self.polygon_m and offset_outlines_m(self.outline_m, by_m)[0],
            altitude_m=altitude_m,
        )

    def forbidden_range_m(self, altitude_m: tuple[float, float]) -> tuple[float, float]:
        """Return the zone's lowest and highest altitude [m] where only some altitudes are allowed anyway.

        An end that covers the lowest or highest allowed altitude is put at infinity: otherwise the airspace's
        floor or ceiling, being a border of the zone too, would be allowed as a sheet of no thickness.

        Args:
            altitude_m: lowest and highest altitude allowed to the vehicle [m].
        """
        lowest, highest = altitude_m
        low, high = self.floor_m, self.ceiling_m
        if low >= highest or high <= lowest:
            return low, high
        return (-math.inf if low <= lowest else low), (math.inf if high >= highest else high)

    def depth_m(
        self, position_m: ArrayLike, altitude_m: tuple[float, float] = (-math.inf, math.inf)
    ) -> NDArray[np.float64]:
        """Measure how deep positions are inside the zone [m]; 0 on its border, below 0 outside.

        Inside it is the distance to the nearest wall, floor or ceiling.

        Args:
            position_m: positions [m], (..., 3).
            altitude_m: lowest and highest altitude allowed to the vehicle [m], for a zone that covers one of
                them (see :meth:`forbidden_range_m`).
        """
        floor_m, ceiling_m = self.forbidden_range_m(altitude_m)
        position = np.asarray(position_m, dtype=np.float64)
        if self.centre_m is not None and self.radius_m is not None:
            sideways = self.radius_m - np.linalg.norm(position[..., :2] - self.centre_m, axis=-1)
        else:
            sideways = depth_m(position[..., :2], self.outline_m)
        height = position[..., 2]
        return np.asarray(np.minimum(sideways, np.minimum(height - floor_m, ceiling_m - height)))
