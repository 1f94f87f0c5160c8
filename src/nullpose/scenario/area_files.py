"""What a scenario file's airspace takes from other files: its fence and no-fly zones."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import product
from typing import TypeAlias, TypeVar

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import Polygon

from nullpose.files import PlainTable
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.altitude_limits import RANGES, Ground, shift_m
from nullpose.scenario.areas import STAY_OUT, Area, areas_of, notes_on, polygons_of
from nullpose.scenario.faults import described, refusal, require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.geodesy import enu_from_geodetic, geodetic_from_enu, wrapped
from nullpose.scenario.no_fly import NoFlyZone
from nullpose.scenario.origin import Origin
from nullpose.scenario.polygon import MOST_CORNERS
from nullpose.scenario.section import Floats
from nullpose.scenario.shapes import DISC_SIDES, corners_of, disc
from nullpose.scenario.units import EARTHLY_RANGES

REACH_M = 6e4
"""How far east, west, north and south of the origin zones of files count; in degrees this square lies within
the 100 km that a frame holds."""
_HALVES_M = (REACH_M, 3e4, 1.5e4, 8e3, 4e3, 2e3)  # of squares about the origin
_BOUNDS = {"x_m", "y_m", "geofence_m", "geofence_lat_lon_deg", *RANGES}
FENCES = {"geofence_m", "geofence_lat_lon_deg"}
"""The keys of an airspace that state a fence, by metres or by degrees."""
_POLE_DEG = 85.0  # longitudes say little beyond


_Raw = TypeVar("_Raw")
Filled: TypeAlias = tuple[_Raw, list[str], dict[str, str]]
"""What is filled in, notes on what became of a file's features, and the places in the file of what is from it
by their path in the scenario."""


def with_zones(features: Sequence[Feature], airspace: PlainTable, origin: Origin) -> Filled[PlainTable]:
    """Add the zones of a file to a raw airspace after its own.

    Where they have too many corners they are cut to the airspace; where that has no bounds it gets some.

    Args:
        features: of the file.
        airspace: raw.
        origin: the scenario's, None standing for what is not stated or at fault.

    Raises:
        ScenarioError: with the faults of all features.
    """
    listed, place = list(airspace.get("no_fly", ())), _place(origin)
    names = {str(zone.get("name")) for zone in listed if isinstance(zone, Mapping)}
    areas, counts, remarks = areas_of(
        features, reach_deg(origin), _ground_m(origin), names, fence=not FENCES.isdisjoint(airspace)
    )
    require(counts["area"], "", f"nothing in it is a zone: {'; '.join(notes_on(areas, counts, remarks))}")
    bounds: PlainTable = {}
    words = ""
    for half_m in _HALVES_M:
        corners = sum(len(polygon.exterior.coords) - 1 for polygon in polygons_of(areas))
        if place is None or corners <= MOST_CORNERS:
            break
        box_m = _box_m(airspace, half_m, place)
        areas = [area for area in areas if area.cut(_box_deg(box_m, place))]
        ends_m = dict(zip(("x_m", "y_m"), box_m.T.tolist(), strict=True))
        bounds = {key: ends for key, ends in ends_m.items() if half_m in ends}
        words = " and ".join(f"{key} = {ends}" for key, ends in bounds.items()) or "the airspace of the file"
    if words:
        remarks.append(f"they are cut to {words}, since all have too many corners")
    zones = [(zone, area.place) for area in areas for zone in area.zones() if zone not in listed]
    places = {f"airspace.no_fly[{index}]": place for index, (_, place) in enumerate(zones, len(listed))}
    filled = {**airspace, **bounds, "no_fly": [*listed, *(zone for zone, _ in zones)]}
    return filled, list(notes_on(areas, counts, remarks)), places


def reach_deg(origin: Origin) -> Polygon:
    """Return the box of degrees in which the areas of a file count.

    Args:
        origin: the scenario's, None standing for what is not stated or at fault.
    """
    place = _place(origin)
    return _everywhere() if place is None else _box_deg(_box_m({}, REACH_M, place), place)


def with_fence(features: Sequence[Feature], airspace: PlainTable, origin: Origin) -> Filled[PlainTable]:
    """Give a raw airspace the fence of a file.

    The fence's holes are zones, and its altitudes bound those of the airspace.

    Args:
        features: of the file, of which one is a polygon.
        airspace: raw, without a fence.
        origin: the scenario's, None standing for what is not stated or at fault.

    Raises:
        ScenarioError: there is not one polygon, or the altitudes leave none.
    """
    place, ground_m = _place(origin), _ground_m(origin)
    reach = _everywhere(0.0 if place is None else float(place[1]))
    names = {str(zone.get("name")) for zone in airspace.get("no_fly", ()) if isinstance(zone, Mapping)}
    areas, counts, remarks = areas_of(features, reach, ground_m, names)
    fences = [area for area in areas if area.role != STAY_OUT]
    outlines = [part for area in fences for part in (*area.polygons, *area.cylinders)]
    others = [area for area in areas if area not in fences]
    beside = [(zone, area.place) for area in others for zone in area.zones()]
    require(
        len(outlines) == 1,
        "",
        f"it has {len(outlines)} areas{f' beside {len(beside)} to stay out of' * bool(beside)}, must be one "
        "polygon or circle, the fence",
    )
    polygon, radius_words = _outline(fences[0], ground_m)
    holes = [
        {"name": f"hole {index} of the fence", "polygon_lat_lon_deg": corners_of(ring)}
        for index, ring in enumerate(polygon.interiors, 1)
    ]
    zones = [*holes, *(zone for zone, _ in beside), *airspace.get("no_fly", ())]
    fenced = {
        **airspace,
        "geofence_lat_lon_deg": corners_of(polygon.exterior),
        **({"no_fly": zones} if holes or beside else {}),
        **_altitudes(airspace, fences[0], ground_m),
    }
    places = {
        "airspace.geofence_lat_lon_deg": fences[0].place,
        **{f"airspace.no_fly[{index}]": place for index, (_, place) in enumerate(beside, len(holes))},
    }
    notes = [
        *notes_on(fences, counts, [*radius_words, *remarks], is_fence=True),
        *(notes_on(others, Counter(area=len(others)), []) if others else ()),
    ]
    return fenced, notes, places


def _outline(fence: Area, ground_m: Ground) -> tuple[Polygon, list[str]]:
    """Return the polygon of a fence, or one in its circle, and what is said of the circle."""
    alt_m = ground_m["altitude_ellipsoid_m"] or ground_m["altitude_msl_m"] or 0.0  # of the local frame
    for lon_deg, lat_deg, stated_m in fence.cylinders:
        if (radius_m := NoFlyZone._sound_part({"radius_m": stated_m}).radius_m) is None:
            raise refusal(f"{fence.place}.radius_m", f"got {described(stated_m)}, must be a radius in m")
        less_m = radius_m * (1.0 - np.cos(np.pi / DISC_SIDES))
        sides = f"a polygon of {DISC_SIDES} sides in it, up to {less_m:.2g} m smaller"
        return disc(lon_deg, lat_deg, radius_m, alt_m), [f"its circle of {radius_m:g} m counts as {sides}"]
    return fence.polygons[0], []


def _altitudes(airspace: PlainTable, fence: Area, ground_m: Ground) -> dict[str, list[float]]:
    """Return the airspace's ranges of altitudes within those of its fence."""
    bounds, limits = _bounds(airspace), NoFlyZone._sound_part(fence.limits)
    found = {key: list(ends_m) for key in RANGES if (ends_m := getattr(bounds, key)) is not None}
    for key, over in product(list(found), fence.limits):
        if (limits_m := getattr(limits, over)) is None:
            raise refusal(f"{fence.place}.{over}", f"got {fence.limits[over]!r}, must be [low, high] in m")
        over_m = shift_m(fence.place, over, key, ground_m)
        found[key] = [max(found[key][0], limits_m[0] + over_m), min(found[key][1], limits_m[1] + over_m)]
        require(
            found[key][0] <= found[key][1],
            fence.place,
            f"its {over} = {fence.limits[over]} has no altitude in common with the airspace's {key} = "
            f"{airspace[key]}{'; '.join(['', *fence.remarks])}; change either",
        )
    return found if fence.limits else {}


def _ground_m(origin: Origin) -> Ground:
    return {"altitude_m": 0.0} | {key: getattr(origin, over) for key, over in EARTHLY_RANGES.items()}


def _place(origin: Origin) -> Floats | None:
    """Return the origin's latitude and longitude, and altitude 0, (3,); None where it is at fault."""
    return (
        None if None in (origin.lat_deg, origin.lon_deg) else np.array([origin.lat_deg, origin.lon_deg, 0.0])
    )


def _bounds(airspace: PlainTable) -> Airspace:
    """Read the borders of a raw airspace; None where it is at fault, which the scenario is refused for."""
    return Airspace._sound_part({key: airspace[key] for key in _BOUNDS & airspace.keys()})


def _box_m(airspace: PlainTable, half_m: float, place: Floats) -> Floats:
    """Return the ends of where the vehicle may be within a square about the origin, (2, 2), by axis last."""
    bounds = _bounds(airspace)
    ends_m = np.array([[-half_m, -half_m], [half_m, half_m]])
    fence: ArrayLike | None = bounds.geofence_m
    if bounds.geofence_lat_lon_deg:
        fence = enu_from_geodetic(np.insert(bounds.geofence_lat_lon_deg, 2, 0.0, axis=-1), place)[:, :2]
    ends_m = np.clip(ends_m, np.min(fence, axis=0), np.max(fence, axis=0)) if fence is not None else ends_m
    sides_m = np.array([bounds.x_m or (-np.inf, np.inf), bounds.y_m or (-np.inf, np.inf)])
    return np.asarray(np.clip(ends_m, *sides_m.T))


def _everywhere(lon_deg: float = 0.0) -> Polygon:
    return shapely.box(lon_deg - 1e4, -1e4, lon_deg + 1e4, 1e4)


def _box_deg(ends_m: Floats, place: Floats) -> Polygon:
    """Return the box of degrees about a rectangle of the local frame, and a little more."""
    east_m, north_m = np.meshgrid(*np.linspace(ends_m[0], ends_m[1], 9).T)
    places = geodetic_from_enu(np.stack([east_m, north_m, 0.0 * east_m], axis=-1).reshape(-1, 3), place)
    corners = places[:, 1::-1]
    corners[:, 0] = wrapped(corners[:, 0], place[1])
    if np.abs(corners[:, 1]).max() > _POLE_DEG:
        corners = np.vstack([corners, [place[1] - 180.0, place[0]], [place[1] + 180.0, place[0]]])
    more = 0.01 * np.ptp(corners, axis=0) + 1e-4
    return shapely.box(*(corners.min(axis=0) - more), *(corners.max(axis=0) + more))
