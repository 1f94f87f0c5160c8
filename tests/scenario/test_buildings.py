"""Buildings in a scenario: what a table means, what is refused, and where the drone may not be."""

import json
import pickle
import tomllib
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.problem.build import build_family
from nullpose.scenario import Building, Scenario, apply_overrides
from nullpose.scenario.buildings import DEEP_M
from nullpose.scenario.geodesy import enu_from_geodetic
from scenes import faults_of, small

HALL = {"polygon_m": [[20, 0], [20, 15], [40, 15], [40, 0]], "height_m": 12.0}
YARD = [[25, 5], [35, 5], [35, 10], [25, 10]]
ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
RING = [[50.0, 14.5010], [50.0, 14.5013], [50.0002, 14.5011]]
INNER = [[50.00005, 14.5011], [50.00005, 14.50115], [50.0001, 14.5011]]


def scene(*buildings: dict[str, Any], **tables: Any) -> Scenario:
    """Return a scenario with these buildings."""
    return Scenario.from_dict(small(buildings=list(buildings), **tables))


def test_what_a_table_means() -> None:
    """Outlines run counter-clockwise; one height is both ends; prisms are those of the buildings in order."""
    scenario = scene(HALL | {"courtyards_m": [YARD]}, HALL | {"height_m": [10, 14], "base_m": 3})
    first, second = scenario.buildings
    assert [each.name for each in scenario.buildings] == ["B1", "B2"]
    np.testing.assert_array_equal(first.outline_m, HALL["polygon_m"][::-1])
    assert (first.heights_m, second.heights_m) == ((12.0, 12.0), (10.0, 14.0))
    assert (first.floor_m, second.floor_m) == (DEEP_M, 3.0)
    prisms = scenario.prisms
    assert set(prisms.building) == {0, 1}
    assert prisms.most_height_m[-1] == 14.0
    assert prisms.least_height_m[-1] == 10.0
    assert prisms.base_m[-1] == 3.0
    assert scenario.prisms is prisms
    assert scene(HALL | {"height_m": 0}).prisms is None
    assert Scenario.from_dict(small()).prisms is None


heights = st.one_of(st.floats(0.0, 90.0), st.tuples(st.floats(0.0, 9.0), st.floats(9.0, 90.0)).map(list))
tables = st.fixed_dictionaries(
    {"polygon_m": st.just(HALL["polygon_m"]), "height_m": heights},
    optional={"courtyards_m": st.just([YARD]), "clearance_m": st.floats(0.0, 5.0)},
)


@given(st.lists(tables, max_size=3))
def test_buildings_are_written_and_read_back(buildings: list[dict[str, Any]]) -> None:
    """TOML, JSON and pickle keep every key."""
    scenario = Scenario.from_dict(small(buildings=buildings))
    assert Scenario.from_dict(tomllib.loads(scenario.to_toml())) == scenario
    assert Scenario.from_dict(json.loads(json.dumps(scenario.to_dict()))) == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    assert ("buildings" in scenario.to_dict()) == bool(buildings)


def test_buildings_on_the_earth_stay_there() -> None:
    """Outlines and courtyards in degrees are metres from the origin, also when that moves."""
    table = {"polygon_lat_lon_deg": RING, "courtyards_lat_lon_deg": [INNER], "height_m": 9}
    scenario = scene(table, origin=ORIGIN)
    moved = apply_overrides(scenario, ["origin.lat_deg=50.001"])
    for each, lat_deg in ((scenario, 50.0), (moved, 50.001)):
        (building,) = each.buildings
        for ring, found_m in ((RING, building.polygon_m), (INNER, building.courtyards_m[0])):
            expected = enu_from_geodetic(np.insert(ring, 2, 230.0, axis=1), [lat_deg, 14.5, 230.0])[:, :2]
            np.testing.assert_allclose(found_m, expected, rtol=0, atol=1e-6)
    higher = apply_overrides(scenario, ["buildings.B1.height_m=[11, 13]"])
    assert higher.buildings[0].heights_m == (11.0, 13.0)


@pytest.mark.parametrize(
    ("table", "path", "words"),
    [
        ({"polygon_m": [[0, 9], [9, 18], [9, 9], [0, 18]]}, "polygon_m", "crosses or touches itself"),
        ({"height_m": -1}, "height_m", "from 0 to 1000"),
        ({"height_m": "22 m"}, "height_m", "must be a number"),
        ({"height_m": [25, 18]}, "height_m", "reversed"),
        ({"height_m": 3, "base_m": 4}, "height_m", "must be base_m = 4 or more"),
        ({"height_m": None}, "", "polygon_m given without height_m"),
        ({"polygon_m": None}, "", "height_m given without polygon_m or polygon_lat_lon_deg"),
        ({"courtyards_m": [[[25, 5], [55, 5], [35, 9]]]}, "courtyards_m", "must lie inside the outline"),
        ({"courtyards_m": [YARD, YARD]}, "courtyards_m", "apart from each other"),
        ({"storey_height_m": 3}, "storey_height_m", "has a meaning only with buildings_from"),
        ({"courtyard_m": [YARD]}, "courtyard_m", 'did you mean "courtyards_m"'),
        ({"polygon_m": [[-9, -9], [9, -9], [0, 9]]}, "", "nodes[0] at [0.0, 0.0, 0.0] stands in it"),
    ],
)
def test_faults_of_a_building(table: dict[str, Any], path: str, words: str) -> None:
    """What is wrong with a building is told with its place."""
    whole = {key: value for key, value in (HALL | table).items() if value is not None}
    ((at, message),) = faults_of(small(buildings=[whole])).items()
    assert at == f"buildings[0].{path}".rstrip(".")
    assert words in message


def test_faults_between_buildings() -> None:
    """Names are used once, degrees need an origin, and only a file on this machine names another."""
    named = HALL | {"name": "hall"}
    assert (
        "the name of buildings[0] already" in faults_of(small(buildings=[named, named]))["buildings[1].name"]
    )
    earthly = {"polygon_lat_lon_deg": RING, "height_m": 9}
    assert "buildings[0] is stated by polygon_lat_lon_deg" in faults_of(small(buildings=[earthly]))["origin"]
    far = faults_of(small(buildings=[earthly], origin=ORIGIN | {"lat_deg": 52.0}))
    assert "km from the origin" in far["buildings[0].polygon_lat_lon_deg"]
    named_file = faults_of(small(buildings=[{"buildings_from": "town.geojson"}]))
    assert "only a scenario file on this machine" in named_file["buildings[0].buildings_from"]
    assert "at most 2000 tables" in faults_of(small(buildings=[HALL] * 2001))["buildings"]


@pytest.mark.parametrize(
    ("at", "table", "is_buried"),
    [
        ([30, 7, 5], {}, True),
        ([30, 7, -2], {}, True),
        ([30, 7, 12], {}, False),
        ([30, 0, 5], {}, False),
        ([30, 7, 5], {"courtyards_m": [YARD]}, False),
        ([30, 7, 2], {"base_m": 3}, False),
        ([30, 7, 11], {"height_m": [10, 14]}, True),
    ],
)
def test_where_a_ground_point_may_be(at: list[float], table: dict[str, Any], is_buried: bool) -> None:
    """Not inside a building, but on its roof, at its wall, in its courtyard and in its passage."""
    jammers = [{"position_m": at, "power_w": 1.0}]
    faults = faults_of(small(buildings=[HALL | table], jammers=jammers))
    assert ("buildings[0]" in faults) == is_buried


def test_the_drone_stays_out() -> None:
    """Out of a building at its highest and of its courtyard, by clearance and margin; zones of the solver."""
    table = HALL | {"height_m": [10, 14], "courtyards_m": [YARD], "clearance_m": 2.0}
    scenario = scene(table, airspace={"altitude_m": [8.0, 30.0], "margin_m": 1.0})
    (zone,) = scenario.open_airspace.no_fly
    assert zone.name == "of the building B1"
    at = [[30, 7, 9], [30, 7, 16.9], [30, 7, 17.1], [17.1, 7, 9], [16.9, 7, 9], [30, 18.1, 9]]
    assert scenario.open_airspace.allows(at).tolist() == [False, False, True, False, True, True]
    assert scenario.airspace.allows(at).all()
    assert len(build_family(scenario, any_channel=True).domain.zone_kind) == 1
    low = scene(HALL | {"height_m": 7.5}, airspace={"altitude_m": [8.0, 30.0]})
    assert low.open_airspace is low.airspace
    assert not len(build_family(low, any_channel=True).domain.zone_kind)
    near = scene(HALL | {"height_m": 7.5}, airspace={"altitude_m": [8.0, 30.0], "margin_m": 1.0})
    assert len(build_family(near, any_channel=True).domain.zone_kind) == 1


def test_buildings_may_leave_no_room() -> None:
    """An airspace that lies within a building is refused."""
    airspace = {"altitude_m": [8.0, 9.0], "x_m": [25, 35], "y_m": [5, 10]}
    assert (
        "in a no-fly zone or a building" in faults_of(small(buildings=[HALL], airspace=airspace))["airspace"]
    )


def test_a_building_alone() -> None:
    """A building can be made in Python, as tables of a scenario are."""
    building = Building(polygon_m=((0, 0), (9, 0), (9, 9)), height_m=(3, 4))
    scenario = Scenario.from_arrays([[20, 20, 0]], noise_w=1e-3, altitude_m=(8, 30), buildings=(building,))
    assert scenario.buildings[0].name == "B1"
