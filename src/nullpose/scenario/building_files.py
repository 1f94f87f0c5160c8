"""The buildings that a scenario file takes from another file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain

import shapely

from nullpose.errors import Fault
from nullpose.files import PlainTable
from nullpose.scenario.area_files import reach_deg
from nullpose.scenario.areas import Area, account, area_of, unique
from nullpose.scenario.building_heights import GONE, MARK, BuildingHeight, height_of, state_of
from nullpose.scenario.buildings import MOST_BUILDINGS, Building
from nullpose.scenario.faults import EXCHANGED, call_each, raise_all, require
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.shapes import corners_of


def buildings_of(
    features: Sequence[Feature], rules: Building, origin: PlainTable, names: set[str], first: int
) -> tuple[list[PlainTable], list[str], dict[str, str]]:
    """Make raw buildings of features: one of each polygon, open where it has a hole.

    Where some features are marked as buildings, as those of OpenStreetMap are, the others are left out. So
    are buildings that are not there. One that may be open, and one that has parts of its own, hides nodes and
    no jammer.

    Args:
        features: of the file.
        rules: the table that names the file.
        origin: the scenario's, raw; empty without one.
        names: that are taken; those of the file are added.
        first: how many buildings the scenario has before them.

    Returns:
        The buildings, notes on what became of the features, and the places in the file of the buildings by
        their path in the scenario.

    Raises:
        ScenarioError: with the faults of all features.
    """
    marked = [
        feature
        for feature in features
        if any(
            MARK.fullmatch(key) and value not in ("no", False) for key, value in feature.properties.items()
        )
    ] or features
    counts, reach = Counter({"other feature": len(features) - len(marked)}), reach_deg(origin)
    parts = [each.geometry for each in marked if "building:part" in each.properties and each.geometry]
    within, gone = shapely.STRtree(shapely.point_on_surface(parts)), Counter[str]()

    def areas_with_height(feature: Feature) -> list[tuple[Area, BuildingHeight]]:
        areas = area_of(feature, reach, counts, is_fence=True)
        counts["point"] += sum(len(area.cylinders) for area in areas)
        areas, state = [area for area in areas if area.polygons], state_of(feature)
        if not state and "building:part" not in feature.properties and areas:
            state = "parts" if len(within.query(feature.geometry, "contains")) else ""
        gone.update([state] * len(areas) if state in GONE else [])
        return [(area, height_of(feature, rules, state)) for area in areas if state not in GONE]

    each, faults = call_each(areas_with_height, marked)
    found: list[tuple[Area, BuildingHeight]] = list(chain.from_iterable(each))
    faults += _without_height([area.place for area, height in found if not height.by])
    raise_all(faults)
    total = sum(len(area.polygons) for area, _ in found)
    require(
        total <= MOST_BUILDINGS,
        "",
        f"it has {total} buildings in reach, must be at most {MOST_BUILDINGS}; cut it to the "
        "streets of the scene",
    )
    tables = [table for area, height in found for table in _tables(area, height, rules, names)]
    places = {
        f"buildings[{index}]": place
        for index, place in enumerate([area.place for area, _ in found for _ in area.polygons], first)
    }
    return tables, list(_notes(found, counts, gone)), places


def _without_height(places: Sequence[str]) -> list[Fault]:
    """List, once for all, that buildings state no height and no rule says which to assume."""
    message = (
        "it states no height (height, or building:levels with storey_height_m)"
        f"{f', and so {len(places) - 1} more' if places[1:] else ''}; write storey_height_m = 3, or "
        "missing_height_m = 9 or [4, 12] for those that state none, beside buildings_from"
    )
    return [Fault(place, message) for place in places[:1]]


def _tables(area: Area, height: BuildingHeight, rules: Building, names: set[str]) -> Iterator[PlainTable]:
    """Yield the raw buildings of an area."""
    low_m, high_m = height.ends_m
    for polygon in area.polygons:
        name = unique(area.name, names)
        yards = [corners_of(ring) for ring in polygon.interiors]
        yield {
            **({"name": name} if name else {}),
            "polygon_lat_lon_deg": corners_of(polygon.exterior),
            **({"courtyards_lat_lon_deg": yards} if yards else {}),
            "height_m": low_m if low_m == high_m else [low_m, high_m],
            "base_m": height.base_m,
            "clearance_m": rules.clearance_m,
        }


def _notes(
    found: Sequence[tuple[Area, BuildingHeight]], counts: Counter[str], gone: Counter[str]
) -> Iterator[str]:
    """Yield how the heights of all buildings are stated and what is passed over, then what is not read."""
    sources = Counter(height.by for area, height in found for _ in area.polygons)
    shares = ", ".join(f"{number} {source}" for source, number in sources.most_common())
    wrong = [height.faults[0].path for _, height in found if height.faults]
    open_ = Counter(height.state for _, height in found if height.state)
    left_out, hiding = (", ".join(f"{n} {word}" for word, n in each.items()) for each in (gone, open_))
    away = counts["area"] - len(found) - gone.total()
    parts = {
        f"not readable: {len(wrong)}, the first {''.join(wrong[:1])}": wrong,
        f"left out: {left_out}": gone,
        f"hiding nodes and no jammer: {hiding}": open_,
        EXCHANGED: away and not found,
        f"out of reach: {away}": away,
    }
    yield account(f"buildings: {sources.total()}{f': {shares}' if shares else ''}", counts, parts)
    if unread := Counter(key for _, height in found for key in height.unread):
        yield f"not read: {', '.join(f'{key} (of {number})' for key, number in unread.items())}"
