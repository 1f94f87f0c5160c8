"""Buildings of files: heights as people state them, what becomes of features, and what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from geo_files import HERE, WRITERS, Feature, write_geojson

from nullpose.channel.buildings import is_blocked
from nullpose.scenario import Scenario, load
from nullpose.scenario.buildings import MOST_BUILDINGS
from scenes import require_fault

SCENE = """\
[origin]
lat_deg = 50.0
lon_deg = 14.5
alt_m = 230.0
[airspace]
altitude_m = [8.0, 30.0]
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
[[nodes]]
lat_deg = {lat}
lon_deg = 14.5
alt_agl_m = 1.5
power_w = 1.0
[[buildings]]
buildings_from = "{file}"
{rules}
"""
STEP = 2e-4
"""Degrees from a building to the next."""


def box(number: int, size: float = 0.5 * STEP) -> shapely.Polygon:
    """Return the outline of a building in degrees, by its place in a row."""
    west, south = HERE[0] + (number + 1) * STEP, HERE[1]
    return shapely.box(west, south, west + size, south + size)


def town(
    folder: Path, features: list[Feature], rules: str = "", more: str = ""
) -> tuple[Scenario, list[str]]:
    """Return the scenario with the buildings of a file, and the notes of loading it."""
    write_geojson(folder / "town.geojson", features)
    notes: list[str] = []
    return load(scene(folder, rules, more), on_note=notes.append), notes


def scene(
    folder: Path, rules: str = "", more: str = "", file: str = "town.geojson", lat: float = 50.0
) -> Path:
    """Return the path of a scenario file that names a town's."""
    path = folder / "scene.toml"
    path.write_text(SCENE.format(file=file, rules=rules, lat=lat) + more, encoding="utf-8")
    return path


FEET, LEVELS = 'height_unit = "ft"', "storey_height_m = 3"
BOTH = 'roof_property = "roof"\nground_property = "ground"'


@pytest.mark.parametrize(
    ("properties", "rules", "ends_m"),
    [
        ({"height": 22}, "", 22.0),
        ({"height": "22"}, "", 22.0),
        ({"height": "22 m"}, "", 22.0),
        ({"height": "22.5m"}, "", 22.5),
        ({"height": " 8 metres "}, "", 8.0),
        ({"height": "72 ft"}, FEET, 21.9456),
        ({"height": 72}, FEET, 21.9456),
        ({"height": "72'"}, FEET, 21.9456),
        ({"height": "72'6\""}, FEET, 22.098),
        ({"height": "72'"}, 'height_unit = "m"', 21.9456),
        ({"height": "22 m"}, FEET, 22.0),
        ({"height": 22, "building:levels": 3}, LEVELS, 22.0),
        ({"building:levels": "3"}, LEVELS, 9.0),
        ({"building:levels": 2.5}, LEVELS, 7.5),
        ({"levels": 15.8}, LEVELS, 47.4),
        ({"num_floors": 4}, LEVELS, 12.0),
        ({"height": -1.0, "num_floors": 4}, LEVELS, 12.0),
        ({"building:levels": 3}, "missing_height_m = 9", 9.0),
        ({}, "missing_height_m = [4, 12]", (4.0, 12.0)),
        ({"building:levels": 3}, f"{LEVELS}\nmissing_height_m = [4, 12]", 9.0),
        ({"roof": 251.5, "ground": "230 m", "height": 9}, BOTH, 21.5),
        ({"roof": 251.5, "height": 9}, BOTH, 9.0),
    ],
)
def test_heights_as_people_have_them(
    properties: dict[str, Any], rules: str, ends_m: Any, tmp_path: Path
) -> None:
    """Numbers and texts with units, levels, what is assumed, and roofs over a datum less their ground."""
    (building,) = town(tmp_path, [(box(0), properties)], rules)[0].buildings
    assert building.heights_m == pytest.approx(ends_m if isinstance(ends_m, tuple) else (ends_m, ends_m))
    assert building.base_m == 0.0


@pytest.mark.parametrize(
    ("properties", "rules", "place", "words"),
    [
        (
            {"height": "72 ft"},
            "",
            ".height",
            'what its heights without a unit are in, height_unit = "m" or "ft"',
        ),
        ({"height": "tall"}, "", ".height", 'got the text "tall", must be a number of metres'),
        ({"height": "8;9"}, "", ".height", "must be a number of metres"),
        ({"height": True}, "", ".height", "got the truth value true"),
        ({"height": -4}, "", "", "its roof is -4 m above the ground (by height)"),
        ({"height": 0}, "", "", "must be above its base, 0 m"),
        ({"height": 8848}, "", "", "at most 1000"),
        ({"height": 9, "min_height": 12}, "", "", "must be above its base, 12 m"),
        ({"height": 9, "min_height": "low"}, "", ".min_height", "must be a number of metres"),
        ({"roof": 230, "ground": 231}, BOTH, "", "-1 m above the ground (by roof less ground)"),
        ({"levels": "3-4"}, LEVELS, ".levels", "must be a number of levels"),
        ({"levels": 3}, "", "", "it states no height"),
        ({"est_height": 3}, LEVELS, "", "missing_height_m = 9"),
        ({"height": 9, "building:min_level": 2}, "", ".building:min_level", "add storey_height_m = 3"),
        ({"height": -1}, "", "", "write missing_height_m = 9 or [4, 12]"),
    ],
)
def test_heights_that_are_refused(
    properties: dict[str, Any], rules: str, place: str, words: str, tmp_path: Path
) -> None:
    """Feet without their unit in the scenario, what is no number, and what is not above the ground."""
    write = lambda: town(tmp_path, [(box(0), properties)], rules)  # noqa: E731
    require_fault(write, f"buildings[0].buildings_from: town.geojson: features[0]{place}", words)


@pytest.mark.parametrize("height", [-1, -1.0, 0, "0", "", "5;7", "~12", "12,5", "tall", True, 9999, "40'"])
def test_what_states_no_height_counts_as_missing(height: object, tmp_path: Path) -> None:
    """A city is not refused for it where it is said what to assume; it is counted, and the first is named."""
    features = [(box(0), {"height": 8.4}), (box(1), {"height": height})]
    scenario, notes = town(tmp_path, features, "missing_height_m = [4, 12]")
    assert [each.heights_m for each in scenario.buildings] == [(8.4, 8.4), (4.0, 12.0)]
    (note,) = notes
    assert "2: 1 by height, 1 assumed; not readable: 1, the first features[1]" in note


@pytest.mark.parametrize(
    ("properties", "base_m", "ends_m"),
    [
        ({"height": 9, "min_height": 4}, 4.0, (9.0, 9.0)),
        ({"height": 9, "building:min_level": "1"}, 3.0, (9.0, 9.0)),
        ({"num_floors": 5, "min_floor": 2}, 6.0, (15.0, 15.0)),
        ({"min_height": 2}, 2.0, (4.0, 14.0)),
        ({"min_height": 30}, 30.0, (30.0, 42.0)),
        ({"height": 9, "min_height": 12}, 12.0, (12.0, 24.0)),
        ({"height": 9, "min_height": "low"}, 0.0, (0.0, 9.0)),
        ({"height": 9, "min_height": -2}, 0.0, (9.0, 9.0)),
    ],
)
def test_what_does_not_stand_on_the_ground(
    properties: dict[str, Any], base_m: float, ends_m: tuple[float, float], tmp_path: Path
) -> None:
    """Where the base or the roof is not sure, the low end hides what is sure, the high end all."""
    (building,) = town(tmp_path, [(box(0), properties)], f"{LEVELS}\nmissing_height_m = [4, 12]")[0].buildings
    assert (building.base_m, building.heights_m) == (base_m, ends_m)


@pytest.mark.parametrize(
    "properties",
    [
        {"building": "parking", "location": "underground"},
        {"building": "yes", "layer": "-1"},
        {"building": "yes", "level": "-2;-1"},
        {"is_underground": True},
        {"is_undergr": 1},
        {"building": "demolished"},
        {"building": "proposed"},
        {"building": "yes", "demolished": "yes"},
        {"demolished:building": "yes"},
        {"razed:building": "house"},
        {"status": "Proposed"},
    ],
)
def test_buildings_that_are_not_there_are_left_out(properties: dict[str, Any], tmp_path: Path) -> None:
    """They hide neither nodes nor jammers, even with a height or without, and are counted."""
    features = [(box(0), {"building": "yes", "height": 8}), (box(1), properties | {"height": 30})]
    both, notes = town(tmp_path, features)
    assert [each.heights_m for each in both.buildings] == [(8.0, 8.0)]
    assert ("left out: 1 " in notes[0]) == ("building" in str(properties)), notes
    alone, notes = town(tmp_path, [(box(1), properties)])
    assert alone.prisms is None
    assert notes[0].startswith("town.geojson: buildings: 0; left out: 1 ")


@pytest.mark.parametrize(
    ("properties", "low_m"),
    [
        ({"building": "roof"}, 0.0),
        ({"building": "carport"}, 0.0),
        ({"class": "canopy"}, 0.0),
        ({"building": "construction"}, 0.0),
        ({"ruins:building": "yes"}, 0.0),
        ({"has_parts": True}, 0.0),
        ({"building": "roof", "min_height": 4}, 6.0),
        ({"abandoned:building": "yes"}, 6.0),
        ({"building": "house", "proposed:building": "flats", "level": "-1;0;1"}, 6.0),
        ({"building": "house", "disused": "yes", "layer": 1, "construction": "no"}, 6.0),
    ],
)
def test_what_may_be_open_hides_nodes_and_no_jammer(
    properties: dict[str, Any], low_m: float, tmp_path: Path
) -> None:
    """A canopy stands on posts, a shell may be low: the high end blocks nodes, the low end no jammer."""
    scenario, notes = town(tmp_path, [(box(0), properties | {"height": 6})])
    assert scenario.buildings[0].heights_m == (low_m, 6.0)
    assert ("hiding nodes and no jammer: 1 " in notes[0]) == (low_m == 0.0)


def test_an_outline_with_parts_hides_jammers_only_where_its_parts_do(tmp_path: Path) -> None:
    """The outline has the height of its highest part, which the rest of it may not reach."""
    tower = shapely.affinity.scale(box(0), 0.2, 0.2)
    features: list[Feature] = [
        (box(0), {"building": "office", "height": 90}),
        (tower, {"building:part": "yes", "height": 90}),
        (box(1), {"building": "yes", "height": 7}),
    ]
    scenario, notes = town(tmp_path, features)
    assert [each.heights_m for each in scenario.buildings] == [(0.0, 90.0), (90.0, 90.0), (7.0, 7.0)]
    assert "hiding nodes and no jammer: 1 parts" in notes[0]


def test_states_that_are_not_understood_are_named(tmp_path: Path) -> None:
    """Such as the year in which a building was torn down."""
    features = [(box(0), {"building": "yes", "height": 9, "end_date": "1998", "STATUS": "vacated"})]
    assert town(tmp_path, features)[1][1] == "town.geojson: not read: end_date (of 1), STATUS (of 1)"


def test_what_becomes_of_features(tmp_path: Path) -> None:
    """Multi-polygons are several buildings, holes are open; the account has all of them."""
    ring = box(0).difference(box(0).buffer(-1e-5))
    pair = shapely.MultiPolygon([box(1), box(2)])
    far = shapely.box(20.0, 50.0, 20.0001, 50.0001)
    features: list[Feature] = [
        (ring, {"building": "yes", "height": "12", "name": "Court", "min_height": 3}),
        (pair, {"building": "house", "building:levels": "2", "roof:height": 3, "name": "Court"}),
        (box(3), {"building:part": "yes", "est_height": 7, "building:levels:underground": 1}),
        (shapely.Point(HERE), {"building": "entrance"}),
        (shapely.LineString(box(4).exterior.coords[:3]), {"building": "wall"}),
        (box(5), {"landuse": "grass"}),
        (box(6), {"building": "no"}),
        (far, {"building": "yes"}),
    ]
    own = '[[buildings]]\nname = "Court"\npolygon_m = [[0, 50], [9, 50], [9, 59]]\nheight_m = 5\n'
    scenario, notes = town(
        tmp_path, features, "storey_height_m = 3\nmissing_height_m = 4\nclearance_m = 2", own
    )
    assert [each.name for each in scenario.buildings] == ["Court 2", "Court 3", "Court 4", "B4", "Court"]
    court = scenario.buildings[0]
    assert len(court.courtyards_m) == 1
    assert (court.base_m, court.clearance_m, court.heights_m) == (3.0, 2.0, (12.0, 12.0))
    inside = shapely.Polygon(court.polygon_m, court.courtyards_m)
    assert inside.area == pytest.approx(sum(_areas(scenario, 0)), rel=1e-5)
    assert notes == [
        "town.geojson: buildings: 4: 2 by levels, 1 by height, 1 assumed; passed over: 1 point, 1 line, "
        "2 other features; out of reach: 1",
        "town.geojson: not read: roof:height (of 1), est_height (of 1)",
    ]


def test_corners_with_altitudes(tmp_path: Path) -> None:
    """The altitudes of corners are no heights, which is told where no other is stated; zeros are silent."""
    for altitude_m, rest in ((0.0, []), (250.0, ["town.geojson: not read: altitudes of corners (of 1)"])):
        high = shapely.force_3d(box(0), altitude_m)
        assert town(tmp_path, [(high, {})], "missing_height_m = 9")[1][1:] == rest
        assert not town(tmp_path, [(high, {"height": 9})])[1][1:]


def _areas(scenario: Scenario, building: int) -> list[float]:
    """Return the areas of the convex pieces of a building, from their sides."""
    prisms, areas = scenario.prisms, []
    for piece in np.flatnonzero(prisms.building == building):
        sides = prisms.sides[prisms.start[piece] : prisms.start[piece + 1]]
        pairs = zip(sides, np.roll(sides, -1, axis=0), strict=True)
        corners = [np.linalg.solve([a[:2], b[:2]], [a[2], b[2]]) for a, b in pairs]
        areas.append(shapely.Polygon(corners).area)
    return areas


@pytest.mark.parametrize("ending", [".kml", ".gpkg"])
def test_other_formats(ending: str, tmp_path: Path) -> None:
    """KML and GeoPackage hold the same buildings as GeoJSON."""
    features = [(box(0), {"name": "hall", "height": 12}), (box(1), {"name": "shed", "height": 4})]
    same = town(tmp_path, features)[0]
    WRITERS[ending](tmp_path / f"town{ending}", features)
    assert load(scene(tmp_path, file=f"town{ending}")).buildings == same.buildings


def test_what_is_refused_of_a_file(tmp_path: Path) -> None:
    """Borders that cross, points in buildings, too many, and rules at fault, by their place in both files."""
    at = "buildings[0].buildings_from: town.geojson"
    x, y = HERE
    bow = shapely.Polygon([(x + 1e-3, y), (x + 2e-3, y + 1e-3), (x + 2e-3, y), (x + 1e-3, y + 1e-3)])
    high = {"height": 9}
    require_fault(lambda: town(tmp_path, [(bow, high)]), f"{at}: features[0]", "its border crosses itself")
    around = shapely.Point(HERE).buffer(1e-4)
    require_fault(
        lambda: town(tmp_path, [(box(0), high), (around, high)]), f"{at}: features[1]", "nodes[0] at"
    )
    many = [(box(n % 100), high) for n in range(MOST_BUILDINGS + 1)]
    require_fault(lambda: town(tmp_path, many), at, "it has 2001 buildings in reach, must be at most 2000")
    bare = [(box(n), {}) for n in range(3)]
    require_fault(lambda: town(tmp_path, bare), f"{at}: features[0]", "and so 2 more; write storey_height_m")
    for rules, key, words in (
        ("storey_height_m = 0", ".storey_height_m", "from 1 to 20"),
        ('height_unit = "in"', ".height_unit", 'must be a unit: "m" or "ft"'),
        ('roof_property = "roof"', ".roof_property", "given without the other"),
        ("base_m = 2", ".base_m", "has a meaning only without buildings_from"),
        ("height_m = 2", "", "both height_m and buildings_from are given"),
    ):
        require_fault(lambda r=rules: town(tmp_path, [(box(0), high)], r), f"buildings[0]{key}", words)
    write_geojson(tmp_path / "town.geojson", [(box(0), high)])
    far = scene(tmp_path, lat=50.7)
    require_fault(lambda: load(far), "buildings[0].buildings_from", "its buildings count up to 60 km")


def test_rules_may_be_set(tmp_path: Path) -> None:
    """Rules are changed before the file is read; what its buildings are called, after."""
    write_geojson(tmp_path / "town.geojson", [(box(0), {"levels": 3, "name": "hall"})])
    changes = ["buildings[0].storey_height_m=4", "buildings.hall.clearance_m=5"]
    (hall,) = load(scene(tmp_path), overrides=changes).buildings
    assert (hall.heights_m, hall.clearance_m) == ((12.0, 12.0), 5.0)


def test_a_shadow_of_a_town(tmp_path: Path) -> None:
    """The prisms of a file stand where its buildings do, and shadow what is behind them."""
    prisms = town(tmp_path, [(box(0), {"height": 12})])[0].prisms
    behind = [[40.0, 5.0, 1.0], [-40.0, 5.0, 1.0], [40.0, 5.0, 60.0]]
    assert is_blocked(prisms, [-40.0, 5.0, 1.0], behind, False).tolist() == [
        True,
        False,
        False,
    ]
