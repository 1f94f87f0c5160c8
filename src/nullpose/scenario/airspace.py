"""Where the vehicle may be."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cached_property, reduce
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from nullpose.files import PlainTable
from nullpose.scenario.faults import ONLY_LOCAL, Place, key_faults
from nullpose.scenario.no_fly import ALTITUDES, NoFlyZone, unplaced
from nullpose.scenario.polygon import (
    MOST_CORNERS,
    EarthlyPolygon,
    Polygon,
    counter_clockwise_m,
    depth_m,
    largest_margin_m,
    offset_outlines_m,
)
from nullpose.scenario.rules import Limits, list_of_tables
from nullpose.scenario.section import Section, optional, read_only
from nullpose.scenario.units import Label, MarginMetres, Range
from nullpose.scenario.ways import Ways

BORDER_M = 1e-9
"""Positions no further than this beyond a border count as on it [m]."""


class Airspace(
    Section,
    ways=(
        ALTITUDES,
        Ways((("geofence_m",), ("geofence_lat_lon_deg",), ("geofence_from",)), fewest=0, most=3),
    ),
    unstated=("margin_m", "no_fly"),
):
    """The positions allowed to the vehicle: a box, within a fence, less zones and a ball around every point.

    World frame: east, north, up (ENU), in metres. Without ``x_m`` or ``y_m`` that direction is
    unbounded, as in the paper, which bounds the altitude only (eq. 2.2).

    Args:
        altitude_m: lowest and highest altitude above the origin [m]; equal ends fix the altitude.
        altitude_msl_m, altitude_ellipsoid_m: the same over the sea or over the ellipsoid, from which a
            scenario with an origin fills in altitude_m; None if it was not stated so.
        x_m: westmost and eastmost position [m], or None for no bound.
        y_m: southmost and northmost position [m], or None for no bound.
        keep_out_m: smallest distance from any point on the ground [m], since the model has no limit
            there.
        margin_m: how far the vehicle stays from fence and zones [m]: sideways, and from a zone's floor and
            ceiling. The ranges have none.
        geofence_m: vertices [east, north] of a polygon [m] that the vehicle stays in, in order around it, the
            last being joined to the first; or None for no fence.
        geofence_lat_lon_deg: the same vertices on the Earth, from which a scenario with an origin fills in
            geofence_m; None if the fence was not stated so.
        geofence_from, no_fly_from: only in files: the files that hold the fence and the zones; None once
            they have been read.
        no_fly: zones that the vehicle stays out of.
    """

    altitude_m: Range = Field(
        description="Lowest and highest altitude of the vehicle above the origin, in metres: [low, high].",
        examples=[[8.0, 30.0]],
    )
    altitude_msl_m: Range | None = optional(
        "The same over the sea (the geoid), in metres, in place of altitude_m; where [origin] "
        "states its own.",
        [215.0, 265.0],
    )
    altitude_ellipsoid_m: Range | None = optional(
        "The same over the WGS-84 ellipsoid, in metres, in place of altitude_m; where [origin] "
        "states its own.",
        [260.0, 310.0],
    )
    x_m: Range | None = optional(
        "Range of the vehicle's position towards the east, in metres: [west end, east end]. "
        "Left out: unbounded.",
        [-100.0, 100.0],
    )
    y_m: Range | None = optional(
        "Range of the vehicle's position towards the north, in metres: [south end, north end]. "
        "Left out: unbounded.",
        [-100.0, 150.0],
    )
    keep_out_m: Annotated[
        float, Limits("a radius in m", 1e-3, 1e7, "the model has no limit at a ground point")
    ] = Field(
        default=1.0,
        description="Smallest distance in metres between the vehicle and any point on the ground.",
        examples=[1.0],
    )
    margin_m: MarginMetres = Field(
        default=0.0,
        description="How far in metres the vehicle stays inside the geofence and outside the no-fly zones: "
        "sideways, above a zone's ceiling and below its floor. x_m, y_m and altitude_m have no margin.",
        examples=[3.0],
    )
    geofence_m: Polygon | None = optional(
        "Vertices of a polygon that the vehicle stays in, in metres, in order around it: "
        "[[east, north], ...]. Left out: no fence.",
        [[-40.0, -20.0], [40.0, -20.0], [40.0, 70.0], [-40.0, 70.0]],
    )
    geofence_lat_lon_deg: EarthlyPolygon | None = optional(
        "The same vertices in degrees, in place of geofence_m, in a scenario with an [origin]: "
        "[[latitude, longitude], ...].",
        [[49.9998, 14.4996], [49.9998, 14.5004], [50.0006, 14.5004], [50.0006, 14.4996]],
    )
    geofence_from: Label | None = optional(
        "Name of a geographic file (GeoJSON, KML, a plan of QGroundControl and others) "
        "with the fence as one polygon or circle, relative to this file's "
        "folder. In place of geofence_m.",
        "fence.geojson",
    )
    no_fly_from: Label | None = optional(
        "Name of a geographic file (GeoJSON, KML, a plan of QGroundControl and others) "
        "with no-fly zones, relative to this file's folder. They "
        "are added to those in tables headed [[airspace.no_fly]].",
        "zones.kml",
    )
    no_fly: Annotated[tuple[NoFlyZone, ...], list_of_tables("airspace.no_fly", most=MOST_CORNERS)] = Field(
        default=(),
        description="Tables headed [[airspace.no_fly]], one for each zone that the vehicle stays out of; "
        "none if left out.",
    )

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return the faults of what has no place on the Earth, of named files and of too large a margin."""
        yield from unplaced(self, raw)
        yield from key_faults(
            raw, ("geofence_from", "no_fly_from"), f"{ONLY_LOCAL}, in place of its own areas; remove one"
        )
        fence_m, margin_m = self.geofence_outline_m, self.margin_m or 0.0
        if margin_m and self.geofence_m and (parts := len(offset_outlines_m(fence_m, -margin_m))) != 1:
            yield (
                ("margin_m",),
                f"got {margin_m:g}, must leave the geofence in one part, but leaves {parts or 'none'}; try "
                f"{largest_margin_m(fence_m, margin_m):g}, the most that does, or a fence that is wider "
                "where it is narrow",
            )

    @cached_property
    def lower_m(self) -> NDArray[np.float64]:
        """The box's lower corner, (3,), in m; minus infinity where unbounded."""
        return read_only([-math.inf if ends is None else ends[0] for ends in self._ranges_m], (3,))

    @cached_property
    def upper_m(self) -> NDArray[np.float64]:
        """The box's upper corner, (3,), in m; infinity where unbounded."""
        return read_only([math.inf if ends is None else ends[1] for ends in self._ranges_m], (3,))

    @cached_property
    def geofence_outline_m(self) -> NDArray[np.float64]:
        """Vertices of the geofence [m], (n, 2), counter-clockwise; none without a fence."""
        return counter_clockwise_m(self.geofence_m)

    @cached_property
    def box_m(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper corner of the smallest box about what the ranges and the fence allow, (3,) in m."""
        if not len(fence_m := self.geofence_outline_m):
            return self.lower_m, self.upper_m
        low_m, high_m = [*fence_m.min(axis=0), -math.inf], [*fence_m.max(axis=0), math.inf]
        return np.maximum(self.lower_m, low_m), np.minimum(self.upper_m, high_m)

    @cached_property
    def inner(self) -> Airspace:
        """The same without its margin, which larger zones and a smaller fence have instead."""
        if not self.margin_m:
            return self
        fence_m = self.geofence_m and offset_outlines_m(self.geofence_outline_m, -self.margin_m)[0]
        zones = tuple(zone.grown(self.margin_m) for zone in self.no_fly)
        return self.model_construct(**{**dict(self), "margin_m": 0.0, "geofence_m": fence_m, "no_fly": zones})

    def outside(self, solids: Iterable[NoFlyZone]) -> Airspace:
        """Return the same without more zones, such as buildings.

        Args:
            solids: the zones.
        """
        more = tuple(zone for zone in solids if self.reached(zone.grown(self.margin_m or 0.0)))
        return self.model_construct(**{**dict(self), "no_fly": (*self.no_fly, *more)}) if more else self

    def reached(self, zone: NoFlyZone) -> bool:
        """Check if a zone may forbid anything that the ranges and the fence allow.

        Args:
            zone: one of the airspace's.
        """
        (low_m, high_m), (lower_m, upper_m) = zone.box_m, self.box_m
        return bool(np.all(low_m < upper_m) and np.all(high_m > lower_m))

    def allows(self, position_m: ArrayLike) -> NDArray[np.bool_]:
        """Check positions of the vehicle against ranges, fence and zones, without the keep-out balls.

        Borders belong to what is allowed, and a position within 1e-9 m of a border counts as on it.

        Args:
            position_m: positions [m], (..., 3).

        Returns:
            Array of shape ``(...)``.
        """
        return np.asarray(self.clearance_m(position_m) >= -BORDER_M)

    def clearance_m(self, position_m: ArrayLike) -> NDArray[np.float64]:
        """Measure distances from what is forbidden [m], without regard to the keep-out balls.

        Below 0 where it is forbidden, 0 on a border; it changes by no more than the distance between two
        positions.

        Args:
            position_m: positions [m], (..., 3).

        Returns:
            Array of shape ``(...)``.
        """
        return np.asarray(reduce(np.minimum, (clearance for _, clearance in self.clearances_m(position_m))))

    def clearances_m(self, position_m: ArrayLike) -> Iterator[tuple[str, NDArray[np.float64]]]:
        """Yield where a position would be forbidden, in words, and how far each is from that [m].

        For the ranges, the geofence and each no-fly zone, with their margin; below 0 where it is forbidden
        by that.

        Args:
            position_m: positions [m], (..., 3).
        """
        position = np.asarray(position_m, dtype=np.float64)
        for axis, key in enumerate(("x_m", "y_m", "altitude_m")):
            across = position[..., axis]
            yield f"outside {key}", np.minimum(across - self.lower_m[axis], self.upper_m[axis] - across)
        counted = f", its margin of {self.margin_m:g} m counted" if self.margin_m else ""
        if len(fence_m := self.inner.geofence_outline_m):
            yield f"outside the geofence{counted}", depth_m(position[..., :2], fence_m)
        yield from (
            (f"inside the no-fly zone {zone.name}{counted}", -zone.depth_m(position, self.altitude_m))
            for zone in self.inner.no_fly
        )

    @property
    def _ranges_m(self) -> tuple[tuple[float, float] | None, ...]:
        return self.x_m, self.y_m, self.altitude_m
